#pragma once

// What contacts remember from one evaluation to the next, by candidate pair and region.

#include "base/ids.hpp"
#include "gcpdda/geometry/vec2.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <tuple>
#include <vector>

namespace gcpdda {

enum class ContactState : std::uint8_t { stick = 1, slip = 2, bonded = 3 };

/// All that is remembered of a contact region of two convex blocks, alive from its first evaluation with an
/// overlap to its last. Four numbers: the lanes read and write them so (src/contact/lanes/lane_region.hpp).
struct RegionState {
  double shear = 0.0;    ///< F_t: along -t_r on the lower block, along t_r on the higher one, N/m
  double longest = 0.0;  ///< largest extent along t_r so far, m: the tangential stiffness never falls
  double slip = 0.0;     ///< accumulated sliding distance, m
  std::int32_t law = -1; ///< JointLaws::constants has it; -1: the only one its pair can have
  ContactState state = ContactState::stick;
  std::uint16_t seen_at = 0; ///< where a choice among laws was made last (contact/laws/region_law.hpp)
};

/// A member of RegionMemory by name.
template <class Member> struct RegionField {
  const char *name;
  Member member;
};
template <class Member> RegionField(const char *, Member) -> RegionField<Member>;

/// Memory of any region, or of one bond, alive until it breaks.
struct RegionMemory : RegionState {
  Vec2 position; ///< x_r in the lower block's reference axes, m; not kept for two convex blocks
  Vec2 opening;  ///< of the joint by its law, in axes that turn with the mean of both blocks, m
  std::int32_t lower_stretch = 0;  ///< stretches of the outlines between re-entrant vertices that face each
  std::int32_t higher_stretch = 0; ///< other; 0 for a convex block; of a bond -1 - number of its edge
  Vec2 grip; ///< where friction acts, in the lower block's reference axes, m; kept if one of the blocks
             ///< deforms

  [[nodiscard]] bool is_bond() const { return lower_stretch < 0; }
  [[nodiscard]] bool is_opened() const { return opening != Vec2{}; }

  /// Everything but blocks, stretches, state, law and where it was chosen, with the names that checkpoints
  /// give it.
  static constexpr auto fields() {
    return std::tuple{RegionField{"/region/shear", &RegionMemory::shear},
                      RegionField{"/region/longest", &RegionMemory::longest},
                      RegionField{"/region/slip", &RegionMemory::slip},
                      RegionField{"/region/position", &RegionMemory::position},
                      RegionField{"/region/dilation", &RegionMemory::opening},
                      RegionField{"/region/grip", &RegionMemory::grip}};
  }

  /// Two copies of one region, not two regions of a pair.
  [[nodiscard]] bool is_same_region(const RegionMemory &other) const {
    return lower_stretch == other.lower_stretch && higher_stretch == other.higher_stretch &&
           position == other.position;
  }
};
// A field that is added joins RegionMemory::fields().
static_assert(sizeof(RegionMemory) == 11 * sizeof(double));

/// A memory with its identity, as it travels with a block.
struct RegionRecord {
  BlockId lower;
  BlockId higher;
  RegionMemory memory;
};
/// The same of a plain pair (contact/candidates.hpp) of rigid blocks, which needs no more.
struct PlainRecord {
  BlockId lower;
  BlockId higher;
  RegionState memory;
};
/// What is remembered of contacts, in any order of pairs.
struct ContactMemory {
  std::vector<PlainRecord> plain;
  std::vector<RegionRecord> others; ///< may be of any pairs
};

/// Consecutive regions of one pair.
struct RegionRange {
  std::uint32_t begin = 0;
  std::uint32_t count = 0;
};

/// How a plain pair (contact/candidates.hpp) overlaps, and so mostly in the next step: with one corner of
/// each block, or in some other polygon. To know it saves work and changes no result. The PlainPair::Kind of
/// the pair must allow corners.
enum class PlainOverlap : std::uint8_t { none = 0, corners = 1, polygon = 2 };

/// Contact memory by candidate pair. Only living regions are listed: at most one of two convex blocks, and
/// behind those of a pair its bonds.
struct ContactHistory {
  // One a pair. A step writes these of plain pairs, and nothing else.
  std::vector<PlainOverlap> overlaps; ///< `none` of the other pairs
  std::vector<RegionState> plain;     ///< the region of a plain pair that overlaps
  std::vector<Vec2> grips;            ///< RegionMemory::grip of it; empty where no block deforms
  // Of the other pairs.
  std::vector<RegionRange> ranges; ///< of `regions`, one a pair; empty if all pairs are plain
  std::vector<RegionMemory> regions;

  [[nodiscard]] bool has_plain(std::size_t pair) const { return overlaps[pair] != PlainOverlap::none; }
  [[nodiscard]] std::size_t num_plain() const {
    const auto none = std::ranges::count(overlaps, PlainOverlap::none);
    return overlaps.size() - static_cast<std::size_t>(none);
  }
  /// Of a pair that is not plain.
  [[nodiscard]] std::span<const RegionMemory> of_other(std::size_t pair) const {
    return ranges.empty() ? std::span<const RegionMemory>()
                          : std::span(regions).subspan(ranges[pair].begin, ranges[pair].count);
  }
  [[nodiscard]] std::span<RegionMemory> of_other(std::size_t pair) {
    return ranges.empty() ? std::span<RegionMemory>()
                          : std::span(regions).subspan(ranges[pair].begin, ranges[pair].count);
  }
  /// Does it touch, or hold by a bond?
  [[nodiscard]] bool is_living(std::size_t pair) const { return has_plain(pair) || !of_other(pair).empty(); }
  [[nodiscard]] bool empty() const {
    return regions.empty() &&
           std::ranges::all_of(overlaps, [](PlainOverlap overlap) { return overlap == PlainOverlap::none; });
  }
  /// visit(memory) for the regions and bonds of a pair.
  template <class Visit> void for_pair(std::size_t pair, Visit &&visit) const {
    if (has_plain(pair)) {
      visit(RegionMemory{plain[pair], {}, {}, 0, 0, grips.empty() ? Vec2{} : grips[pair]});
    } else {
      std::ranges::for_each(of_other(pair), visit);
    }
  }
  [[nodiscard]] std::vector<RegionMemory> of_pair(std::size_t pair) const {
    std::vector<RegionMemory> known;
    for_pair(pair, [&](const RegionMemory &memory) { known.push_back(memory); });
    return known;
  }
  /// Region or bond `number` of a pair.
  [[nodiscard]] RegionState &state(std::size_t pair, std::size_t number) {
    return has_plain(pair) ? plain[pair] : regions[ranges[pair].begin + number];
  }
  [[nodiscard]] const RegionState &state(std::size_t pair, std::size_t number) const {
    return has_plain(pair) ? plain[pair] : regions[ranges[pair].begin + number];
  }
  [[nodiscard]] bool has_bonds(std::size_t pair) const {
    const std::span<const RegionMemory> known = of_other(pair);
    return !known.empty() && known.back().is_bond();
  }
  [[nodiscard]] bool is_opened(std::size_t pair) const {
    const std::span<const RegionMemory> known = of_other(pair);
    return std::any_of(known.begin(), known.end(), [](const RegionMemory &m) { return m.is_opened(); });
  }
};

} // namespace gcpdda
