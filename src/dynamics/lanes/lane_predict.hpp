#pragma once

// The next trial configuration of blocks, one in each lane, to the bits of predict().

#include "dynamics/lanes/lane_deformable.hpp"
#include "dynamics/lanes/lane_ledger.hpp"

#include <cstddef>

namespace gcpdda::GCPDDA_INSTRUCTIONS {

/// Onto rows [first, first + num_lanes).
[[gnu::always_inline]] inline void set_trials(const LaneRigid &trial, BlockSystem &system,
                                              std::size_t first) {
  const LaneRigid increment = trial - LaneRigid::load(system.trial[first]);
  static_assert(offsetof(BlockMotion, spin) == offsetof(BlockMotion, step) + 3 * sizeof(double));
  const Lanes spin =
      load_four(&system.motion[first], offsetof(BlockMotion, step))[3]; // of the last evaluation
  store_by_lane(places_of(&system.motion[first]), offsetof(BlockMotion, step), increment.u.x, increment.u.y,
                increment.r, spin);
  trial.store(system.trial[first]);
}

inline void predict_rigids(BlockSystem &system, std::size_t first, double by_velocity,
                           double by_acceleration) {
  set_trials(LaneRigid::load(system.displacement[first]) +
                 (Lanes(by_velocity) * LaneRigid::load(system.velocity[first]) +
                  Lanes(by_acceleration) * LaneRigid::load(system.acceleration[first])),
             system, first);
}

inline void predict_deformables(BlockSystem &system, std::size_t first, double by_velocity,
                                double by_acceleration) {
  Deformation *deformation = &system.deformation[system.deformation_begin[first]];
  const auto load = [&](Mat2 Deformation::*field) __attribute__((always_inline)) {
    return LaneMat::of([&](std::size_t i) { return &(deformation[i].*field); });
  };
  const auto to = places_of(deformation);
  const auto moved = [&](const auto &q, const auto &v, const auto &a) __attribute__((always_inline)) {
    return q + (Lanes(by_velocity) * v + Lanes(by_acceleration) * a);
  };
  const LaneMat gradient = load(&Deformation::gradient);
  const LaneMat trial = moved(gradient, load(&Deformation::rate), load(&Deformation::acceleration));
  const LaneMat turn = (trial - load(&Deformation::trial)) * inverse(trial);
  store_by_lane(to, offsetof(Deformation, trial), trial.xx(), trial.xy(), trial.yx(), trial.yy());
  store_by_lane(places_of(&system.motion[first]), offsetof(BlockMotion, turn), turn.xx(), turn.xy(),
                turn.yx(), turn.yy());
  const LaneRigid displacement = LaneRigid::load(system.displacement[first]);
  LaneRigid dofs = moved(displacement, LaneRigid::load(system.velocity[first]),
                         LaneRigid::load(system.acceleration[first]));
  dofs.r = displacement.r + lane_angle_between(gradient, trial);
  set_trials(dofs, system, first);
}

} // namespace gcpdda::GCPDDA_INSTRUCTIONS
