#pragma once

// Deformable blocks that nothing but contacts, weight and local damping acts on, one in each lane: the forces
// on them, the works of the ledger and the step, as the scalar way of simulation/step_rows.cpp with
// step_deformables(), to the same bits.

#include "dynamics/lanes/lane_deformable.hpp"
#include "dynamics/lanes/lane_ledger.hpp"

#include <array>
#include <cstddef>

namespace gcpdda::GCPDDA_INSTRUCTIONS {

/// What contacts do to the gradients of rows that follow each other, in the axes of their forces.
struct LaneGradients {
  LaneMat force;
  LaneMat shear;
  LaneMat damping;

  [[gnu::always_inline]] LaneGradients(const BlockSystem &system, std::size_t entry) {
    const Deformation *deformation = &system.deformation[entry];
    const LaneMat to_reference = LaneMat::of([&](std::size_t i) { return &system.trial_inverse[entry + i]; });
    const auto load = [&](Mat2 BlockGradientSum::*field) __attribute__((always_inline)) {
      return transposed(to_reference *
                        LaneMat::of([&](std::size_t i) { return &(deformation[i].contact.*field); }));
    };
    force = load(&BlockGradientSum::force);
    shear = load(&BlockGradientSum::shear);
    damping = load(&BlockGradientSum::damping);
  }
  [[gnu::always_inline]] void store(const std::array<std::byte *, num_lanes> &to) const {
    const auto put = [&](std::size_t offset, const LaneMat &m) __attribute__((always_inline)) {
      store_by_lane(to, offsetof(Deformation, contact) + offset, m.xx(), m.xy(), m.yx(), m.yy());
    };
    put(offsetof(BlockGradientSum, force), force);
    put(offsetof(BlockGradientSum, shear), shear);
    put(offsetof(BlockGradientSum, damping), damping);
  }
};

inline FreeStep free_step_of(const Mask &sound, const Mask &is_safe, const Lanes &turned) {
  FreeStep done{(!sound).by_lane(), (!is_safe).by_lane()};
  for (std::size_t i = 0; i < num_lanes; ++i) {
    done.largest_turn = turned[i] > done.largest_turn ? turned[i] : done.largest_turn;
  }
  return done;
}

inline FreeStep step_free_deformables(BlockSystem &system, std::size_t first, const FreeRows &rows,
                                      const BlockSolve &step) {
  const std::size_t entry = system.deformation_begin[first];
  Deformation *deformation = &system.deformation[entry];
  const auto load = [&](Mat2 Deformation::*field) __attribute__((always_inline)) {
    return LaneMat::of([&](std::size_t i) { return &(deformation[i].*field); });
  };
  const LaneMasses masses = LaneMasses::of_rows(&system.properties[first]);
  const LaneApplied applied(rows.body, masses);
  const LaneRigid displacement = LaneRigid::load(system.displacement[first]);
  const LaneRigid velocity = LaneRigid::load(system.velocity[first]);
  const LaneRigid acceleration = LaneRigid::load(system.acceleration[first]);
  LaneDeformable block;
  block.u = displacement.u;
  block.v = velocity.u;
  block.a = acceleration.u;
  block.load([&](std::size_t i) { return deformation + i; });

  LaneContacts sum = LaneContacts::load(&system.contact[first]);
  sum.force.u = sum.force.u + applied.load + applied.gravity;
  sum.shear.r = 0.0; // stands in the deformation
  sum.damping.r = 0.0;
  LaneGradients gradients(system, entry);
  const LaneRigid half_increment = half_increments(system, first);
  const LaneWay way{Lanes(2.0) * half_increment.u, gradient_increment(system, first, block.trial)};
  FourLanes works = lane_half_works(sum, applied, half_increment);
  add_on_gradient(gradients.shear, gradients.damping, way.gradient, works);

  LaneStepped now =
      step_of(block, FreeMatrix(block, masses, step), masses.mass, sum.force.u, gradients.force, way, step);
  const Mask sound = now.are_sound();
  if ((!sound).any()) {
    now.keep_where(sound, block, load(&Deformation::internal));
  }
  if (step.local_damping > 0.0) {
    sum.force.u += now.damped.u;
    sum.damping.u += now.damped.u;
    gradients.force = gradients.force + now.damped.gradient;
    gradients.damping = gradients.damping + now.damped.gradient;
  }
  sum.store(&system.contact[first]);
  add_to_ledger(works, &system.ledger[first], half_work(now.damped, way));
  const auto to = places_of(deformation);
  gradients.store(to);
  now.store(to);
  LaneRigid{now.u, displacement.r + now.turned}.store(system.displacement[first]);
  LaneRigid{now.v, velocity.r}.store(system.velocity[first]);
  LaneRigid{now.a, acceleration.r}.store(system.acceleration[first]);

  const Lanes most_motion = now.most_motion(LaneRigid::load(system.refreshed[first]).u,
                                            load(&Deformation::refreshed), masses.radius, step.time_step);
  return free_step_of(sound, most_motion <= rows.safe_motion, abs(now.turned));
}

} // namespace gcpdda::GCPDDA_INSTRUCTIONS
