#include "gcpdda/contact/overlap.hpp"

#include <algorithm>
#include <limits>

namespace gcpdda {

namespace {

constexpr std::size_t none = std::numeric_limits<std::size_t>::max();

/// The stretch of an edge inside the other block and the line on which the envelope starts there.
struct Inside {
  double begin = 0.0;
  double end = 0.0;
  std::size_t entry = none; ///< line that lets the edge in; none if the edge starts inside
  bool leaves = false;      ///< the stretch ends before the edge does
};

/// Where all lines alpha + beta s are positive on [0, length]; an empty stretch has begin >= end. Most lines
/// cut nothing off, which their values at the ends tell without a division.
Inside positive_stretch(std::span<const double> alpha, std::span<const double> beta, double length) {
  Inside in{0.0, length, none, false};
  for (std::size_t j = 0; j < alpha.size(); ++j) {
    if (beta[j] > 0.0) {
      if (alpha[j] < 0.0) {
        const double root = -alpha[j] / beta[j];
        if (root > in.begin || (root == in.begin && in.entry != none && beta[j] < beta[in.entry])) {
          in.begin = root;
          in.entry = j;
        }
      }
    } else if (alpha[j] <= 0.0) {
      in.end = 0.0;
    } else if (alpha[j] + beta[j] * in.end < 0.0) {
      in.end = std::min(in.end, -alpha[j] / beta[j]);
      in.leaves = true;
    }
    if (in.begin >= in.end) {
      break;
    }
  }
  return in;
}

/// The same stretch after the edge's start has been moved to its entry; `length` is what is left of the edge.
/// The ends move by rounding only: the root of a line that is parallel but for rounding could move anywhere.
Inside near_entry(std::span<const double> alpha, std::span<const double> beta, const Inside &in,
                  double length, double rounding) {
  Inside near = in;
  near.begin = std::clamp(-alpha[in.entry] / beta[in.entry], -rounding, rounding);
  near.end = length;
  for (std::size_t j = 0; j < alpha.size() && in.leaves; ++j) {
    if (beta[j] < 0.0) {
      near.end = std::min(near.end, -alpha[j] / beta[j]);
    }
  }
  const double old_end = in.end - in.begin;
  near.end = std::clamp(near.end, old_end - rounding, old_end + rounding);
  return near;
}

std::size_t lowest_at_start(std::span<const double> alpha, std::span<const double> beta) {
  std::size_t lowest = 0;
  for (std::size_t j = 1; j < alpha.size(); ++j) {
    if (alpha[j] < alpha[lowest] || (alpha[j] == alpha[lowest] && beta[j] < beta[lowest])) {
      lowest = j;
    }
  }
  return lowest;
}

} // namespace

void Overlap::clip_edges(const ConvexView &own, const ConvexView &other, PotentialKind potential) {
  const std::size_t num_lines = other.vertex.size();
  const std::size_t first_piece = pieces_.size();
  alpha_.resize(num_lines);
  beta_.resize(num_lines);
  for (std::size_t e = 0; e < own.vertex.size(); ++e) {
    Vec2 a = own.vertex[e];
    const Vec2 b = own.vertex[e + 1 == own.vertex.size() ? 0 : e + 1];
    const Aabb edge_box{{std::min(a.x, b.x), std::min(a.y, b.y)}, {std::max(a.x, b.x), std::max(a.y, b.y)}};
    if (!edge_box.meets(other.box)) {
      continue;
    }
    const Vec2 tangent = perp(own.normal[e]);
    for (std::size_t j = 0; j < num_lines; ++j) {
      alpha_[j] = dot(other.normal[j], other.vertex[j] - a);
      beta_[j] = -dot(other.normal[j], tangent);
    }
    Inside in = positive_stretch(alpha_, beta_, own.length[e]);
    if (in.begin < in.end && in.entry != none) {
      // Measured from near the entry, the rest of a long edge costs no digits of the stretch inside.
      a += in.begin * tangent;
      for (std::size_t j = 0; j < num_lines; ++j) {
        alpha_[j] = dot(other.normal[j], other.vertex[j] - a);
      }
      const double rounding = 16.0 * std::numeric_limits<double>::epsilon() *
                              (own.length[e] + std::max(std::abs(a.x), std::abs(a.y)));
      in = near_entry(alpha_, beta_, in, dot(b - a, tangent), rounding);
    }
    if (in.begin >= in.end) {
      continue;
    }
    const std::size_t line = in.entry != none ? in.entry : lowest_at_start(alpha_, beta_);
    const Piece start{a + in.begin * tangent, own.normal[e], 0.0, in.entry != none ? 0.0 : alpha_[line], 0.0,
                      in.entry != none};
    if (potential == PotentialKind::linear) {
      pieces_.push_back(chord(start, in.begin, in.end, in.leaves));
    } else {
      walk_envelope(start, line, in.begin, in.end);
    }
  }
  start_at_entry(first_piece);
}

Piece Overlap::chord(Piece piece, double s_begin, double s_end, bool leaves) const {
  double lowest = std::numeric_limits<double>::infinity();
  for (std::size_t j = 0; j < alpha_.size(); ++j) {
    lowest = std::min(lowest, alpha_[j] + beta_[j] * s_end);
  }
  piece.length = s_end - s_begin;
  piece.depth_end = leaves ? 0.0 : std::max(0.0, lowest);
  return piece;
}

void Overlap::walk_envelope(Piece piece, std::size_t line, double s, double s_end) {
  while (true) {
    std::size_t next = none;
    double s_next = s_end;
    double lowest = alpha_[line] + beta_[line] * s_next;
    for (std::size_t j = 0; j < alpha_.size(); ++j) {
      // A line of smaller slope that is lower at s_next crosses before it.
      if (beta_[j] < beta_[line] && alpha_[j] + beta_[j] * s_next < lowest) {
        // The clamp is for collinear edges, whose lines cross anywhere in rounding.
        s_next = std::clamp((alpha_[j] - alpha_[line]) / (beta_[line] - beta_[j]), s, s_next);
        lowest = alpha_[line] + beta_[line] * s_next;
        next = j;
      }
    }
    if (s_next > s) {
      piece.length = s_next - s;
      piece.depth_end = std::max(0.0, lowest);
      pieces_.push_back(piece);
      piece = {piece.end(), piece.normal, 0.0, piece.depth_end, 0.0, false};
      s = s_next;
    }
    if (next == none) {
      return;
    }
    line = next;
  }
}

void Overlap::start_at_entry(std::size_t first_piece) {
  // Sum from where the boundary comes in, the lowest leftmost such place if there are several: a choice that
  // cutting or renumbering the block elsewhere cannot change.
  const auto begin = pieces_.begin() + static_cast<std::ptrdiff_t>(first_piece);
  const auto start = std::min_element(begin, pieces_.end(), [](const Piece &p, const Piece &q) {
    if (p.enters != q.enters) {
      return p.enters;
    }
    return p.begin.x != q.begin.x ? p.begin.x < q.begin.x : p.begin.y < q.begin.y;
  });
  std::rotate(begin, start, pieces_.end());
}

bool Overlap::find(const ConvexView &first, const ConvexView &second, PotentialKind potential) {
  pieces_.clear();
  clip_edges(first, second, potential);
  num_first_ = pieces_.size();
  clip_edges(second, first, potential);
  return !pieces_.empty();
}

RegionIntegrals Overlap::integrate() const {
  RegionIntegrals sum;
  sum.origin = pieces_.front().begin;
  for (std::size_t i = 0; i < pieces_.size(); ++i) {
    const Piece &piece = pieces_[i];
    const double length = piece.length;
    const double total = 0.5 * length * (piece.depth_begin + piece.depth_end);
    const double along = length * length * (piece.depth_begin + 2.0 * piece.depth_end) / 6.0;
    const Vec2 moment = total * (piece.begin - sum.origin) + along * perp(piece.normal);
    const Vec2 direction = i < num_first_ ? -piece.normal : piece.normal;
    sum.force += total * direction;
    sum.dyad[0] += moment.x * direction.x;
    sum.dyad[1] += moment.x * direction.y;
    sum.dyad[2] += moment.y * direction.x;
    sum.dyad[3] += moment.y * direction.y;
    sum.pressure += total;
    sum.pressure_moment += moment;
  }
  return sum;
}

namespace {

using Polygon = std::vector<Vec2>;

/// The part of a convex polygon where distance(x) >= 0 for a linear function given by its values at the
/// vertices.
template <class Distance> Polygon keep_positive(const Polygon &polygon, const Distance &distance) {
  Polygon kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec2 a = polygon[i];
    const Vec2 b = polygon[(i + 1) % polygon.size()];
    const double da = distance(a);
    const double db = distance(b);
    if (da >= 0.0) {
      kept.push_back(a);
    }
    if ((da > 0.0 && db < 0.0) || (da < 0.0 && db > 0.0)) {
      kept.push_back(a + (da / (da - db)) * (b - a));
    }
  }
  return kept;
}

/// int d dA of a linear function over a convex polygon: each triangle of the fan by the mean of its corners.
template <class Distance> double integrate_linear(const Polygon &polygon, const Distance &distance) {
  double sum = 0.0;
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
    const double area = 0.5 * cross(polygon[i] - polygon[0], polygon[i + 1] - polygon[0]);
    sum += area * (distance(polygon[0]) + distance(polygon[i]) + distance(polygon[i + 1])) / 3.0;
  }
  return sum;
}

