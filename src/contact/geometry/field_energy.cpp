// The cells of the nearest boundary feature, cut without assembling them.
//
// Inside a polygon d is the smallest of: the signed distance to a line, where the foot lies on its edge, and
// the distance to a re-entrant vertex, between the normals of its two edges. A convex region is cut
//   1. by the ends of those domains and by the lines themselves, until each feature counts everywhere or
//      nowhere;
//   2. line against line and vertex against vertex, both by straight lines, until at most one of each is
//   left.
// What remains is exact in closed form:
//   line:    the mean of a triangle's corners,
//   vertex v: |x - v| is homogeneous of degree 1 about v, so its integral is a third of that of
//            |x - v| (x - v).n over the border: sum over the edges of (h/3) int R ds, h the distance of v
//            from the edge, positive to its left,
//   both:    int min(d, |x - v|) = int d - int (d - |x - v|)_+. About v, with d = D + r c in direction u,
//            c = -n.u, the vertex is nearer for r < r* = D/(1 - c), a parabola. Each edge of the cell spans a
//            triangle with v; where the edge lies inside the parabola the whole triangle counts, beyond it
//            int_0^r* (D + r c - r) r dr = D^3 / (6 (1 - c)^2) counts per angle, and with psi the angle of u
//            from -n:  int dpsi/(1 - cos psi)^2 = -cot(psi/2)/2 - cot^3(psi/2)/6.
// So the error is rounding: some epsilon times area times depth.

#include "contact/geometry/field_energy.hpp"

#include "contact/geometry/curve.hpp"
#include "geometry/aabb.hpp"
#include "geometry/polygon.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>

namespace gcpdda {

namespace {

/// The two sides of a cell; one is empty if the cut passes it by but for rounding.
template <class Cut> std::array<Polygon, 2> halves(const Polygon &cell, const Cut &cut) {
  double low = 0.0;
  double high = 0.0;
  for (const Vec2 x : cell) {
    const double value = cut(x);
    low = std::min(low, value);
    high = std::max(high, value);
  }
  const double least = 1e-14 * (high - low);
  if (low >= -least) {
    return {cell, Polygon{}};
  }
  if (high <= least) {
    return {Polygon{}, cell};
  }
  return {keep_positive(cell, cut), keep_positive(cell, [&](Vec2 x) { return -cut(x); })};
}

/// int |x - v| over the triangle of v and the directed edge a -> b, negative if v lies to its right.
double integrate_radius(Vec2 v, Vec2 a, Vec2 b) {
  const double length = norm(b - a);
  if (!(length > 0.0)) {
    return 0.0;
  }
  const Vec2 t = (1.0 / length) * (b - a);
  const double h = cross(a - v, t);
  const double begin = dot(a - v, t);
  const double end = dot(b - v, t);
  const double q = std::abs(h);
  // integrate_curve() wants one side of the foot.
  const double total = begin < 0.0 && end > 0.0
                           ? integrate_curve(q, 0.0, -begin).total + integrate_curve(q, 0.0, end).total
                           : integrate_curve(q, begin, length).total;
  return h * total / 3.0;
}

} // namespace

std::vector<Polygon> convex_parts(std::span<const Vec2> vertex) {
  Polygon rest(vertex.begin(), vertex.end());
  if (is_convex(rest)) {
    return {rest};
  }
  std::vector<Polygon> parts;
  while (rest.size() > 3) {
    const std::size_t n = rest.size();
    // Among the ears the one with the best shape: needles cost digits.
    std::size_t best = n;
    double best_shape = -1.0;
    for (std::size_t i = 0; i < n; ++i) {
      const Vec2 a = rest[(i + n - 1) % n];
      const Vec2 b = rest[i];
      const Vec2 c = rest[(i + 1) % n];
      const double area = cross(b - a, c - a);
      bool is_ear = area >= 0.0;
      for (std::size_t k = 0; k < n && is_ear; ++k) {
        const Vec2 p = rest[k];
        is_ear = p == a || p == b || p == c || cross(b - a, p - a) < 0.0 || cross(c - b, p - b) < 0.0 ||
                 cross(a - c, p - c) < 0.0;
      }
      const double shape = area / (dot(b - a, b - a) + dot(c - b, c - b) + dot(a - c, a - c));
      if (is_ear && shape > best_shape) {
        best = i;
        best_shape = shape;
      }
    }
    if (best == n) {
      break; // only rounding is left
    }
    parts.push_back({rest[(best + n - 1) % n], rest[best], rest[(best + 1) % n]});
    rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(best));
  }
  parts.push_back(rest);
  return parts;
}

