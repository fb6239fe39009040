#pragma once

// Where the water of a stage finds the blocks.

#include "dynamics/water_pressure.hpp"
#include "simulation/run_state.hpp"

#include <cstddef>

namespace gcpdda {

/// What the water of the stage at hand does to a row. Settle stages and trials ask whether blocks rest where
/// they are: there it pushes as where the row was when the stage began, and in a stage that confirms a trial
/// as in the trial.
///
/// @param gravity  downwards acceleration, m/s2
/// @param outline  place for the row's outline
WaterLoad water_on(const RunState &run, std::size_t row, double gravity, TrialOutline &outline);

} // namespace gcpdda
