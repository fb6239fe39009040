#pragma once

// Contacts and their springs in a stage with the static solver: at a configuration, and over a refresh.

#include "simulation/run_state.hpp"

namespace gcpdda {

/// Share of the skin that blocks may use up before a refresh: pairs that are twice as far apart are still
/// known, and with them the springs of contacts that have opened.
inline constexpr double share_of_skin_kept = 0.25;

/// The rows have been found anew. Collective.
void lay_statics(RunState &run);
/// Find the neighbourhood anew; springs go with their blocks. Collective.
void refresh_statics(RunState &run);
/// All that acts at the configuration at hand.
void evaluate_statically(RunState &run);

} // namespace gcpdda