Polygon common_part(Polygon region, const Polygon &other) {
  for (std::size_t j = 0; j < other.size() && region.size() >= 3; ++j) {
    const Vec2 a = other[j];
    const Vec2 along = other[(j + 1) % other.size()] - a;
    region = keep_positive(region, [&](Vec2 x) { return cross(along, x - a); });
  }
  return region;
}

FieldEnergy::FieldEnergy(std::span<const Vec2> vertex, std::span<const Vec2> normal)
    : vertex_(vertex), normal_(normal), reentrant_(reentrant_vertices(vertex)) {}

double FieldEnergy::depth(std::size_t line, Vec2 x) const {
  return dot(normal_[line], vertex_[line] - x);
}

double FieldEnergy::distance(std::size_t edge, Vec2 x) const {
  const Vec2 a = vertex_[edge];
  const Vec2 along = vertex_[after(edge)] - a;
  const double share = std::clamp(dot(x - a, along) / dot(along, along), 0.0, 1.0);
  return norm(x - (a + share * along));
}

FieldEnergy::Features FieldEnergy::near(const Polygon &cell) const {
  const Vec2 centre =
      (1.0 / static_cast<double>(cell.size())) * std::accumulate(cell.begin(), cell.end(), Vec2{});
  double radius = 0.0;
  for (const Vec2 x : cell) {
    radius = std::max(radius, norm(x - centre));
  }
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < vertex_.size(); ++i) {
    nearest = std::min(nearest, distance(i, centre));
  }
  // Nowhere in the cell is the depth larger than nearest + radius.
  const double reach = 1.000001 * (nearest + 2.0 * radius);
  Features features;
  for (std::size_t i = 0; i < vertex_.size(); ++i) {
    if (distance(i, centre) <= reach) {
      features.lines.push_back(i);
    }
    if (reentrant_[i] && norm(vertex_[i] - centre) <= reach) {
      features.vertices.push_back(i);
    }
  }
  return features;
}

double FieldEnergy::integrate(const Polygon &region) const {
  return region.size() < 3 ? 0.0 : within_domains(region, near(region), 0);
}

double FieldEnergy::integrate_among(const Polygon &region, const std::vector<std::size_t> &edges) const {
  if (region.size() < 3) {
    return 0.0;
  }
  Features features{edges, {}};
  std::copy_if(edges.begin(), edges.end(), std::back_inserter(features.vertices),
               [&](std::size_t v) { return reentrant_[v]; });
  return within_domains(region, features, 0);
}

/// Cut by the domains of the lines from number `next` on, then of the vertices.
double FieldEnergy::within_domains(const Polygon &cell, const Features &features, std::size_t next) const {
  if (cell.size() < 3) {
    return 0.0;
  }
  const std::size_t num_lines = features.lines.size();
  const bool is_line = next < num_lines;
  if (!is_line && next - num_lines >= features.vertices.size()) {
    return among_lines(cell, features);
  }
  const std::size_t feature = is_line ? features.lines[next] : features.vertices[next - num_lines];
  const std::size_t other = is_line ? feature : before(feature);
  const Vec2 v = vertex_[feature];
  const Vec2 end = vertex_[after(feature)];
  // A line counts behind its own side and between its ends, a vertex between the normals there.
  std::vector<std::array<Vec2, 2>> bounds; // a point and the direction inwards
  if (is_line) {
    bounds = {{v, -normal_[feature]}, {v, tangent(feature)}, {end, -tangent(feature)}};
  } else {
    bounds = {{v, tangent(other)}, {v, -tangent(feature)}};
  }
  double sum = 0.0;
  Polygon inside = cell;
  Features without = features;
  auto &list = is_line ? without.lines : without.vertices;
  list.erase(std::find(list.begin(), list.end(), feature));
  for (const auto &[point, inwards] : bounds) {
    auto [kept, outside] =
        halves(inside, [&, point = point, inwards = inwards](Vec2 x) { return dot(inwards, x - point); });
    sum += within_domains(outside, without, next);
    inside = std::move(kept);
    if (inside.size() < 3) {
      return sum;
    }
  }
  return sum + within_domains(inside, features, next + 1);
}

double FieldEnergy::among_lines(const Polygon &cell, const Features &features) const {
  if (cell.size() < 3) {
    return 0.0;
  }
  if (features.lines.size() < 2) {
    return among_vertices(cell, features);
  }
  Features first = features;
  Features second = features;
  const std::size_t i = features.lines[features.lines.size() - 2];
  const std::size_t j = features.lines.back();
  first.lines.pop_back();
  second.lines.erase(second.lines.end() - 2);
  const auto [nearer_i, nearer_j] = halves(cell, [&](Vec2 x) { return depth(j, x) - depth(i, x); });
  return among_lines(nearer_i, first) + among_lines(nearer_j, second);
}

