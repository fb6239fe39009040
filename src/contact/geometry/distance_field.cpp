// How the distance field of a re-entrant polygon is traced along an edge x(s) = a + s t.
//
// The nearest boundary point of an interior point lies inside an edge or at a re-entrant vertex, never at a
// convex one. So along the edge d(s) consists of pieces
//     line i:    alpha_i + beta_i s,   alpha_i = n_i.(v_i - a),  beta_i = -n_i.t,
//     vertex v:  sqrt(q^2 + (s - f)^2),   f = (v - a).t,  q = |(v - a) x t|.
// A line counts only where the foot of x falls on its edge: beyond its ends the line runs through the
// interior.
//
// 1. Which stretches are inside. The edge can change sides only where it meets the boundary, which is at a
//    zero of a line. Sort the zeros, and between neighbours ask the midpoint: its nearest boundary point
//    tells the side. This needs no parity and no tolerance, because rounding can pick a wrong nearest point
//    only among equally near ones; where that flips the side they are all at distance 0 to rounding, and
//    there is no force. At a convex vertex the nearest point's side is that of both lines (for a needle's tip
//    one line alone can have the wrong sign), at a re-entrant one it is inside.
//
// 2. A stretch with an entry is measured from there, so that the length of the edge outside costs no digits.
//
// 3. Features that can be active. d is Lipschitz with constant 1: on a stretch of length l about its midpoint
//    m, d(s) <= min(d_begin + (s - begin), d_end + (end - s)), and a feature f active at s has
//    |m - f| <= d(s) + |s - m| <= max(d_begin, d_end) + l/2. All others are dropped.
//
// 4. Break points. Two neighbouring active features are equal where they change, or the foot reaches an end
// of
//    its edge. So the candidates are
//      line/line      alpha_i + beta_i s = alpha_j + beta_j s
//      foot at end    (a + s t - v).t_i = 0      (line/own vertex: a double root of the next, taken here)
//      line/vertex    with s = f + g, A = alpha + beta f and 1 - beta^2 = gamma^2, gamma = n x t:
//                     gamma^2 g^2 - 2 A beta g + q^2 - A^2 = 0,  g = (A beta +- sqrt(A^2 - gamma^2 q^2)) /
//                     gamma^2, the smaller root from the product of both (gamma -> 0: the edge is normal to
//                     the line)
//      vertex/vertex  (f_u - f_v) (2 s - f_u - f_v) = q_v^2 - q_u^2
//      bisector       (a + s t - v).(t_before + t_after) = 0: each half of a vertex's fan belongs to the face
//                     on its side.
//    Sorted, they cut the stretch into intervals with one active feature each; the midpoint tells which. More
//    candidates than needed do no harm: neighbouring intervals with the same feature are merged, so break
//    points remain only where the active feature changes, and what lies far away changes no bit.
//
// A part nearest to a vertex is cut once more at the foot, s = f, so that its depth is monotonous.

#include "contact/geometry/distance_field.hpp"

#include "geometry/polygon.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

