#pragma once

// From a scene to a first state: distribution of the blocks, the step, forces and accelerations.
//
// No rank holds all blocks. Each takes one slab of BlockIds from the scene, its generators and its file, and
// what is said of all of them (region, smallest, median) is agreed on by reductions. From the slabs blocks
// migrate to the owners of their cells; fixed ones go to everybody.

#include "simulation/saved_state.hpp"

namespace gcpdda {

/// The state of a scene at t = 0 or of a checkpoint. Collective.
/// @param run  of a scene that is valid by itself, the same on all ranks
/// @throws SceneError with all that is wrong with the block file, the overlaps, the monitors and the step
/// @throws FileError where the folder it begins with has no checkpoint that fits
void start(RunState &run, const Beginning &beginning);

} // namespace gcpdda
