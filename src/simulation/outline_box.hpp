#pragma once

// Where a block can be at most, without its outline.

#include "geometry/aabb.hpp"
#include "model/block_system.hpp"

#include <cstddef>

namespace gcpdda {

/// A box that holds the outline of a block at t_n. It is that of a circle, which costs a fraction of the
/// outline and tells most blocks apart from what lies far away.
Aabb box_around(const BlockSystem &system, std::size_t row);

} // namespace gcpdda
