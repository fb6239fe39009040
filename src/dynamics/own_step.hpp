#pragma once

// The step of a block with a matrix of its own: deformable, or with anchors or dashpots.

#include "gcpdda/dynamics/integrate.hpp"

namespace gcpdda {

/// @return false, and the old state kept, if the new one is not finite
bool step_by_own_matrix(BlockSystem &system, std::size_t row, const BlockForces &forces, const Scheme &scheme,
                        double time_step, Elasticity elasticity);

} // namespace gcpdda
