#include "gcpdda/contact/initial_friction.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace gcpdda {

namespace {

double yield_of(const BlockProperties &block, Vec2 arm, Vec2 tangent) {
  const double moment = cross(arm, tangent);
  return 1.0 / block.mass + moment * moment / block.inertia; // 0 for infinite mass
}

Vec2 velocity_at(const RigidDof &v, Vec2 arm) {
  return v.u + v.r * perp(arm);
}

Vec2 acceleration_at(const RigidDof &v, const RigidDof &a, Vec2 arm) {
  return a.u + a.r * perp(arm) - (v.r * v.r) * arm;
}

} // namespace

InitialStick::InitialStick(const BlockSystem &system, const Candidates &candidates, ContactForces &forces,
                           ContactHistory &history)
    : forces_(forces), history_(history), contact_counts_(system.num_rows(), 0.0) {
  for (std::size_t k = 0; k < candidates.pairs.size(); ++k) {
    const PairForce &force = forces.pairs()[k];
    // A region without extent along its tangent (faces that coincide up to rounding) has no spring yet.
    if (!force.touching || !(force.cap > 0.0) || !(history.regions[k].longest > 0.0)) {
      continue;
    }
    Region region;
    region.pair = k;
    region.tangent = perp(force.normal);
    region.lower = candidates.pairs[k].lower.value;
    region.higher = candidates.pairs[k].higher.value;
    region.arm_lower = force.point - system.trial_centroid[region.lower];
    region.arm_higher = force.point - system.trial_centroid[region.higher];
    region.cap = force.cap;
    region.yield_lower = yield_of(system.properties[region.lower], region.arm_lower, region.tangent);
    region.yield_higher = yield_of(system.properties[region.higher], region.arm_higher, region.tangent);
    contact_counts_[region.lower] += 1.0;
    contact_counts_[region.higher] += 1.0;
    const Vec2 lower_velocity = velocity_at(system.velocity[region.lower], region.arm_lower);
    const Vec2 higher_velocity = velocity_at(system.velocity[region.higher], region.arm_higher);
    const double sliding = dot(lower_velocity - higher_velocity, region.tangent);
    const double rounding =
        16.0 * std::numeric_limits<double>::epsilon() * (norm(lower_velocity) + norm(higher_velocity));
    if (std::abs(sliding) > rounding) {
      set_shear(region, std::copysign(region.cap, sliding));
      history_.regions[k].state = ContactState::slip;
    } else {
      regions_.push_back(region);
    }
  }
}

double InitialStick::tangential_acceleration(const BlockSystem &system, const Region &region) const {
  const auto at = [&](std::size_t row, Vec2 arm) {
    return acceleration_at(system.velocity[row], system.acceleration[row], arm);
  };
  return dot(at(region.lower, region.arm_lower) - at(region.higher, region.arm_higher), region.tangent);
}

double InitialStick::corrected(const Region &region, double change) const {
  return std::clamp(history_.regions[region.pair].shear + change, -region.cap, region.cap);
}

void InitialStick::set_shear(const Region &region, double shear) {
  history_.regions[region.pair].shear = shear;
  forces_.set_shear(region.pair, shear);
}

double InitialStick::residual(const BlockSystem &system) const {
  double largest = 0.0;
  for (const Region &region : regions_) {
    const double yield = region.yield_lower + region.yield_higher;
    const double wanted = corrected(region, tangential_acceleration(system, region) / yield);
    largest = std::max(largest, std::abs(wanted - history_.regions[region.pair].shear) * yield);
  }
  return largest;
}

void InitialStick::sweep(const BlockSystem &system) {
  for (const Region &region : regions_) {
    const double damped_yield = contact_counts_[region.lower] * region.yield_lower +
                                contact_counts_[region.higher] * region.yield_higher;
    set_shear(region, corrected(region, tangential_acceleration(system, region) / damped_yield));
  }
}

void InitialStick::reset() {
  for (const Region &region : regions_) {
    set_shear(region, 0.0);
  }
}

} // namespace gcpdda
