#pragma once

// The next trial configuration of deformable blocks, one in each lane, to the bits of predict().

#include "lane_deformable.hpp"
#include "lane_ledger.hpp"

#include <cstddef>

namespace gcpdda::GCPDDA_INSTRUCTIONS {

inline void predict_deformables(BlockSystem &system, std::size_t first, double by_velocity,
                                double by_acceleration) {
  Deformation *deformation = &system.deformation[system.deformation_begin[first]];
  const auto load = [&](Mat2 Deformation::*field) __attribute__((always_inline)) {
    return LaneMat::of([&](std::size_t i) { return &(deformation[i].*field); });
  };
  const auto to = places_of(deformation);
  const auto store = [&](std::size_t offset, const LaneMat &m) __attribute__((always_inline)) {
    store_by_lane(to, offset, m.xx(), m.xy(), m.yx(), m.yy());
  };
  const auto moved = [&](const auto &q, const auto &v, const auto &a) __attribute__((always_inline)) {
    return q + (Lanes(by_velocity) * v + Lanes(by_acceleration) * a);
  };
  LaneRigid::load(system.trial[first]).store(system.trial_previous[first]);
  store(offsetof(Deformation, trial_previous), load(&Deformation::trial));
  const LaneMat gradient = load(&Deformation::gradient);
  const LaneMat trial = moved(gradient, load(&Deformation::rate), load(&Deformation::acceleration));
  store(offsetof(Deformation, trial), trial);
  const LaneRigid displacement = LaneRigid::load(system.displacement[first]);
  LaneRigid dofs = moved(displacement, LaneRigid::load(system.velocity[first]),
                         LaneRigid::load(system.acceleration[first]));
  dofs.r = displacement.r + lane_angle_between(gradient, trial);
  dofs.store(system.trial[first]);
}

} // namespace gcpdda::GCPDDA_INSTRUCTIONS
