#pragma once

// What a valid scene says in vain of blocks that its stages excavate: warnings.

#include "simulation/run_state.hpp"

namespace gcpdda {

/// Warn of excavations by a polygon whose outline passes through centroids: rounding decides about such
/// blocks. Collective.
void doubt_outlines(RunState &run);
/// Warn of monitors of blocks that a stage excavates. Collective.
void doubt_monitors(RunState &run);
/// Warn of loads that a stage sets on blocks which it or an earlier stage excavates. Collective.
void doubt_loads(RunState &run);
/// Warn of bolts in place that a stage takes away, or that lose their hold in part. Collective.
void doubt_bolts(RunState &run);

} // namespace gcpdda
