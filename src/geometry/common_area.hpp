#pragma once

// The area that two polygons have in common.

#include "gcpdda/geometry/vec2.hpp"

#include <span>

namespace gcpdda {

/// Area of the intersection of two simple polygons (m2), both counter-clockwise. It is continuous in the
/// vertices: coincident edges need no tolerance. O((n + m) log(n + m)) and the number of pairs of edges that
/// lie at one height.
double common_area(std::span<const Vec2> first, std::span<const Vec2> second);

} // namespace gcpdda
