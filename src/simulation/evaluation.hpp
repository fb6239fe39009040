#pragma once

// Contact and bolt forces of a run at the trial configuration, in the parts in which a step takes them.

#include "simulation/run_state.hpp"

namespace gcpdda {

void evaluate_group(RunState &run, const PairGroup &group);
/// Open MPI gets a chance to move the ghosts' messages.
void progress_messages(RunState &run);
void receive_ghosts(RunState &run);
/// Pairs with a ghost, then bolts.
void evaluate_border(RunState &run);
/// Contact forces are summed on each block in the order of its partners' ids, then bolts are added.
void sum_forces(RunState &run);

/// All pairs and bolts at once; ghosts are whole copies.
void evaluate_all(RunState &run);
/// The contact forces of the present trial configuration once more: nothing has moved since.
void evaluate_still(RunState &run);

} // namespace gcpdda
