#pragma once

// Edges of convex blocks inside one another, several contacts at a time: what overlap.hpp derives, one
// contact in each lane. Every step is taken by all lanes and counts where it applies, so the bits of a
// contact do not depend on which others are computed with it.

#include "base/lanes.hpp"
#include "contact/candidates.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <type_traits>
#include <utility>

namespace gcpdda::GCPDDA_INSTRUCTIONS {

/// Chains of as many contacts as there are lanes: the edges of one block each that can take part.
struct LaneChain {
  std::size_t edges = 0;
  std::array<LaneVec, most_plain_edges + 1> vertex; ///< ends of the edges, in order
  std::array<LaneVec, most_plain_edges> normal;
  /// Minus the gradient of the depth below each edge: the normals, but for deformable blocks F^-T N / J, N
  /// the reference normal.
  std::array<LaneVec, most_plain_edges> slope;
  std::array<Lanes, most_plain_edges> length;
  LaneVec low; ///< corners of the block's box
  LaneVec high;
};

/// The part of an edge inside the other block. Where there is none all lengths and depths are 0.
struct LaneStretch {
  Mask valid;
  LaneVec begin;
  LaneVec end;
  Lanes length;
  Lanes pressure; ///< int d ds, m2
  Lanes moment;   ///< int d s ds, s from `begin`, m3
  Lanes deepest;
  // Pieces of linear depth, which may be empty.
  std::size_t num_pieces = 0;
  std::array<Lanes, most_plain_edges> piece_start; ///< m from `begin`
  std::array<Lanes, most_plain_edges> piece_depth; ///< there
  Lanes last_depth;                                ///< at `end`

