#pragma once

// Two convex blocks that lie on each other with whole edges of one length, so that their next edges on either
// side run in one line: bricks above one another, squares side by side. No corner of either is inside the
// other one by more than rounding. One contact in four of a pile that starts pressed together is so at first.
//
// Let e, from V to V', be the only edge of the lower block both of whose ends lie in the higher one or, but
// for rounding, on its boundary, and f, from W to W', that of the higher block. If V' lies on the line of the
// edge that ends in W, and W on that of the edge that begins in V', both these edges run along V' W, and so
// at the other end between W' and V. The overlap then is the quadrilateral V V' W W'. Its pressure is that of
// e below the higher block's lines and of f below the lower one's, both over their whole length; along V' W
// and W' V depths are no larger than rounding and left out, like the depths that rounding puts below 0. So
// are dashpots there: of two edges in one line, whose normals are the same, no more than one faces along n_r,
// and only rounding would say whether that is the one inside.
//
// Nor is this looked for where V and V' lie below f by no more than rounding: other ways may have seen a line
// between the blocks then, and what a walk along e adds up is rounding.
//
// Where a corner is clearly inside, one of the other short ways applies (lane_corners.hpp, lane_faces.hpp)
// and not this one. All that is looked at are ends of edges in or on the other block, whose edges are in the
// chains whatever the last refresh has left out, and lines near them; so no bit depends on the refreshes.

#include "contact/lanes/lane_faces.hpp"

#include <array>

