#include "geometry/holds_point.hpp"

#include "geometry/aabb.hpp"

#include <algorithm>
#include <limits>

namespace gcpdda {

namespace {

double distance_to_edge(Vec2 a, Vec2 b, Vec2 point) {
  const Vec2 edge = b - a;
  const double share = std::clamp(dot(point - a, edge) / dot(edge, edge), 0.0, 1.0);
  return norm(point - (a + share * edge));
}

} // namespace

double distance_to_boundary(std::span<const Vec2> vertices, Vec2 point) {
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    nearest = std::min(nearest, distance_to_edge(vertices[i], vertices[(i + 1) % vertices.size()], point));
  }
  return nearest;
}

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
    if (distance_to_edge(a, b, point) <= near) {
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
