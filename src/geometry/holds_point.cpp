#include "gcpdda/geometry/holds_point.hpp"

#include "gcpdda/geometry/aabb.hpp"

#include <algorithm>

namespace gcpdda {

bool holds_point(std::span<const Vec2> vertices, Vec2 point) {
  const Aabb box = bounding_box(vertices);
  const double near = 1e-9 * std::max(box.extent().x, box.extent().y);
  if (!box.inflated(near).meets({point, point})) {
    return false;
  }
  bool inside = false;
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const Vec2 a = vertices[i];
    const Vec2 b = vertices[(i + 1) % vertices.size()];
    const Vec2 edge = b - a;
    const double share = std::clamp(dot(point - a, edge) / dot(edge, edge), 0.0, 1.0);
    if (norm(point - (a + share * edge)) <= near) {
      return true;
    }
    // A ray to the right crosses the edges that have one end above the point and one not.
    if ((a.y > point.y) != (b.y > point.y) && point.x < a.x + edge.x * (point.y - a.y) / edge.y) {
      inside = !inside;
    }
  }
  return inside;
}

} // namespace gcpdda
