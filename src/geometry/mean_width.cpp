#include "geometry/mean_width.hpp"

#include "geometry/polygon.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace gcpdda {

double mean_width(double area, std::span<const Vec2> vertices) {
  constexpr std::size_t many = 64;
  if (vertices.size() > many) { // the two farthest are corners of the hull
    const std::vector<Vec2> hull = convex_hull(vertices);
    if (hull.size() < vertices.size()) {
      return mean_width(area, hull);
    }
  }
  double longest = 0.0;
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const Vec2 way = vertices[i] - vertices[j];
      longest = std::max(longest, dot(way, way));
    }
  }
  return longest > 0.0 ? area / std::sqrt(longest) : 0.0;
}

} // namespace gcpdda
