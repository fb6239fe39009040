#pragma once

// What a simulation tells of itself at the end of a run: sizes, counted work, verdicts, seconds by phase.

#include "gcpdda/io/run_summary.hpp"
#include "simulation/simulation.hpp"

#include <cstdint>

namespace gcpdda {

/// Collective.
/// @param first_step  of this part of the run
/// @param summary  gets all that follows from the simulation alone
void take_facts(const Communicator &communicator, Simulation &simulation, std::int64_t first_step,
                RunSummary &summary);

} // namespace gcpdda
