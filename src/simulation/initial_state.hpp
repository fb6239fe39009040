#pragma once

#include "simulation/run_state.hpp"

namespace gcpdda {

/// The consistent initial state of blocks that have been distributed: bonds, initial stick forces and
/// accelerations, and what is wrong with overlaps. Collective.
void find_initial_state(RunState &run);

} // namespace gcpdda
