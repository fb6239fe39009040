#pragma once

// The step of deformable blocks, one in each lane; the derivation is in deformable.hpp.

#include "base/lanes.hpp"
#include "dynamics/deformable.hpp"
#include "dynamics/lanes/block_lanes.hpp"
#include "dynamics/lanes/lane_damping.hpp"
#include "dynamics/lanes/lane_deformable_block.hpp"
#include "dynamics/lanes/lane_ledger.hpp"
#include "dynamics/lanes/lane_newmark.hpp"
#include "geometry/lane_mat.hpp"

#include <array>
#include <cstddef>
#include <vector>

namespace gcpdda::GCPDDA_INSTRUCTIONS {

/// Deformable blocks after their step.
struct LaneStepped {
  LaneVec u;
  LaneVec v;
  LaneVec a;
  Lanes turned; ///< rad
  LaneMat gradient;
  LaneMat rate;
  LaneMat acceleration;
  LaneMat internal;
  LaneMat viscous; ///< what beta K adds to the elastic force, N
  LaneWay damped;  ///< force of local damping, N

  /// Finite, and not inside out.
  [[nodiscard, gnu::always_inline]] Mask are_sound() const {
    // Accelerations that are not finite leave their trace in velocities.
    Lanes nothing = Lanes(0.0) * u.x + Lanes(0.0) * u.y + Lanes(0.0) * v.x + Lanes(0.0) * v.y;
    for (std::size_t k = 0; k < 4; ++k) {
      nothing += Lanes(0.0) * gradient.entry[k] + Lanes(0.0) * rate.entry[k];
    }
    return (nothing == 0.0) & (determinant(gradient) > 0.0);
  }
  /// Others stay what they were.
  void keep_where(const Mask &sound, const LaneDeformable &before, const LaneMat &internal_before) {
    u = select(sound, u, before.u);
    v = select(sound, v, before.v);
    a = select(sound, a, before.a);
    turned = select(sound, turned, 0.0);
    const auto keep = [&](LaneMat &now, const LaneMat &old) {
      for (std::size_t k = 0; k < 4; ++k) {
        now.entry[k] = select(sound, now.entry[k], old.entry[k]);
      }
    };
    keep(gradient, before.gradient);
    keep(rate, before.rate);
    keep(acceleration, before.acceleration);
    keep(internal, internal_before);
    keep(viscous, {{0.0, 0.0, 0.0, 0.0}});
    damped.u = select(sound, damped.u, {0.0, 0.0});
    keep(damped.gradient, {{0.0, 0.0, 0.0, 0.0}});
  }
  [[gnu::always_inline]] void store(const std::array<std::byte *, num_lanes> &deformation) const {
    const auto put = [&](std::size_t offset, const LaneMat &m) __attribute__((always_inline)) {
      store_by_lane(deformation, offset, m.xx(), m.xy(), m.yx(), m.yy());
    };
    put(offsetof(Deformation, gradient), gradient);
    put(offsetof(Deformation, rate), rate);
    put(offsetof(Deformation, acceleration), acceleration);
    put(offsetof(Deformation, internal), internal);
  }
  /// As most_motion().
  [[nodiscard, gnu::always_inline]] Lanes most_motion(const LaneVec &u_refreshed,
                                                      const LaneMat &gradient_refreshed, const Lanes &radius,
                                                      double dt) const {
    const auto most = [&](const LaneVec &p, const LaneMat &f) __attribute__((always_inline)) {
      return abs(p.x) + abs(p.y) + radius * (abs(f.xx()) + abs(f.xy()) + abs(f.yx()) + abs(f.yy()));
    };
    return Lanes(rounding_of_most_motion) * (most(u - u_refreshed, gradient - gradient_refreshed) +
                                             Lanes(dt) * (most(v, rate) + Lanes(dt) * most(a, acceleration)));
  }
};

/// The elasticity at the trial configuration, in turning axes, at the spring's time so far known.
struct LaneResistance {
  LaneMat back; ///< to turning axes
  LaneMat stretch;
  LaneMat stress;
  LaneMat viscous; ///< of stiffness damping
  LaneMat all;     ///< both

