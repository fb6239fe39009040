#pragma once

// Driven blocks whose path leads into others.

#include "gcpdda/model/scene.hpp"
#include "model/block_system.hpp"

namespace gcpdda {

/// Two blocks that keep their velocity push nothing and are pushed by nothing, so they make no contact. A
/// driven block of the scene whose path leads into a fixed one or into another driven one gets a warning
/// here: nothing later says so. So does one whose face closes on that of such a block, as in a shear test: it
/// meets neither pressure nor friction there. The path is looked at 500 times.
///
/// @param blocks  posed; its fixed rows are those of all ranks, so the notes are the same on all
void warn_of_driven_paths(const Scene &scene, const BlockSystem &blocks, Diagnostics &notes);

} // namespace gcpdda
