#pragma once

// What is not balanced on a block, as verdicts and histories see it.
//
// A force is small or large beside others. A block is measured by the largest force anywhere: forces on it
// that come from its neighbours are known no better than those. But a block that lies or slides on its own
// knows none of them, and its weight alone may be less than the tolerance of that force: beside 90,000 times
// its weight a stone with 28 degrees of friction rested on a plane of 30, and the factor of safety of one
// with 1.45 came out as 1.8; beside a million times its weight another one rested in the air. A block with
// weight is therefore measured by no more than `most_times` the largest force on itself: its weight, what is
// applied to it, or a contact. With the tolerance of 1e-5 at most 0.3 % of that is left. A splinter between
// large blocks is measured by what they push with.

#include "simulation/run_state.hpp"

#include <cstddef>

namespace gcpdda {

/// Net force on an owned row that moves, of the last evaluation: before local damping took its share, with
/// that of fixed points, the torque or what strains a deformable block over its radius, N/m.
double unbalanced_force(const RunState &run, std::size_t row);
/// Largest of its weight and the forces applied to it, N/m.
double acting_force(const RunState &run, std::size_t row);

/// Of the largest force on a block itself.
inline constexpr double most_times = 300.0;

/// Finds by what the looks at blocks are measured (BlockLook::yardstick); their unbalanced forces are in
/// RunState::unbalanced_forces as well. Collective.
/// @param largest  force anywhere, N/m
/// @return unbalanced ratio
double measure_looks(RunState &run, double largest);

/// Largest unbalanced force of a block over what it is measured by. Collective.
double unbalanced_ratio(RunState &run);

} // namespace gcpdda
