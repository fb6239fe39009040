#pragma once

// Two convex blocks that overlap with one corner each, V of the lower block and W of the higher one: what
// most contacts of jointed rock and masonry are, where a face lies on a face.
//
// The overlap then is a quadrilateral V X W X'. Its boundary runs from V along both edges of V to where they
// leave the higher block across an edge of W, and likewise from W. With D = W - V the depth of V below the
// lines of W's edges is s_i.D (s_i their slopes, lane_stretch.hpp), that of W below V's lines -s_j.D: these
// are as short as the contact, and no digit is lost. From a corner on every depth is linear, and the lowest
// one is walked along from crossing to crossing.
//
// Three conditions make it so, for edges that can take part (candidates.hpp):
//  - V is the first vertex between two of them that lies in the other block's box and below all of its lines,
//    W likewise,
//  - each of the four edges leaves the other block before it ends,
//  - and across an edge of the other corner. Then X on an edge of W is where that edge leaves V's block: a
//    line leaves a convex block once.
// Edges left out of a chain lie deeper than another one all over the contact and change none of these
// answers, and no bit of the integrals: whether a pair is computed so does not depend on the neighbourhood's
// refreshes, as it must be, since the last bits of both ways differ.

#include "lane_region.hpp"
#include "lane_stretch.hpp"

#include <array>
#include <limits>
#include <utility>

namespace gcpdda::GCPDDA_INSTRUCTIONS {

struct LaneCorner {
  LaneVec vertex;
  // Of the edge that ends there and the one that begins.
  std::array<LaneVec, 2> normal;
  std::array<LaneVec, 2> slope;
  std::array<Lanes, 2> length;
  std::array<Mask, most_corner_edges> has_line; ///< edges of the chain that are one of them

