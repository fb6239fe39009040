#include "contact/laws/initial_friction.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace gcpdda {

namespace {

/// Acceleration of the point along `tangent` under a unit force there; 0 for infinite mass.
double yield_of(const BlockSystem &system, std::size_t row, Vec2 arm, Vec2 tangent) {
  const BlockProperties &block = system.properties[row];
  if (system.is_deformable(row)) {
    const Vec2 x = system.trial_inverse[system.deformation_begin[row]](arm);
    return 1.0 / block.mass + dot(x, inverse(system.deformation_of(row).second_moment)(x));
  }
  const double moment = cross(arm, tangent);
  return 1.0 / block.mass + moment * moment / block.inertia;
}

Vec2 velocity_at(const BlockSystem &system, std::size_t row, Vec2 arm) {
  const RigidDof &v = system.velocity[row];
  if (system.is_deformable(row)) {
    return v.u + system.deformation_of(row).rate(system.trial_inverse[system.deformation_begin[row]](arm));
  }
  return v.u + v.r * perp(arm);
}

Vec2 acceleration_at(const BlockSystem &system, std::size_t row, Vec2 arm) {
  const RigidDof &v = system.velocity[row];
  const RigidDof &a = system.acceleration[row];
  if (system.is_deformable(row)) {
    const Mat2 &to_reference = system.trial_inverse[system.deformation_begin[row]];
    return a.u + system.deformation_of(row).acceleration(to_reference(arm));
  }
  return a.u + a.r * perp(arm) - (v.r * v.r) * arm;
}

} // namespace

InitialStick::InitialStick(const BlockSystem &system, const Candidates &candidates, ContactForces &forces,
                           ContactHistory &history, bool with_bonds)
    : system_(system), candidates_(candidates), forces_(forces), history_(history), with_bonds_(with_bonds),
      contact_counts_(system.num_rows(), 0.0) {
  forces_.change_shear(system_, candidates_, history_, [&](Region region) {
    if (!takes_part(region)) {
      return;
    }
    contact_counts_[region.pair.lower.value] += 1.0;
    contact_counts_[region.pair.higher.value] += 1.0;
    const double sliding = sliding_of(region);
    if (sliding != 0.0 && !region.force.bonded) { // a bond that slides starts with its spring unstretched
      region.set(std::copysign(region.force.cap, sliding));
      region.memory.state = ContactState::slip;
    }
  });
}

double InitialStick::sliding_of(const Region &region) const {
  const Vec2 lower = velocity_at(system_, region.pair.lower.value, region.arm_lower);
  const Vec2 higher = velocity_at(system_, region.pair.higher.value, region.arm_higher);
  const double sliding = dot(lower - higher, region.tangent);
  const double rounding = 16.0 * std::numeric_limits<double>::epsilon() * (norm(lower) + norm(higher));
  return std::abs(sliding) > rounding ? sliding : 0.0;
}

bool InitialStick::takes_part(const Region &region) const {
  return region.force.cap > 0.0 && region.memory.longest > 0.0 && (with_bonds_ || !region.force.bonded);
}

bool InitialStick::sticks(const Region &region) const {
  return takes_part(region) && sliding_of(region) == 0.0;
}

InitialStick::Yields InitialStick::yields_of(const Region &region) const {
  return {yield_of(system_, region.pair.lower.value, region.arm_lower, region.tangent),
          yield_of(system_, region.pair.higher.value, region.arm_higher, region.tangent)};
}

double InitialStick::tangential_acceleration(const Region &region) const {
  return dot(acceleration_at(system_, region.pair.lower.value, region.arm_lower) -
                 acceleration_at(system_, region.pair.higher.value, region.arm_higher),
             region.tangent);
}

double InitialStick::corrected(const Region &region, double change) {
  return std::clamp(region.memory.shear + change, -region.force.cap, region.force.cap);
}

template <class Change> void InitialStick::change_sticking(Change &&change) {
  forces_.change_shear(system_, candidates_, history_, [&](Region region) {
    if (sticks(region)) {
      region.set(change(region));
    }
  });
}

double InitialStick::sweep() {
  double largest = 0.0;
  change_sticking([&](const Region &region) {
    const double acceleration = tangential_acceleration(region);
    const auto [lower, higher] = yields_of(region);
    const double yield = lower + higher;
    const double wanted = corrected(region, acceleration / yield);
    largest = std::max(largest, std::abs(wanted - region.memory.shear) * yield);
    const double damped_yield =
        contact_counts_[region.pair.lower.value] * lower + contact_counts_[region.pair.higher.value] * higher;
    return corrected(region, acceleration / damped_yield);
  });
  return largest;
}

void InitialStick::reset() {
  change_sticking([](const Region &) { return 0.0; });
}

} // namespace gcpdda
