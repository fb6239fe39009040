#pragma once

// Two convex blocks of which one, "own", has one or two neighbouring corners inside the other one, which has
// none inside it: a corner in a face, or the end of a block on a larger one.
//
// Let V and V' be the corners (the same if it is one). If the edge that ends in V and the one that begins in
// V' leave the other block across the same line f, at X and X', before they end, then the overlap is the
// polygon X V V' X': what is beyond f of own is no part of the other block, what is on this side of it is
// that polygon, since own is convex, and all of its corners are in the other block. Its boundary is four
// stretches: V X and V' X' are walked as those of corners (lane_corners.hpp), V V' along own's edge below the
// other block's lines, X' X along f below own's. Depths along f are measured from V and V', so they are as
// short as the contact.
//
// Where both blocks have a corner inside the other one this is not looked for, so that it and the overlap of
// two corners never hold for the same pair: which of the ways a pair is computed in depends on its shapes
// alone, not on what has been tried first.

#include "contact/lanes/lane_corners.hpp"

#include <array>

namespace gcpdda::GCPDDA_INSTRUCTIONS {

/// Part of an edge whose ends both may be below all lines.
template <std::size_t lines> struct InnerStretch : CornerStretch<lines> {
  Lanes last_depth; ///< at the end

  [[nodiscard, gnu::always_inline]] Lanes depth(std::size_t k) const {
    return k < lines ? this->piece_depth[k] : last_depth;
  }
};

/// Walk along the lower envelope of the depths over the whole length, which `stretch` has with its begin and
/// direction.
template <std::size_t lines>
[[gnu::always_inline]] inline void integrate_inside(const FallingDepths<lines> &lower,
                                                    InnerStretch<lines> &stretch) {
  const Lanes &length = stretch.length;
  const PlaceAlong end{length, 1.0};
  NearestLine nearest{lower.depth[0], lower.fall[0]};
  each<lines - 1>([&](auto before) __attribute__((always_inline)) {
    const Lanes &depth = lower.depth[before + 1];
    const Lanes &fall = lower.fall[before + 1];
    const Mask nearer = (depth < nearest.depth) | ((depth == nearest.depth) & (fall > nearest.fall));
    nearest.depth = select(nearer, depth, nearest.depth);
    nearest.fall = select(nearer, fall, nearest.fall);
  });
  Mask goes_on = length == length;
  Lanes s = 0.0;
  Lanes here = nearest.depth;
  Lanes along = 0.0;
  stretch.pressure = 0.0;
  stretch.deepest = here;
  each<lines>([&](auto k) __attribute__((always_inline)) {
    NearestLine next = nearest;
    Lanes to = length;
    Mask crosses{};
    if (k + 1 < lines && goes_on.any()) {
      const PlaceAlong place = find_crossing<lines>(lower, nearest, next);
      crosses = goes_on & place.is_before(end);
      if (crosses.any()) {
        to = select(crosses, clamp(place.over / place.rate, s, length), length);
      }
    }
    const Lanes there = nearest.at(to);
    along += add_piece(k, s, to, here, there, stretch);
    s = to;
    here = there;
    nearest.depth = select(crosses, next.depth, nearest.depth);
    nearest.fall = select(crosses, next.fall, nearest.fall);
    goes_on = crosses;
  });
  stretch.last_depth = here;
  stretch.moment = stretch.pressure * stretch.begin + along * stretch.direction;
}

/// The boundary of such an overlap.
template <std::size_t edges> struct FaceOverlap {
  Mask lower_has; ///< it has a corner inside the other one
  Mask higher_has;

  [[nodiscard]] const LaneVec &origin() const { return first_; }

  /// True where the blocks overlap so; elsewhere nothing of this but lower_has and higher_has means anything.
  /// Edges of a chain from its number of edges on are copies of its last one.
  Mask find(const LaneChain &lower, std::size_t lower_edges, const LaneChain &higher,
            std::size_t higher_edges);

  /// visit(number, stretch, direction of its pressure on the lower block).
  template <class Visit> [[gnu::always_inline]] void for_stretches(Visit &&visit) const {
    visit(std::integral_constant<std::size_t, 0>{}, on_before_, before_push_);
    visit(std::integral_constant<std::size_t, 1>{}, on_after_, after_push_);
    visit(std::integral_constant<std::size_t, 2>{}, on_face_, face_push_);
    if (has_two_) {
      visit(std::integral_constant<std::size_t, 3>{}, on_inner_, inner_push_);
    }
  }
  /// visit(x) for the corners of the overlap but the origin, from there.
  template <class Visit> [[gnu::always_inline]] void for_corners(Visit &&visit) const {
    visit(on_before_.length * on_before_.direction);
    visit(on_face_.begin);
    visit(on_after_.begin);
  }

private:
  using Inside = std::array<Mask, edges>; ///< by vertex of a chain; the first one is no corner

  /// An edge of own that begins or ends in a corner.
  struct Edge {
    LaneVec normal;
    Lanes length;
    std::array<Mask, edges> is_it; ///< by edge of the chain

    [[gnu::always_inline]] void take(const Mask &here, const LaneChain &chain, std::size_t k) {
      normal = select(here, chain.normal[k], normal);
      length = select(here, chain.length[k], length);
      is_it[k] = here;
    }
  };

  static Mask find_inside(const LaneChain &own, std::size_t own_edges, const LaneChain &other,
                          Inside &inside);
  /// Edges of `a` where the mask is true, else of `b`.
  static void choose(const Mask &mask, const LaneChain &a, const LaneChain &b, LaneChain &chosen);
  void find_corners(const LaneChain &own, const Inside &inside);
  /// Which line the edge leaves across first.
  static std::array<Mask, edges> find_exit(const FallingDepths<edges> &lower);
  static void find_falls(const LaneChain &other, const LaneVec &direction, FallingDepths<edges> &lower);
  Mask walk_face(const LaneChain &own, const LaneVec &face_normal);

  LaneVec first_;        ///< V
  LaneVec second_;       ///< V'
  bool has_two_ = false; ///< they are two in some lane
  Edge before_;          ///< ends in V
  Edge inner_;           ///< from V to V', of no length where they are one
  Edge after_;           ///< begins in V'
  CornerStretch<edges> on_before_;
  CornerStretch<edges> on_after_;
  InnerStretch<edges> on_inner_;
  InnerStretch<edges> on_face_;
  LaneVec before_push_;
  LaneVec inner_push_;
  LaneVec after_push_;
  LaneVec face_push_;
};

template <std::size_t edges>
[[gnu::always_inline]] inline Mask FaceOverlap<edges>::find_inside(const LaneChain &own,
                                                                   std::size_t own_edges,
                                                                   const LaneChain &other, Inside &inside) {
  const Lanes rounding = rounding_of(other);
  Mask any{};
  inside[0] = any;
  each<edges - 1>([&](auto before) __attribute__((always_inline)) {
    constexpr std::size_t k = before + 1;
    inside[k] = k < own_edges ? is_inside<edges>(own.vertex[k], other, rounding) : Mask{};
    any = any | inside[k];
  });
  return any;
}

template <std::size_t edges>
[[gnu::always_inline]] inline void FaceOverlap<edges>::choose(const Mask &mask, const LaneChain &a,
                                                              const LaneChain &b, LaneChain &chosen) {
  each<edges>([&](auto k) __attribute__((always_inline)) {
    chosen.vertex[k] = select(mask, a.vertex[k], b.vertex[k]);
    chosen.normal[k] = select(mask, a.normal[k], b.normal[k]);
    chosen.slope[k] = select(mask, a.slope[k], b.slope[k]);
    chosen.length[k] = select(mask, a.length[k], b.length[k]);
  });
}

template <std::size_t edges>
[[gnu::always_inline]] inline void FaceOverlap<edges>::find_corners(const LaneChain &own,
                                                                    const Inside &inside) {
  first_ = own.vertex[1];
  second_ = first_;
  const Mask none{};
  for (Edge *edge : {&before_, &inner_, &after_}) {
    edge->normal = own.normal[0];
    edge->length = 0.0;
    edge->is_it.fill(none);
  }
  Mask found = none;
  has_two_ = false;
  Mask goes_on = none; // the edge before this vertex runs between both corners
  each<edges - 1>([&](auto previous) __attribute__((always_inline)) {
    constexpr std::size_t k = previous + 1;
    const Mask here = inside[k] & !found;
    Mask are_two = none;
    if constexpr (k + 1 < edges) {
      are_two = here & inside[k + 1];
      has_two_ = has_two_ || are_two.any();
    }
    const Mask is_last = (here & !are_two) | goes_on;
    first_ = select(here, own.vertex[k], first_);
    second_ = select(is_last, own.vertex[k], second_);
    before_.take(here, own, k - 1);
    inner_.take(are_two, own, k);
    after_.take(is_last, own, k);
    found = found | here;
    goes_on = are_two;
  });
}

template <std::size_t edges>
[[gnu::always_inline]] inline std::array<Mask, edges>
FaceOverlap<edges>::find_exit(const FallingDepths<edges> &lower) {
  PlaceAlong exit{lower.depth[0], max(0.0, lower.fall[0])};
  std::array<Mask, edges> is_exit;
  is_exit[0] = exit.rate > 0.0;
  each<edges - 1>([&](auto before) __attribute__((always_inline)) {
    constexpr std::size_t j = before + 1;
    const PlaceAlong place{lower.depth[j], lower.fall[j]};
    const Mask first = place.is_before(exit);
    exit.over = select(first, place.over, exit.over);
    exit.rate = select(first, place.rate, exit.rate);
    for (std::size_t i = 0; i < j; ++i) {
      is_exit[i] = is_exit[i] & !first;
    }
    is_exit[j] = first;
  });
  return is_exit;
}

template <std::size_t edges>
[[gnu::always_inline]] inline void FaceOverlap<edges>::find_falls(const LaneChain &other,
                                                                  const LaneVec &direction,
                                                                  FallingDepths<edges> &lower) {
  each<edges>([&](auto j) __attribute__((always_inline)) { lower.fall[j] = dot(other.slope[j], direction); });
}

/// From X' to X.
template <std::size_t edges>
[[gnu::always_inline]] inline Mask FaceOverlap<edges>::walk_face(const LaneChain &own,
                                                                 const LaneVec &face_normal) {
  on_face_.direction = perp(face_normal);
  on_face_.begin = on_after_.begin + on_after_.length * on_after_.direction;
  on_face_.length = dot(on_before_.length * on_before_.direction - on_face_.begin, on_face_.direction);
  FallingDepths<edges> lower;
  find_falls(own, on_face_.direction, lower);
  each<edges>([&](auto j) __attribute__((always_inline)) {
    const LaneVec anchor =
        select(before_.is_it[j] | inner_.is_it[j], LaneVec{0.0, 0.0}, own.vertex[j] - first_);
    lower.depth[j] = select(after_.is_it[j], 0.0, max(0.0, dot(own.slope[j], anchor - on_face_.begin)));
  });
  integrate_inside<edges>(lower, on_face_);
  return on_face_.length > 0.0;
}

template <std::size_t edges>
Mask FaceOverlap<edges>::find(const LaneChain &lower, std::size_t lower_edges, const LaneChain &higher,
                              std::size_t higher_edges) {
  Inside inside;
  Inside higher_inside;
  const Mask lower_is_own = find_inside(lower, lower_edges, higher, inside);
  lower_has = lower_is_own;
  higher_has = find_inside(higher, higher_edges, lower, higher_inside);
  Mask valid = lower_has ^ higher_has;
  if (!valid.any()) {
    return valid;
  }
  each<edges>([&](auto k) __attribute__((always_inline)) {
    inside[k] = (inside[k] & lower_is_own) | (higher_inside[k] & !lower_is_own);
  });
  LaneChain own;
  LaneChain other;
  choose(lower_is_own, lower, higher, own);
  choose(lower_is_own, higher, lower, other);
  find_corners(own, inside);

  FallingDepths<edges> below;
  find_depths<edges>(other, first_, below.depth);
  on_before_.begin = {0.0, 0.0};
  on_before_.direction = -perp(before_.normal);
  find_falls(other, on_before_.direction, below);
  const std::array<Mask, edges> face = find_exit(below);
  valid = valid & integrate_stretch<edges>(below, face, on_before_);
  valid = valid & (on_before_.length <= before_.length);
  if (has_two_) {
    on_inner_.begin = {0.0, 0.0};
    on_inner_.direction = perp(inner_.normal);
    on_inner_.length = inner_.length;
    find_falls(other, on_inner_.direction, below);
    integrate_inside<edges>(below, on_inner_);
    find_depths<edges>(other, second_, below.depth);
  }
  on_after_.begin = second_ - first_;
  on_after_.direction = perp(after_.normal);
  find_falls(other, on_after_.direction, below);
  valid = valid & integrate_stretch<edges>(below, face, on_after_);
  valid = valid & (on_after_.length <= after_.length);
  LaneVec face_normal = other.normal[0];
  each<edges - 1>([&](auto before) __attribute__((always_inline)) {
    face_normal = select(face[before + 1], other.normal[before + 1], face_normal);
  });
  valid = valid & walk_face(own, face_normal);

  const auto push = [&](const LaneVec &normal, bool is_own) __attribute__((always_inline)) {
    return is_own ? select(lower_is_own, -normal, normal) : select(lower_is_own, normal, -normal);
  };
  before_push_ = push(before_.normal, true);
  inner_push_ = push(inner_.normal, true);
  after_push_ = push(after_.normal, true);
  face_push_ = push(face_normal, false);
  return valid;
}

} // namespace gcpdda::GCPDDA_INSTRUCTIONS
