#pragma once

// What all ranks learn of a step: whether one needs a refresh, has failed or was asked to stop.

#include "simulation/run_state.hpp"

namespace gcpdda {

/// One maximum over all ranks. Collective.
void report_step(RunState &run, const AdvanceReport &advance);

/// Counters of this rank after a step.
void count_step(RunState &run, const AdvanceReport &advance);
/// RunState::fault of all local ones. Collective.
void agree_on_fault(RunState &run);

/// What the run so far has to warn of, the same on all ranks. Collective.
[[nodiscard]] Diagnostics warnings_of(const RunState &run);

} // namespace gcpdda
