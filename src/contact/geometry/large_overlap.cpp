// The overlap of large outlines, cell by cell.
//
// The common box of both outlines is halved until few edges of each can be the nearest to any point of a
// cell. With c the centre of a cell, r its radius and D the distance from c to the nearest edge, that takes a
// distance of at most D + 2 r from c. So every cell hands its halves the edges it keeps, and all that is
// asked in a cell, which points are inside and how far the boundary is, the edges kept there tell. Edges that
// pass through the cell are among them.
//
// In the cells at the end each polygon is cut into trapezoids between the heights of the vertices, and those
// of one are clipped by those of the other. Around a point where many edges are equally near, as the centre
// of a circle, no halving leaves few of them: it ends where the cell is too small to matter.

#include "contact/geometry/large_overlap.hpp"

#include "contact/geometry/field_energy.hpp"
#include "geometry/aabb.hpp"
#include "geometry/polygon.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace gcpdda {

namespace {

using Edges = std::vector<std::size_t>;

/// A polygon of which a few edges are looked at.
class NearEdges {
public:
  explicit NearEdges(const PlainOutline &polygon)
      : polygon_(&polygon), reentrant_(reentrant_vertices(polygon.vertex)) {}

  [[nodiscard]] std::size_t size() const { return polygon_->vertex.size(); }
  [[nodiscard]] Vec2 begin(std::size_t edge) const { return polygon_->vertex[edge]; }
  [[nodiscard]] Vec2 end(std::size_t edge) const { return polygon_->vertex[after(edge)]; }

  /// Those of `edges` that may be the nearest to a point within `radius` of the centre.
  [[nodiscard]] Edges near(Vec2 centre, double radius, const Edges &edges) const {
    std::vector<double> distances;
    distances.reserve(edges.size());
    for (const std::size_t edge : edges) {
      distances.push_back(norm(centre - foot(edge, centre)));
    }
    // A little more than the bound, so that no equality is lost to rounding.
    const double reach = 1.000001 * (*std::min_element(distances.begin(), distances.end()) + 2.0 * radius);
    Edges kept;
    for (std::size_t k = 0; k < edges.size(); ++k) {
      if (distances[k] <= reach) {
        kept.push_back(edges[k]);
      }
    }
    return kept;
  }

  /// Distance of a point to the boundary, negative outside.
  [[nodiscard]] double depth(Vec2 x, const Edges &edges) const {
    double nearest = std::numeric_limits<double>::infinity();
    std::size_t edge = 0;
    for (const std::size_t candidate : edges) {
      const double distance = norm(x - foot(candidate, x));
      if (distance < nearest) {
        nearest = distance;
        edge = candidate;
      }
    }
    return is_inside(x, edge) ? nearest : -nearest;
  }

private:
  [[nodiscard]] std::size_t after(std::size_t i) const { return i + 1 == size() ? 0 : i + 1; }
  [[nodiscard]] std::size_t before(std::size_t i) const { return i == 0 ? size() - 1 : i - 1; }

  /// Place of the foot of a point on an edge, 0 at its begin and 1 at its end.
  [[nodiscard]] double share(std::size_t edge, Vec2 x) const {
    const Vec2 along = end(edge) - begin(edge);
    return std::clamp(dot(x - begin(edge), along) / dot(along, along), 0.0, 1.0);
  }
  [[nodiscard]] Vec2 foot(std::size_t edge, Vec2 x) const {
    return begin(edge) + share(edge, x) * (end(edge) - begin(edge));
  }
  [[nodiscard]] bool is_behind(std::size_t edge, Vec2 x) const {
    return dot(polygon_->normal[edge], begin(edge) - x) > 0.0;
  }
  /// Of a point whose nearest edge this is.
  [[nodiscard]] bool is_inside(Vec2 x, std::size_t edge) const {
    const double at = share(edge, x);
    if (at > 0.0 && at < 1.0) {
      return is_behind(edge, x);
    }
    const std::size_t v = at == 0.0 ? edge : after(edge);
    return reentrant_[v] || (is_behind(before(v), x) && is_behind(v, x));
  }

  const PlainOutline *polygon_;
  std::vector<bool> reentrant_;
};

/// An edge between two heights, from below.
struct Flank {
  double low = 0.0; ///< x at the lower height
  double high = 0.0;
};

/// Cuts the part of a polygon in a cell into trapezoids.
class Trapezoids {
public:
  Trapezoids(const NearEdges &polygon, const Edges &edges, const Aabb &cell)
      : polygon_(&polygon), edges_(&edges), cell_(cell) {}

