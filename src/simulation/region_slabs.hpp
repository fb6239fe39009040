#pragma once

#include "gcpdda/base/diagnostic.hpp"
#include "gcpdda/model/scene.hpp"
#include "gcpdda/parallel/communicator.hpp"
#include "simulation/run_state.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace gcpdda {

/// The faults that all ranks have seen, in the order of the ranks; the first 20 and how many there are more.
/// Collective.
Diagnostics all_faults(const Communicator &communicator, const Diagnostics &mine);

/// Brings the blocks that the ranks have cut, ids first, first + 1, ... in the order of the ranks, to the
/// slabs of ids they belong to, and appends them there. Collective.
/// @param num_blocks  of the scene
void send_to_slabs(const Communicator &communicator, std::int64_t num_blocks, std::int64_t first,
                   std::vector<SceneBlock> cut, std::vector<SceneBlock> &slab);

/// Each rank cuts its share of the tiles of the scene's region; how many blocks there are is known then.
/// Collective.
/// @throws SceneError
std::vector<SceneBlock> cut_region(RunState &run);
/// Everybody learns which blocks lie in the openings. Collective.
void note_groups(RunState &run, std::span<const SceneBlock> slab);

} // namespace gcpdda
