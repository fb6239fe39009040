#pragma once

// The step of rigid blocks that nothing but contacts and gravity acts on, one in each lane, with the works of
// the ledger.

#include "dynamics/lanes/lane_ledger.hpp"
#include "dynamics/lanes/lane_newmark.hpp"

namespace gcpdda::GCPDDA_INSTRUCTIONS {

/// The same as of one row (integrate.hpp).
[[gnu::always_inline]] inline Lanes most_motion(const LaneRigid &moved, const LaneRigid &velocity,
                                                const LaneRigid &acceleration, const Lanes &radius,
                                                double dt) {
  const auto most = [&](const LaneRigid &q) __attribute__((always_inline)) {
    return abs(q.u.x) + abs(q.u.y) + radius * abs(q.r);
  };
  return Lanes(rounding_of_most_motion) *
         (most(moved) + Lanes(dt) * (most(velocity) + Lanes(dt) * most(acceleration)));
}

inline FreeStep step_free_rows(BlockSystem &system, std::size_t first, const FreeRows &rows,
                               const Scheme &scheme, double dt) {
  const LaneMasses of = LaneMasses::of_rows(&system.properties[first]);
  const LaneApplied applied(rows.body, of);
  LaneContacts sum = LaneContacts::load(&system.contact[first]);
  LaneRigid &force = sum.force;
  force.u = force.u + applied.load + applied.gravity;

  const LaneRigid v = LaneRigid::load(system.velocity[first]);
  if (rows.local_damping != 0.0) {
    const LaneRigid taken = Lanes(rows.local_damping) *
                            LaneRigid{{lane_against(force.u.x, v.u.x), lane_against(force.u.y, v.u.y)},
                                      lane_against(force.r, v.r)};
    force = force + taken;
    sum.damping = sum.damping + taken;
  }
  sum.store(&system.contact[first]);
  add_to_ledger(lane_half_works(sum, applied, half_increments(system, first)), &system.ledger[first]);

  const LaneRigid a = LaneRigid::load(system.acceleration[first]);
  const LaneRigid d = LaneRigid::load(system.displacement[first]);
  const LaneRigid free{(Lanes(1.0) / of.mass) * force.u, force.r / of.inertia};
  const LaneRigid a_new = Lanes(1.0 / (1.0 - scheme.alpha_m)) * (free - Lanes(scheme.alpha_m) * a);
  const LaneRigid d_new = position_of(scheme, dt, d, v, a, a_new);
  const LaneRigid v_new = velocity_of(scheme, dt, v, a, a_new);
  const LaneRigid trace = Lanes(0.0) * d_new + Lanes(0.0) * v_new; // where a_new leaves its own
  const Mask sound = (trace.u.x + trace.u.y + trace.r) == 0.0;
  const LaneRigid acceleration = select(sound, a_new, a);
  const LaneRigid displacement = select(sound, d_new, d);
  const LaneRigid velocity = select(sound, v_new, v);
  acceleration.store(system.acceleration[first]);
  displacement.store(system.displacement[first]);
  velocity.store(system.velocity[first]);
  const LaneRigid moved = displacement - LaneRigid::load(system.refreshed[first]);
  return {(!sound).by_lane(),
          (!(most_motion(moved, velocity, acceleration, of.radius, dt) <= rows.safe_motion)).by_lane()};
}

} // namespace gcpdda::GCPDDA_INSTRUCTIONS
