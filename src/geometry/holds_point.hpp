#pragma once

// Whether a point lies in a polygon.

#include "gcpdda/geometry/vec2.hpp"

#include <span>

namespace gcpdda {

/// The point lies in a simple polygon or on its boundary, up to 1e-9 of the polygon's size.
bool holds_point(std::span<const Vec2> vertices, Vec2 point);

/// Distance from the point to the nearest point on the boundary of a simple polygon.
double distance_to_boundary(std::span<const Vec2> vertices, Vec2 point);

} // namespace gcpdda
