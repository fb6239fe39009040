#include "geometry/polygon.hpp"

#include "geometry/edge_tree.hpp"

#include <algorithm>
#include <limits>
#include <optional>
#include <tuple>

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

/// From this number of vertices on a look at all pairs costs more than a tree of boxes.
constexpr std::size_t many_vertices = 64;

/// Distances from a re-entrant vertex to other edges.
class WidthAtVertex {
public:
  /// @param tree  of the polygon, null for one of few vertices
  /// @param area  of the polygon
  WidthAtVertex(std::span<const Vec2> vertices, const EdgeTree *tree, std::size_t vertex, double area)
      : vertices_(vertices), tree_(tree), vertex_(vertex), area_(area), v_(vertices[vertex]),
        in_(v_ - vertices[before(vertex)]), out_(vertices[after(vertex)] - v_) {}

  /// Smallest distance through the interior to an edge that does not start or end at the vertex, if it is
  /// below this one. The foot of a step's riser lies in the cone's border: material is not narrow there. Nor
  /// is it where the way cuts off a nib: a step of millimetres whose riser leans does so.
  [[nodiscard]] double narrower_than(double narrowest) const {
    const auto look_at = [&](std::size_t edge) {
      if (is_own(edge)) {
        return;
      }
      const Vec2 a = vertices_[edge];
      const Vec2 along = vertices_[after(edge)] - a;
      const double share = std::clamp(dot(v_ - a, along) / dot(along, along), 0.0, 1.0);
      const Vec2 foot = a + share * along;
      const double width = norm(foot - v_);
      if (width < narrowest && is_in_cone(foot - v_, width) && !is_blocked(foot) &&
          !is_nib(edge, foot, width)) {
        narrowest = width;
      }
    };
    if (tree_ == nullptr) {
      for (std::size_t edge = 0; edge < vertices_.size(); ++edge) {
        look_at(edge);
      }
    } else {
      tree_->visit_nearest([&](const Aabb &box) { return least_width(box); }, [&] { return narrowest; },
                           look_at);
    }
    return narrowest;
  }

private:
  [[nodiscard]] std::size_t before(std::size_t i) const { return i == 0 ? vertices_.size() - 1 : i - 1; }
  [[nodiscard]] std::size_t after(std::size_t i) const { return i + 1 == vertices_.size() ? 0 : i + 1; }
  [[nodiscard]] bool is_own(std::size_t edge) const { return edge == vertex_ || edge == before(vertex_); }

  [[nodiscard]] bool is_in_cone(Vec2 way, double length) const {
    constexpr double strictly = 1e-9;
    return cross(in_, way) > strictly * norm(in_) * length ||
           cross(out_, way) > strictly * norm(out_) * length;
  }

  /// No edge in the box is nearer; infinite where the box lies outside the cone.
  [[nodiscard]] double least_width(const Aabb &box) const {
    const bool may_be_in_cone = std::max(most_of_cross(in_, box), most_of_cross(out_, box)) > 0.0;
    const Vec2 nearest{std::clamp(v_.x, box.low.x, box.high.x), std::clamp(v_.y, box.low.y, box.high.y)};
    return may_be_in_cone ? (1.0 - 1e-12) * norm(nearest - v_) : std::numeric_limits<double>::infinity();
  }
  [[nodiscard]] double most_of_cross(Vec2 along, const Aabb &box) const {
    return std::max(along.x * (box.low.y - v_.y), along.x * (box.high.y - v_.y)) -
           std::min(along.y * (box.low.x - v_.x), along.y * (box.high.x - v_.x));
  }

  /// Whether an edge other than those at the vertex crosses the way from there, short of its end.
  [[nodiscard]] bool is_blocked(Vec2 to) const {
    const Vec2 way = to - v_;
    const auto crosses = [&](std::size_t edge) {
      constexpr double short_of_end = 1e-9;
      if (is_own(edge)) {
        return false;
      }
      const Vec2 a = vertices_[edge];
      const Vec2 along = vertices_[after(edge)] - a;
      const double from_a = cross(way, a - v_);
      const double from_b = cross(way, a + along - v_);
      const double across = cross(way, along);
      if (across == 0.0 || (from_a <= 0.0) == (from_b <= 0.0)) {
        return false;
      }
      const double share = cross(a - v_, along) / across;
      return share > 0.0 && share < 1.0 - short_of_end;
    };
    if (tree_ != nullptr) {
      Aabb around;
      around.include(v_);
      around.include(to);
      return tree_->any_meeting(around.inflated(1e-9 * norm(way)), crosses);
    }
    for (std::size_t edge = 0; edge < vertices_.size(); ++edge) {
      if (crosses(edge)) {
        return true;
      }
    }
    return false;
  }

