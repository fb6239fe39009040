#pragma once

// What contacts, weight and local damping do to deformable blocks, one in each lane, with the works of the
// ledger: as the scalar way of simulation/simulation.cpp and local_damping.cpp, to the same bits.

#include "lane_deformable.hpp"
#include "lane_ledger.hpp"

#include <array>
#include <cstddef>

namespace gcpdda::GCPDDA_INSTRUCTIONS {

/// As damp_gradient().
[[gnu::always_inline]] inline LaneMat lane_damping(const LaneMat &trial, const LaneMat &force,
                                                   const LaneMat &rate, const Lanes &share) {
  const LaneMat turn = lane_rotation_of(trial);
  const LaneMat back = transposed(turn);
  const LaneMat h = back * force;
  const LaneMat g = back * rate;
  const Lanes r = lane_against(h.yx() - h.xy(), lane_spin(g));
  const Lanes gxy = lane_against(Lanes(0.5) * (h.xy() + h.yx()), g.xy() + g.yx());
  return share * (turn * LaneMat{{lane_against(h.xx(), g.xx()), gxy - Lanes(0.5) * r, gxy + Lanes(0.5) * r,
                                  lane_against(h.yy(), g.yy())}});
}

inline void gather_deformables(BlockSystem &system, std::size_t first, const FreeRows &rows) {
  const std::size_t entry = system.deformation_begin[first];
  Deformation *deformation = &system.deformation[entry];
  const auto load = [&](Mat2 Deformation::*field) __attribute__((always_inline)) {
    return LaneMat::of([&](std::size_t i) { return &(deformation[i].*field); });
  };
  const LaneApplied applied(rows.body, LaneMasses(&system.properties[first]));
  LaneContacts sum = LaneContacts::load(&system.contact[first]);
  sum.force.u = sum.force.u + applied.load + applied.gravity;

  const LaneMat to_reference = LaneMat::of([&](std::size_t i) { return &system.trial_inverse[entry + i]; });
  const auto on_gradient = [&](Mat2 BlockGradientSum::*field) __attribute__((always_inline)) {
    return transposed(to_reference *
                      LaneMat::of([&](std::size_t i) { return &(rows.gradients[entry + i].*field); }));
  };
  const LaneMat none{{0.0, 0.0, 0.0, 0.0}};
  const LaneMat shear = on_gradient(&BlockGradientSum::shear);
  LaneMat damping = on_gradient(&BlockGradientSum::damping);
  LaneMat gradient = on_gradient(&BlockGradientSum::force) + none;
  sum.shear.r = 0.0; // stands in the deformation
  sum.damping.r = 0.0;
  const LaneMat trial = load(&Deformation::trial);
  if (rows.local_damping != 0.0) {
    const Lanes share = rows.local_damping;
    const LaneVec v = LaneVec::of([&](std::size_t i) { return &system.velocity[first + i].u; });
    const LaneVec taken = share * LaneVec{lane_against(sum.force.u.x, v.x), lane_against(sum.force.u.y, v.y)};
    const LaneMat taken_gradient =
        lane_damping(trial, gradient - load(&Deformation::internal) + load(&Deformation::anchor_force),
                     load(&Deformation::rate), share);
    gradient = gradient + taken_gradient;
    damping = damping + taken_gradient;
    sum.force.u += taken;
    sum.damping.u += taken;
  }
  sum.store(&system.contact[first]);

  FourLanes works = lane_half_works(sum, applied, half_increments(system, first));
  add_on_gradient(shear, damping, none, trial - load(&Deformation::trial_previous), works);
  add_to_ledger(works, &system.ledger[first]);

  std::array<std::byte *, num_lanes> to;
  std::array<std::byte *, num_lanes> to_forces;
  for (std::size_t i = 0; i < num_lanes; ++i) {
    to[i] = reinterpret_cast<std::byte *>(deformation + i);
    to_forces[i] = reinterpret_cast<std::byte *>(&rows.gradient_forces[entry + i]);
  }
  const auto store = [&](const std::array<std::byte *, num_lanes> &places, std::size_t offset,
                         const LaneMat &m) __attribute__((always_inline)) {
    store_by_lane(places, offset, m.xx(), m.xy(), m.yx(), m.yy());
  };
  store(to, offsetof(Deformation, shear_force), shear);
  store(to, offsetof(Deformation, damping_force), damping);
  store(to, offsetof(Deformation, load_force), none);
  store(to_forces, 0, gradient);
}

} // namespace gcpdda::GCPDDA_INSTRUCTIONS
