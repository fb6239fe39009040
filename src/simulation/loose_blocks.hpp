#pragma once

// Loose blocks: the few that keep moving where all others are at rest.
//
// In a large model some blocks have no place to rest near by: a block on a bench face falls through a gap of
// millimetres, one that has lost a contact bounces. Each carries no more than itself, so the rest of the
// model is in equilibrium whatever they do, and to wait for them costs an evaluation of all pairs for each of
// their steps. A settle stage therefore does not wait for them. Loose is a block whose net force or motion
// since the look before is beyond what is allowed to a block at rest (stages.hpp). A stage has settled but
// for its loose blocks where, at a number of looks in a row,
//     they are at most 0.1 % of the mobile blocks,
//     their net forces together are at most 1 % of the weights and applied loads of all,
//     and the kinetic energy of the others does not grow.
// They are named, and go on moving in the next stage. A trial of gcpdda fos by the static solver does not
// wait for them either where they stay near (static_stage.cpp).

#include "simulation/run_state.hpp"

namespace gcpdda {

/// Its net force or its motion is beyond what is allowed to a block at rest.
/// @param look  at all blocks
[[nodiscard]] bool is_loose(const BlockLook &block, const Stage &stage, const StageLook &look);

/// Fills in what a look at a stage says of loose blocks, from RunState::looks. Collective.
void look_for_loose_blocks(RunState &run, StageLook &look);

/// Remember and say that the stage at hand has settled but for the loose blocks of the last look. Collective.
void note_loose_blocks(RunState &run);
/// The same where the stage at hand has ended so. Collective.
void note_loose_blocks_at_end(RunState &run);

} // namespace gcpdda