/// int over the region of the distance to the boundary of `block`: cut the region into the cells in which one
/// edge line is nearest.
double integrate_distance(const Polygon &region, const ConvexView &block) {
  double sum = 0.0;
  double largest = 0.0;
  for (const Vec2 x : block.vertex) {
    largest = std::max({largest, std::abs(x.x), std::abs(x.y)});
  }
  // Collinear edges share a line up to the rounding of their vertices: the first of them takes the whole
  // cell.
  const double same_line = 64.0 * std::numeric_limits<double>::epsilon() * largest;
  for (std::size_t i = 0; i < block.vertex.size(); ++i) {
    const auto depth = [&](std::size_t line, Vec2 x) {
      return dot(block.normal[line], block.vertex[line] - x);
    };
    Polygon cell = region;
    for (std::size_t j = 0; j < block.vertex.size() && cell.size() >= 3; ++j) {
      const auto margin = [&](Vec2 x) { return depth(j, x) - depth(i, x); };
      if (j == i) {
        continue;
      }
      if (std::all_of(cell.begin(), cell.end(), [&](Vec2 x) { return std::abs(margin(x)) <= same_line; })) {
        if (j < i) {
          cell.clear();
        }
      } else {
        cell = keep_positive(cell, margin);
      }
    }
    if (cell.size() >= 3) {
      sum += integrate_linear(cell, [&](Vec2 x) { return depth(i, x); });
    }
  }
  return sum;
}

} // namespace

double overlap_energy(const ConvexView &first, const ConvexView &second) {
  Polygon region(first.vertex.begin(), first.vertex.end());
  for (std::size_t j = 0; j < second.vertex.size() && region.size() >= 3; ++j) {
    region = keep_positive(region, [&](Vec2 x) { return dot(second.normal[j], second.vertex[j] - x); });
  }
  if (region.size() < 3) {
    return 0.0;
  }
  return integrate_distance(region, first) + integrate_distance(region, second);
}

} // namespace gcpdda
