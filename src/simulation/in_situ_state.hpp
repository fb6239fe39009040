#pragma once

// The in-situ stress of a run (contact/in_situ.hpp), put into blocks that lie as the scene draws them.
//
// Shapes follow from the neighbours at t = 0 and stand in no checkpoint, so every start finds them anew,
// before a restart puts blocks where they have come to: the slab's blocks go to the owners of their places
// for a moment, and what they swell by comes back.

#include "simulation/run_state.hpp"

namespace gcpdda {

/// Blocks swell and get strains. Collective.
/// @throws SceneError where the stress would pull
void apply_in_situ_stress(RunState &run);
/// Contacts that have been evaluated get the shear of the stress, cut at their strength. Collective.
void put_initial_shear(RunState &run);

} // namespace gcpdda
