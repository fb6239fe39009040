#pragma once

// Upper bounds of the factor of safety by limit analysis (limit_analysis/limit_analysis.hpp) at a settled
// state, or at one that stages without steps have changed since.
//
// The load of a block is all that acts on it but its contacts. At rest it is minus the sum of the forces of
// its contacts, whatever it is made of. Stages that change the scene at once (loads, weight, water,
// strengths, rock that is excavated, blocks that are freed) leave blocks and contacts as they are, and
// nothing balances the change. With R the sum of all forces on a block in one evaluation and C that of its
// contacts in the same one, its load is
//     L = R - C,
// again whatever it is made of. R is zero at rest. Each region counts in R by the same resultant as in C, so
// that L does not depend on what contacts happen to carry at the moment. Loads that take their time (ramps,
// tables, the forces of excavated rock that fall to zero) count as what they come to in the end: a run is at
// rest under no others. The torque of a deformable block is the part of R that works on a rotation: with G
// the force on F (dynamics/deformable.hpp), and D = F G^T the dyad of arms and forces, D_xy - D_yx.
// Elasticity has no such part.

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

/// Blocks are rigid. The load of a block is weight, water, loads, and bolts and liners as they pull, which
/// may change by as much as the motion of these blocks lets them (support_reserves.hpp). Strength that
/// depends on pressure (Barton and Bandis) is the line that touches it at the pressure of the state, or the
/// steepest friction where a joint is open. Collective.
/// @param settled         the state at the end of a settle stage, or of stages without steps behind it; its
///                        contact forces are evaluated, and in the latter case its loads are completed
/// @param settled_factor  what its strengths were divided by
SafetyBounds bounds_at(Simulation &settled, double settled_factor);

} // namespace gcpdda
