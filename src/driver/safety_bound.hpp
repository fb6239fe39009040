#pragma once

// The upper bound of the factor of safety by limit analysis (limit_analysis/limit_analysis.hpp) at a settled
// state.

#include "simulation/simulation.hpp"

#include <optional>

namespace gcpdda {

/// Bound between `from` and `to` of the reduction, to 0.1 %; nothing where the blocks could still hold at
/// `to`. Blocks are rigid there, as they lie. Joints are where they touch, and where a corner stands before
/// an edge at less than a tenth of the smallest block: a block that slides on by less and finds hold has not
/// failed. The load of a block is what its contacts carry: weight, water, bolts and liners as they pull,
/// loads. Friction that depends on pressure (Barton and Bandis) is taken at the pressure of the state, or of
/// none where a joint is open. Collective.
/// @param settled         the state; its contact forces are evaluated
/// @param settled_factor  what its strengths were divided by
std::optional<double> bound_at(Simulation &settled, double settled_factor);

} // namespace gcpdda
