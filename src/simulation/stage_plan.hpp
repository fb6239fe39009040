#pragma once

// The steps of the stages of a run, and what is to be said of them.

#include "simulation/run_state.hpp"

#include <cstdint>

namespace gcpdda {

/// What cannot be run is told before anything is.
void plan_all_stages(RunState &run);
/// The steps of the stage that begins. A note on them is given once a run, and where the dynamic step takes
/// them.
void plan_stage(RunState &run);
/// The notes on the steps of a stage that the static solver leaves to the dynamic step.
void note_plan(RunState &run);

/// Steps in which the strengths of a trial fall; its limit counts from there.
[[nodiscard]] std::int64_t steps_of_weakening(const RunState &run);

} // namespace gcpdda
