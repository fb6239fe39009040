#pragma once

// Settle stages with the static solver (statics/pseudo_time.hpp).
//
// A step is one evaluation of the contacts: blocks move by what the last evaluation has found, forces are
// found where they are then, and the iteration finds the motion of the next step. What a step leaves behind
// is the state of the iteration (StageState::iteration), the motions of the blocks (BlockSystem::pseudo) and
// the springs of their contacts (RunState::statics).
//
// Time goes on by the step of the dynamic solver, so that frames, histories and the limit of a stage are
// those of any stage; it means nothing else. Loads that take their time (run.gravity_ramp, relax, ramp) would
// have it mean something: the time of the stage therefore begins when they are complete, and the iteration
// lets them in by its own increments. A load whose table rises and falls would lose its extremes by that, so
// that such a stage is one of damped motion.
//
// A checkpoint holds the whole state of the iteration. It is written, and a run stops, only where the coarse
// matrix is due anyway, so that a restart goes on with the same bits.
//
// A stage that the iteration does not serve, or in which it stalls, goes on with the dynamic solver from
// where the blocks are. It stalls where, once all of the load acts, the least unbalanced ratio of
// `stall_window` evaluations is more than half of that of the window before, and so is the least share of
// blocks that are not at rest (loose_blocks.hpp: in a large model the worst of a few blocks says little of
// all others); and where a block has moved so far that the stage may have failed, the dynamic solver is the
// judge. Where two blocks run into each other by more than half of one, the step that led there is taken back
// first. (In the trials of gcpdda fos, where falling blocks do so, the dynamic step begins anew.)

#include "simulation/run_state.hpp"

namespace gcpdda {

/// The stage at hand takes steps of the static solver.
[[nodiscard]] bool is_static(const RunState &run);
/// When the loads of the stage at hand are what they stay, s; infinite where that is never.
[[nodiscard]] double end_of_loads(const RunState &run);
/// Before a step of a stage with that solver: the iteration begins, goes on after a restart, or leaves the
/// stage to the dynamic solver if it does not serve it. Collective.
void prepare_statics(RunState &run);
/// Collective.
void static_step(RunState &run);
/// The stage is over.
void close_statics(RunState &run);
/// A checkpoint of the state at hand is due.
[[nodiscard]] bool checkpoint_is_due(const RunState &run);

} // namespace gcpdda
