#pragma once

// Convex polygons cut by lines, for integrals over an overlap.

#include "gcpdda/geometry/vec2.hpp"

#include <cstddef>
#include <vector>

namespace gcpdda {

using Polygon = std::vector<Vec2>;

/// The part of a convex polygon where distance(x) >= 0 for a linear function given by its values at the
/// vertices.
template <class Distance> Polygon keep_positive(const Polygon &polygon, const Distance &distance) {
  Polygon kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec2 a = polygon[i];
    const Vec2 b = polygon[(i + 1) % polygon.size()];
    const double da = distance(a);
    const double db = distance(b);
    if (da >= 0.0) {
      kept.push_back(a);
    }
    if ((da > 0.0 && db < 0.0) || (da < 0.0 && db > 0.0)) {
      kept.push_back(a + (da / (da - db)) * (b - a));
    }
  }
  return kept;
}

/// int d dA of a linear function over a convex polygon: each triangle of the fan by the mean of its corners.
template <class Distance> double integrate_linear(const Polygon &polygon, const Distance &distance) {
  double sum = 0.0;
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
    const double area = 0.5 * cross(polygon[i] - polygon[0], polygon[i + 1] - polygon[0]);
    sum += area * (distance(polygon[0]) + distance(polygon[i]) + distance(polygon[i + 1])) / 3.0;
  }
  return sum;
}

} // namespace gcpdda