  [[nodiscard]] std::vector<Polygon> cut() {
    std::vector<double> heights{cell_.low.y, cell_.high.y};
    const auto add_height = [&](double y) {
      if (y > cell_.low.y && y < cell_.high.y) {
        heights.push_back(y);
      }
    };
    for (const std::size_t edge : *edges_) {
      const Vec2 a = polygon_->begin(edge);
      const Vec2 b = polygon_->end(edge);
      add_height(a.y);
      add_height(b.y);
      for (const double x : {cell_.low.x, cell_.high.x}) { // then it leaves the cell between no two heights
        if ((a.x < x) != (b.x < x)) {
          add_height(a.y + (x - a.x) / (b.x - a.x) * (b.y - a.y));
        }
      }
    }
    std::sort(heights.begin(), heights.end());
    for (std::size_t k = 0; k + 1 < heights.size(); ++k) {
      if (heights[k] < heights[k + 1]) {
        cut_between(heights[k], heights[k + 1]);
      }
    }
    return std::move(parts_);
  }

private:
  void cut_between(double low, double high) {
    std::vector<Flank> flanks;
    for (const std::size_t edge : *edges_) {
      const Vec2 a = polygon_->begin(edge);
      const Vec2 b = polygon_->end(edge);
      if (std::min(a.y, b.y) <= low && std::max(a.y, b.y) >= high) {
        const auto at = [&](double y) {
          return std::clamp(a.x + (y - a.y) / (b.y - a.y) * (b.x - a.x), cell_.low.x, cell_.high.x);
        };
        flanks.push_back({at(low), at(high)});
      }
    }
    std::sort(flanks.begin(), flanks.end(),
              [](const Flank &f, const Flank &g) { return f.low + f.high < g.low + g.high; });
    Flank left{cell_.low.x, cell_.low.x};
    flanks.push_back({cell_.high.x, cell_.high.x});
    for (const Flank &right : flanks) {
      add(low, high, left, right);
      left = right;
    }
  }

  void add(double low, double high, const Flank &left, const Flank &right) {
    Polygon part{{left.low, low}, {right.low, low}, {right.high, high}, {left.high, high}};
    if (!(signed_area(part) > 0.0)) {
      return;
    }
    if (polygon_->depth(polygon_moments(part).centroid, *edges_) > 0.0) {
      parts_.push_back(std::move(part));
    }
  }

  const NearEdges *polygon_;
  const Edges *edges_;
  Aabb cell_;
  std::vector<Polygon> parts_;
};

class CellIntegral {
public:
  CellIntegral(const PlainOutline &polygon, const PlainOutline &other)
      : outline_(&polygon), polygon_(polygon), other_(other), field_(polygon.vertex, polygon.normal),
        is_convex_(is_convex(polygon.vertex)) {
    const Aabb a = bounding_box(polygon.vertex);
    const Aabb b = bounding_box(other.vertex);
    box_ = {{std::max(a.low.x, b.low.x), std::max(a.low.y, b.low.y)},
            {std::min(a.high.x, b.high.x), std::min(a.high.y, b.high.y)}};
    constexpr double too_small = 1e-6; // its share of the integral is below 1e-18
    smallest_ = too_small * std::max(box_.extent().x, box_.extent().y);
  }

  [[nodiscard]] double sum() const {
    if (!(box_.low.x < box_.high.x && box_.low.y < box_.high.y)) {
      return 0.0;
    }
    return of_cell(box_, all(polygon_), all(other_));
  }

private:
  static Edges all(const NearEdges &polygon) {
    Edges edges(polygon.size());
    for (std::size_t i = 0; i < edges.size(); ++i) {
      edges[i] = i;
    }
    return edges;
  }

  [[nodiscard]] double of_cell(const Aabb &cell, const Edges &polygon_edges, const Edges &other_edges) const {
    const Vec2 centre = 0.5 * (cell.low + cell.high);
    const Vec2 extent = cell.extent();
    const double radius = 0.5 * norm(extent);
    const Edges own = polygon_.near(centre, radius, polygon_edges);
    const Edges others = other_.near(centre, radius, other_edges);
    const double depth = polygon_.depth(centre, own);
    if (depth < -radius || other_.depth(centre, others) < -radius) {
      return 0.0;
    }
    // Of a convex polygon more edges than of another one are worth a cell.
    constexpr std::size_t few = 6;
    constexpr std::size_t few_of_convex = 24;
    if (own.size() <= (is_convex_ ? few_of_convex : few) && others.size() <= few_of_convex) {
      return of_few(cell, own, others);
    }
    if (std::max(extent.x, extent.y) < smallest_) {
      return other_.depth(centre, others) > 0.0 ? std::max(0.0, depth) * extent.x * extent.y : 0.0;
    }
    Aabb first = cell;
    Aabb second = cell;
    if (extent.x > extent.y) {
      first.high.x = second.low.x = centre.x;
    } else {
      first.high.y = second.low.y = centre.y;
    }
    return of_cell(first, own, others) + of_cell(second, own, others);
  }

