#include "gcpdda/geometry/mean_width.hpp"

#include <algorithm>
#include <cmath>

namespace gcpdda {

double mean_width(double area, std::span<const Vec2> vertices) {
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
