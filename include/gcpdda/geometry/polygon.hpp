#pragma once

#include "gcpdda/geometry/vec2.hpp"

#include <span>
#include <vector>

namespace gcpdda {

/// Simplex integrals of a simple polygon (vertices counter-clockwise): area, centroid, and the second
/// moments int x^2, int y^2, int xy dA about the centroid (m4).
struct Moments {
  double area = 0.0;
  Vec2 centroid;
  double xx = 0.0;
  double yy = 0.0;
  double xy = 0.0;
};

/// Positive when the vertices run counter-clockwise (m2).
double signed_area(std::span<const Vec2> vertices);

/// Integrals by the divergence theorem, taken about vertex 0 so that a distant origin costs no digits.
/// Clockwise rings give a negative area (holes).
Moments polygon_moments(std::span<const Vec2> vertices);

/// No edge meets another except neighbours at their common vertex. O(n^2); exact up to rounding of the
/// orientation test.
bool is_simple(std::span<const Vec2> vertices);

/// All turns are left turns or straight up to rounding (counter-clockwise vertices).
bool is_convex(std::span<const Vec2> vertices);

/// Smallest distance between two parallel lines that enclose the polygon's convex hull (m). The minimum is
/// reached flush with an edge of the hull; for a convex polygon every edge is one.
double narrowest_width(std::span<const Vec2> vertices);

} // namespace gcpdda
