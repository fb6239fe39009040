#pragma once

// Blocks of odd shapes, which inspect reports: contact forces on them are soft or short-lived.

#include "gcpdda/parallel/communicator.hpp"
#include "model/block_system.hpp"

#include <cstdint>
#include <limits>

namespace gcpdda {

inline constexpr double needle_angle = 10.0; ///< degrees, of a corner
inline constexpr double sliver_ratio = 0.05; ///< narrowest width over sqrt(area)

/// The worst of its kind and how many there are, over all ranks.
struct Oddity {
  std::int64_t count = 0;
  double worst = std::numeric_limits<double>::infinity();
  std::int64_t block = -1;

  void see(double value, double limit, std::int64_t id);
  /// Of all ranks.
  void agree(const Communicator &communicator);
};

struct OddBlocks {
  Oddity needles; ///< by their sharpest convex corner, degrees
  Oddity slivers; ///< by width over sqrt(area)
};

/// Collective.
OddBlocks odd_blocks(const Communicator &communicator, const BlockSystem &blocks);

} // namespace gcpdda
