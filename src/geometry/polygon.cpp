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

/// Whether the boundary turns right from `in` to `out` by more than `rounding` of the vertices explains.
bool turns_right(Vec2 in, Vec2 out, double rounding) {
  // A vertex placed on a straight edge by another program's rounding sits up to about 1e-12 edge lengths off
  // it; such a dent is far below any overlap and the lower envelope does not mind it.
  constexpr double dent = 1e-11;
  return cross(in, out) < -dent * norm(in) * norm(out) - rounding * (norm(in) + norm(out));
}

double rounding_of(std::span<const Vec2> vertices) {
  double largest = 0.0;
  for (const Vec2 p : vertices) {
    largest = std::max({largest, std::abs(p.x), std::abs(p.y)});
  }
  return 4.0 * std::numeric_limits<double>::epsilon() * largest;
}

/// Whether an edge other than those at vertex `from` crosses the way from there to `to`, short of its end.
bool is_blocked(std::span<const Vec2> vertices, std::size_t from, Vec2 to) {
  const std::size_t n = vertices.size();
  const Vec2 v = vertices[from];
  const Vec2 way = to - v;
  constexpr double short_of_end = 1e-9;
  for (std::size_t step = 1; step + 1 < n; ++step) {
    const Vec2 a = vertices[(from + step) % n];
    const Vec2 edge = vertices[(from + step + 1) % n] - a;
    const double from_a = cross(way, a - v);
    const double from_b = cross(way, a + edge - v);
    const double across = cross(way, edge);
    if (across != 0.0 && (from_a <= 0.0) != (from_b <= 0.0)) {
      const double share = cross(a - v, edge) / across;
      if (share > 0.0 && share < 1.0 - short_of_end) {
        return true;
      }
    }
  }
  return false;
}

/// Smallest distance from a re-entrant vertex through the interior to an edge that does not start or end
/// there. The foot of a step's riser lies in the cone's border: material is not narrow there.
double width_at(std::span<const Vec2> vertices, std::size_t vertex) {
  const std::size_t n = vertices.size();
  const Vec2 v = vertices[vertex];
  const Vec2 in = v - vertices[(vertex + n - 1) % n];
  const Vec2 out = vertices[(vertex + 1) % n] - v;
  constexpr double strictly = 1e-9;
  double narrowest = std::numeric_limits<double>::infinity();
  for (std::size_t step = 1; step + 1 < n; ++step) {
    const Vec2 a = vertices[(vertex + step) % n];
    const Vec2 edge = vertices[(vertex + step + 1) % n] - a;
    const double share = std::clamp(dot(v - a, edge) / dot(edge, edge), 0.0, 1.0);
    const Vec2 foot = a + share * edge;
    const double width = norm(foot - v);
    const bool in_cone = cross(in, foot - v) > strictly * norm(in) * width ||
                         cross(out, foot - v) > strictly * norm(out) * width;
    if (width < narrowest && in_cone && !is_blocked(vertices, vertex, foot)) {
      narrowest = width;
    }
  }
  return narrowest;
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
  const double rounding = rounding_of(vertices);
  for (std::size_t i = 0; i < n; ++i) {
    const Vec2 in = vertices[(i + 1) % n] - vertices[i];
    const Vec2 out = vertices[(i + 2) % n] - vertices[(i + 1) % n];
    if (turns_right(in, out, rounding)) {
      return false;
    }
  }
  return true;
}

void find_reentrant_vertices(std::span<const Vec2> vertices, std::vector<bool> &reentrant) {
  const std::size_t n = vertices.size();
  const double rounding = rounding_of(vertices);
  reentrant.resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    const Vec2 in = vertices[i] - vertices[i == 0 ? n - 1 : i - 1];
    const Vec2 out = vertices[i + 1 == n ? 0 : i + 1] - vertices[i];
    reentrant[i] = turns_right(in, out, rounding);
  }
}

std::vector<bool> reentrant_vertices(std::span<const Vec2> vertices) {
  std::vector<bool> reentrant;
  find_reentrant_vertices(vertices, reentrant);
  return reentrant;
}

double narrowest_width(std::span<const Vec2> vertices) {
  const std::size_t n = vertices.size();
  // The edges of a convex polygon are those of its hull. Otherwise the hull's are among all pairs of
  // vertices, and no direction is narrower than the narrowest.
  const std::vector<bool> reentrant = reentrant_vertices(vertices);
  const bool convex = std::find(reentrant.begin(), reentrant.end(), true) == reentrant.end();
  const std::size_t farthest = convex ? 1 : n - 1;
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
    if (reentrant[i]) {
      narrowest = std::min(narrowest, width_at(vertices, i));
    }
  }
  return narrowest;
}

} // namespace gcpdda