namespace gcpdda {

namespace {

constexpr std::size_t none = std::numeric_limits<std::size_t>::max();

} // namespace

void DistanceField::take(std::span<const Vec2> vertex, std::span<const Vec2> normal) {
  vertex_ = vertex;
  normal_ = normal;
  length_.resize(vertex.size());
  find_reentrant_vertices(vertex, reentrant_);
  for (std::size_t i = 0; i < vertex_.size(); ++i) {
    length_[i] = dot(vertex_[after(i)] - vertex_[i], tangent(i));
  }
}

double DistanceField::signed_distance(std::size_t edge, Vec2 x) const {
  return dot(normal_[edge], vertex_[edge] - x);
}

DistanceField::Line DistanceField::line(std::size_t edge, Vec2 origin, Vec2 along) const {
  return {signed_distance(edge, origin), -dot(normal_[edge], along)};
}

void DistanceField::compare(std::size_t edge, Vec2 x, Nearest &nearest) const {
  const Vec2 from = x - vertex_[edge];
  const double along = dot(from, tangent(edge));
  Nearest own{0.0, edge, 0};
  if (along <= 0.0) {
    own = {dot(from, from), edge, -1};
  } else if (along >= length_[edge]) {
    const Vec2 from_end = x - vertex_[after(edge)];
    own = {dot(from_end, from_end), edge, 1};
  } else {
    const double distance = dot(normal_[edge], from);
    own.square = distance * distance;
  }
  if (own.square < nearest.square) {
    nearest = own;
  }
}

DistanceField::Nearest DistanceField::nearest(Vec2 x) const {
  Nearest found{std::numeric_limits<double>::infinity(), 0, 0};
  for (std::size_t i = 0; i < vertex_.size(); ++i) {
    compare(i, x, found);
  }
  return found;
}

DistanceField::Nearest DistanceField::nearest_kept(Vec2 x) const {
  Nearest found{std::numeric_limits<double>::infinity(), 0, 0};
  for (const std::size_t i : kept_edges_) {
    compare(i, x, found);
  }
  return found;
}

DistanceField::Feature DistanceField::feature(Vec2 x, const Nearest &nearest) const {
  if (nearest.end == 0) {
    return {nearest.edge, 0, false, signed_distance(nearest.edge, x) > 0.0};
  }
  const std::size_t v = nearest.end < 0 ? nearest.edge : after(nearest.edge);
  const std::size_t edge_before = before(v);
  if (reentrant_[v]) {
    const double side = dot(x - vertex_[v], tangent(edge_before) + tangent(v));
    return {side <= 0.0 ? edge_before : v, v, true, true};
  }
  // Outside, or at a vertex that is straight up to rounding.
  const double depth_before = signed_distance(edge_before, x);
  const double depth_after = signed_distance(v, x);
  return {depth_before <= depth_after ? edge_before : v, 0, false, std::min(depth_before, depth_after) > 0.0};
}

void DistanceField::trace(const FieldEdge &edge, PotentialKind potential, std::vector<FieldPart> &parts) {
  find_stretches(edge);
  for (const Stretch &stretch : stretches_) {
    const Anchored inside = anchored(edge, stretch);
    if (!(inside.begin < inside.end)) {
      continue;
    }
    if (potential == PotentialKind::linear) {
      append_chord(inside, parts);
    } else {
      keep_features(inside);
      find_break_points(inside);
      append_parts(inside, parts);
    }
  }
}

void DistanceField::find_stretches(const FieldEdge &edge) {
  zeros_.clear();
  stretches_.clear();
  for (std::size_t i = 0; i < vertex_.size(); ++i) {
    const Line l = line(i, edge.begin, edge.tangent);
    if (l.alpha * l.at(edge.length) > 0.0) { // most lines, told without a division
      continue;
    }
    const double s = -l.alpha / l.beta;
    if (!(s > 0.0 && s < edge.length)) {
      continue;
    }
    // Far from its edge a line is no boundary; one zero too many would do no harm.
    const double foot = dot(edge.begin + s * edge.tangent - vertex_[i], tangent(i));
    const double slack = 0.01 * length_[i];
    if (foot >= -slack && foot <= length_[i] + slack) {
      zeros_.push_back({s, l.beta, i});
    }
  }
  std::sort(zeros_.begin(), zeros_.end(),
            [](const Zero &p, const Zero &q) { return std::tie(p.s, p.beta) < std::tie(q.s, q.beta); });
  zeros_.push_back({edge.length, 0.0, none});
  Zero last{0.0, 0.0, none};
  bool was_inside = false;
  for (const Zero &zero : zeros_) {
    if (zero.s <= last.s) {
      continue;
    }
    const Vec2 middle = edge.begin + 0.5 * (last.s + zero.s) * edge.tangent;
    const bool inside = feature(middle, nearest(middle)).inside;
    if (inside && was_inside) {
      stretches_.back().end = zero.s;
      stretches_.back().exit = zero.line;
    } else if (inside) {
      stretches_.push_back({last.s, zero.s, last.line, zero.line});
    }
    was_inside = inside;
    last = zero;
  }
}

DistanceField::Anchored DistanceField::anchored(const FieldEdge &edge, const Stretch &stretch) const {
  Anchored in;
  in.enters = stretch.entry != none;
  in.anchor = stretch.begin;
  in.tangent = edge.tangent;
  in.origin = edge.begin + stretch.begin * edge.tangent;
  // Moved to the entry, the zeros may move by rounding only: that of a line nearly parallel to the edge could
  // move anywhere.
  in.rounding = 16.0 * std::numeric_limits<double>::epsilon() *
                (edge.length + std::max(std::abs(in.origin.x), std::abs(in.origin.y)));
  const auto zero_near = [&](std::size_t i, double s) {
    const Line l = line(i, in.origin, edge.tangent);
    return l.beta == 0.0 ? s : std::clamp(-l.alpha / l.beta, s - in.rounding, s + in.rounding);
  };
  in.begin = in.enters ? zero_near(stretch.entry, 0.0) : 0.0;
  if (stretch.exit != none) {
    in.end = zero_near(stretch.exit, stretch.end - stretch.begin);
  } else {
    in.end = in.enters ? dot(edge.end - in.origin, edge.tangent) : edge.length;
  }
  in.depth_begin = in.enters ? 0.0 : std::sqrt(nearest(in.at(in.begin)).square);
  in.depth_end = stretch.exit != none ? 0.0 : std::sqrt(nearest(in.at(in.end)).square);
  return in;
}

void DistanceField::keep_features(const Anchored &inside) {
  kept_edges_.clear();
  kept_vertices_.clear();
  lines_.clear();
  const double half = 0.5 * (inside.end - inside.begin);
  const Vec2 middle = inside.at(inside.begin + half);
  // A little more than the bound, so that no equality is lost to rounding.
  const double reach = 1.000001 * (std::max(inside.depth_begin, inside.depth_end) + half) + inside.rounding;
  for (std::size_t i = 0; i < vertex_.size(); ++i) {
    Nearest on_edge{std::numeric_limits<double>::infinity(), i, 0};
    compare(i, middle, on_edge);
    if (on_edge.square <= reach * reach) {
      kept_edges_.push_back(i);
      lines_.push_back(line(i, inside.origin, inside.tangent));
    }
    const Vec2 to_vertex = vertex_[i] - middle;
    if (reentrant_[i] && dot(to_vertex, to_vertex) <= reach * reach) {
      kept_vertices_.push_back(i);
    }
  }
}

void DistanceField::add_break_point(const Anchored &inside, double s) {
  if (s > inside.begin && s < inside.end) {
    break_points_.push_back(s);
  }
}

void DistanceField::add_foot_ends(const Anchored &inside, std::size_t edge) {
  const double along = dot(inside.tangent, tangent(edge));
  for (const std::size_t v : {edge, after(edge)}) {
    add_break_point(inside, dot(vertex_[v] - inside.origin, tangent(edge)) / along);
  }
}

void DistanceField::add_line_and_vertex(const Anchored &inside, std::size_t edge, Vec2 vertex) {
  const Line line = this->line(edge, inside.origin, inside.tangent);
  const double gamma = cross(normal_[edge], inside.tangent);
  const double gamma2 = gamma * gamma;
  const double foot = dot(vertex - inside.origin, inside.tangent);
  const double q = cross(vertex - inside.origin, inside.tangent);
  const double a = line.at(foot);
  const double square = a * a - gamma2 * q * q;
  if (square < 0.0) {
    return;
  }
  const double larger = a * line.beta + std::copysign(std::sqrt(square), a * line.beta);
  add_break_point(inside, foot + larger / gamma2);
  add_break_point(inside, foot + (q - a) * (q + a) / larger);
}

void DistanceField::find_break_points(const Anchored &inside) {
  break_points_.clear();
  for (std::size_t k = 0; k < kept_edges_.size(); ++k) {
    const std::size_t edge = kept_edges_[k];
    add_foot_ends(inside, edge);
    for (std::size_t m = 0; m < k; ++m) {
      add_break_point(inside, (lines_[m].alpha - lines_[k].alpha) / (lines_[k].beta - lines_[m].beta));
    }
    for (const std::size_t v : kept_vertices_) {
      if (v != edge && v != after(edge)) {
        add_line_and_vertex(inside, edge, vertex_[v]);
      }
    }
  }
  for (std::size_t k = 0; k < kept_vertices_.size(); ++k) {
    const std::size_t v = kept_vertices_[k];
    const Vec2 to_v = vertex_[v] - inside.origin;
    const Vec2 across = tangent(before(v)) + tangent(v);
    add_break_point(inside, dot(to_v, across) / dot(inside.tangent, across));
    for (std::size_t m = 0; m < k; ++m) {
      // |to_v - s t| = |to_u - s t|
      const Vec2 to_u = vertex_[kept_vertices_[m]] - inside.origin;
      add_break_point(inside, 0.5 * dot(to_v - to_u, to_v + to_u) / dot(to_v - to_u, inside.tangent));
    }
  }
  std::sort(break_points_.begin(), break_points_.end());
  break_points_.push_back(inside.end);
}

void DistanceField::append_chord(const Anchored &inside, std::vector<FieldPart> &parts) const {
  const Vec2 middle = inside.at(0.5 * (inside.begin + inside.end));
  const Feature at_middle = feature(middle, nearest(middle));
  parts.push_back({inside.anchor, inside.begin, inside.end, inside.depth_begin, inside.depth_end,
                   static_cast<std::int32_t>(at_middle.face), inside.enters});
}

void DistanceField::append_parts(const Anchored &inside, std::vector<FieldPart> &parts) const {
  Feature active;
  double begin = inside.begin; // of the active feature
  double last = inside.begin;
  bool any = false;
  for (const double s : break_points_) {
    if (s <= last) {
      continue;
    }
    const Vec2 middle = inside.at(0.5 * (last + s));
    const Feature here = feature(middle, nearest_kept(middle));
    if (any && !here.same_as(active)) {
      append_part(inside, active, begin, last, parts);
      begin = last;
    }
    active = here;
    any = true;
    last = s;
  }
  append_part(inside, active, begin, last, parts);
}

void DistanceField::append_part(const Anchored &inside, const Feature &feature, double begin, double end,
                                std::vector<FieldPart> &parts) const {
  FieldPart part{inside.anchor,
                 begin,
                 end,
                 0.0,
                 0.0,
                 static_cast<std::int32_t>(feature.face),
                 begin == inside.begin && inside.enters,
                 feature.at_vertex};
  if (!feature.at_vertex) {
    const Line l = line(feature.face, inside.origin, inside.tangent);
    part.depth_begin = part.enters ? 0.0 : std::max(0.0, l.at(begin));
    part.depth_end = std::max(0.0, l.at(end));
    parts.push_back(part);
    return;
  }
  const Vec2 to_vertex = vertex_[feature.vertex] - inside.origin;
  const double foot = dot(to_vertex, inside.tangent);
  part.q = std::abs(cross(to_vertex, inside.tangent));
  const auto append = [&](double from, double to) {
    part.begin = from;
    part.end = to;
    part.foot = foot - from;
    part.depth_begin = std::hypot(part.q, foot - from);
    part.depth_end = std::hypot(part.q, foot - to);
    parts.push_back(part);
    part.enters = false;
  };
  if (begin < foot && foot < end) {
    append(begin, foot);
    append(foot, end);
  } else {
    append(begin, end);
  }
}

} // namespace gcpdda
