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
//  - V is the first vertex between two of them that lies in the other block's box and clearly below all of
//    its lines, W likewise,
//  - each of the four edges leaves the other block before it ends,
//  - and across an edge of the other corner. Then X on an edge of W is where that edge leaves V's block: a
//    line leaves a convex block once.
// Edges left out of a chain lie deeper than another one all over the contact and change none of these
// answers, and no bit of the integrals: whether a pair is computed so does not depend on the neighbourhood's
// refreshes, as it must be, since the last bits of both ways differ.

#include "contact/lanes/lane_region.hpp"
#include "contact/lanes/lane_stretch.hpp"

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

/// More than what rounding does to a depth below a line of a block.
[[gnu::always_inline]] inline Lanes rounding_of(const LaneChain &chain) {
  return Lanes(16.0 * std::numeric_limits<double>::epsilon()) *
         (max(abs(chain.low.x), abs(chain.high.x)) + max(abs(chain.low.y), abs(chain.high.y)));
}

[[gnu::always_inline]] inline Mask is_in_box(const LaneVec &x, const LaneChain &chain) {
  return (chain.low.x <= x.x) & (x.x <= chain.high.x) & (chain.low.y <= x.y) & (x.y <= chain.high.y);
}

/// @param rounding  of the other block: edges in one line have no corner that is clearly inside, and it would
///                  be in vain to look at what rounding puts there
template <std::size_t lines>
[[gnu::always_inline]] inline Mask is_inside(const LaneVec &x, const LaneChain &other,
                                             const Lanes &rounding) {
  Mask inside = is_in_box(x, other);
  each<lines>([&](auto j) { inside = inside & (dot(other.slope[j], other.vertex[j] - x) > rounding); });
  return inside;
}

/// How many corners of one block are inside the other one.
struct CornersInside {
  Mask any{};
  Mask two{}; ///< at least
};

inline CornersInside count_corners(const LaneChain &own, const LaneChain &other) {
  const Lanes rounding = rounding_of(other);
  CornersInside count;
  for (std::size_t k = 1; k < own.edges; ++k) {
    const LaneVec &x = own.vertex[k];
    Lanes least = dot(other.slope[0], other.vertex[0] - x);
    for (std::size_t j = 1; j < other.edges; ++j) {
      least = min(least, dot(other.slope[j], other.vertex[j] - x));
    }
    const Mask inside = is_in_box(x, other) & (least > rounding);
    count.two = count.two | (count.any & inside);
    count.any = count.any | inside;
  }
  return count;
}

