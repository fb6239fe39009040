#pragma once

// Boxes along the axes.

#include "gcpdda/geometry/vec2.hpp"

#include <algorithm>
#include <limits>
#include <span>

namespace gcpdda {

/// Axis-aligned box; a fresh one is empty (meets nothing).
struct Aabb {
  Vec2 low{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  Vec2 high{-std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};

  void include(Vec2 p) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y)};
  }
  void include(const Aabb &b) {
    low = {std::min(low.x, b.low.x), std::min(low.y, b.low.y)};
    high = {std::max(high.x, b.high.x), std::max(high.y, b.high.y)};
  }
  [[nodiscard]] bool empty() const { return low.x > high.x; }
  [[nodiscard]] Vec2 extent() const { return high - low; }
  [[nodiscard]] Aabb inflated(double by) const {
    return {{low.x - by, low.y - by}, {high.x + by, high.y + by}};
  }
  [[nodiscard]] bool holds(Vec2 p) const {
    return low.x <= p.x && p.x <= high.x && low.y <= p.y && p.y <= high.y;
  }
  [[nodiscard]] bool meets(const Aabb &b) const {
    return low.x <= b.high.x && b.low.x <= high.x && low.y <= b.high.y && b.low.y <= high.y;
  }
};

inline Aabb bounding_box(std::span<const Vec2> points) {
  Aabb box;
  for (const Vec2 p : points) {
    box.include(p);
  }
  return box;
}

} // namespace gcpdda