  [[gnu::always_inline]] LaneResistance(const LaneDeformable &block, const LaneMat &turn,
                                        const BlockSolve &step)
      : back(transposed(turn)), stretch(back * block.trial),
        stress(block.elasticity.force(stretch, block.initial_strain)), viscous{{0.0, 0.0, 0.0, 0.0}} {
    if (step.is_implicit) {
      const LaneMat f_base = base_of(step, block.gradient, block.rate, block.acceleration);
      stress = stress + block.elasticity.stress(back * (f_base - block.trial));
    }
    all = stress;
    if (step.stiffness_damping > 0.0) {
      viscous = Lanes(step.stiffness_damping) *
                block.elasticity.stress(back * base_rate_of(step, block.rate, block.acceleration));
      all = all + viscous;
    }
  }
};

/// a J added to the elastic force so that all of it, K e included, has no torque. One linear equation: it
/// works on r alone, as the force -2 a against it.
/// @param x  the solution without it; takes it in
/// @return a J
template <class Matrix>
[[gnu::always_inline]] inline LaneMat free_of_torque(const LaneElasticity &elasticity, const Matrix &matrix,
                                                     const LaneResistance &resistance, const BlockSolve &step,
                                                     LaneDofs &x) {
  const LaneMat &stretch = resistance.stretch;
  const Lanes coming = step.spring.coming + step.stiffness_damping * step.spring.rate_coming;
  const LaneDofs by_torque = matrix.by_torque();
  const LaneMat whole = resistance.all + coming * elasticity.stress(lane_gradient_of(x.gradient));
  const Lanes no_torque =
      lane_moment(whole, stretch) /
      (stretch.xx() + stretch.yy() +
       Lanes(2.0) * coming * lane_moment(elasticity.stress(lane_gradient_of(by_torque.gradient)), stretch));
  x.u = x.u - Lanes(2.0) * no_torque * by_torque.u;
  for (std::size_t k = 0; k < 4; ++k) {
    x.gradient[k] = x.gradient[k] - Lanes(2.0) * no_torque * by_torque.gradient[k];
  }
  return LaneMat{{0.0, -no_torque, no_torque, 0.0}};
}

/// @param force, gradient_force  all that acts at the trial configuration, without the elasticity
/// @param way  from the trial configuration before to this one; read where local damping acts
template <class Matrix>
[[gnu::always_inline]] inline LaneStepped
step_of(const LaneDeformable &block, const Matrix &matrix, const Lanes &mass, const LaneVec &force,
        const LaneMat &gradient_force, const LaneWay &way, const BlockSolve &step) {
  const LaneMat turn = lane_rotation_of(block.trial);
  const LaneResistance resistance(block, turn, step);
  const LaneElasticity &elasticity = block.elasticity;
  const LaneMat &back = resistance.back;
  const double am = step.scheme.alpha_m;
  const LaneMat h =
      back * (gradient_force - Lanes(am) * (block.acceleration * block.second_moment)) - resistance.all;
  LaneDofs x{back(force - am * mass * block.a), lane_force_dofs(h)};
  matrix.solve(x);
  LaneMat torque_free{{0.0, 0.0, 0.0, 0.0}};
  if (step.is_implicit) {
    torque_free = free_of_torque(elasticity, matrix, resistance, step, x);
  }
  LaneStepped now;
  now.damped = {{0.0, 0.0}, {{0.0, 0.0, 0.0, 0.0}}};
  if (step.local_damping > 0.0) {
    const LaneDofs d = damp_locally(block, matrix, mass, back, way, step, x);
    now.damped = {turn(d.u), turn * lane_force_of(d.gradient)};
  }
  LaneMat stress = resistance.stress;
  if (step.is_implicit) {
    stress =
        stress + (Lanes(step.spring.coming) * elasticity.stress(lane_gradient_of(x.gradient)) + torque_free);
  }

  now.a = turn(x.u);
  now.acceleration = turn * lane_gradient_of(x.gradient);
  now.internal = turn * stress;
  now.viscous = resistance.viscous;
  if (step.stiffness_damping > 0.0) {
    now.viscous = turn * (resistance.viscous + Lanes(step.stiffness_damping * step.spring.rate_coming) *
                                                   elasticity.stress(lane_gradient_of(x.gradient)));
  }
  const double dt = step.time_step;
  now.u = position_of(step.scheme, dt, block.u, block.v, block.a, now.a);
  now.v = velocity_of(step.scheme, dt, block.v, block.a, now.a);
  now.gradient =
      position_of(step.scheme, dt, block.gradient, block.rate, block.acceleration, now.acceleration);
  now.rate = velocity_of(step.scheme, dt, block.rate, block.acceleration, now.acceleration);
  now.turned = lane_angle_between(block.gradient, now.gradient);
  return now;
}

/// Blocks of any rows, one in each lane; lanes beyond repeat the last one.
struct ScatteredRows {
  std::array<std::size_t, num_lanes> row;
  std::array<std::size_t, num_lanes> given; ///< place in DeformableLanes
  std::array<Deformation *, num_lanes> of;

