#include "contact/geometry/overlap.hpp"

#include "contact/geometry/curve.hpp"
#include "contact/geometry/distance_field.hpp"
#include "contact/geometry/regions.hpp"

#include <algorithm>
#include <cmath>
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
[[gnu::always_inline]] inline Inside positive_stretch(std::span<const double> alpha,
                                                      std::span<const double> beta, double length) {
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

inline Vec2 end_of_edge(const BlockView &block, std::size_t e) {
  return block.vertex[e + 1 == block.vertex.size() ? 0 : e + 1];
}

/// An edge in the axes in which the other block has its field.
struct EdgeInField {
  FieldEdge edge;
  double stretch = 1.0; ///< length there per length in the world

  EdgeInField(const BlockView &own, std::size_t e, const BlockView &other)
      : edge{own.vertex[e], end_of_edge(own, e), perp(own.normal[e]), own.length[e]} {
    if (other.frame) {
      const DeformedFrame &frame = *other.frame;
      const Vec2 along = frame.inverse(edge.tangent);
      stretch = norm(along);
      edge.begin = frame.inverse(edge.begin - frame.centre);
      edge.end = frame.inverse(edge.end - frame.centre);
      edge.tangent = (1.0 / stretch) * along;
      edge.length *= stretch;
    }
  }
};

inline bool edge_meets(Vec2 a, Vec2 b, const Aabb &box) {
  return std::max(a.x, b.x) >= box.low.x && std::min(a.x, b.x) <= box.high.x &&
         std::max(a.y, b.y) >= box.low.y && std::min(a.y, b.y) <= box.high.y;
}

/// 1/J of a block's potential.
double field_scale(const BlockView &block) {
  return block.frame ? 1.0 / determinant(block.frame->gradient) : 1.0;
}

std::span<const Vec2> field_vertices(const BlockView &block) {
  return block.frame ? block.frame->vertex : block.vertex;
}

std::span<const Vec2> field_normals(const BlockView &block) {
  return block.frame ? block.frame->normal : block.normal;
}

} // namespace

/// Scratch of pairs that are not both convex.
struct Overlap::OfReentrant {
  DistanceField field;
  std::vector<FieldPart> parts;
  RegionSplitter splitter;
};

Overlap::Overlap() = default;
Overlap::~Overlap() = default;
Overlap::Overlap(Overlap &&) noexcept = default;
Overlap &Overlap::operator=(Overlap &&) noexcept = default;

// Over the common part C of the two boxes line j lies between low_j and high_j. Where low_j is above the
// smallest high_k, line k is nearer all over C and line j can be left out: inside C nothing changes, and
// nothing of the other block lies outside. If the other block has a point in C, an edge of this one cannot
// leave it through a line left out, because that line does not enter C. If it has none, the lines kept may
// meet outside C; a stretch found there does not lie in the other block's box, which tells it.
bool Overlap::keep_lines(const BlockView &own, const BlockView &other) {
  const std::span<const Vec2> vertex = field_vertices(other);
  const std::span<const Vec2> normal = field_normals(other);
  if (lines_.size() < vertex.size()) {
    lines_.resize(vertex.size());
    alpha_.resize(vertex.size());
    beta_.resize(vertex.size());
  }
  num_lines_ = 0;
  const auto keep = [&](std::size_t j) {
    Line &line = lines_[num_lines_++];
    line.normal = normal[j];
    line.vertex = vertex[j];
    line.face = static_cast<std::int32_t>(j);
  };
  if (other.frame) {
    for (std::size_t j = 0; j < vertex.size(); ++j) {
      keep(j);
    }
    return true;
  }
  const Vec2 low{std::max(own.box.low.x, other.box.low.x), std::max(own.box.low.y, other.box.low.y)};
  const Vec2 high{std::min(own.box.high.x, other.box.high.x), std::min(own.box.high.y, other.box.high.y)};
  const Vec2 centre = 0.5 * (low + high);
  const Vec2 half = 0.5 * (high - low);
  double smallest_high = std::numeric_limits<double>::infinity();
  for (std::size_t j = 0; j < vertex.size(); ++j) {
    const double middle = dot(normal[j], vertex[j] - centre);
    const double spread = std::abs(normal[j].x) * half.x + std::abs(normal[j].y) * half.y;
    smallest_high = std::min(smallest_high, middle + spread);
    alpha_[j] = middle - spread;
  }
  for (std::size_t j = 0; j < vertex.size(); ++j) {
    if (alpha_[j] <= smallest_high) {
      keep(j);
    }
  }
  return smallest_high > 0.0;
}

