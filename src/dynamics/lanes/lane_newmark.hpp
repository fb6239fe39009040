#pragma once

// The update of velocity and displacement, for as many blocks at a time as there are lanes.

#include "base/lanes.hpp"
#include "dynamics/scheme.hpp"

namespace gcpdda::GCPDDA_INSTRUCTIONS {

// The new position and velocity of the family (scheme.hpp), of anything that lanes can hold.
template <class Q>
[[gnu::always_inline]] inline Q position_of(const Scheme &scheme, double dt, const Q &q, const Q &v,
                                            const Q &a, const Q &a_new) {
  return q + (Lanes(dt) * v + Lanes(dt * dt) * (Lanes(0.5 - scheme.beta) * a + Lanes(scheme.beta) * a_new));
}
template <class Q>
[[gnu::always_inline]] inline Q velocity_of(const Scheme &scheme, double dt, const Q &v, const Q &a,
                                            const Q &a_new) {
  return v + Lanes(dt) * (Lanes(1.0 - scheme.gamma) * a + Lanes(scheme.gamma) * a_new);
}

} // namespace gcpdda::GCPDDA_INSTRUCTIONS