double FieldEnergy::among_vertices(const Polygon &cell, const Features &features) const {
  if (cell.size() < 3) {
    return 0.0;
  }
  if (features.vertices.size() > 1) {
    Features first = features;
    Features second = features;
    const Vec2 u = vertex_[features.vertices[features.vertices.size() - 2]];
    const Vec2 v = vertex_[features.vertices.back()];
    first.vertices.pop_back();
    second.vertices.erase(second.vertices.end() - 2);
    const auto [nearer_u, nearer_v] = halves(cell, [&](Vec2 x) { return dot(u - v, x - 0.5 * (u + v)); });
    return among_vertices(nearer_u, first) + among_vertices(nearer_v, second);
  }
  if (features.vertices.empty()) {
    if (features.lines.empty()) {
      return 0.0; // a sliver of rounding
    }
    return integrate_linear(cell, [&](Vec2 x) { return depth(features.lines[0], x); });
  }
  const Vec2 v = vertex_[features.vertices[0]];
  if (!features.lines.empty()) {
    return of_line_and_vertex(cell, features.lines[0], features.vertices[0]);
  }
  double sum = 0.0;
  for (std::size_t k = 0; k < cell.size(); ++k) {
    sum += integrate_radius(v, cell[k], cell[(k + 1) % cell.size()]);
  }
  return sum;
}

namespace {

/// Shares of the way from a to b between which the vertex or the line is the nearer one, 0 and 1 with them:
/// |x - v|^2 = d^2 at x = a + s (b - a).
std::vector<double> shares_where_as_far(Vec2 vertex, Vec2 a, Vec2 b, double depth_a, double depth_b) {
  const Vec2 ab = b - a;
  const double rise = depth_b - depth_a;
  const double c2 = dot(ab, ab) - rise * rise;
  const double c1 = dot(ab, a - vertex) - rise * depth_a;
  const double c0 = dot(a - vertex, a - vertex) - depth_a * depth_a;
  std::vector<double> shares{0.0, 1.0};
  const double square = c1 * c1 - c2 * c0;
  if (square > 0.0) {
    const double larger = -(c1 + std::copysign(std::sqrt(square), c1));
    for (const double share : {larger / c2, c0 / larger}) {
      if (share > 0.0 && share < 1.0) {
        shares.push_back(share);
      }
    }
    std::sort(shares.begin(), shares.end());
  }
  return shares;
}

} // namespace

double FieldEnergy::of_line_and_vertex(const Polygon &cell, std::size_t line, std::size_t v) const {
  const auto line_depth = [&](Vec2 x) { return depth(line, x); };
  const double all_line = integrate_linear(cell, line_depth);
  const Vec2 vertex = vertex_[v];
  const double at_vertex = line_depth(vertex);
  if (v == line || v == after(line) || !(at_vertex > 0.0)) {
    return all_line; // a vertex on the line is nowhere nearer than it
  }
  double saved = 0.0;
  for (std::size_t k = 0; k < cell.size(); ++k) {
    const Vec2 a = cell[k];
    const Vec2 b = cell[(k + 1) % cell.size()];
    const std::vector<double> shares = shares_where_as_far(vertex, a, b, line_depth(a), line_depth(b));
    for (std::size_t m = 0; m + 1 < shares.size(); ++m) {
      saved += saved_by_vertex(line, vertex, a + shares[m] * (b - a), a + shares[m + 1] * (b - a));
    }
  }
  return all_line - saved;
}

double FieldEnergy::saved_by_vertex(std::size_t line, Vec2 vertex, Vec2 p, Vec2 q) const {
  const auto cot_of_half = [&](Vec2 x) {
    const double radius = norm(x - vertex);
    const double along = -dot(normal_[line], x - vertex);
    const double across = cross(-normal_[line], x - vertex);
    return along > 0.0 ? (radius + along) / across : across / (radius - along);
  };
  const double at_vertex = depth(line, vertex);
  const Vec2 middle = 0.5 * (p + q);
  const double twice = cross(p - vertex, q - vertex);
  if (norm(middle - vertex) <= depth(line, middle)) {
    return 0.5 * twice * (at_vertex + depth(line, p) + depth(line, q)) / 3.0 - integrate_radius(vertex, p, q);
  }
  if (twice == 0.0) {
    return 0.0;
  }
  const double from = cot_of_half(p);
  const double to = cot_of_half(q);
  const double angle = (from - to) * (0.5 + (from * from + from * to + to * to) / 6.0);
  // Not finite: the ray along the axis, which leaves no parabola.
  return std::isfinite(angle) ? at_vertex * at_vertex * at_vertex / 6.0 * angle : 0.0;
}

} // namespace gcpdda
