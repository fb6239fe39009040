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

/// Four numbers from an offset on of each of num_lanes structures.
template <class T> [[gnu::always_inline]] inline FourLanes load_four(const T *first, std::size_t offset) {
  return load_by_lane([&](std::size_t i) {
    return reinterpret_cast<const double *>(reinterpret_cast<const std::byte *>(first + i) + offset);
  });
}
template <class T> [[gnu::always_inline]] inline std::array<std::byte *, num_lanes> places_of(T *first) {
  std::array<std::byte *, num_lanes> to;
  for (std::size_t i = 0; i < num_lanes; ++i) {
    to[i] = reinterpret_cast<std::byte *>(first + i);
  }
  return to;
}

/// BlockLedger, one in each lane.
struct LaneLedger {
  LaneRigid shear_force;
  LaneRigid damping_force;
  FourLanes works; ///< shear, damping, load, gravity

  [[gnu::always_inline]] static LaneLedger load(const BlockLedger *first) {
    const FourLanes a = load_four(first, 0);
    const FourLanes b = load_four(first, bytes);
    return {{{a[0], a[1]}, a[2]}, {{a[3], b[0]}, b[1]}, load_four(first, works_at)};
  }
  [[gnu::always_inline]] void store(BlockLedger *first) const {
    const auto to = places_of(first);
    store_by_lane(to, 0, shear_force.u.x, shear_force.u.y, shear_force.r, damping_force.u.x);
    store_by_lane(to, bytes, damping_force.u.y, damping_force.r, works[0], works[1]);
    store_by_lane(to, works_at, works[0], works[1], works[2], works[3]);
  }

private:
  static constexpr std::size_t bytes = 4 * sizeof(double); ///< what is read and written at a time
  static constexpr std::size_t works_at = offsetof(BlockLedger, shear_work);
  static_assert(offsetof(BlockLedger, shear_force) == 0 &&
                offsetof(BlockLedger, damping_force) == 3 * sizeof(double) &&
                works_at == 6 * sizeof(double) && offsetof(BlockLedger, damping_work) == 7 * sizeof(double) &&
                offsetof(BlockLedger, load_work) == 8 * sizeof(double) &&
                offsetof(BlockLedger, gravity_work) == 9 * sizeof(double));
};

/// AppliedForces of free blocks, one in each lane: they have no anchors.
struct LaneApplied {
  LaneRigid load;
  LaneVec gravity;

  [[gnu::always_inline]] static LaneApplied load_from(const AppliedForces *first) {
    const FourLanes a = load_four(first, 0);
    const FourLanes b = load_four(first, sizeof(double));
    return {{{a[0], a[1]}, a[2]}, {b[2], b[3]}};
  }
  [[gnu::always_inline]] void store(AppliedForces *first) const {
    const auto to = places_of(first);
    store_by_lane(to, 0, load.u.x, load.u.y, load.r, gravity.x);
    store_by_lane(to, sizeof(double), load.u.y, load.r, gravity.x, gravity.y);
  }

private:
  static_assert(offsetof(AppliedForces, load) == 0 && offsetof(AppliedForces, gravity) == 3 * sizeof(double));
};

/// Now and at the evaluation before.
struct LaneAppliedTwice {
  LaneApplied before;
  LaneApplied now;
};

/// Masses and the like of rows [first, first + num_lanes).
struct LaneMasses {
  Lanes mass;
  Lanes inertia;
  Lanes scaling;
  Lanes radius;

  [[gnu::always_inline]] explicit LaneMasses(const BlockProperties *first) {
    const FourLanes four = load_four(first, offsetof(BlockProperties, mass));
    mass = four[0];
    inertia = four[1];
    scaling = four[2];
    radius = four[3];
  }

private:
  static constexpr std::size_t at = offsetof(BlockProperties, mass);
  static_assert(offsetof(BlockProperties, inertia) == at + sizeof(double) &&
                offsetof(BlockProperties, mass_scaling) == at + 2 * sizeof(double) &&
                offsetof(BlockProperties, radius) == at + 3 * sizeof(double));
};

/// What weight and shaking do to free rows [first, first + num_lanes), which is noted.
[[gnu::always_inline]] inline LaneAppliedTwice apply_to_free(BlockSystem &system, std::size_t first,
                                                             const FreeRows &rows, const LaneMasses &of) {
  const LaneApplied now{
      {LaneVec{0.0, 0.0} + (LaneVec{0.0, 0.0} - of.mass * LaneVec{rows.shaking.x, rows.shaking.y}), 0.0},
      of.mass / of.scaling * LaneVec{rows.gravity.x, rows.gravity.y}};
  if (rows.are_applied) {
    return {now, now};
  }
  const LaneApplied before = LaneApplied::load_from(&system.applied[first]);
  now.store(&system.applied[first]);
  return {before, now};
}

/// What contacts and that do to them in all; what of it stands in the ledger gets there, but for the works.
[[gnu::always_inline]] inline LaneRigid gather_free_forces(std::size_t first, const FreeRows &rows,
                                                           const LaneApplied &applied, LaneLedger &ledger) {
  static_assert(sizeof(BlockContactSum) == 9 * sizeof(double));
  const BlockContactSum *contacts = &rows.contacts[first];
  const FourLanes sums_0 = load_four(contacts, 0);
  const FourLanes sums_1 = load_four(contacts, 4 * sizeof(double));
  const FourLanes sums_2 = load_four(contacts, 5 * sizeof(double));
  ledger.shear_force = {{sums_0[3], sums_1[0]}, sums_1[1]};
  ledger.damping_force = {{sums_1[2], sums_2[2]}, sums_2[3]};
  LaneRigid force = LaneRigid{{sums_0[0], sums_0[1]}, sums_0[2]} + applied.load;
  force.u += applied.gravity;
  return force;
}

/// Half the way of rows [first, first + num_lanes) between their last two trial configurations.
[[gnu::always_inline]] inline LaneRigid half_increments(const BlockSystem &system, std::size_t first) {
  return Lanes(0.5) * (LaneRigid::load(system.trial[first]) - LaneRigid::load(system.trial_previous[first]));
}

/// Onto the works of `now`: half with the forces of `before`, half with its own.
[[gnu::always_inline]] inline void add_works(const LaneLedger &before, const LaneAppliedTwice &applied,
                                             const LaneRigid &half_increment, LaneLedger &now) {
  now.works = {before.works[0] + work(before.shear_force + now.shear_force, half_increment),
               before.works[1] + work(before.damping_force + now.damping_force, half_increment),
               before.works[2] + work(applied.before.load + applied.now.load, half_increment),
               before.works[3] + dot(applied.before.gravity + applied.now.gravity, half_increment.u)};
}

} // namespace gcpdda::GCPDDA_INSTRUCTIONS
