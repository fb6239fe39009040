#pragma once

// Which stretches of edges the water tables with a list of laws wet, found once from the scene's shapes.

#include "simulation/run_state.hpp"

namespace gcpdda {

/// Fill BlockSystem::water_stretch of all rows; nothing where no water table lists laws. Rows are those of
/// the slab, at t = 0 and not yet closed by an in-situ stress. Collective.
void find_wet_joints(RunState &run);

/// The freed row of a block that was fixed keeps the stretches of its fixed row.
void keep_wet_joints(const BlockSystem &blocks, std::int64_t id, BlockSystem &freed);

} // namespace gcpdda