  /// Whether the way to this place on an edge cuts off next to nothing, no longer than it is wide.
  [[nodiscard]] bool is_nib(std::size_t edge, Vec2 foot, double width) const {
    constexpr double share_of_nib = 1e-3;
    double twice = 0.0;
    for (std::size_t i = after(vertex_); i != edge; i = after(i)) {
      twice += cross(vertices_[i] - v_, vertices_[after(i)] - v_);
    }
    const double part = 0.5 * std::abs(twice + cross(vertices_[edge] - v_, foot - v_));
    return std::min(part, area_ - part) < std::min(share_of_nib * area_, width * width);
  }

  std::span<const Vec2> vertices_;
  const EdgeTree *tree_;
  std::size_t vertex_;
  double area_;
  Vec2 v_;
  Vec2 in_;
  Vec2 out_;
};

/// Smallest distance between two parallel lines that enclose a convex polygon, one of them flush with an
/// edge: the vertex farthest from an edge goes around with the edge.
double width_of_hull(std::span<const Vec2> hull) {
  const std::size_t n = hull.size();
  double narrowest = std::numeric_limits<double>::infinity();
  std::size_t far = 1;
  for (std::size_t i = 0; i < n; ++i) {
    const Vec2 along = hull[(i + 1) % n] - hull[i];
    const auto distance = [&](std::size_t k) { return cross(along, hull[k % n] - hull[i]) / norm(along); };
    far = std::max(far, i + 1);
    while (distance(far + 1) > distance(far)) {
      ++far;
    }
    narrowest = std::min(narrowest, distance(far));
  }
  return narrowest;
}

/// The same of any polygon of few vertices, from all pairs of them.
double width_of_few(std::span<const Vec2> vertices, bool convex) {
  const std::size_t n = vertices.size();
  // The edges of a convex polygon are those of its hull. Otherwise the hull's are among all pairs of
  // vertices, and no direction is narrower than the narrowest.
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
  const bool are_many = n > many_vertices;
  const std::optional<EdgeTree> tree = are_many ? std::optional<EdgeTree>(vertices) : std::nullopt;
  for (std::size_t i = 0; i < n; ++i) {
    const Vec2 a = vertices[i];
    const Vec2 b = vertices[(i + 1) % n];
    // A neighbour may fold back onto this edge.
    const Vec2 c = vertices[(i + 2) % n];
    if (turn(a, b, c) == 0 && dot(b - a, c - b) < 0.0) {
      return false;
    }
    const auto is_met_by = [&](std::size_t j) {
      const bool closes_ring = i == 0 && j == n - 1;
      return j >= i + 2 && !closes_ring && segments_meet(a, b, vertices[j], vertices[(j + 1) % n]);
    };
    if (tree) {
      if (tree->any_meeting(tree->box(i), is_met_by)) {
        return false;
      }
      continue;
    }
    for (std::size_t j = i + 2; j < n; ++j) {
      if (is_met_by(j)) {
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

bool are_in_one_side(Vec2 normal, Vec2 next_normal) {
  constexpr double straight = 0.01; // blocks that lie on one edge of a larger turn do not lie on the other
  return std::abs(cross(normal, next_normal)) <= straight && dot(normal, next_normal) > 0.0;
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

std::vector<Vec2> convex_hull(std::span<const Vec2> points) {
  std::vector<Vec2> sorted(points.begin(), points.end());
  std::sort(sorted.begin(), sorted.end(),
            [](Vec2 a, Vec2 b) { return std::tie(a.x, a.y) < std::tie(b.x, b.y); });
  std::vector<Vec2> hull;
  // Where a side has vertices in a line, rounding alone makes corners of them: they are none.
  constexpr double least_turn = 1e-12;
  const auto turns = [](Vec2 along, Vec2 next) {
    return cross(along, next) > least_turn * norm(along) * norm(next);
  };
  const auto add_chain = [&](auto first, auto last) {
    const std::size_t begin = hull.size();
    for (auto p = first; p != last; ++p) {
      while (hull.size() >= begin + 2 && !turns(hull.back() - hull[hull.size() - 2], *p - hull.back())) {
        hull.pop_back();
      }
      hull.push_back(*p);
    }
    hull.pop_back(); // it begins the other chain
  };
  add_chain(sorted.begin(), sorted.end());
  add_chain(sorted.rbegin(), sorted.rend());
  return hull;
}

double narrowest_width(std::span<const Vec2> vertices) {
  const std::vector<bool> reentrant = reentrant_vertices(vertices);
  const bool convex = std::find(reentrant.begin(), reentrant.end(), true) == reentrant.end();
  const bool are_many = vertices.size() > many_vertices;
  double narrowest = are_many ? width_of_hull(convex_hull(vertices)) : width_of_few(vertices, convex);
  if (convex) {
    return narrowest;
  }
  const std::optional<EdgeTree> tree = are_many ? std::optional<EdgeTree>(vertices) : std::nullopt;
  const double area = std::abs(signed_area(vertices));
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    if (reentrant[i]) {
      narrowest = WidthAtVertex(vertices, tree ? &*tree : nullptr, i, area).narrower_than(narrowest);
    }
  }
  return narrowest;
}

} // namespace gcpdda
