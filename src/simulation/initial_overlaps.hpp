#pragma once

// Blocks that overlap at the start by more than a contact may.
//
// The overlap of a contact is thin: nowhere deeper than a share of the narrower block's width. The depth of
// an overlap is that of the edges inside, and it vanishes where outlines coincide: a block that is listed
// twice touches itself without a force. There the area tells. Where all edges inside are in a thin depth, the
// common area is either thin itself, less than a third of the smaller block even if it goes all around a
// triangle, or nearly the whole of it; a half separates them.
//
// Between blocks that keep their motion no contact acts, and supports may overlap on purpose. The same of
// them twice is a slip all the same.

#include "simulation/run_state.hpp"

namespace gcpdda {

/// Faults become notes. Collective.
void check_initial_overlaps(RunState &run);

} // namespace gcpdda
