#pragma once

// The grips (grip.hpp) of as many regions as there are lanes.

#include "contact/lanes/lane_motion.hpp"

namespace gcpdda::GCPDDA_INSTRUCTIONS {

/// Grip, one in each lane, of pairs with a deformable block.
class LaneGrip {
public:
  /// @param is_new  there is none so far, or the region is longer than ever
  [[gnu::always_inline]] LaneGrip(const DeformingMotion &motion, const LaneVec &centre_of_pressure,
                                  const LaneVec &tangent, const Lanes &begin, const Lanes &end,
                                  const Mask &is_new)
      : motion_(motion), from_(centre_of_pressure), tangent_(tangent), begin_(begin), end_(end),
        reference_(motion.grip) {
    const Lanes known = place();
    const Mask has_parted = (known < begin) | (end < known);
    move(is_new | has_parted, select(is_new, middle(), cut(known)));
  }
  [[gnu::always_inline]] void move_to_middle(const Mask &where) { move(where, middle()); }
  /// @param excess  of the elastic shear over its cap, N/m
  [[gnu::always_inline]] void slip(const Mask &where, const Lanes &excess, const Lanes &cap) {
    const Lanes along = place();
    const Lanes share = min(1.0, excess / select(where, cap, 1.0));
    move(where, along + share * (middle() - along));
  }
  /// X_g.
  [[nodiscard]] const LaneVec &reference() const { return reference_; }
  /// Where friction acts.
  [[nodiscard, gnu::always_inline]] LaneVec point() const { return from_ + cut(place()) * tangent_; }

private:
  [[nodiscard, gnu::always_inline]] Lanes middle() const { return Lanes(0.5) * (begin_ + end_); }
  [[nodiscard, gnu::always_inline]] Lanes cut(const Lanes &along) const { return clamp(along, begin_, end_); }
  [[nodiscard, gnu::always_inline]] Lanes place() const {
    return dot(motion_.lower_centroid + motion_.lower_gradient(reference_) - from_, tangent_);
  }
  [[gnu::always_inline]] void move(const Mask &where, const Lanes &along) {
    if (where.any()) {
      const LaneVec moved = motion_.lower_to_reference(from_ + along * tangent_ - motion_.lower_centroid);
      reference_ = select(where, moved, reference_);
    }
  }

  const DeformingMotion &motion_;
  LaneVec from_;
  LaneVec tangent_;
  Lanes begin_;
  Lanes end_;
  LaneVec reference_;
};

/// Two rigid blocks: friction acts at the centre of pressure, and nothing is remembered.
class LaneNoGrip {
public:
  [[gnu::always_inline]] explicit LaneNoGrip(const LaneVec &centre_of_pressure)
      : point_(centre_of_pressure) {}
  [[gnu::always_inline]] void move_to_middle(const Mask &) {}
  [[gnu::always_inline]] void slip(const Mask &, const Lanes &, const Lanes &) {}
  [[nodiscard]] const LaneVec &reference() const { return point_; }
  [[nodiscard]] const LaneVec &point() const { return point_; }

private:
  LaneVec point_;
};

} // namespace gcpdda::GCPDDA_INSTRUCTIONS
