#include "gcpdda/contact/initial_friction.hpp"

#include "pair_motion.hpp"

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

void ContactForces::set_shear(std::size_t region, double shear, Vec2 lower_arm, Vec2 higher_arm) {
  RegionForce &force = forces_[region];
  const Vec2 tangent = perp(force.normal);
  const auto add_torques = [&](PairTorques &torque, Vec2 f) {
    torque[0] += cross(lower_arm, f);
    torque[1] -= cross(higher_arm, f);
  };
  const Vec2 change = (force.shear - shear) * tangent;
  add_force(force, force.point, change);
  add_torques(force.torque, change);
  const Vec2 drag = (force.shear + dot(force.shear_force, tangent)) * tangent;
  force.damping_force += drag;
  add_torques(force.damping_torque, drag);
  const Vec2 elastic = -shear * tangent;
  const std::size_t number = region - ranges_[force.pair].begin;
  if (RegionDyads *dyads = sums_.kept_dyads(force.pair, number)) {
    for (const std::size_t k : {0U, 1U}) {
      const Vec2 arm = k == 0 ? lower_arm : -higher_arm;
      BlockGradientSum &sum = (*dyads)[k];
      sum.force += outer(arm, change);
      sum.damping += outer(arm, drag);
      sum.shear = force.bonded ? sum.shear + outer(arm, elastic - force.shear_force) : outer(arm, elastic);
    }
  }
  force.shear = shear;
  force.shear_force = elastic;
  force.shear_torque = {};
  add_torques(force.shear_torque, force.shear_force);
}

InitialStick::Yields InitialStick::yields_of(const BlockSystem &system, const Region &region) {
  return {yield_of(system, region.lower, region.arm_lower, region.tangent),
          yield_of(system, region.higher, region.arm_higher, region.tangent)};
}

double InitialStick::tangential_acceleration(const BlockSystem &system, const Region &region) {
  return dot(acceleration_at(system, region.lower, region.arm_lower) -
                 acceleration_at(system, region.higher, region.arm_higher),
             region.tangent);
}

double InitialStick::corrected(const Region &region, double change) {
  return std::clamp(region.memory->shear + change, -region.cap, region.cap);
}

InitialStick::InitialStick(const BlockSystem &system, const Candidates &candidates, ContactForces &forces,
                           ContactHistory &history)
    : forces_(forces), candidates_(candidates), history_(history), contact_counts_(system.num_rows(), 0.0) {
  for (std::size_t k = 0; k < forces.regions().size(); ++k) {
    const Region region = region_of(system, k);
    // A region without extent along its tangent (faces that coincide up to rounding) has no spring yet.
    if (!(region.cap > 0.0) || !(region.memory->longest > 0.0)) {
      continue;
    }
    contact_counts_[region.lower] += 1.0;
    contact_counts_[region.higher] += 1.0;
    const Vec2 lower_velocity = velocity_at(system, region.lower, region.arm_lower);
    const Vec2 higher_velocity = velocity_at(system, region.higher, region.arm_higher);
    const double sliding = dot(lower_velocity - higher_velocity, region.tangent);
    const double rounding =
        16.0 * std::numeric_limits<double>::epsilon() * (norm(lower_velocity) + norm(higher_velocity));
    if (std::abs(sliding) > rounding && forces.regions()[k].bonded) {
      continue; // its spring starts unstretched
    }
    if (std::abs(sliding) > rounding) {
      set_shear(region, std::copysign(region.cap, sliding));
      region.memory->state = ContactState::slip;
    } else {
      sticking_.push_back(static_cast<std::uint32_t>(k));
    }
  }
}

InitialStick::Region InitialStick::region_of(const BlockSystem &system, std::size_t number) const {
  const RegionForce &force = forces_.regions()[number];
  const CandidatePair &pair = candidates_.pairs[force.pair];
  return {number,
          &history_.state(force.pair, forces_.number_in_pair(number)),
          perp(force.normal),
          force.point - system.trial_centroid[pair.lower.value],
          force.point - system.trial_centroid[pair.higher.value],
          force.cap,
          pair.lower.value,
          pair.higher.value};
}

void InitialStick::set_shear(const Region &region, double shear) {
  region.memory->shear = shear;
  forces_.set_shear(region.number, shear, region.arm_lower, region.arm_higher);
}

double InitialStick::residual(const BlockSystem &system) const {
  double largest = 0.0;
  for (const std::uint32_t number : sticking_) {
    const Region region = region_of(system, number);
    const auto [lower, higher] = yields_of(system, region);
    const double yield = lower + higher;
    const double wanted = corrected(region, tangential_acceleration(system, region) / yield);
    largest = std::max(largest, std::abs(wanted - region.memory->shear) * yield);
  }
  return largest;
}

void InitialStick::sweep(const BlockSystem &system) {
  for (const std::uint32_t number : sticking_) {
    const Region region = region_of(system, number);
    const auto [lower, higher] = yields_of(system, region);
    const double damped_yield =
        contact_counts_[region.lower] * lower + contact_counts_[region.higher] * higher;
    set_shear(region, corrected(region, tangential_acceleration(system, region) / damped_yield));
  }
}

void InitialStick::reset(const BlockSystem &system) {
  for (const std::uint32_t number : sticking_) {
    set_shear(region_of(system, number), 0.0);
  }
}

} // namespace gcpdda