/// The first end of two edges of `own` inside `other`.
template <std::size_t edges>
[[gnu::always_inline]] inline Mask find_corner(const LaneChain &own, const LaneChain &other,
                                               LaneCorner &corner) {
  const Lanes rounding = rounding_of(other);
  Mask found{};
  each<edges - 1>([&](auto before) {
    constexpr std::size_t k = before + 1;
    const Mask here = is_inside<edges>(own.vertex[k], other, rounding) & !found;
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
  std::array<Lanes, lines> piece_start; ///< m from the begin; pieces may be empty
  std::array<Lanes, lines> piece_depth; ///< there
  Lanes deepest;
  Lanes pressure; ///< int d ds, m2
  LaneVec moment; ///< int d (x - origin) ds, m3

  // As LaneStretch tells of its pieces.
  [[nodiscard, gnu::always_inline]] constexpr std::size_t count() const { return lines; }
  [[nodiscard, gnu::always_inline]] Lanes start(std::size_t k) const {
    return k < lines ? piece_start[k] : length;
  }
  [[nodiscard, gnu::always_inline]] Lanes depth(std::size_t k) const {
    return k < lines ? piece_depth[k] : Lanes(0.0);
  }
};

/// Depths below the lines of a block at a corner of the other one, and by how much they fall in a metre along
/// an edge away from it.
template <std::size_t lines> struct FallingDepths {
  PerLine<lines> depth;
  PerLine<lines> fall;
};

/// A place `over`/`rate` along an edge, m. Places are compared by products: of all that are looked at, one or
/// two are needed, and a division costs as much as a dozen products.
struct PlaceAlong {
  Lanes over;
  Lanes rate; ///< above 0, or the place is nowhere

  [[nodiscard, gnu::always_inline]] Mask is_before(const PlaceAlong &other) const {
    return over * other.rate < other.over * rate;
  }
};

/// The line nearest to an edge up to some place.
struct NearestLine {
  Lanes depth;
  Lanes fall;

  [[nodiscard, gnu::always_inline]] Lanes at(const Lanes &s) const { return max(0.0, depth - fall * s); }
};

/// Where the next line becomes the nearest one, and which one that is.
template <std::size_t lines>
[[gnu::always_inline]] inline PlaceAlong find_crossing(const FallingDepths<lines> &lower,
                                                       const NearestLine &nearest, NearestLine &next) {
  PlaceAlong first{1.0, 0.0};
  each<lines>([&](auto j) __attribute__((always_inline)) {
    const PlaceAlong place{lower.depth[j] - nearest.depth, lower.fall[j] - nearest.fall};
    const Mask is_first = (place.rate > 0.0) & place.is_before(first);
    first.over = select(is_first, place.over, first.over);
    first.rate = select(is_first, place.rate, first.rate);
    next.depth = select(is_first, lower.depth[j], next.depth);
    next.fall = select(is_first, lower.fall[j], next.fall);
  });
  return first;
}

/// Piece k of a stretch, from s to `to`, with the depths there.
/// @return int d s ds
template <std::size_t lines>
[[gnu::always_inline]] inline Lanes add_piece(std::size_t k, const Lanes &s, const Lanes &to,
                                              const Lanes &here, const Lanes &there,
                                              CornerStretch<lines> &stretch) {
  const Lanes piece = to - s;
  const Lanes total = Lanes(0.5) * piece * (here + there);
  stretch.pressure += total;
  stretch.piece_start[k] = s;
  stretch.piece_depth[k] = here;
  stretch.deepest = max(stretch.deepest, there);
  return s * total + piece * piece * (here + Lanes(2.0) * there) * Lanes(1.0 / 6.0);
}

/// How a walk along an edge begins and ends: the line that is nearest at the corner, and the one across which
/// the edge leaves the block first.
template <std::size_t lines> struct WalkEnds {
  PlaceAlong exit;
  Mask leaves; ///< across a line that is wanted
  NearestLine nearest;
  Lanes other_fall; ///< of two lines, of the one that is not the nearest

  /// @param wanted  by line
  [[gnu::always_inline]] WalkEnds(const FallingDepths<lines> &lower,
                                  const std::array<Mask, most_corner_edges> &wanted)
      : exit{lower.depth[0], max(0.0, lower.fall[0])},
        leaves(wanted[0]), nearest{lower.depth[0], lower.fall[0]}, other_fall(lower.fall[0]) {
    each<lines - 1>([&](auto before) __attribute__((always_inline)) {
      constexpr std::size_t j = before + 1;
      const Lanes &depth = lower.depth[j];
      const Lanes &fall = lower.fall[j];
      const Mask first = PlaceAlong{depth, fall}.is_before(exit);
      leaves = (first & wanted[j]) | (leaves & !first);
      exit.over = select(first, depth, exit.over);
      exit.rate = select(first, fall, exit.rate);
      const Mask nearer = (depth < nearest.depth) | ((depth == nearest.depth) & (fall > nearest.fall));
      other_fall = select(nearer, nearest.fall, fall);
      nearest.depth = select(nearer, depth, nearest.depth);
      nearest.fall = select(nearer, fall, nearest.fall);
    });
  }
};

/// Walk along the lower envelope of the depths to where the first one is used up.
/// @param wanted  by line
/// @return where that is a line that is wanted
template <std::size_t lines>
[[gnu::always_inline]] inline Mask integrate_stretch(const FallingDepths<lines> &lower,
                                                     const std::array<Mask, most_corner_edges> &wanted,
                                                     CornerStretch<lines> &stretch) {
  const WalkEnds<lines> ends(lower, wanted);
  const PlaceAlong &exit = ends.exit;
  NearestLine nearest = ends.nearest;
  // One division for the exit and the first crossing, if that comes before. A line left out of the chain
  // never does, so it changes no bit.
  NearestLine next = nearest;
  Mask crosses{};
  PlaceAlong crossing;
  if constexpr (lines == 2) { // they cross once, whichever is nearer
    crossing = {lower.depth[1] - lower.depth[0], lower.fall[1] - lower.fall[0]};
    crosses =
        (ends.other_fall > nearest.fall) & (abs(crossing.over) * exit.rate < exit.over * abs(crossing.rate));
  } else {
    crossing = find_crossing<lines>(lower, nearest, next);
    crosses = crossing.is_before(exit);
  }
  crossing.rate = select(crosses, crossing.rate, 1.0);
  const Lanes inverse = Lanes(1.0) / (exit.rate * crossing.rate);
  const Lanes length = exit.over * (inverse * crossing.rate);
  Lanes to = min(select(crosses, crossing.over * (inverse * exit.rate), length), length);
  Lanes s = 0.0;
  Lanes here = nearest.depth;
  Lanes along = 0.0;
  stretch.length = length;
  stretch.pressure = 0.0;
  stretch.deepest = here;
  each<lines>([&](auto k) __attribute__((always_inline)) {
    const bool is_last = k + 1 == lines;
    if constexpr (is_last) {
      to = length;
    } else if constexpr (k > 0) {
      nearest = next;
      const PlaceAlong place = find_crossing<lines>(lower, nearest, next);
      const Mask comes = crosses & place.is_before(exit);
      crosses = comes;
      to = length;
      if (comes.any()) {
        to = select(comes, clamp(place.over / place.rate, s, length), length);
      }
    }
    const Lanes there = is_last ? Lanes(0.0) : select(to < length, nearest.at(to), 0.0);
    along += add_piece(k, s, to, here, there, stretch);
    s = to;
    here = there;
  });
  stretch.moment = stretch.pressure * stretch.begin + along * stretch.direction;
  return ends.leaves;
}

/// Do all of the edges of `own` that can take part lie beyond a line of `other`?
struct BeyondLine {
  Mask all{};     ///< they do
  Mask clearly{}; ///< by more than rounding
};

template <std::size_t edges> BeyondLine find_line_between(const LaneChain &own, const LaneChain &other) {
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
template <std::size_t edges> Mask are_apart(const LaneChain &lower, const LaneChain &higher) {
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

  /// Where the boundary is measured from.
  [[nodiscard]] const LaneVec &origin() const { return lower.vertex; }
  /// visit(number, stretch, direction of its pressure on the lower block).
  template <class Visit> [[gnu::always_inline]] void for_stretches(Visit &&visit) const {
    each<2>([&](auto i) __attribute__((always_inline)) {
      visit(std::integral_constant<std::size_t, 2 * i>{}, on_lower[i], -lower.normal[i]);
      visit(std::integral_constant<std::size_t, 2 * i + 1>{}, on_higher[i], higher.normal[i]);
    });
  }
  /// visit(x) for the corners of the overlap but the origin, from there.
  template <class Visit> [[gnu::always_inline]] void for_corners(Visit &&visit) const {
    visit(on_lower[0].length * on_lower[0].direction);
    visit(on_lower[1].length * on_lower[1].direction);
    visit(on_higher[0].begin);
  }

  /// True where the blocks overlap so; elsewhere nothing of this means anything.
  Mask find(const LaneChain &lower_chain, const LaneChain &higher_chain);
  /// Is one of the two lines of the corner the nearest wherever an edge runs inside a block?
  [[nodiscard]] Mask has_two_lines_each() const;
  /// int_S (phi_A + phi_B) H dA where that is so, m3; see pair_energies.hpp.
  [[nodiscard]] Lanes energy() const;

private:
  static Mask find_stretches(const LaneCorner &own, const LaneChain &other_chain, const LaneCorner &other,
                             const LaneVec &begin, std::array<CornerStretch<edges>, 2> &stretches);
};

template <std::size_t edges>
[[gnu::always_inline]] inline Mask
CornerOverlap<edges>::find_stretches(const LaneCorner &own, const LaneChain &other_chain,
                                     const LaneCorner &other, const LaneVec &begin,
                                     std::array<CornerStretch<edges>, 2> &stretches) {
  Mask valid = own.vertex.x == own.vertex.x;
  FallingDepths<edges> lower;
  each<edges>([&](auto j) __attribute__((always_inline)) {
    // A line of the corner is measured from there: both ends are as near as the contact is short.
    const LaneVec anchor =
        edges == 2 ? other.vertex : select(other.has_line[j], other.vertex, other_chain.vertex[j]);
    lower.depth[j] = dot(other_chain.slope[j], anchor - own.vertex);
    valid = valid & (lower.depth[j] > 0.0);
  });
  each<2>([&](auto i) __attribute__((always_inline)) {
    CornerStretch<edges> &stretch = stretches[i];
    stretch.begin = begin;
    stretch.direction = own.away(i);
    each<edges>([&](auto j) __attribute__((always_inline)) {
      lower.fall[j] = dot(other_chain.slope[j], stretch.direction);
    });
    valid = valid & integrate_stretch<edges>(lower, other.has_line, stretch);
    valid = valid & (stretch.length <= own.length[i]);
  });
  return valid;
}

template <std::size_t edges>
Mask CornerOverlap<edges>::find(const LaneChain &lower_chain, const LaneChain &higher_chain) {
  const Mask lower_has = find_corner<edges>(lower_chain, higher_chain, lower);
  const Mask has_both = lower_has & find_corner<edges>(higher_chain, lower_chain, higher);
  if (!has_both.any()) {
    return has_both;
  }
  const Mask on_first = find_stretches(lower, higher_chain, higher, {0.0, 0.0}, on_lower);
  return has_both & on_first &
         find_stretches(higher, lower_chain, lower, higher.vertex - lower.vertex, on_higher);
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
        integrate_stretch<2>(below, other.has_line, stretch);
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
