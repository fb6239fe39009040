#pragma once

// What a simulation tells of itself at the end of a run: sizes, counted work, verdicts, seconds by phase.

#include "gcpdda/io/run_summary.hpp"
#include "simulation/simulation.hpp"

#include <cstdint>
#include <vector>

namespace gcpdda {

/// What the summary says of the stages that have begun.
/// @param stages   those of the run, in order
/// @param results  of the first ones
std::vector<RunSummary::StageLine> stage_lines(const Scene &scene, const std::vector<Stage> &stages,
                                               const std::vector<StageResult> &results);

/// Collective.
/// @param first_step  of this part of the run
/// @param summary  gets all that follows from the simulation alone
void take_facts(const Communicator &communicator, Simulation &simulation, std::int64_t first_step,
                RunSummary &summary);

} // namespace gcpdda
