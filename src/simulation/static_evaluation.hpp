#pragma once

// Contacts and their springs in a stage with the static solver: at a configuration, and over a refresh.

#include "simulation/run_state.hpp"

namespace gcpdda {

/// The rows have been found anew. Collective.
void lay_statics(RunState &run);
/// Find the neighbourhood anew; springs go with their blocks. Collective.
void refresh_statics(RunState &run);
/// All that acts at the configuration at hand.
void evaluate_statically(RunState &run);

} // namespace gcpdda
