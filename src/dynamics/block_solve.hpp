#pragma once

// The step of blocks with a matrix of their own: deformable, or with anchors or dashpots.

#include "base/instructions.hpp"
#include "dynamics/integrate.hpp"
#include "dynamics/lanes/block_lanes.hpp"

namespace gcpdda {

BlockSolve block_solve(const OwnForces &forces, const Scheme &scheme, double time_step,
                       Elasticity elasticity);

/// True for deformable blocks that are not driven.
inline bool deforms_freely(const BlockSystem &system, std::size_t row) {
  return system.is_deformable(row) && !system.properties[row].keeps_its_velocity();
}

/// Step those rows of [first, last) that deform or have a matrix, as solve_and_update() says, and list the
/// deformable ones among them that are to be checked.
void solve_by_matrix(BlockSystem &system, const BlockSolve &step, std::size_t first, std::size_t last,
                     double safe_motion, AdvanceReport &report,
                     Instructions instructions = Instructions::widest);

} // namespace gcpdda