  ScatteredRows(BlockSystem &system, const DeformableLanes &lanes) {
    for (std::size_t i = 0; i < num_lanes; ++i) {
      given[i] = i < lanes.count ? i : lanes.count - 1;
      row[i] = lanes.row[given[i]];
      of[i] = &system.deformation_of(row[i]);
    }
  }
  [[nodiscard, gnu::always_inline]] LaneMat load(Mat2 Deformation::*field) const {
    return LaneMat::of([&](std::size_t i) { return &(of[i]->*field); });
  }
  [[nodiscard, gnu::always_inline]] LaneVec load_u(const std::vector<RigidDof> &field) const {
    return LaneVec::of([&](std::size_t i) { return &field[row[i]].u; });
  }
};

inline void store_scattered(const LaneStepped &now, const LaneWay &way, const Lanes &most_motion,
                            const ScatteredRows &rows, BlockSystem &system, DeformableLanes &lanes) {
  std::array<std::byte *, num_lanes> state;
  std::array<std::byte *, num_lanes> viscous;
  for (std::size_t i = 0; i < num_lanes; ++i) {
    state[i] = reinterpret_cast<std::byte *>(rows.of[i]);
    viscous[i] = reinterpret_cast<std::byte *>(&lanes.viscous[rows.given[i]]);
  }
  now.store(state);
  store_by_lane(viscous, 0, now.viscous.xx(), now.viscous.xy(), now.viscous.yx(), now.viscous.yy());
  const Lanes damped_work = half_work(now.damped, way);
  for (std::size_t i = 0; i < lanes.count; ++i) {
    const std::size_t row = rows.row[i];
    const LaneMat &damped = now.damped.gradient;
    lanes.damped[i] = {{now.damped.u.x[i], now.damped.u.y[i]},
                       {damped.xx()[i], damped.xy()[i], damped.yx()[i], damped.yy()[i]}};
    lanes.damped_work[i] = damped_work[i];
    system.displacement[row].u = {now.u.x[i], now.u.y[i]};
    system.displacement[row].r += now.turned[i];
    system.velocity[row].u = {now.v.x[i], now.v.y[i]};
    system.acceleration[row].u = {now.a.x[i], now.a.y[i]};
    lanes.turned[i] = now.turned[i];
    lanes.most_motion[i] = most_motion[i];
  }
}

template <class MatrixOf>
inline unsigned step_scattered(BlockSystem &system, DeformableLanes &lanes, const BlockSolve &step,
                               MatrixOf &&matrix_of) {
  const ScatteredRows rows(system, lanes);
  LaneDeformable block;
  block.u = rows.load_u(system.displacement);
  block.v = rows.load_u(system.velocity);
  block.a = rows.load_u(system.acceleration);
  block.load([&](std::size_t i) { return rows.of[i]; });
  const LaneMasses masses = LaneMasses::of([&](std::size_t i) { return &system.properties[rows.row[i]]; });
  LaneVec force = LaneVec::of([&](std::size_t i) { return &system.contact[rows.row[i]].force.u; });
  LaneMat gradient_force = LaneMat::of([&](std::size_t i) { return &rows.of[i]->contact.force; });
  if (lanes.are_held) {
    force = force + LaneVec::of([&](std::size_t i) { return &lanes.held[rows.given[i]].u; });
    gradient_force =
        gradient_force + LaneMat::of([&](std::size_t i) { return &lanes.held[rows.given[i]].gradient; });
  }
  const LaneWay way{
      LaneVec::of([&](std::size_t i) { return &system.motion[rows.row[i]].step; }),
      LaneMat{load_by_lane([&](std::size_t i) { return &system.motion[rows.row[i]].turn[0].x; })} *
          block.trial};
  LaneStepped now =
      step_of(block, matrix_of(block, masses, rows.row), masses.mass, force, gradient_force, way, step);
  const Mask sound = now.are_sound();
  const unsigned broken = (!sound).by_lane() & ((1U << lanes.count) - 1U);
  if (broken != 0) {
    now.keep_where(sound, block, rows.load(&Deformation::internal));
  }
  const Lanes most_motion = now.most_motion(rows.load_u(system.refreshed), rows.load(&Deformation::refreshed),
                                            masses.radius, step.time_step);
  store_scattered(now, way, most_motion, rows, system, lanes);
  return broken;
}

inline unsigned step_deformables(BlockSystem &system, DeformableLanes &lanes, const BlockSolve &step) {
  using Rows = std::array<std::size_t, num_lanes>;
  if (lanes.are_held) {
    return step_scattered(
        system, lanes, step,
        [&](const LaneDeformable &, const LaneMasses &, const Rows &row) __attribute__((always_inline)) {
          return HeldMatrix([&](std::size_t i) { return &system.matrix[system.matrix_begin[row[i]]]; });
        });
  }
  return step_scattered(
      system, lanes, step,
      [&](const LaneDeformable &block, const LaneMasses &masses, const Rows &)
          __attribute__((always_inline)) { return FreeMatrix(block, masses, step); });
}

} // namespace gcpdda::GCPDDA_INSTRUCTIONS