template <bool deformed>
void Overlap::clip_edges(const BlockView &own, const BlockView &other, PotentialKind potential) {
  if (!keep_lines(own, other)) {
    return;
  }
  const std::size_t num_lines = num_lines_;
  const std::span<const double> alpha(alpha_.data(), num_lines);
  const std::span<const double> beta(beta_.data(), num_lines);
  for (std::size_t e = 0; e < own.vertex.size(); ++e) {
    if (!edge_meets(own.vertex[e], end_of_edge(own, e), other.box)) {
      continue;
    }
    const EdgeInField in_field(own, e, other);
    const FieldEdge &edge = in_field.edge;
    Vec2 a = edge.begin;
    const Vec2 tangent = edge.tangent;
    for (std::size_t j = 0; j < num_lines; ++j) {
      alpha_[j] = dot(lines_[j].normal, lines_[j].vertex - a);
      beta_[j] = -dot(lines_[j].normal, tangent);
    }
    Inside in = positive_stretch(alpha, beta, edge.length);
    double anchor = 0.0;
    if (in.begin < in.end && in.entry != none) {
      // Measured from near the entry, the rest of a long edge costs no digits of the stretch inside.
      anchor = in.begin;
      a += in.begin * tangent;
      for (std::size_t j = 0; j < num_lines; ++j) {
        alpha_[j] = dot(lines_[j].normal, lines_[j].vertex - a);
      }
      const double rounding = 16.0 * std::numeric_limits<double>::epsilon() *
                              (edge.length + std::max(std::abs(a.x), std::abs(a.y)));
      in = near_entry(alpha, beta, in, dot(edge.end - a, tangent), rounding);
    }
    if (in.begin >= in.end || (!deformed && !other.box.holds(a + (0.5 * (in.begin + in.end)) * tangent))) {
      continue;
    }
    const std::size_t line = in.entry != none ? in.entry : lowest_at_start(alpha, beta);
    const Piece start{a + in.begin * tangent,
                      own.normal[e],
                      0.0,
                      in.entry != none ? 0.0 : alpha_[line],
                      0.0,
                      in.entry != none,
                      static_cast<std::int32_t>(e),
                      lines_[line].face};
    const std::size_t first_piece = pieces_.size();
    if (potential == PotentialKind::linear) {
      pieces_.push_back(chord(start, in.begin, in.end, in.leaves));
    } else {
      walk_envelope(start, line, in.begin, in.end);
    }
    if constexpr (deformed) {
      const double begin = (anchor + in.begin) / in_field.stretch;
      to_world(first_piece, own.vertex[e] + begin * perp(own.normal[e]), in_field.stretch,
               field_scale(other));
    }
  }
}

void Overlap::to_world(std::size_t first_piece, Vec2 begin, double stretch, double scale) {
  for (std::size_t i = first_piece; i < pieces_.size(); ++i) {
    Piece &piece = pieces_[i];
    piece.begin = begin;
    piece.length /= stretch;
    piece.depth_begin *= scale;
    piece.depth_end *= scale;
    begin = piece.end();
  }
}