  /// Along an edge away from the corner.
  [[nodiscard, gnu::always_inline]] LaneVec away(std::size_t edge) const {
    return edge == 0 ? -perp(normal[0]) : perp(normal[1]);
  }
};

template <std::size_t lines>
[[gnu::always_inline]] inline Mask is_inside(const LaneVec &x, const LaneSide &other) {
  Mask inside = (other.low.x <= x.x) & (x.x <= other.high.x) & (other.low.y <= x.y) & (x.y <= other.high.y);
  each<lines>([&](auto j) { inside = inside & (dot(other.slope[j], other.vertex[j] - x) > 0.0); });
  return inside;
}

/// Would find_corner() find one?
inline Mask has_corner(const LaneSide &own, const LaneSide &other) {
  Mask found = Mask::from(0);
  for (std::size_t k = 1; k < own.edges; ++k) {
    const LaneVec &x = own.vertex[k];
    Mask inside = (other.low.x <= x.x) & (x.x <= other.high.x) & (other.low.y <= x.y) & (x.y <= other.high.y);
    for (std::size_t j = 0; j < other.edges; ++j) {
      inside = inside & (dot(other.slope[j], other.vertex[j] - x) > 0.0);
    }
    found = found | inside;
  }
  return found;
}

/// The first end of two edges of `own` inside `other`.
template <std::size_t edges>
[[gnu::always_inline]] inline Mask find_corner(const LaneSide &own, const LaneSide &other,
                                               LaneCorner &corner) {
  Mask found{};
  each<edges - 1>([&](auto before) {
    constexpr std::size_t k = before + 1;
    const Mask here = is_inside<edges>(own.vertex[k], other) & !found;
    if constexpr (k == 1) {
      corner.vertex = own.vertex[1];
      for (std::size_t i = 0; i < 2; ++i) {
        corner.normal[i] = own.normal[i];
        corner.slope[i] = own.slope[i];
        corner.length[i] = own.length[i];
      }
    } else {
      corner.vertex = select(here, own.vertex[k], corner.vertex);
      for (std::size_t i = 0; i < 2; ++i) {
        corner.normal[i] = select(here, own.normal[before + i], corner.normal[i]);
        corner.slope[i] = select(here, own.slope[before + i], corner.slope[i]);
        corner.length[i] = select(here, own.length[before + i], corner.length[i]);
      }
    }
    corner.has_line[before] = before == 0 ? here : corner.has_line[before] | here;
    corner.has_line[k] = here;
    found = found | here;
  });
  return found;
}

/// An edge from its corner to where it leaves the other block, which may have `lines` edges there.
template <std::size_t lines> struct CornerStretch {
  LaneVec begin; ///< from the origin
  LaneVec direction;
  Lanes length;
  std::array<Lanes, lines> start; ///< of each piece, m from the begin; pieces may be empty
  std::array<Lanes, lines> depth; ///< there
  Lanes deepest;
  Lanes pressure; ///< int d ds, m2
  LaneVec moment; ///< int d (x - origin) ds, m3

  [[nodiscard]] std::array<LanePiece, lines> pieces() const {
    std::array<LanePiece, lines> result;
    for (std::size_t k = 0; k < lines; ++k) {
      const bool is_last = k + 1 == lines;
      result[k] = {start[k], (is_last ? length : start[k + 1]) - start[k], depth[k],
                   is_last ? Lanes(0.0) : depth[k + 1]};
    }
    return result;
  }
};

/// Depths below the lines of a block at a corner of the other one, and by how much they fall in a metre along
/// an edge away from it.
template <std::size_t lines> struct FallingDepths {
  PerLine<lines> depth;
  PerLine<lines> fall;
};

/// Walk along the lower envelope of the depths to where the first one is used up.
/// @return where that is an edge of the other corner
template <std::size_t lines>
[[gnu::always_inline]] inline Mask integrate_stretch(const FallingDepths<lines> &lower,
                                                     const LaneCorner &other, CornerStretch<lines> &stretch) {
  constexpr double never = std::numeric_limits<double>::infinity();
  Lanes length = never;
  Mask leaves{};
  Lanes depth = lower.depth[0];
  Lanes fall = lower.fall[0];
  Lanes other_fall = fall; // of two lines
  each<lines>([&](auto j) __attribute__((always_inline)) {
    const Lanes end = select(lower.fall[j] > 0.0, lower.depth[j] / lower.fall[j], never);
    const Mask first = end < length;
    leaves = (first & other.has_line[j]) | (leaves & !first);
    length = min(end, length);
    const Mask nearer = (lower.depth[j] < depth) | ((lower.depth[j] == depth) & (lower.fall[j] > fall));
    other_fall = select(nearer, fall, lower.fall[j]);
    depth = select(nearer, lower.depth[j], depth);
    fall = select(nearer, lower.fall[j], fall);
  });
  Lanes s = 0.0;
  Lanes here = depth;
  Lanes along = 0.0;
  stretch.length = length;
  stretch.pressure = 0.0;
  stretch.deepest = here;
  each<lines>([&](auto k) __attribute__((always_inline)) {
    Lanes next = length;
    Lanes there = 0.0;
    Lanes next_depth = depth;
    Lanes next_fall = fall;
    if constexpr (lines == 2 && k == 0) { // they cross once, whichever is nearer
      const Lanes crossing = (lower.depth[1] - lower.depth[0]) / (lower.fall[1] - lower.fall[0]);
      next = select((other_fall > fall) & (crossing < next), crossing, next);
    } else if constexpr (k + 1 < lines) {
      each<lines>([&](auto j) __attribute__((always_inline)) {
        const Lanes crossing = (lower.depth[j] - depth) / (lower.fall[j] - fall);
        const Mask first = (lower.fall[j] > fall) & (crossing < next);
        next = select(first, crossing, next);
        next_depth = select(first, lower.depth[j], next_depth);
        next_fall = select(first, lower.fall[j], next_fall);
      });
    }
    if constexpr (k + 1 < lines) {
      next = max(next, s);
      there = select(next < length, max(0.0, depth - fall * next), 0.0);
    }
    const Lanes piece = next - s;
    const Lanes total = Lanes(0.5) * piece * (here + there);
    stretch.pressure += total;
    along += s * total + piece * piece * (here + Lanes(2.0) * there) * Lanes(1.0 / 6.0);
    stretch.start[k] = s;
    stretch.depth[k] = here;
    stretch.deepest = max(stretch.deepest, there);
    s = next;
    here = there;
    depth = next_depth;
    fall = next_fall;
  });
  stretch.moment = stretch.pressure * stretch.begin + along * stretch.direction;
  return leaves;
}

/// Do all of the edges of `own` that can take part lie beyond a line of `other`?
struct BeyondLine {
  Mask all{};     ///< they do
  Mask clearly{}; ///< by more than rounding
};

template <std::size_t edges> BeyondLine find_line_between(const LaneSide &own, const LaneSide &other) {
  const Lanes rounding = Lanes(1e-9) * (other.high.x - other.low.x + other.high.y - other.low.y);
  BeyondLine beyond;
  each<edges>([&](auto j) __attribute__((always_inline)) {
    Lanes deepest = dot(other.slope[j], other.vertex[j] - own.vertex[0]);
    each<edges>([&](auto k) __attribute__((always_inline)) {
      deepest = max(deepest, dot(other.slope[j], other.vertex[j] - own.vertex[k + 1]));
    });
    beyond.all = beyond.all | (deepest <= 0.0);
    beyond.clearly = beyond.clearly | (deepest < -rounding);
  });
  return beyond;
}

/// Where evaluate() would find no pressure either: no edge of either block has an end below all lines of the
/// other one, or a line keeps them apart whatever rounding does.
template <std::size_t edges> Mask are_apart(const LaneSide &lower, const LaneSide &higher) {
  const BeyondLine first = find_line_between<edges>(lower, higher);
  const BeyondLine second = find_line_between<edges>(higher, lower);
  return (first.all & second.all) | first.clearly | second.clearly;
}

/// The boundary of an overlap of two corners: two stretches of each.
template <std::size_t edges> struct CornerOverlap {
  LaneCorner lower;
  LaneCorner higher;
  std::array<CornerStretch<edges>, 2> on_lower;
  std::array<CornerStretch<edges>, 2> on_higher;

  /// True where the blocks overlap so; elsewhere nothing of this means anything.
  Mask find(const LaneSide &lower_side, const LaneSide &higher_side);
  /// Is one of the two lines of the corner the nearest wherever an edge runs inside a block?
  [[nodiscard]] Mask has_two_lines_each() const;
  /// int_S (phi_A + phi_B) H dA where that is so, m3; see pair_energies.hpp.
  [[nodiscard]] Lanes energy() const;

private:
  static Mask find_stretches(const LaneCorner &own, const LaneSide &other_side, const LaneCorner &other,
                             const LaneVec &begin, std::array<CornerStretch<edges>, 2> &stretches);
};

template <std::size_t edges>
[[gnu::always_inline]] inline Mask
CornerOverlap<edges>::find_stretches(const LaneCorner &own, const LaneSide &other_side,
                                     const LaneCorner &other, const LaneVec &begin,
                                     std::array<CornerStretch<edges>, 2> &stretches) {
  Mask valid = own.vertex.x == own.vertex.x;
  FallingDepths<edges> lower;
  each<edges>([&](auto j) __attribute__((always_inline)) {
    // A line of the corner is measured from there: both ends are as near as the contact is short.
    const LaneVec anchor =
        edges == 2 ? other.vertex : select(other.has_line[j], other.vertex, other_side.vertex[j]);
    lower.depth[j] = dot(other_side.slope[j], anchor - own.vertex);
    valid = valid & (lower.depth[j] > 0.0);
  });
  each<2>([&](auto i) __attribute__((always_inline)) {
    CornerStretch<edges> &stretch = stretches[i];
    stretch.begin = begin;
    stretch.direction = own.away(i);
    each<edges>([&](auto j) __attribute__((always_inline)) {
      lower.fall[j] = dot(other_side.slope[j], stretch.direction);
    });
    valid = valid & integrate_stretch<edges>(lower, other, stretch);
    valid = valid & (stretch.length <= own.length[i]);
  });
  return valid;
}

template <std::size_t edges>
Mask CornerOverlap<edges>::find(const LaneSide &lower_side, const LaneSide &higher_side) {
  const Mask has_both = find_corner<edges>(lower_side, higher_side, lower) &
                        find_corner<edges>(higher_side, lower_side, higher);
  if (!has_both.any()) {
    return has_both;
  }
  const Mask on_first = find_stretches(lower, higher_side, higher, {0.0, 0.0}, on_lower);
  return has_both & on_first &
         find_stretches(higher, lower_side, lower, higher.vertex - lower.vertex, on_higher);
}

// Walked along these two lines alone, an edge has the same pressure, bit for bit.
template <std::size_t edges> Mask CornerOverlap<edges>::has_two_lines_each() const {
  Mask same = lower.vertex.x == lower.vertex.x;
  if constexpr (edges > 2) {
    const auto compare = [&](const LaneCorner &own, const LaneCorner &other,
                             const std::array<CornerStretch<edges>, 2> &stretches) {
      FallingDepths<2> below;
      each<2>([&](auto j) { below.depth[j] = dot(other.slope[j], other.vertex - own.vertex); });
      each<2>([&](auto i) {
        CornerStretch<2> stretch;
        stretch.begin = stretches[i].begin;
        stretch.direction = stretches[i].direction;
        each<2>([&](auto j) { below.fall[j] = dot(other.slope[j], stretch.direction); });
        integrate_stretch<2>(below, other, stretch);
        same = same & (stretch.pressure == stretches[i].pressure);
      });
    };
    compare(lower, higher, on_lower);
    compare(higher, lower, on_higher);
  }
  return same;
}

template <std::size_t edges> Lanes CornerOverlap<edges>::energy() const {
  LaneVec force{0.0, 0.0};
  each<2>([&](auto i) {
    force += on_higher[i].pressure * higher.normal[i];
    force += -on_lower[i].pressure * lower.normal[i];
  });
  return Lanes(1.0 / 3.0) * dot(higher.vertex - lower.vertex, force);
}

} // namespace gcpdda::GCPDDA_INSTRUCTIONS
