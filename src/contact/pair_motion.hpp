#pragma once

#include "gcpdda/contact/contact_forces.hpp"

namespace gcpdda {

/// Motion of the material point now at offset r from the trial centroid since the last trial configuration.
inline Vec2 increment_at(const TrialIncrement &step, Vec2 r) {
  return step.u + step.turn(r);
}

/// Motion of the lower block's material point now at x relative to the higher one's.
inline Vec2 slide_at(const BlockSystem &system, const CandidatePair &pair, Vec2 x,
                     const TrialIncrement &lower, const TrialIncrement &higher) {
  return increment_at(lower, x - system.trial_centroid[pair.lower.value]) -
         increment_at(higher, x - system.trial_centroid[pair.higher.value]);
}

inline void add_force(RegionForce &force, Vec2 at, Vec2 f) {
  force.force += f;
  force.dyad += outer(at - force.origin, f);
}

} // namespace gcpdda
