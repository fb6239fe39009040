#pragma once

// Upper bounds of the factor of safety by limit analysis (limit_analysis/limit_analysis.hpp) at a settled
// state.

#include "simulation/simulation.hpp"

#include <optional>

namespace gcpdda {

/// Bounds between `from` and `to` of the reduction, to 0.1 %; nothing where the blocks could still hold at
/// `to`.
struct SafetyBounds {
  /// Joints are where blocks touch, and where a corner stands before an edge, or beside an end of it, by less
  /// than a tenth of the size of one of both blocks, sqrt(area), and may come to lie on it: a block that
  /// slides on by less and finds hold has not failed. No factor of a run lies above it, but where the motion
  /// itself holds the blocks: one that slides farther, or lever arms that change before a strong support.
  std::optional<double> sliding;
  /// The same for a thousandth of the size: blocks that hold as they lie. No larger than `sliding`, and a
  /// factor beyond it means that blocks have moved to where they hold.
  std::optional<double> resting;
};

/// Blocks are rigid. The load of a block is what its contacts carry: weight, water, loads, and bolts and
/// liners as they pull, which may change by as much as the motion of these blocks lets them
/// (support_reserves.hpp). Strength that depends on pressure (Barton and Bandis) is the line that touches it
/// at the pressure of the state, or the steepest friction where a joint is open. Collective.
/// @param settled         the state; its contact forces are evaluated
/// @param settled_factor  what its strengths were divided by
SafetyBounds bounds_at(Simulation &settled, double settled_factor);

} // namespace gcpdda