  /// From piece `count` on they are empty.
  [[nodiscard, gnu::always_inline]] std::size_t count() const { return num_pieces; }
  [[nodiscard, gnu::always_inline]] const Lanes &start(std::size_t k) const {
    return k < num_pieces ? piece_start[k] : length;
  }
  [[nodiscard, gnu::always_inline]] const Lanes &depth(std::size_t k) const {
    return k < num_pieces ? piece_depth[k] : last_depth;
  }
};

[[gnu::always_inline]] inline Mask boxes_meet(const LaneChain &a, const LaneChain &b) {
  return (a.low.x <= b.high.x) & (b.low.x <= a.high.x) & (a.low.y <= b.high.y) & (b.low.y <= a.high.y);
}

using LaneStretches = std::array<LaneStretch, most_plain_edges>;

template <std::size_t lines> using PerLine = std::array<Lanes, lines>;

/// visit(0) ... visit(count - 1), unrolled by the language: the arrays can live in registers.
template <std::size_t count, class Visit> [[gnu::always_inline]] inline void each(Visit &&visit) {
  [&]<std::size_t... j>(std::index_sequence<j...>) __attribute__((always_inline)) {
    (visit(std::integral_constant<std::size_t, j>{}), ...);
  }
  (std::make_index_sequence<count>{});
}

/// Which edge stands for line j: beyond four, lines are padded with the last edge, which then is never the
/// next active line, since its slope is not smaller.
template <std::size_t lines>
[[gnu::always_inline]] inline std::size_t edge_of(const LaneChain &chain, std::size_t j) {
  return lines <= 4 ? j : std::min(j, chain.edges - 1);
}

/// Depth of a point below each line of a block.
template <std::size_t lines>
[[gnu::always_inline]] inline void find_depths(const LaneChain &chain, const LaneVec &x,
                                               PerLine<lines> &depth) {
  each<lines>([&](auto j) {
    const std::size_t k = edge_of<lines>(chain, j);
    depth[j] = dot(chain.slope[k], chain.vertex[k] - x);
  });
}

/// The line nearest at the begin of a stretch.
struct ActiveLine {
  Lanes depth; ///< where the stretch's parameter is 0
  Lanes slope;
};

/// Integrals over the pieces of a stretch whose ends are known; see Overlap::walk_envelope.
template <std::size_t lines>
[[gnu::always_inline]] inline void walk(const PerLine<lines> &depth, const PerLine<lines> &slope,
                                        ActiveLine line, const Lanes &depth_begin, const Lanes &begin,
                                        const Lanes &end, LaneStretch &stretch) {
  Lanes s = begin;
  Lanes here = depth_begin;
  stretch.pressure = 0.0;
  stretch.moment = 0.0;
  stretch.deepest = here;
  stretch.num_pieces = 0;
  for (std::size_t k = 0; k < lines; ++k) {
    Lanes s_next = end;
    Lanes lowest = line.depth + line.slope * s_next;
    ActiveLine next = line;
    Mask goes_on{};
    each<lines>([&](auto j) {
      // A line of smaller slope that is lower at s_next crosses before it; collinear edges cross anywhere.
      const Mask crosses = (slope[j] < line.slope) & (depth[j] + slope[j] * s_next < lowest);
      if (crosses.any()) {
        const Lanes crossing = clamp((depth[j] - line.depth) / (line.slope - slope[j]), s, s_next);
        s_next = select(crosses, crossing, s_next);
        lowest = select(crosses, line.depth + line.slope * s_next, lowest);
        next.depth = select(crosses, depth[j], next.depth);
        next.slope = select(crosses, slope[j], next.slope);
        goes_on = goes_on | crosses;
      }
    });
    const Mask grows = s_next > s;
    const Lanes length = select(grows, s_next - s, 0.0);
    const Lanes there = select(grows, max(0.0, lowest), here);
    const Lanes total = Lanes(0.5) * length * (here + there);
    const Lanes from_begin = s - begin;
    stretch.pressure += total;
    stretch.moment += from_begin * total + length * length * (here + Lanes(2.0) * there) * Lanes(1.0 / 6.0);
    stretch.deepest = max(stretch.deepest, there);
    stretch.piece_start[stretch.num_pieces] = from_begin;
    stretch.piece_depth[stretch.num_pieces++] = here;
    s = select(grows, s_next, s);
    here = there;
    stretch.last_depth = there;
    if (!goes_on.any()) {
      return;
    }
    line = next;
  }
}

/// Where an edge runs inside the other block, seen from `origin` along `tangent`.
template <std::size_t lines> struct EdgeInside {
  Mask valid; ///< somewhere it does
  LaneVec origin;
  LaneVec tangent;
  PerLine<lines> depth; ///< at the origin
  PerLine<lines> slope;
  PerLine<lines> root; ///< from the begin of the edge
  Lanes begin;
  Lanes end;
  Mask entered; ///< it begins outside
  ActiveLine entry;

  [[gnu::always_inline]] void find_ends(const LaneChain &own, std::size_t edge, const LaneChain &other,
                                        const PerLine<lines> &at_begin, const PerLine<lines> &at_end) {
    const Lanes &edge_length = own.length[edge];
    tangent = perp(own.normal[edge]);
    begin = 0.0;
    end = edge_length;
    each<lines>([&](auto j) {
      slope[j] = -dot(other.slope[edge_of<lines>(other, j)], tangent);
      root[j] = -at_begin[j] / slope[j];
      const Mask enters = at_begin[j] < 0.0;
      begin = max(begin, select(enters, root[j], 0.0));
      end = min(end, select(at_end[j] < 0.0, root[j], edge_length));
      valid = valid & !(enters & (slope[j] <= 0.0)); // depth 0 but for rounding
    });
    valid = valid & (begin < end);
    entered = valid & (begin > 0.0);
    entry = {0.0, std::numeric_limits<double>::infinity()};
    depth = at_begin;
    origin = own.vertex[edge];
  }

  /// Measured from near the entry, the rest of a long edge costs no digits of the stretch inside. The ends
  /// move by rounding only: the root of a line that is parallel but for rounding could move anywhere.
  [[gnu::always_inline]] void measure_from_entry(const LaneChain &own, std::size_t edge,
                                                 const LaneChain &other, const PerLine<lines> &at_begin) {
    const Lanes &edge_length = own.length[edge];
    origin = select(entered, origin + begin * tangent, origin);
    const Lanes rounding = Lanes(16.0 * std::numeric_limits<double>::epsilon()) *
                           (edge_length + max(abs(origin.x), abs(origin.y)));
    const Lanes old_end = end - begin;
    const Mask leaves = end < edge_length;
    Lanes near_end = dot(own.vertex[edge + 1] - origin, tangent);
    each<lines>([&](auto j) {
      const std::size_t k = edge_of<lines>(other, j);
      depth[j] = select(entered, dot(other.slope[k], other.vertex[k] - origin), depth[j]);
      // Of lines that let it in at the same place the one of smallest slope.
      const Mask is_entry = (at_begin[j] < 0.0) & (root[j] == begin) & (slope[j] < entry.slope);
      entry.depth = select(is_entry, depth[j], entry.depth);
      entry.slope = select(is_entry, slope[j], entry.slope);
      near_end = select((slope[j] < 0.0) & leaves, min(near_end, -depth[j] / slope[j]), near_end);
    });
    begin = select(entered, clamp(-entry.depth / entry.slope, -rounding, rounding), begin);
    end = select(entered, clamp(near_end, old_end - rounding, old_end + rounding), end);
    valid = valid & (begin < end);
  }

  [[nodiscard, gnu::always_inline]] ActiveLine lowest() const {
    ActiveLine lowest{depth[0], slope[0]};
    for (std::size_t j = 1; j < lines; ++j) {
      const Mask lower = (depth[j] < lowest.depth) | ((depth[j] == lowest.depth) & (slope[j] < lowest.slope));
      lowest.depth = select(lower, depth[j], lowest.depth);
      lowest.slope = select(lower, slope[j], lowest.slope);
    }
    return lowest;
  }
};

template <std::size_t lines>
void cut_edge(const LaneChain &own, std::size_t edge, const LaneChain &other, const PerLine<lines> &at_begin,
              const PerLine<lines> &at_end, LaneStretch &stretch) {
  Lanes least = max(at_begin[0], at_end[0]);
  each<lines>([&](auto j) { least = min(least, max(at_begin[j], at_end[j])); });
  EdgeInside<lines> inside;
  inside.valid = least > 0.0; // else beyond one of the lines
  if (!inside.valid.any()) {
    stretch.valid = inside.valid;
    stretch.begin = stretch.end = own.vertex[edge];
    stretch.length = stretch.pressure = stretch.moment = stretch.deepest = 0.0;
    stretch.num_pieces = 0;
    return;
  }
  inside.find_ends(own, edge, other, at_begin, at_end);
  if (inside.entered.any()) {
    inside.measure_from_entry(own, edge, other, at_begin);
  }
  // Lines left out of the chain may meet outside the other block: then all of the stretch lies outside its
  // box.
  const LaneVec middle = inside.origin + (Lanes(0.5) * (inside.begin + inside.end)) * inside.tangent;
  const Mask valid = inside.valid & (other.low.x <= middle.x) & (middle.x <= other.high.x) &
                     (other.low.y <= middle.y) & (middle.y <= other.high.y);
  const Lanes begin = select(valid, inside.begin, 0.0);
  const Lanes end = select(valid, inside.end, 0.0);
  const LaneVec origin = select(valid, inside.origin, own.vertex[edge]);
  const ActiveLine lowest = inside.lowest();
  const Lanes depth_begin = select(valid & !inside.entered, lowest.depth, 0.0);
  const ActiveLine line{select(inside.entered, inside.entry.depth, lowest.depth),
                        select(inside.entered, inside.entry.slope, lowest.slope)};
  stretch.valid = valid;
  stretch.begin = origin + begin * inside.tangent;
  stretch.end = origin + end * inside.tangent;
  stretch.length = end - begin;
  walk<lines>(inside.depth, inside.slope, line, depth_begin, begin, end, stretch);
}

template <std::size_t lines>
void cut_all(const LaneChain &own, const LaneChain &other, LaneStretches &stretches) {
  PerLine<lines> at_begin;
  PerLine<lines> at_end;
  find_depths<lines>(other, own.vertex[0], at_end);
  for (std::size_t edge = 0; edge < own.edges; ++edge) {
    at_begin = at_end;
    find_depths<lines>(other, own.vertex[edge + 1], at_end);
    cut_edge<lines>(own, edge, other, at_begin, at_end, stretches[edge]);
  }
}

/// The stretches of all edges of `own` inside `other`.
inline void cut_edges(const LaneChain &own, const LaneChain &other, LaneStretches &stretches) {
  static_assert(most_plain_edges == 8);
  switch (other.edges) {
  case 1:
    return cut_all<1>(own, other, stretches);
  case 2:
    return cut_all<2>(own, other, stretches);
  case 3:
    return cut_all<3>(own, other, stretches);
  case 4:
    return cut_all<4>(own, other, stretches);
  default:
    return cut_all<8>(own, other, stretches);
  }
}

} // namespace gcpdda::GCPDDA_INSTRUCTIONS
