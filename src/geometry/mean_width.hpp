#pragma once

// The mean width of a polygon, which is small for slivers.

#include "gcpdda/geometry/vec2.hpp"

#include <span>

namespace gcpdda {

/// Area over the longest way across (m): w of a strip w wide, half the height of a flat triangle.
double mean_width(double area, std::span<const Vec2> vertices);

} // namespace gcpdda
