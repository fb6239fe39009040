#include "contact/laws/dilation.hpp"

#include "contact/pair_motion.hpp"

#include <algorithm>
#include <cmath>

namespace gcpdda {

double guessed_slip(const BlockSystem &system, const CandidatePair &pair, const RegionMemory &known,
                    ClosedPair &closed) {
  closed.move(system, pair, known.opening);
  const Aabb &a = closed.lower().box;
  const Aabb &b = closed.higher().box;
  const Vec2 middle = 0.5 * (Vec2{std::max(a.low.x, b.low.x), std::max(a.low.y, b.low.y)} +
                             Vec2{std::min(a.high.x, b.high.x), std::min(a.high.y, b.high.y)});
  const Vec2 slide = slide_at(system, pair, middle);
  return std::abs(cross(opening_axes(system, pair)(known.opening), slide)) / norm(known.opening);
}

double consistent_slip(const BlockSystem &system, const CandidatePair &pair, const JointLaw &law,
                       const RegionMemory &known, const RegionForce &force, double guess) {
  const double extent = force.extent_end - force.extent_begin;
  const LawConstants constants = law.constants();
  const double normal_force = constants.half_stiffness * force.normal_force;
  const double tan_friction = law.is_barton_bandis && extent > 0.0
                                  ? law.tan_friction_at(normal_force / extent)
                                  : constants.tan_friction;
  const double stiffness = constants.tangential_stiffness * std::max(known.longest, extent);
  const Vec2 slide = slide_at(system, pair, force.point);
  const double trial = known.shear + stiffness * dot(slide, perp(force.normal));
  const double by_opening = 2.0 * constants.half_stiffness * extent * law.tan_dilation * tan_friction;
  const double excess = std::abs(trial) - (normal_force * tan_friction + constants.cohesion * extent);
  return std::max(0.0, (excess + by_opening * guess) / (stiffness + by_opening));
}

double dilate(const BlockSystem &system, const CandidatePair &pair, const JointLaw &law, double slip_before,
              const RegionForce &force, RegionMemory &memory) {
  const double opened = law.dilation_at(memory.slip) - law.dilation_at(slip_before);
  if (!(opened > 0.0)) {
    return 0.0;
  }
  const Rotation axes = opening_axes(system, pair);
  memory.opening += Rotation{axes.c, -axes.s}(opened * force.normal);
  return opened * force.normal_force;
}

} // namespace gcpdda