namespace gcpdda::GCPDDA_INSTRUCTIONS {

/// The boundary of such an overlap.
template <std::size_t edges> struct EdgeOverlap {
  static_assert(edges >= 3);
  Mask lower_has; ///< it has a corner clearly inside the other one
  Mask higher_has;

  [[nodiscard]] const LaneVec &origin() const { return origin_; }

  /// True where the blocks overlap so; elsewhere nothing of this but lower_has and higher_has means anything.
  /// Edges of a chain from its number of edges on are copies of its last one.
  Mask find(const LaneChain &lower, std::size_t lower_edges, const LaneChain &higher,
            std::size_t higher_edges);

  /// visit(number, stretch, direction of its pressure on the lower block).
  template <class Visit> [[gnu::always_inline]] void for_stretches(Visit &&visit) const {
    visit(std::integral_constant<std::size_t, 0>{}, on_lower_, lower_push_);
    visit(std::integral_constant<std::size_t, 1>{}, on_higher_, higher_push_);
  }
  /// visit(x) for the corners of the overlap but the origin, from there.
  template <class Visit> [[gnu::always_inline]] void for_corners(Visit &&visit) const {
    visit(on_lower_.length * on_lower_.direction);
    visit(on_higher_.begin);
    visit(on_higher_.begin + on_higher_.length * on_higher_.direction);
  }

private:
  /// What of a block lies in or on the other one.
  struct Meeting {
    std::array<PerLine<edges>, edges> depth; ///< of vertex k below line j; the first vertex is no corner
    std::array<Mask, edges> is_whole;        ///< both ends of edge k do
    Mask has_side{};                         ///< these ends alone do
    Mask has_inside{};                       ///< some corner is clearly inside
  };
  /// The edge of a block, and depths of its begin below the other one's lines.
  struct WholeEdge {
    LaneVec begin;
    LaneVec normal;
    Lanes length;
    PerLine<edges> depth;
  };

  static void find_meeting(const LaneChain &own, std::size_t own_edges, const LaneChain &other,
                           Meeting &meeting);
  static WholeEdge find_edge(const LaneChain &own, const Meeting &meeting);
  static void walk(const WholeEdge &edge, const LaneChain &other, const LaneVec &origin,
                   InnerStretch<edges> &stretch);

  LaneVec origin_; ///< V
  InnerStretch<edges> on_lower_;
  InnerStretch<edges> on_higher_;
  LaneVec lower_push_;
  LaneVec higher_push_;
};

template <std::size_t edges>
[[gnu::always_inline]] inline void
EdgeOverlap<edges>::find_meeting(const LaneChain &own, std::size_t own_edges, const LaneChain &other,
                                 Meeting &meeting) {
  const Lanes rounding = rounding_of(other);
  std::array<Mask, edges> touches{};
  Mask two{};
  Mask three{};
  Mask any{};
  each<edges - 1>([&](auto before) __attribute__((always_inline)) {
    constexpr std::size_t k = before + 1;
    const LaneVec &x = own.vertex[k];
    find_depths<edges>(other, x, meeting.depth[k]);
    Lanes least = meeting.depth[k][0];
    each<edges - 1>([&](auto j)
                        __attribute__((always_inline)) { least = min(least, meeting.depth[k][j + 1]); });
    if (k < own_edges) {
      meeting.has_inside = meeting.has_inside | (is_in_box(x, other, 0.0) & (least > rounding));
      touches[k] = is_in_box(x, other, rounding) & (least >= -rounding);
    }
    three = three | (two & touches[k]);
    two = two | (any & touches[k]);
    any = any | touches[k];
  });
  Mask has_neighbours{};
  each<edges>([&](auto k) __attribute__((always_inline)) {
    meeting.is_whole[k] = k > 0 && k + 1 < edges ? touches[k] & touches[(k + 1) % edges] : Mask{};
    has_neighbours = has_neighbours | meeting.is_whole[k];
  });
  meeting.has_side = has_neighbours & !three;
}

template <std::size_t edges>
[[gnu::always_inline]] inline typename EdgeOverlap<edges>::WholeEdge
EdgeOverlap<edges>::find_edge(const LaneChain &own, const Meeting &meeting) {
  WholeEdge edge{own.vertex[1], own.normal[1], own.length[1], meeting.depth[1]};
  each<edges - 3>([&](auto before) __attribute__((always_inline)) {
    constexpr std::size_t k = before + 2;
    const Mask &here = meeting.is_whole[k];
    edge.begin = select(here, own.vertex[k], edge.begin);
    edge.normal = select(here, own.normal[k], edge.normal);
    edge.length = select(here, own.length[k], edge.length);
    each<edges>([&](auto j) __attribute__((always_inline)) {
      edge.depth[j] = select(here, meeting.depth[k][j], edge.depth[j]);
    });
  });
  return edge;
}

template <std::size_t edges>
[[gnu::always_inline]] inline void EdgeOverlap<edges>::walk(const WholeEdge &edge, const LaneChain &other,
                                                            const LaneVec &origin,
                                                            InnerStretch<edges> &stretch) {
  stretch.begin = edge.begin - origin;
  stretch.direction = perp(edge.normal);
  stretch.length = edge.length;
  FallingDepths<edges> below;
  each<edges>([&](auto j) __attribute__((always_inline)) {
    below.depth[j] = max(0.0, edge.depth[j]);
    below.fall[j] = dot(other.slope[j], stretch.direction);
  });
  integrate_inside<edges>(below, stretch);
}

template <std::size_t edges>
Mask EdgeOverlap<edges>::find(const LaneChain &lower, std::size_t lower_edges, const LaneChain &higher,
                              std::size_t higher_edges) {
  Meeting of_lower;
  Meeting of_higher;
  find_meeting(lower, lower_edges, higher, of_lower);
  find_meeting(higher, higher_edges, lower, of_higher);
  lower_has = of_lower.has_inside;
  higher_has = of_higher.has_inside;
  const Lanes below_lower = rounding_of(lower);
  const Lanes below_higher = rounding_of(higher);
  Mask run_in_line{};
  each<edges - 2>([&](auto lower_before) __attribute__((always_inline)) {
    each<edges - 2>([&](auto higher_before) __attribute__((always_inline)) {
      constexpr std::size_t k = lower_before + 1;
      constexpr std::size_t q = higher_before + 1;
      const Lanes closed = max(of_lower.depth[k][q], of_lower.depth[k + 1][q]);
      run_in_line =
          run_in_line |
          (of_lower.is_whole[k] & of_higher.is_whole[q] & (closed > below_higher) &
           (of_lower.depth[k + 1][q - 1] <= below_higher) & (of_lower.depth[k][q + 1] <= below_higher) &
           (of_higher.depth[q + 1][k - 1] <= below_lower) & (of_higher.depth[q][k + 1] <= below_lower));
    });
  });
  const Mask valid = of_lower.has_side & of_higher.has_side & run_in_line & !(lower_has | higher_has);
  if (!valid.any()) {
    return valid;
  }
  const WholeEdge on_lower = find_edge(lower, of_lower);
  const WholeEdge on_higher = find_edge(higher, of_higher);
  origin_ = on_lower.begin;
  walk(on_lower, higher, origin_, on_lower_);
  walk(on_higher, lower, origin_, on_higher_);
  lower_push_ = -on_lower.normal;
  higher_push_ = on_higher.normal;
  return valid;
}

} // namespace gcpdda::GCPDDA_INSTRUCTIONS