  [[nodiscard]] double of_few(const Aabb &cell, const Edges &own, const Edges &others) const {
    const std::vector<Polygon> other_parts = Trapezoids(other_, others, cell).cut();
    double sum = 0.0;
    for (const Polygon &part : Trapezoids(polygon_, own, cell).cut()) {
      for (const Polygon &other_part : other_parts) {
        const Polygon region = common_part(part, other_part);
        sum += is_convex_ ? among_lines(region, own) : field_.integrate_among(region, own);
      }
    }
    return sum;
  }

  /// Of a convex polygon: each line where it is the nearest.
  [[nodiscard]] double among_lines(const Polygon &region, const Edges &lines) const {
    const auto depth = [&](std::size_t line, Vec2 x) {
      return dot(outline_->normal[line], outline_->vertex[line] - x);
    };
    double sum = 0.0;
    for (const std::size_t i : lines) {
      Polygon nearest = region;
      for (const std::size_t j : lines) {
        const auto margin = [&](Vec2 x) { return depth(j, x) - depth(i, x); };
        const Extremes found = extremes_of(nearest, margin);
        if (nearest.size() < 3 || j == i) {
          continue;
        }
        if (found.largest <= 0.0 && (found.least < 0.0 || j < i)) { // of equal lines the first counts
          nearest.clear();
        } else if (found.least < 0.0) {
          nearest = keep_positive(nearest, margin);
        }
      }
      sum += nearest.size() < 3 ? 0.0 : integrate_linear(nearest, [&](Vec2 x) { return depth(i, x); });
    }
    return sum;
  }

  const PlainOutline *outline_;
  NearEdges polygon_;
  NearEdges other_;
  FieldEnergy field_;
  bool is_convex_ = true;
  Aabb box_;
  double smallest_ = 0.0;
};

} // namespace

// From a corner on, a vertex may be left out as long as one direction passes all that were left out closely
// enough: the cone of these directions shrinks from vertex to vertex.
PlainOutline without_straight_vertices(std::span<const Vec2> vertex, std::span<const Vec2> normal) {
  const std::size_t n = vertex.size();
  double largest = 0.0;
  for (const Vec2 x : vertex) {
    largest = std::max({largest, std::abs(x.x), std::abs(x.y)});
  }
  const double rounding = 16.0 * std::numeric_limits<double>::epsilon() * largest;
  const auto edge = [&](std::size_t i) { return vertex[(i + 1) % n] - vertex[i % n]; };
  // The sharpest turn is a corner.
  std::size_t corner = 0;
  double sharpest = -1.0;
  for (std::size_t i = 0; i < n; ++i) {
    const Vec2 in = edge(i + n - 1);
    const double turn = std::abs(cross(in, edge(i))) / (norm(in) * norm(edge(i)));
    if (turn > sharpest) {
      sharpest = turn;
      corner = i;
    }
  }
  PlainOutline plain;
  for (std::size_t step = 0; step < n;) {
    const std::size_t first = (corner + step) % n;
    const Vec2 along = normal[first];
    const Vec2 tangent = perp(along);
    double slope_low = -std::numeric_limits<double>::infinity();
    double slope_high = -slope_low;
    std::size_t last = step;
    for (std::size_t next = step + 1; next <= n; ++next) {
      const Vec2 x = vertex[(corner + next) % n] - vertex[first];
      const double far = dot(x, tangent);
      const double aside = dot(x, along);
      const double slope = aside / far;
      if (next > step + 1 && !(far > 0.0 && slope_low <= slope && slope <= slope_high &&
                               dot(edge(corner + next - 1), tangent) > 0.0)) {
        break;
      }
      last = next;
      slope_low = std::max(slope_low, (aside - rounding) / far);
      slope_high = std::min(slope_high, (aside + rounding) / far);
    }
    plain.vertex.push_back(vertex[first]);
    // One edge keeps the normal it has, which is turned with the block and not computed from its ends.
    const Vec2 chord = vertex[(corner + last) % n] - vertex[first];
    plain.normal.push_back(last == step + 1 ? normal[first] : (-1.0 / norm(chord)) * perp(chord));
    step = last;
  }
  return plain;
}

double integrate_by_cells(const PlainOutline &polygon, const PlainOutline &other) {
  return CellIntegral(polygon, other).sum();
}

} // namespace gcpdda
