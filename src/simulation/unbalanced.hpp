#pragma once

// What is not balanced on a block, as verdicts and histories see it.

#include "simulation/run_state.hpp"

#include <cstddef>

namespace gcpdda {

/// Net force on an owned row that moves, of the last evaluation: before local damping took its share, with
/// that of fixed points, the torque or what strains a deformable block over its radius, N/m.
double unbalanced_force(const RunState &run, std::size_t row);
/// Largest of its weight and the forces applied to it, N/m.
double acting_force(const RunState &run, std::size_t row);

/// Largest unbalanced force of a block over the largest force that acts anywhere. Collective.
double unbalanced_ratio(const RunState &run);

} // namespace gcpdda
