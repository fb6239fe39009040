#pragma once

// Small rotations, one in each lane.

#include "base/lanes.hpp"
#include "gcpdda/geometry/vec2.hpp"

namespace gcpdda::GCPDDA_INSTRUCTIONS {

/// SmallTurn, one in each lane, to the same bits.
struct LaneTurn {
  Lanes sine;
  Lanes versine;

  [[gnu::always_inline]] static Mask is_small(const Lanes &angle) { return abs(angle) <= SmallTurn::largest; }
  [[gnu::always_inline]] static LaneTurn of(const Lanes &a) {
    const Lanes one = 1.0;
    const Lanes q = a * a;
    return {
        a * (one - q * (1.0 / 6.0) *
                       (one - q * (1.0 / 20.0) *
                                  (one - q * (1.0 / 42.0) * (one - q * (1.0 / 72.0) * (one - q / 110.0))))),
        Lanes(0.5) * q *
            (one - q * (1.0 / 12.0) *
                       (one - q * (1.0 / 30.0) * (one - q * (1.0 / 56.0) * (one - q * (1.0 / 90.0)))))};
  }
};

} // namespace gcpdda::GCPDDA_INSTRUCTIONS
