#pragma once

// The energy of an overlap.

#include "contact/geometry/overlap.hpp"

namespace gcpdda {

/// Energy int_S (phi_A + phi_B) H dA (m3) that belongs to the forces of RegionIntegrals: moving a block
/// changes it by minus the work of its contact force. For the ledger, not for the step: it assembles S.
double overlap_energy(const BlockView &first, const BlockView &second);

} // namespace gcpdda
