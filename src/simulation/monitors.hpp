#pragma once

// Which blocks the monitored points of a scene follow.

#include "simulation/run_state.hpp"

#include <span>

namespace gcpdda {

/// @param slab  blocks of this rank
/// @throws SceneError where a monitor has no block. Collective.
void place_monitors(RunState &run, std::span<const SceneBlock> slab);

} // namespace gcpdda
