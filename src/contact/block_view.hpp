#pragma once

// Rows of the system as the contact integrals see them.

#include "contact/geometry/overlap.hpp"
#include "model/block_system.hpp"

#include <cstddef>

namespace gcpdda {

/// Material point X of a block that is now at x, in the trial configuration.
Vec2 reference_point(const BlockSystem &system, std::size_t row, Vec2 x);

/// Where the material point X of a block is in the trial configuration.
Vec2 current_point(const BlockSystem &system, std::size_t row, Vec2 x);

/// @param outline  is found, and has to live as long as the view
BlockView view_of(const BlockSystem &system, std::size_t row, TrialOutline &outline);

} // namespace gcpdda
