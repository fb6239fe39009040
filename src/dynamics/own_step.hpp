#pragma once

// The step of blocks with a matrix of their own: deformable, or with anchors or dashpots.

#include "block_lanes.hpp"

#include "gcpdda/base/instructions.hpp"
#include "gcpdda/dynamics/integrate.hpp"

namespace gcpdda {

OwnStep own_step(const OwnForces &forces, const Scheme &scheme, double time_step, Elasticity elasticity);

/// Does it deform, and heed forces?
inline bool deforms_freely(const BlockSystem &system, std::size_t row) {
  return system.is_deformable(row) && !system.properties[row].keeps_its_velocity();
}

/// Of rows [first, last) those that deform or have such a matrix; what solve_and_update() says holds, but
/// that only deformable ones are looked at.
void step_by_own_matrices(BlockSystem &system, const OwnStep &step, std::size_t first, std::size_t last,
                          double calm, AdvanceReport &report,
                          Instructions instructions = Instructions::widest);

} // namespace gcpdda
