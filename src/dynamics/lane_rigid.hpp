#pragma once

// The step of rigid blocks that nothing but contacts and gravity acts on, one in each lane, with the works of
// the ledger.

#include "block_lanes.hpp"
#include "lane_newmark.hpp"

#include "gcpdda/base/lanes.hpp"

#include <array>
#include <cstddef>

namespace gcpdda::GCPDDA_INSTRUCTIONS {

/// RigidDof, one in each lane.
struct LaneRigid {
  LaneVec u;
  Lanes r;

  static_assert(sizeof(RigidDof) == 3 * sizeof(double));
  [[gnu::always_inline]] static LaneRigid load(const RigidDof &first) {
    const ThreeLanes three = load_triples(&first.u.x);
    return {{three[0], three[1]}, three[2]};
  }
  [[gnu::always_inline]] void store(RigidDof &first) const { store_triples(&first.u.x, {u.x, u.y, r}); }

  [[gnu::always_inline]] friend LaneRigid operator+(const LaneRigid &a, const LaneRigid &b) {
    return {a.u + b.u, a.r + b.r};
  }
  [[gnu::always_inline]] friend LaneRigid operator-(const LaneRigid &a, const LaneRigid &b) {
    return {a.u - b.u, a.r - b.r};
  }
  [[gnu::always_inline]] friend LaneRigid operator*(const Lanes &s, const LaneRigid &a) {
    return {s * a.u, s * a.r};
  }
  [[gnu::always_inline]] friend LaneRigid select(const Mask &mask, const LaneRigid &a, const LaneRigid &b) {
    return {select(mask, a.u, b.u), select(mask, a.r, b.r)};
  }
  [[gnu::always_inline]] friend Lanes work(const LaneRigid &force, const LaneRigid &motion) {
    return dot(force.u, motion.u) + force.r * motion.r;
  }
};

/// -|force| sign(velocity), as that of apply_local_damping().
[[gnu::always_inline]] inline Lanes lane_against(const Lanes &force, const Lanes &velocity) {
  const Lanes size = abs(force);
  return select(velocity == 0.0, 0.0, select(velocity < 0.0, size, -size));
}

/// Four numbers of the ledger of each lane's block.
class LaneLedgers {
public:
  [[gnu::always_inline]] explicit LaneLedgers(BlockLedger *first) {
    for (std::size_t i = 0; i < num_lanes; ++i) {
      place_[i] = reinterpret_cast<std::byte *>(first + i);
    }
  }
  [[nodiscard, gnu::always_inline]] FourLanes load(std::size_t offset) const {
    return load_by_lane([&](std::size_t i) { return reinterpret_cast<const double *>(place_[i] + offset); });
  }
  [[gnu::always_inline]] void store(std::size_t offset, const Lanes &a, const Lanes &b, const Lanes &c,
                                    const Lanes &d) const {
    store_by_lane(place_, offset, a, b, c, d);
  }

private:
  std::array<std::byte *, num_lanes> place_;
};

inline unsigned step_free_rows(BlockSystem &system, std::size_t first, const FreeRows &rows,
                               const Scheme &scheme, double dt) {
  // What is read and written four at a time.
  constexpr std::size_t shear = offsetof(BlockLedger, shear_force);
  constexpr std::size_t four = 4 * sizeof(double);
  static_assert(offsetof(BlockLedger, damping_force) == shear + 3 * sizeof(double) &&
                offsetof(BlockLedger, load_force) == shear + 6 * sizeof(double) &&
                offsetof(BlockLedger, anchor_force) == shear + 9 * sizeof(double) &&
                offsetof(BlockLedger, gravity_force) == shear + 3 * four &&
                offsetof(BlockLedger, shear_work) == shear + 14 * sizeof(double) &&
                offsetof(BlockLedger, damping_work) == shear + 15 * sizeof(double) &&
                offsetof(BlockLedger, load_work) == shear + 4 * four &&
                offsetof(BlockLedger, gravity_work) == shear + 17 * sizeof(double));
  static_assert(sizeof(BlockContactSum) == 9 * sizeof(double));
  const LaneLedgers ledger(&system.ledger[first]);
  const FourLanes known_0 = ledger.load(shear);
  const FourLanes known_1 = ledger.load(shear + four);
  const FourLanes known_2 = ledger.load(shear + 2 * four);
  const FourLanes known_3 = ledger.load(shear + 3 * four);
  const FourLanes works = ledger.load(shear + 14 * sizeof(double));
  const LaneRigid shear_before{{known_0[0], known_0[1]}, known_0[2]};
  const LaneRigid damping_before{{known_0[3], known_1[0]}, known_1[1]};
  const LaneRigid load_before{{known_1[2], known_1[3]}, known_2[0]};
  const LaneRigid anchors{{known_2[1], known_2[2]}, known_2[3]};
  const LaneVec gravity_before{known_3[0], known_3[1]};

  const auto contact = [&](std::size_t number) __attribute__((always_inline)) {
    return load_by_lane([&](std::size_t i) { return &rows.contacts[first + i].force.u.x + number; });
  };
  const FourLanes sums_0 = contact(0);
  const FourLanes sums_1 = contact(4);
  const FourLanes sums_2 = contact(5);
  LaneRigid force{{sums_0[0], sums_0[1]}, sums_0[2]};
  const LaneRigid shear_force{{sums_0[3], sums_1[0]}, sums_1[1]};
  LaneRigid damping_force{{sums_1[2], sums_2[2]}, sums_2[3]};

  const BlockProperties *properties = &system.properties[first];
  const Lanes mass = Lanes::of([&](std::size_t i) { return properties[i].mass; });
  const Lanes inertia = Lanes::of([&](std::size_t i) { return properties[i].inertia; });
  const Lanes heavy_mass = mass / Lanes::of([&](std::size_t i) { return properties[i].mass_scaling; });
  const LaneVec gravity_force = heavy_mass * LaneVec{rows.gravity.x, rows.gravity.y};
  const LaneRigid load_force{
      LaneVec{0.0, 0.0} + (LaneVec{0.0, 0.0} - mass * LaneVec{rows.shaking.x, rows.shaking.y}), 0.0};
  force = force + load_force;
  force.u += gravity_force;

  const LaneRigid v = LaneRigid::load(system.velocity[first]);
  if (rows.local_damping != 0.0) {
    const LaneRigid f = force + anchors;
    const LaneRigid taken =
        Lanes(rows.local_damping) *
        LaneRigid{{lane_against(f.u.x, v.u.x), lane_against(f.u.y, v.u.y)}, lane_against(f.r, v.r)};
    force = force + taken;
    damping_force = damping_force + taken;
  }
  force.store(rows.forces[first]);

  const LaneRigid half_increment =
      Lanes(0.5) * (LaneRigid::load(system.trial[first]) - LaneRigid::load(system.trial_previous[first]));
  ledger.store(shear, shear_force.u.x, shear_force.u.y, shear_force.r, damping_force.u.x);
  ledger.store(shear + four, damping_force.u.y, damping_force.r, load_force.u.x, load_force.u.y);
  ledger.store(shear + 2 * four, load_force.r, anchors.u.x, anchors.u.y, anchors.r);
  ledger.store(shear + 3 * four, gravity_force.x, gravity_force.y, 0.0, 0.0);
  ledger.store(shear + 14 * sizeof(double), works[0] + work(shear_before + shear_force, half_increment),
               works[1] + work(damping_before + damping_force, half_increment),
               works[2] + work(load_before + load_force, half_increment),
               works[3] + dot(gravity_before + gravity_force, half_increment.u));

  const LaneRigid a = LaneRigid::load(system.acceleration[first]);
  const LaneRigid d = LaneRigid::load(system.displacement[first]);
  const LaneRigid free{(Lanes(1.0) / mass) * force.u, force.r / inertia};
  const LaneRigid a_new = Lanes(1.0 / (1.0 - scheme.alpha_m)) * (free - Lanes(scheme.alpha_m) * a);
  const LaneRigid d_new = position_of(scheme, dt, d, v, a, a_new);
  const LaneRigid v_new = velocity_of(scheme, dt, v, a, a_new);
  const LaneRigid trace = Lanes(0.0) * d_new + Lanes(0.0) * v_new; // where a_new leaves its own
  const Mask sound = (trace.u.x + trace.u.y + trace.r) == 0.0;
  select(sound, a_new, a).store(system.acceleration[first]);
  select(sound, d_new, d).store(system.displacement[first]);
  select(sound, v_new, v).store(system.velocity[first]);
  return (!sound).by_lane();
}

} // namespace gcpdda::GCPDDA_INSTRUCTIONS
