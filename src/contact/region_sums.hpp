#pragma once

// What one touching region of a pair does to its two blocks.

#include "base/ids.hpp"
#include "gcpdda/geometry/mat2.hpp"
#include "model/block_system.hpp"

#include <array>
#include <cstdint>

namespace gcpdda {

/// Normals of a region cancel when the resultant falls below this share of the total pressure.
inline constexpr double least_resultant = 0.1;

/// Torques of a region on the lower and the higher block of its pair, about their trial centroids, N.
using PairTorques = std::array<double, 2>;

/// One touching region: force on the lower block of its pair; the higher block gets the opposite at the same
/// points. All that a step needs of two rigid blocks, together. Four numbers each: the lanes write them so
/// (lane_region.hpp).
struct RegionSums {
  Vec2 force; ///< normal, friction and dashpot, N/m
  PairTorques torque{};
  Vec2 shear_force; ///< elastic part of friction in `force`; acts at `grip`
  PairTorques shear_torque{};
  Vec2 damping_force; ///< dashpots in `force`
  PairTorques damping_torque{};
};

/// What else is known about it, see Details. Four numbers each at first, as above.
struct RegionDetails {
  Mat2 dyad;                 ///< int (x - origin) df^T, N
  Vec2 origin;               ///< what dyads are about
  Vec2 point;                ///< x_r
  Vec2 normal;               ///< n_r
  double normal_force = 0.0; ///< |N|
  double shear = 0.0;        ///< friction and tangential dashpot along -t_r on the lower block
  double cap = 0.0;          ///< N/m
  double overlap = 0.0;      ///< thickness of the overlap along n_r, m
  double extent_begin = 0.0; ///< of the pieces along t_r, from x_r, m
  double extent_end = 0.0;
  Vec2 grip; ///< where friction acts: x_r between rigid blocks, else see src/contact/laws/grip.hpp
  std::uint32_t pair = 0;        ///< number of the candidate
  bool born = false;             ///< not there at the evaluation before
  bool normal_undefined = false; ///< normals nearly cancel: no friction, no dashpot
  bool bonded = false; ///< a bond (bonds.hpp): normal_force is minus its tension, which joins shear_force
};

struct RegionForce : RegionSums, RegionDetails {};

/// What one region does to F of the lower block, about its trial centroid: of pairs with a deformable block.
using RegionDyads = BlockGradientSum;

/// What it does to that of the higher block: the opposite forces at the same points, about another centroid.
/// @param apart  the trial centroid of the lower block from that of the higher one
inline BlockGradientSum on_higher(const RegionDyads &on_lower, const RegionSums &sums, Vec2 apart) {
  return {-1.0 * (on_lower.force + outer(apart, sums.force)),
          -1.0 * (on_lower.shear + outer(apart, sums.shear_force)),
          -1.0 * (on_lower.damping + outer(apart, sums.damping_force))};
}

} // namespace gcpdda
