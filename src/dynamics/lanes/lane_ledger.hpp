#pragma once

// What acts on blocks that are free but for contacts and gravity, and the ledger of it, one block in each
// lane.

#include "base/lanes.hpp"
#include "dynamics/lanes/block_lanes.hpp"
#include "geometry/lane_mat.hpp"

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

/// BlockContactSum, one in each lane.
struct LaneContacts {
  LaneRigid force;
  LaneRigid shear;
  LaneRigid damping;

  [[gnu::always_inline]] static LaneContacts load(const BlockContactSum *first) {
    const FourLanes a = load_four(first, 0);
    const FourLanes b = load_four(first, 4 * sizeof(double));
    const FourLanes c = load_four(first, 5 * sizeof(double));
    return {{{a[0], a[1]}, a[2]}, {{a[3], b[0]}, b[1]}, {{b[2], c[2]}, c[3]}};
  }
  /// All but the force.
  [[gnu::always_inline]] static LaneContacts load_parts(const BlockContactSum *first) {
    const FourLanes a = load_four(first, 3 * sizeof(double));
    const FourLanes b = load_four(first, 5 * sizeof(double));
    return {{{0.0, 0.0}, 0.0}, {{a[0], a[1]}, a[2]}, {{a[3], b[2]}, b[3]}};
  }
  [[gnu::always_inline]] void store(BlockContactSum *first) const {
    const auto to = places_of(first);
    store_by_lane(to, 0, force.u.x, force.u.y, force.r, shear.u.x);
    store_by_lane(to, 4 * sizeof(double), shear.u.y, shear.r, damping.u.x, damping.u.y);
    store_by_lane(to, 5 * sizeof(double), shear.r, damping.u.x, damping.u.y, damping.r);
  }

private:
  static_assert(sizeof(BlockContactSum) == 9 * sizeof(double) &&
                offsetof(BlockContactSum, shear) == 3 * sizeof(double) &&
                offsetof(BlockContactSum, damping) == 6 * sizeof(double));
};

/// Masses and the like of rows.
struct LaneMasses {
  Lanes mass;
  Lanes inertia;
  Lanes scaling;
  Lanes radius;

  /// Lane i holds those of *get(i).
  template <class Get> [[gnu::always_inline]] static LaneMasses of(Get &&get) {
    const FourLanes four = load_by_lane([&](std::size_t i) { return &get(i)->mass; });
    return {four[0], four[1], four[2], four[3]};
  }
  /// Those of rows from `first` on.
  [[gnu::always_inline]] static LaneMasses of_rows(const BlockProperties *first) {
    return of([first](std::size_t i) { return first + i; });
  }

private:
  static constexpr std::size_t at = offsetof(BlockProperties, mass);
  static_assert(offsetof(BlockProperties, inertia) == at + sizeof(double) &&
                offsetof(BlockProperties, mass_scaling) == at + 2 * sizeof(double) &&
                offsetof(BlockProperties, radius) == at + 3 * sizeof(double));
};

/// What weight and shaking do to free blocks, one in each lane, as applied_by().
struct LaneApplied {
  LaneVec load;
  LaneVec gravity;

  [[gnu::always_inline]] LaneApplied(const BodyForces &body, const LaneMasses &of)
      : load(LaneVec{0.0, 0.0} - of.mass * LaneVec{body.shaking.x, body.shaking.y}),
        gravity(of.mass / of.scaling * LaneVec{body.gravity.x, body.gravity.y}) {}
};

/// Half the way of rows [first, first + num_lanes) between their last two trial configurations.
[[gnu::always_inline]] inline LaneRigid half_increments(const BlockSystem &system, std::size_t first) {
  static_assert(offsetof(BlockMotion, rotated) == offsetof(BlockMotion, step) + 2 * sizeof(double));
  const FourLanes four = load_four(&system.motion[first], offsetof(BlockMotion, step));
  return Lanes(0.5) * LaneRigid{{four[0], four[1]}, four[2]};
}

/// HalfWorks, one in each lane: of shear, damping, load and gravity.
[[gnu::always_inline]] inline FourLanes
lane_half_works(const LaneContacts &contacts, const LaneApplied &applied, const LaneRigid &half_increment) {
  return {work(contacts.shear, half_increment), work(contacts.damping, half_increment),
          dot(applied.load, half_increment.u), dot(applied.gravity, half_increment.u)};
}

/// BlockSystem::gradient_increment() of rows [first, first + num_lanes).
[[gnu::always_inline]] inline LaneMat gradient_increment(const BlockSystem &system, std::size_t first,
                                                         const LaneMat &trial) {
  return LaneMat{load_four(&system.motion[first], offsetof(BlockMotion, turn))} * trial;
}

/// What contacts do on F adds to them.
[[gnu::always_inline]] inline void add_on_gradient(const LaneMat &shear, const LaneMat &damping,
                                                   const LaneMat &increment, FourLanes &works) {
  works[0] += Lanes(0.5) * contract(shear, increment);
  works[1] += Lanes(0.5) * contract(damping, increment);
}

/// @param damped  what local damping adds to the second of them
[[gnu::always_inline]] inline void add_to_ledger(const FourLanes &works, BlockLedger *first,
                                                 const Lanes &damped = 0.0) {
  static_assert(sizeof(BlockLedger) == 4 * sizeof(double));
  const FourLanes before = load_four(first, 0);
  store_by_lane(places_of(first), 0, before[0] + works[0], before[1] + works[1] + damped,
                before[2] + works[2], before[3] + works[3]);
}

/// What add_half_works() says of free rows [first, first + num_lanes), rigid or deformable ones.
inline void add_half_works_of_rigids(BlockSystem &system, std::size_t first) {
  const LaneApplied applied(system.body, LaneMasses::of_rows(&system.properties[first]));
  add_to_ledger(lane_half_works(LaneContacts::load_parts(&system.contact[first]), applied,
                                half_increments(system, first)),
                &system.ledger[first]);
}

inline void add_half_works_of_deformables(BlockSystem &system, std::size_t first) {
  const Deformation *deformation = &system.deformation[system.deformation_begin[first]];
  const auto load = [&](Mat2 BlockGradientSum::*field) __attribute__((always_inline)) {
    return LaneMat::of([&](std::size_t i) { return &(deformation[i].contact.*field); });
  };
  const LaneMat trial = LaneMat::of([&](std::size_t i) { return &deformation[i].trial; });
  const LaneApplied applied(system.body, LaneMasses::of_rows(&system.properties[first]));
  FourLanes works = lane_half_works(LaneContacts::load_parts(&system.contact[first]), applied,
                                    half_increments(system, first));
  add_on_gradient(load(&BlockGradientSum::shear), load(&BlockGradientSum::damping),
                  gradient_increment(system, first, trial), works);
  add_to_ledger(works, &system.ledger[first]);
}

} // namespace gcpdda::GCPDDA_INSTRUCTIONS
