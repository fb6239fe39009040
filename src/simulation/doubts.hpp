#pragma once

// What is implausible of the blocks of a valid scene together: warnings, one line for each kind.

#include "simulation/run_state.hpp"

#include <span>

namespace gcpdda {

/// Of the blocks as the scene draws them. Collective.
/// @throws SceneError
void doubt_blocks(RunState &run, std::span<const SceneBlock> slab);
/// Why pairs of blocks have been refused for their overlap, and which width would merge the thin ones.
/// Collective.
void explain_slivers(RunState &run);
/// Blocks that face each other across a narrow gap with no block in it. Collective.
void doubt_gaps(RunState &run);

} // namespace gcpdda
