#pragma once

// Water tables that act on nothing, or twice: warnings.

#include "simulation/run_state.hpp"

namespace gcpdda {

/// Warn of water tables that wet no edge of a block that can move, and of two that act on the same edge.
/// Rows are those of the slab at t = 0, with what find_wet_joints() has found. Collective.
void doubt_water(RunState &run);

} // namespace gcpdda
