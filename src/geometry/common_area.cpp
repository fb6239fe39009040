// Along a horizontal line a polygon is the sum over its edges e of s_e H(x - x_e), with s_e = 1 where the
// edge runs down (the polygon begins) and -1 where it runs up. The length that two polygons share is then
// -sum s_e s_f max(x_e, x_f) over the edges e of one and f of the other, and because the signs of each
// polygon add up to zero, x_f may be taken off: what remains is -sum s_e s_f max(x_e - x_f, 0). Its integral
// over the height is the common area.

#include "geometry/common_area.hpp"

#include <algorithm>
#include <vector>

namespace gcpdda {

namespace {

struct Side {
  Vec2 low;
  Vec2 high;
  double sign = 1.0;

  [[nodiscard]] double x_at(double y) const {
    const double share = std::clamp((y - low.y) / (high.y - low.y), 0.0, 1.0);
    return low.x + share * (high.x - low.x);
  }
};

/// The edges that are not horizontal, from below.
std::vector<Side> sides_of(std::span<const Vec2> vertices) {
  std::vector<Side> sides;
  sides.reserve(vertices.size());
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const Vec2 a = vertices[i];
    const Vec2 b = vertices[i + 1 == vertices.size() ? 0 : i + 1];
    if (a.y > b.y) {
      sides.push_back({b, a, 1.0});
    } else if (a.y < b.y) {
      sides.push_back({a, b, -1.0});
    }
  }
  std::sort(sides.begin(), sides.end(), [](const Side &a, const Side &b) { return a.low.y < b.low.y; });
  return sides;
}

/// int max(x_e - x_f, 0) dy over the height at which both lie.
double integrate_lead(const Side &e, const Side &f) {
  const double from = std::max(e.low.y, f.low.y);
  const double to = std::min(e.high.y, f.high.y);
  const double at_from = e.x_at(from) - f.x_at(from);
  const double at_to = e.x_at(to) - f.x_at(to);
  const double higher = std::max(at_from, at_to);
  const double lower = std::min(at_from, at_to);
  if (to <= from || higher <= 0.0) {
    return 0.0;
  }
  const double mean = lower >= 0.0 ? 0.5 * (lower + higher) : 0.5 * higher * higher / (higher - lower);
  return mean * (to - from);
}

} // namespace

double common_area(std::span<const Vec2> first, std::span<const Vec2> second) {
  const std::vector<Side> first_sides = sides_of(first);
  const std::vector<Side> second_sides = sides_of(second);
  std::vector<Side> first_open; // those that a horizontal line meets as it rises
  std::vector<Side> second_open;
  double area = 0.0;
  auto e = first_sides.begin();
  auto f = second_sides.begin();
  while (e != first_sides.end() || f != second_sides.end()) {
    const bool is_first = f == second_sides.end() || (e != first_sides.end() && e->low.y <= f->low.y);
    const Side &next = is_first ? *e++ : *f++;
    std::vector<Side> &others = is_first ? second_open : first_open;
    std::erase_if(others, [&](const Side &side) { return side.high.y <= next.low.y; });
    for (const Side &other : others) {
      area -= next.sign * other.sign * (is_first ? integrate_lead(next, other) : integrate_lead(other, next));
    }
    (is_first ? first_open : second_open).push_back(next);
  }
  return std::max(0.0, area);
}

} // namespace gcpdda
