#pragma once

// The energy of an overlap from its boundary, one pair in each lane: nothing is cut out.
//
// In the cell C_i of a convex block B where its line i (normal n_i) is the nearest, phi = d_i and
// div(-n_i d_i^2/2) = d_i. By Gauss over the cells of B in the overlap S, int_S phi dA is the sum of
//  - over the other block's edges in S, with normal N: -(n_i.N) int d_i^2/2 ds. B's own edges have d = 0;
//  - over each line where cells i and k meet: |n_i - n_k| int d^2/2 ds. It comes from their vertex, and d
//  grows
//    along it by |n_i + n_k|/2 in a metre, so from there to where d = d_c it gives
//    |n_i - n_k|/|n_i + n_k| d_c^3/3 = tan(phi/2) d_c^3/3 with the angle phi between the normals.
// The boundary of S crosses such a line where an edge's nearest line changes. If i comes before k around B,
// then S lies towards the vertex where the change is from k to i, and away from it from i to k: d_c^3 counts
// with + and -. This holds as long as no three cells meet in S. Then every such line in S has two ends:
// changes of opposite sense, or one change and its vertex. Where some end is missing, nothing is known here.

#include "contact/lanes/lane_stretch.hpp"

#include <array>
#include <limits>

namespace gcpdda::GCPDDA_INSTRUCTIONS {

struct LaneEnergy {
  Lanes energy; ///< m3
  Mask known;
};

/// Below the lines of a block, along a stretch: where each is the least.
template <std::size_t lines> struct LeastDepths {
  PerLine<lines> first; ///< depth at the begin of the stretch
  PerLine<lines> last;  ///< and at its end
  PerLine<lines> from;  ///< the share of the stretch that is left where line j becomes the least ...
  PerLine<lines> to;    ///< ... and where it ceases to be
  std::array<Mask, lines> somewhere;

  [[nodiscard, gnu::always_inline]] Lanes at(std::size_t j, const Lanes &share) const {
    return first[j] + share * (last[j] - first[j]);
  }
  /// Does the least change from line i to line j on the way?
  [[nodiscard, gnu::always_inline]] Mask changes(std::size_t i, std::size_t j) const {
    return somewhere[i] & somewhere[j] & (to[i] == from[j]);
  }
};

template <std::size_t lines>
[[gnu::always_inline]] inline LeastDepths<lines> find_least(const LaneStretch &stretch,
                                                            const LaneChain &other) {
  LeastDepths<lines> depths;
  each<lines>([&](auto j) __attribute__((always_inline)) {
    depths.first[j] = dot(other.slope[j], other.vertex[j] - stretch.begin);
    depths.last[j] = dot(other.slope[j], other.vertex[j] - stretch.end);
    depths.from[j] = 0.0;
    depths.to[j] = 1.0;
  });
  each<lines>([&](auto i) __attribute__((always_inline)) {
    each<lines>([&](auto j) __attribute__((always_inline)) {
      if constexpr (i < j) {
        const Lanes begin = depths.first[i] - depths.first[j];
        const Lanes end = depths.last[i] - depths.last[j];
        const Lanes crossing = begin / (begin - end);
        const Mask to_j = (begin < 0.0) & (end > 0.0);
        const Mask to_i = (begin > 0.0) & (end < 0.0);
        depths.to[i] = select(to_j, min(depths.to[i], crossing), depths.to[i]);
        depths.from[j] = select(to_j, max(depths.from[j], crossing), depths.from[j]);
        depths.to[j] = select(to_i, min(depths.to[j], crossing), depths.to[j]);
        depths.from[i] = select(to_i, max(depths.from[i], crossing), depths.from[i]);
        // Of equal ones the first.
        const Mask never_i = (begin >= 0.0) & (end >= 0.0) & ((begin > 0.0) | (end > 0.0));
        depths.to[i] = select(never_i, 0.0, depths.to[i]);
        depths.to[j] = select((begin <= 0.0) & (end <= 0.0), 0.0, depths.to[j]);
      }
    });
  });
  each<lines>([&](auto j) { depths.somewhere[j] = stretch.valid & (depths.from[j] < depths.to[j]); });
  return depths;
}

/// Inside the edges of a block that can take part, and its box, or on its boundary up to rounding.
inline Mask is_inside(const LaneVec &x, const LaneChain &chain, const Lanes &rounding) {
  Mask inside = (chain.low.x - rounding <= x.x) & (x.x <= chain.high.x + rounding) &
                (chain.low.y - rounding <= x.y) & (x.y <= chain.high.y + rounding);
  for (std::size_t j = 0; j < chain.edges; ++j) {
    inside = inside & (dot(chain.slope[j], chain.vertex[j] - x) > -rounding);
  }
  return inside;
}

/// int phi dA of `other`, by the stretches of `own` inside it.
template <std::size_t lines>
LaneEnergy find_field_energy(const LaneChain &own, const LaneStretches &on_own, const LaneChain &other) {
  // At the vertex between lines k and k + 1: tan(phi/2)/3, and the ends of the line from there that are
  // missing. A vertex on the boundary, as where faces end flush, counts as inside, changes there do not.
  const Lanes rounding = Lanes(64.0 * std::numeric_limits<double>::epsilon()) *
                         max(max(abs(own.low.x), abs(own.high.x)), max(abs(own.low.y), abs(own.high.y)));
  PerLine<lines> by_cube;
  PerLine<lines> missing;
  each<lines - 1>([&](auto k) {
    by_cube[k] = cross(other.slope[k], other.slope[k + 1]) /
                 (Lanes(3.0) * (Lanes(1.0) + dot(other.slope[k], other.slope[k + 1])));
    missing[k] = select(is_inside(other.vertex[k + 1], own, rounding), Lanes(1.0), 0.0);
  });
  LaneEnergy result{0.0, own.low.x == own.low.x};
  for (std::size_t edge = 0; edge < own.edges; ++edge) {
    const LaneStretch &stretch = on_own[edge];
    if (!stretch.valid.any()) {
      continue;
    }
    const LeastDepths<lines> depths = find_least<lines>(stretch, other);
    each<lines>([&](auto j) __attribute__((always_inline)) {
      const Lanes length = stretch.length * (depths.to[j] - depths.from[j]);
      const Lanes p = depths.at(j, depths.from[j]);
      const Lanes q = depths.at(j, depths.to[j]);
      const Lanes facing = Lanes(-1.0 / 6.0) * dot(other.slope[j], own.normal[edge]);
      result.energy += select(depths.somewhere[j], facing * length * (p * p + p * q + q * q), 0.0);
    });
    each<lines>([&](auto i) __attribute__((always_inline)) {
      each<lines>([&](auto j) __attribute__((always_inline)) {
        if constexpr (i == j + 1 || j == i + 1) {
          constexpr std::size_t k = i < j ? i : j;
          const Lanes depth = depths.at(i, depths.to[i]);
          const Mask here = depths.changes(i, j) & (depth > rounding);
          const Lanes sense = i < j ? -1.0 : 1.0;
          result.energy += select(here, sense * by_cube[k] * (depth * depth * depth), 0.0);
          missing[k] = missing[k] - select(here, sense, 0.0);
        } else if constexpr (i != j) {
          result.known = result.known & !depths.changes(i, j);
        }
      });
    });
  }
  each<lines - 1>([&](auto k) { result.known = result.known & (missing[k] == 0.0); });
  return result;
}

/// The energy of overlaps for any number of lines that has a specialised kernel.
inline LaneEnergy find_field_energy(const LaneChain &own, const LaneStretches &on_own,
                                    const LaneChain &other) {
  static_assert(most_corner_edges == 4);
  switch (other.edges) {
  case 1:
    return find_field_energy<1>(own, on_own, other);
  case 2:
    return find_field_energy<2>(own, on_own, other);
  case 3:
    return find_field_energy<3>(own, on_own, other);
  default:
    return find_field_energy<4>(own, on_own, other);
  }
}

} // namespace gcpdda::GCPDDA_INSTRUCTIONS
