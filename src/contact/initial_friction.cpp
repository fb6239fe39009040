#include "gcpdda/contact/initial_friction.hpp"

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
                           ContactHistory &history)
    : forces_(forces), contact_counts_(system.num_rows(), 0.0) {
  regions_.reserve(forces.regions().size());
  for (std::size_t k = 0; k < forces.regions().size(); ++k) {
    const RegionForce &force = forces.regions()[k];
    // A region without extent along its tangent (faces that coincide up to rounding) has no spring yet.
    RegionState &memory = history.state(force.pair, forces.number_in_pair(k));
    if (!(force.cap > 0.0) || !(memory.longest > 0.0)) {
      continue;
    }
    Region region;
    region.number = k;
    region.memory = &memory;
    region.tangent = perp(force.normal);
    region.lower = candidates.pairs[force.pair].lower.value;
    region.higher = candidates.pairs[force.pair].higher.value;
    region.arm_lower = force.point - system.trial_centroid[region.lower];
    region.arm_higher = force.point - system.trial_centroid[region.higher];
    region.cap = force.cap;
    region.yield_lower = yield_of(system, region.lower, region.arm_lower, region.tangent);
    region.yield_higher = yield_of(system, region.higher, region.arm_higher, region.tangent);
    contact_counts_[region.lower] += 1.0;
    contact_counts_[region.higher] += 1.0;
    const Vec2 lower_velocity = velocity_at(system, region.lower, region.arm_lower);
    const Vec2 higher_velocity = velocity_at(system, region.higher, region.arm_higher);
    const double sliding = dot(lower_velocity - higher_velocity, region.tangent);
    const double rounding =
        16.0 * std::numeric_limits<double>::epsilon() * (norm(lower_velocity) + norm(higher_velocity));
    if (std::abs(sliding) > rounding && force.bonded) {
      continue; // its spring starts unstretched
    }
    if (std::abs(sliding) > rounding) {
      set_shear(region, std::copysign(region.cap, sliding));
      memory.state = ContactState::slip;
    } else {
      regions_.push_back(region);
    }
  }
}

double InitialStick::tangential_acceleration(const BlockSystem &system, const Region &region) const {
  return dot(acceleration_at(system, region.lower, region.arm_lower) -
                 acceleration_at(system, region.higher, region.arm_higher),
             region.tangent);
}

double InitialStick::corrected(const Region &region, double change) const {
  return std::clamp(region.memory->shear + change, -region.cap, region.cap);
}

void InitialStick::set_shear(const Region &region, double shear) {
  region.memory->shear = shear;
  forces_.set_shear(region.number, shear, region.arm_lower, region.arm_higher);
}

double InitialStick::residual(const BlockSystem &system) const {
  double largest = 0.0;
  for (const Region &region : regions_) {
    const double yield = region.yield_lower + region.yield_higher;
    const double wanted = corrected(region, tangential_acceleration(system, region) / yield);
    largest = std::max(largest, std::abs(wanted - region.memory->shear) * yield);
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
