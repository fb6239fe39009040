#pragma once

// What stages do at once: blocks go, parameters change. Every change is made in the same order by a run and
// by a restart into a later stage, so that both have the same bits.

#include "simulation/run_state.hpp"

#include <cstdint>
#include <functional>
#include <vector>

namespace gcpdda {

/// The scene of the stage from here on: laws, materials, loads, water, which blocks are fixed or driven.
/// @param begin  s, of the stage
void adopt(RunState &run, const Stage &stage, double begin);

/// Joint laws from here on; what contacts know of them follows with adopt() or change_strengths().
void take_laws(RunState &run, const std::vector<JointLaw> &laws);
/// Joint laws that differ from those in force in their strengths alone, at once.
void change_strengths(RunState &run, const std::vector<JointLaw> &laws);

/// Bolts and liners that are in place now and were not are put in where the blocks are; those that are no
/// longer, and all links at blocks that are gone, are taken out. Collective.
/// @param bolts, liners  those of the scene in the stage before
void change_support(RunState &run, const std::vector<Bolt> &bolts, const std::vector<Liner> &liners);

/// What change_support() does to bolts, to a copy of those of the run as well. Collective.
/// @param scene  of the stage
/// @param before  the bolts of the scene in the stage before
/// @param is_gone  whether a block has been excavated
void change_bolts(const RunState &run, const Scene &scene, const std::vector<Bolt> &before,
                  const std::function<bool(std::int64_t)> &is_gone, Bolts &bolts, Diagnostics &notes);

/// Ids of the selected blocks, ascending, the same on all ranks. Collective.
[[nodiscard]] std::vector<std::int64_t> select_blocks(const RunState &run, const BlockSelection &selection);

/// Blocks are to be removed; what they put on others stays and goes. Collective.
/// @param relax  s, over which their forces fall to zero; infinite where they stay
void excavate(RunState &run, const std::vector<std::int64_t> &ids, double relax);
/// The blocks that the stage excavates are to be removed; a warning says if there are none. Collective.
void excavate(RunState &run, const Stage &stage);
/// Rows of these blocks go. Collective.
void remove_blocks(RunState &run, const std::vector<std::int64_t> &ids);

/// What excavated blocks still put on this one, at the time of the loads.
[[nodiscard]] Unloading unloading_of(const RunState &run, BlockId block);

} // namespace gcpdda
