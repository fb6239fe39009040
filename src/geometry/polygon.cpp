#include "gcpdda/geometry/polygon.hpp"

#include <algorithm>
#include <limits>

namespace gcpdda {

namespace {

// Sign of the turn a -> b -> c, with turns within rounding of the coordinates' differences counted straight.
int turn(Vec2 a, Vec2 b, Vec2 c) {
  const Vec2 ab = b - a;
  const Vec2 ac = c - a;
  const double area2 = cross(ab, ac);
  const double bound =
      4.0 * std::numeric_limits<double>::epsilon() * (std::abs(ab.x * ac.y) + std::abs(ab.y * ac.x));
  return area2 > bound ? 1 : area2 < -bound ? -1 : 0;
}

bool within_box(Vec2 p, Vec2 a, Vec2 b) {
  return std::min(a.x, b.x) <= p.x && p.x <= std::max(a.x, b.x) && std::min(a.y, b.y) <= p.y &&
         p.y <= std::max(a.y, b.y);
}

bool segments_meet(Vec2 a, Vec2 b, Vec2 c, Vec2 d) {
  const int abc = turn(a, b, c);
  const int abd = turn(a, b, d);
  const int cda = turn(c, d, a);
  const int cdb = turn(c, d, b);
  if (abc * abd < 0 && cda * cdb < 0) {
    return true;
  }
  return (abc == 0 && within_box(c, a, b)) || (abd == 0 && within_box(d, a, b)) ||
         (cda == 0 && within_box(a, c, d)) || (cdb == 0 && within_box(b, c, d));
}

} // namespace

double signed_area(std::span<const Vec2> vertices) {
  double twice = 0.0;
  for (std::size_t i = 1; i + 1 < vertices.size(); ++i) {
    twice += cross(vertices[i] - vertices[0], vertices[i + 1] - vertices[0]);
  }
  return 0.5 * twice;
}

Moments polygon_moments(std::span<const Vec2> vertices) {
  double area = 0.0;
  Vec2 first;
  double xx = 0.0;
  double yy = 0.0;
  double xy = 0.0;
  for (std::size_t i = 1; i + 1 < vertices.size(); ++i) {
    const Vec2 p = vertices[i] - vertices[0];
    const Vec2 q = vertices[i + 1] - vertices[0];
    const double w = cross(p, q);
    area += w / 2.0;
    first += (w / 6.0) * (p + q);
    xx += w / 12.0 * (p.x * p.x + p.x * q.x + q.x * q.x);
    yy += w / 12.0 * (p.y * p.y + p.y * q.y + q.y * q.y);
    xy += w / 24.0 * (2.0 * p.x * p.y + p.x * q.y + q.x * p.y + 2.0 * q.x * q.y);
  }
  const Vec2 c = (1.0 / area) * first;
  return {area, vertices[0] + c, xx - area * c.x * c.x, yy - area * c.y * c.y, xy - area * c.x * c.y};
}

bool is_simple(std::span<const Vec2> vertices) {
  const std::size_t n = vertices.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Vec2 a = vertices[i];
    const Vec2 b = vertices[(i + 1) % n];
    // A neighbour may fold back onto this edge.
    const Vec2 c = vertices[(i + 2) % n];
    if (turn(a, b, c) == 0 && dot(b - a, c - b) < 0.0) {
      return false;
    }
    for (std::size_t j = i + 2; j < n; ++j) {
      const bool closes_ring = i == 0 && j == n - 1;
      if (!closes_ring && segments_meet(a, b, vertices[j], vertices[(j + 1) % n])) {
        return false;
      }
    }
  }
  return true;
}

bool is_convex(std::span<const Vec2> vertices) {
  const std::size_t n = vertices.size();
  // A vertex placed on a straight edge by another program's rounding sits up to about 1e-12 edge lengths off
  // it; such a dent is far below any overlap and the lower envelope does not mind it.
  constexpr double dent = 1e-11;
  double largest = 0.0;
  for (const Vec2 p : vertices) {
    largest = std::max({largest, std::abs(p.x), std::abs(p.y)});
  }
  const double rounding = 4.0 * std::numeric_limits<double>::epsilon() * largest;
  for (std::size_t i = 0; i < n; ++i) {
    const Vec2 in = vertices[(i + 1) % n] - vertices[i];
    const Vec2 out = vertices[(i + 2) % n] - vertices[(i + 1) % n];
    if (cross(in, out) < -dent * norm(in) * norm(out) - rounding * (norm(in) + norm(out))) {
      return false;
    }
  }
  return true;
}

double narrowest_width(std::span<const Vec2> vertices) {
  const std::size_t n = vertices.size();
  // The edges of a convex polygon are those of its hull. Otherwise the hull's are among all pairs of
  // vertices, and no direction is narrower than the narrowest.
  const std::size_t farthest = is_convex(vertices) ? 1 : n - 1;
  double narrowest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t step = 1; step <= farthest; ++step) {
      const Vec2 along = vertices[(i + step) % n] - vertices[i];
      const double length = norm(along);
      double low = 0.0;
      double high = 0.0;
      for (const Vec2 p : vertices) {
        const double d = cross(along, p - vertices[i]);
        low = std::min(low, d);
        high = std::max(high, d);
      }
      if (length > 0.0) {
        narrowest = std::min(narrowest, (high - low) / length);
      }
    }
  }
  return narrowest;
}

} // namespace gcpdda
