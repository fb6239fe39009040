#pragma once

// The step of blocks with a matrix of their own: deformable, or with anchors or dashpots.

#include "gcpdda/base/instructions.hpp"
#include "gcpdda/dynamics/integrate.hpp"

#include <optional>

namespace gcpdda {

/// Of rows [first, last) those that have one; what solve_and_update() says holds.
/// @return first row whose new state is broken
std::optional<std::size_t> step_by_own_matrices(BlockSystem &system, const BlockForces &forces,
                                                const Scheme &scheme, double time_step, Elasticity elasticity,
                                                std::size_t first, std::size_t last, double calm = 0.0,
                                                std::vector<RowSpan> *restless = nullptr,
                                                Instructions instructions = Instructions::widest);

} // namespace gcpdda
