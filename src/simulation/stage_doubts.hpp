#pragma once

// What is doubtful of values that stages change.

#include "simulation/run_state.hpp"

namespace gcpdda {

/// Overlaps and strains are total: a stage that changes the stiffness of joints or blocks that are there
/// changes the stress in them, too. One warning for each such stage, with the stiffness of joints that
/// follows from moduli. Collective.
void doubt_stiffness(RunState &run);

/// Bonds to which a stage gives so much tension, or so little stiffness, that they open far before they
/// break.
void doubt_stretch_of_bonds(RunState &run);

} // namespace gcpdda
