#pragma once

// The stages of a run: the looks at them, how one ends and the next begins.

#include "simulation/run_state.hpp"

#include <vector>

namespace gcpdda {

/// Time since the strengths of a trial have fallen, of another stage since it began, s.
[[nodiscard]] double time_of_trial(const RunState &run);
/// Before a dynamic step: where a look has come before, strengths of a trial fall by the next increment.
void weaken_further(RunState &run);
/// After a step: kinetic damping, and every so many steps a look at the stage. Collective.
void judge_stage(RunState &run);

/// What the stage has come to, and its verdict. Collective.
void look_at_stage(RunState &run);
/// Mobile blocks lose their velocities.
void set_to_rest(RunState &run);
/// So does one in the middle of its motion; its ledger takes what stopping takes.
void stop(RunState &run, std::size_t row);

/// Of a mobile block by its velocity, J/m.
double kinetic_energy_of(const BlockSystem &blocks, std::size_t row);

/// Of the stages that are over, and of this one as far as it has come. Collective.
[[nodiscard]] std::vector<StageResult> stage_results(RunState &run);
/// A stage that is over gets its result. A settled pile is set to rest, under its own masses. A stage that
/// reached its limit undecided stays as it is: with a longer limit a restart goes on with it. Collective.
void end_stage(RunState &run);
/// Go over to the next stage and do what it does at once. On return the contact forces are those of the new
/// state. Collective.
void begin_next_stage(RunState &run);

} // namespace gcpdda
