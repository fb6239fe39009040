#pragma once

// Blocks that a settle stage of the dynamic step holds, so that its cost follows what moves.
//
// Where all but a few blocks are at rest, most of a step is spent on contacts that do not change. A block
// whose velocity and acceleration are exactly zero therefore stays where it is for as long as the net force
// on it is at most a tenth of what the tolerance of the stage allows to a block at rest (`held_force`). Pairs
// of two such blocks are left out of the evaluation, to the same bits (contact/resting_rows.hpp). Forces on
// held blocks are known at every step; one on which more than that acts moves on in the same step.
//
// Blocks are set to rest at looks at which no more than a tenth of all are beyond that force or have moved by
// more than `held_motion` of the largest overlap since the look before, and where the static solver hands
// over to the dynamic step. The state itself says who is held, so that a restart goes on with the same bits.
//
// The static solver has its own rule (statics/far_rows.hpp). A block that it keeps where it is for a
// while need not be at rest: where four of 10,883 blocks creep, 10 to 50 % of all move by more than 1e-5 of
// the largest overlap in 50 evaluations.

#include "simulation/run_state.hpp"

namespace gcpdda {

/// N/m; 0 where the stage at hand holds no block.
[[nodiscard]] double held_force(const RunState &run);
/// The same over the largest force anywhere. A trial that is confirmed has ten times the tolerance of others.
[[nodiscard]] double held_ratio(const Stage &stage);

/// That of a block over its mass, as verdicts measure one (unbalanced.hpp) on which only its weight acts,
/// m/s2.
[[nodiscard]] double held_share(const RunState &run);
/// Whether a block stays on which that force acts.
/// @param of_all  held_force()
/// @param share   held_share()
[[nodiscard]] bool is_held_by(const BlockProperties &block, double force, double of_all, double share);

/// Velocity and acceleration are exactly zero.
[[nodiscard]] bool is_at_rest(const BlockSystem &blocks, std::size_t row);
/// What nothing balances on a row, in a measure of forces, N/m.
[[nodiscard]] double net_force(const BlockSystem &blocks, std::size_t row);
/// A row is set to rest where its contacts were last evaluated, so that a step that has moved it is undone.
void hold(BlockSystem &blocks, std::size_t row);

/// At a look: blocks that hardly move are set to rest. Collective.
void hold_at_look(RunState &run);
/// Where the static solver has left all blocks without velocity: those on which hardly a force acts stay.
void hold_after_statics(RunState &run);

} // namespace gcpdda
