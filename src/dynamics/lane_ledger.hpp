#pragma once

// What acts on blocks that are free but for contacts and gravity, and the ledger of it, one block in each
// lane.

#include "block_lanes.hpp"

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

/// BlockLedger, one in each lane.
struct LaneLedger {
  LaneRigid shear_force;
  LaneRigid damping_force;
  LaneRigid load_force;
  LaneRigid anchor_force;
  LaneVec gravity_force;
  FourLanes works; ///< shear, damping, load, gravity

  [[gnu::always_inline]] static LaneLedger load(const BlockLedger *first) {
    const auto four = [&](std::size_t offset) __attribute__((always_inline)) {
      return load_by_lane([&](std::size_t i) {
        return reinterpret_cast<const double *>(reinterpret_cast<const std::byte *>(first + i) + offset);
      });
    };
    const FourLanes a = four(forces);
    const FourLanes b = four(forces + bytes);
    const FourLanes c = four(forces + 2 * bytes);
    const FourLanes d = four(forces + 3 * bytes);
    return {{{a[0], a[1]}, a[2]}, {{a[3], b[0]}, b[1]}, {{b[2], b[3]}, c[0]},
            {{c[1], c[2]}, c[3]}, {d[0], d[1]},         four(offsetof(BlockLedger, shear_work))};
  }
  [[gnu::always_inline]] void store(BlockLedger *first) const {
    std::array<std::byte *, num_lanes> to;
    for (std::size_t i = 0; i < num_lanes; ++i) {
      to[i] = reinterpret_cast<std::byte *>(first + i);
    }
    store_by_lane(to, forces, shear_force.u.x, shear_force.u.y, shear_force.r, damping_force.u.x);
    store_by_lane(to, forces + bytes, damping_force.u.y, damping_force.r, load_force.u.x, load_force.u.y);
    store_by_lane(to, forces + 2 * bytes, load_force.r, anchor_force.u.x, anchor_force.u.y, anchor_force.r);
    store_by_lane(to, forces + 3 * bytes, gravity_force.x, gravity_force.y, works[0], works[1]);
    store_by_lane(to, offsetof(BlockLedger, shear_work), works[0], works[1], works[2], works[3]);
  }

private:
  static constexpr std::size_t forces = offsetof(BlockLedger, shear_force);
  static constexpr std::size_t bytes = 4 * sizeof(double); ///< what is read and written at a time
  static_assert(offsetof(BlockLedger, damping_force) == forces + 3 * sizeof(double) &&
                offsetof(BlockLedger, load_force) == forces + 6 * sizeof(double) &&
                offsetof(BlockLedger, anchor_force) == forces + 9 * sizeof(double) &&
                offsetof(BlockLedger, gravity_force) == forces + 12 * sizeof(double) &&
                offsetof(BlockLedger, shear_work) == forces + 14 * sizeof(double) &&
                offsetof(BlockLedger, damping_work) == forces + 15 * sizeof(double) &&
                offsetof(BlockLedger, load_work) == forces + 16 * sizeof(double) &&
                offsetof(BlockLedger, gravity_work) == forces + 17 * sizeof(double));
};

/// What contacts, weight and shaking do to rows [first, first + num_lanes), in all and as the new forces of
/// the ledger, whose works are left alone.
[[gnu::always_inline]] inline LaneRigid gather_free_forces(const BlockSystem &system, std::size_t first,
                                                           const FreeRows &rows, LaneLedger &ledger) {
  static_assert(sizeof(BlockContactSum) == 9 * sizeof(double));
  const auto contact = [&](std::size_t number) __attribute__((always_inline)) {
    return load_by_lane([&](std::size_t i) { return &rows.contacts[first + i].force.u.x + number; });
  };
  const FourLanes sums_0 = contact(0);
  const FourLanes sums_1 = contact(4);
  const FourLanes sums_2 = contact(5);
  LaneRigid force{{sums_0[0], sums_0[1]}, sums_0[2]};
  ledger.shear_force = {{sums_0[3], sums_1[0]}, sums_1[1]};
  ledger.damping_force = {{sums_1[2], sums_2[2]}, sums_2[3]};

  const BlockProperties *properties = &system.properties[first];
  const Lanes mass = Lanes::of([&](std::size_t i) { return properties[i].mass; });
  const Lanes heavy_mass = mass / Lanes::of([&](std::size_t i) { return properties[i].mass_scaling; });
  ledger.gravity_force = heavy_mass * LaneVec{rows.gravity.x, rows.gravity.y};
  ledger.load_force = {
      LaneVec{0.0, 0.0} + (LaneVec{0.0, 0.0} - mass * LaneVec{rows.shaking.x, rows.shaking.y}), 0.0};
  force = force + ledger.load_force;
  force.u += ledger.gravity_force;
  return force;
}

/// Half the way of rows [first, first + num_lanes) between their last two trial configurations.
[[gnu::always_inline]] inline LaneRigid half_increments(const BlockSystem &system, std::size_t first) {
  return Lanes(0.5) * (LaneRigid::load(system.trial[first]) - LaneRigid::load(system.trial_previous[first]));
}

/// Onto the works of `now`: half with the forces of `before`, half with its own.
[[gnu::always_inline]] inline void add_works(const LaneLedger &before, const LaneRigid &half_increment,
                                             LaneLedger &now) {
  now.works = {before.works[0] + work(before.shear_force + now.shear_force, half_increment),
               before.works[1] + work(before.damping_force + now.damping_force, half_increment),
               before.works[2] + work(before.load_force + now.load_force, half_increment),
               before.works[3] + dot(before.gravity_force + now.gravity_force, half_increment.u)};
}

} // namespace gcpdda::GCPDDA_INSTRUCTIONS
