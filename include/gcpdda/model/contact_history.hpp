#pragma once

#include "gcpdda/base/ids.hpp"
#include "gcpdda/geometry/vec2.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace gcpdda {

enum class ContactState : std::uint8_t { stick = 1, slip = 2, bonded = 3 };

/// Memory of one contact region, alive from its first evaluation with an overlap to its last, or of one bond,
/// alive until it breaks.
struct RegionMemory {
  double shear = 0.0;    ///< F_t: along -t_r on the lower block, along t_r on the higher one, N/m
  double longest = 0.0;  ///< largest extent along t_r so far, m: the tangential stiffness never falls
  double slip = 0.0;     ///< accumulated sliding distance, m
  std::int32_t law = -1; ///< that the region was born with; -1: the only one its pair can have
  ContactState state = ContactState::stick;
  // All that a step needs of two convex blocks stands above.
  Vec2 position; ///< x_r in the lower block's reference axes, m; not kept for two convex blocks
  Vec2 dilation; ///< what slip has opened, in axes that turn with the mean of both blocks, m
  std::int32_t lower_stretch = 0;  ///< stretches of the outlines between re-entrant vertices that face each
  std::int32_t higher_stretch = 0; ///< other; 0 for a convex block; of a bond -1 - number of its edge

  [[nodiscard]] bool is_bond() const { return lower_stretch < 0; }
  [[nodiscard]] bool is_dilated() const { return dilation != Vec2{}; }

  /// Two copies of one region, not two regions of a pair.
  [[nodiscard]] bool is_same_region(const RegionMemory &other) const {
    return lower_stretch == other.lower_stretch && higher_stretch == other.higher_stretch &&
           position == other.position;
  }
};

/// A memory with its identity, as it travels with a block.
struct RegionRecord {
  BlockId lower;
  BlockId higher;
  RegionMemory memory;
};

/// Consecutive regions of one pair.
struct RegionRange {
  std::uint32_t begin = 0;
  std::uint32_t count = 0;
};

/// Contact memory by candidate pair. Only living regions are listed, at most one of two convex blocks, and
/// behind them the bonds.
struct ContactHistory {
  std::vector<RegionRange> ranges; ///< one a pair
  std::vector<RegionMemory> regions;
  /// Whether a pair overlapped otherwise than with one corner of each block, and hardly will so in the next
  /// step. Saves work and changes no result: it is forgotten where that is easier. One a pair, or none.
  std::vector<std::uint8_t> by_faces;

  [[nodiscard]] std::span<const RegionMemory> of_pair(std::size_t pair) const {
    return {regions.data() + ranges[pair].begin, ranges[pair].count};
  }
  [[nodiscard]] bool has_bonds(std::size_t pair) const {
    return ranges[pair].count > 0 && of_pair(pair).back().is_bond();
  }
  [[nodiscard]] bool is_dilated(std::size_t pair) const {
    const std::span<const RegionMemory> known = of_pair(pair);
    return std::any_of(known.begin(), known.end(), [](const RegionMemory &m) { return m.is_dilated(); });
  }
};

} // namespace gcpdda
