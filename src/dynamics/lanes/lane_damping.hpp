#pragma once

// Local damping of deformable blocks within their step, one in each lane; the derivation is in
// local_damping.hpp.

#include "dynamics/lanes/lane_deformable_block.hpp"

namespace gcpdda::GCPDDA_INSTRUCTIONS {

/// The way of x_c and F from the trial configuration before to this one, or a force on them.
struct LaneWay {
  LaneVec u;
  LaneMat gradient;
};
[[gnu::always_inline]] inline Lanes half_work(const LaneWay &force, const LaneWay &way) {
  return Lanes(0.5) * (dot(force.u, way.u) + contract(force.gradient, way.gradient));
}

/// Changes the coming accelerations x of the undamped step in the axes of `back` to those under friction.
///
/// @param way  from the trial configuration before to this one
/// @return the friction, on (u, v) and (r, ex, ey, gxy)
template <class Matrix>
[[gnu::always_inline]] inline LaneDofs damp_locally(const LaneDeformable &block, const Matrix &matrix,
                                                    const Lanes &mass, const LaneMat &back,
                                                    const LaneWay &way, const BlockSolve &step, LaneDofs &x) {
  const auto dofs_of = [&](const LaneVec &u, const LaneMat &f) __attribute__((always_inline))->LaneDofs {
    const LaneMat g = back * f;
    return {back(u), {lane_spin(g), g.xx(), g.yy(), g.xy() + g.yx()}};
  };
  const double dt = step.time_step;
  const TrialWay ahead = trial_way(step.scheme);
  const Lanes known = dt * ahead.old;
  const Lanes coming = dt * ahead.coming;
  const LaneDofs half_before = Lanes(0.5 / dt) * dofs_of(way.u, way.gradient);
  const LaneDofs half_after =
      Lanes(0.5) * (dofs_of(block.v + known * block.a, block.rate + known * block.acceleration) + coming * x);
  LaneDofs mean = half_after + half_before;
  // The net force of the step would change it by that, if nothing but this matrix resisted.
  LaneDofs change = half_after + Lanes(-1.0) * half_before;
  const Lanes share = 1.0 - step.scheme.alpha_m;
  change = {share * mass * change.u,
            lane_force_dofs(share * (lane_gradient_of(change.gradient) * block.second_moment))};
  matrix.solve(change);
  matrix.to_squares(mean);
  matrix.to_squares(change);
  const auto friction = [&](const Lanes &motion, const Lanes &most) __attribute__((always_inline)) {
    const Lanes size = min(abs(motion), Lanes(step.local_damping) * abs(most));
    return select(motion < 0.0, size, -size);
  };
  LaneDofs taken = Lanes(2.0) / coming * LaneDofs::of(mean, change, friction);
  LaneDofs force = taken;
  matrix.to_force(force);
  matrix.from_squares(taken);
  x = x + taken;
  return force;
}

} // namespace gcpdda::GCPDDA_INSTRUCTIONS