void Overlap::trace_edges(const BlockView &own, const BlockView &other, PotentialKind potential) {
  DistanceField &field = of_reentrant_->field;
  std::vector<FieldPart> &parts = of_reentrant_->parts;
  const double scale = field_scale(other);
  bool is_taken = false;
  for (std::size_t e = 0; e < own.vertex.size(); ++e) {
    if (!edge_meets(own.vertex[e], end_of_edge(own, e), other.box)) {
      continue;
    }
    if (!is_taken) { // many pairs end here, without an edge near the other block
      field.take(field_vertices(other), field_normals(other));
      is_taken = true;
    }
    const EdgeInField in_field(own, e, other);
    const double stretch = in_field.stretch;
    const Vec2 tangent = perp(own.normal[e]);
    parts.clear();
    field.trace(in_field.edge, potential, parts);
    for (const FieldPart &part : parts) {
      const Vec2 anchor = own.vertex[e] + (part.anchor / stretch) * tangent;
      Piece piece{anchor + (part.begin / stretch) * tangent,
                  own.normal[e],
                  (part.end - part.begin) / stretch,
                  scale * part.depth_begin,
                  scale * part.depth_end,
                  part.enters,
                  static_cast<std::int32_t>(e),
                  part.face};
      if (part.nearest_vertex) {
        piece.curve = static_cast<std::int32_t>(curves_.size());
        curves_.push_back({scale * stretch, part.q / stretch, part.foot / stretch});
      }
      pieces_.push_back(piece);
    }
  }
}

Piece Overlap::chord(Piece piece, double s_begin, double s_end, bool leaves) const {
  double lowest = std::numeric_limits<double>::infinity();
  for (std::size_t j = 0; j < num_lines_; ++j) {
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
    for (std::size_t j = 0; j < num_lines_; ++j) {
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
      piece = {piece.end(), piece.normal, 0.0, piece.depth_end, 0.0, false, piece.edge, piece.face};
      s = s_next;
    }
    if (next == none) {
      return;
    }
    line = next;
    piece.face = lines_[line].face;
  }
}

bool Overlap::find(const BlockView &first, const BlockView &second, PotentialKind potential) {
  pieces_.clear();
  curves_.clear();
  regions_.clear();
  const bool are_convex = first.is_convex && second.is_convex;
  if (!are_convex && !of_reentrant_) {
    of_reentrant_ = std::make_unique<OfReentrant>();
  }
  const auto add_edges = [&](const BlockView &own, const BlockView &other) {
    if (!other.is_convex) {
      trace_edges(own, other, potential);
    } else if (other.frame) {
      clip_edges<true>(own, other, potential);
    } else {
      clip_edges<false>(own, other, potential);
    }
  };
  add_edges(first, second);
  const std::size_t num_first = pieces_.size();
  add_edges(second, first);
  if (!are_convex) {
    of_reentrant_->splitter.split(first, second, pieces_, num_first, regions_);
  } else if (!pieces_.empty()) {
    start_at_entry(std::span(pieces_).first(num_first));
    start_at_entry(std::span(pieces_).subspan(num_first));
    regions_.push_back(
        {0, static_cast<std::uint32_t>(num_first), static_cast<std::uint32_t>(pieces_.size()), {}});
  }
  return !regions_.empty();
}

RegionIntegrals Overlap::integrate(const Region &region) const {
  RegionIntegrals sum;
  sum.origin = pieces_[region.begin].begin;
  for (std::size_t i = region.begin; i < region.end; ++i) {
    const Piece &piece = pieces_[i];
    const double length = piece.length;
    double total = 0.5 * length * (piece.depth_begin + piece.depth_end);
    double along = length * length * (piece.depth_begin + 2.0 * piece.depth_end) / 6.0;
    if (piece.curve >= 0) {
      const DepthCurve &curve = curves_[static_cast<std::size_t>(piece.curve)];
      const CurveIntegral integral = integrate_curve(curve.q, -curve.foot, length);
      total = curve.scale * integral.total;
      along = curve.scale * integral.moment;
    }
    const Vec2 moment = total * (piece.begin - sum.origin) + along * perp(piece.normal);
    const Vec2 direction = i < region.middle ? -piece.normal : piece.normal;
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

std::array<double, 2> Overlap::curve_floor(const Piece &piece) const {
  // The tangent in the middle of a convex curve. It is nowhere negative, because the foot is not inside.
  const DepthCurve &curve = curves_[static_cast<std::size_t>(piece.curve)];
  const double g = 0.5 * piece.length - curve.foot;
  const double r = std::hypot(curve.q, g);
  if (r == 0.0) {
    return {0.0, 0.0};
  }
  const double rise = 0.5 * piece.length * g / r;
  return {std::max(0.0, curve.scale * (r - rise)), std::max(0.0, curve.scale * (r + rise))};
}

} // namespace gcpdda
