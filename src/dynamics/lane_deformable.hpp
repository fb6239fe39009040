#pragma once

// The step of deformable blocks, one in each lane; the derivation is in deformable.hpp.

#include "block_lanes.hpp"
#include "lane_newmark.hpp"

#include "gcpdda/base/lanes.hpp"
#include "gcpdda/dynamics/block_matrix.hpp"
#include "gcpdda/dynamics/deformable.hpp"
#include "gcpdda/geometry/lane_mat.hpp"

#include <array>
#include <cstddef>
#include <cstring>
#include <vector>

namespace gcpdda::GCPDDA_INSTRUCTIONS {

// As the members of OwnStep: Q is LaneVec or LaneMat.
template <class Q>
[[gnu::always_inline]] inline Q base_of(const OwnStep &step, const Q &q, const Q &v, const Q &a) {
  return q + (Lanes(step.spring.velocity) * v + Lanes(step.spring.acceleration) * a);
}
template <class Q> [[gnu::always_inline]] inline Q base_rate_of(const OwnStep &step, const Q &v, const Q &a) {
  return v + Lanes(step.spring.rate_acceleration) * a;
}
using LaneDofs = std::array<Lanes, 6>; ///< (u, v, r, ex, ey, gxy) in turning axes

/// The constant matrix of each block.
struct LaneFactors {
  std::array<Lanes, 21> factor;
  LaneDofs by_torque;

  template <class Get> [[gnu::always_inline]] static LaneFactors of(Get &&get) {
    static_assert(offsetof(BlockMatrix, by_torque) == 21 * sizeof(double));
    const auto load = [&](std::size_t first) __attribute__((always_inline)) {
      return load_by_lane([&](std::size_t i) { return get(i)->factor.data() + first; });
    };
    LaneFactors f;
    for (std::size_t k = 0; k < 20; k += 4) {
      const FourLanes four = load(k);
      for (std::size_t j = 0; j < 4; ++j) {
        f.factor[k + j] = four[j];
      }
    }
    const FourLanes middle = load(20);
    const FourLanes last = load(23);
    f.factor[20] = middle[0];
    f.by_torque = {middle[1], middle[2], middle[3], last[1], last[2], last[3]};
    return f;
  }

  /// As gcpdda::solve.
  [[gnu::always_inline]] void solve(LaneDofs &x) const {
    for (std::size_t i = 1; i < 6; ++i) {
      for (std::size_t k = 0; k < i; ++k) {
        x[i] = x[i] - factor[packed(i, k)] * x[k];
      }
    }
    for (std::size_t i = 0; i < 6; ++i) {
      x[i] = x[i] * factor[packed(i, i)];
    }
    for (std::size_t i = 5; i-- > 0;) {
      for (std::size_t k = i + 1; k < 6; ++k) {
        x[i] = x[i] - factor[packed(k, i)] * x[k];
      }
    }
  }
};

[[gnu::always_inline]] inline LaneMat lane_rotation_of(const LaneMat &gradient) {
  const Lanes c = gradient.xx() + gradient.yy();
  const Lanes s = gradient.yx() - gradient.xy();
  const Lanes unit = Lanes(1.0) / sqrt(c * c + s * s);
  return {{unit * c, -unit * s, unit * s, unit * c}};
}

[[gnu::always_inline]] inline LaneMat lane_gradient_of(const LaneDofs &x) {
  return {{x[3], Lanes(0.5) * x[5] - x[2], Lanes(0.5) * x[5] + x[2], x[4]}};
}

/// tr(J stress stretch): minus the torque of a force on F in turning axes.
[[gnu::always_inline]] inline Lanes lane_moment(const LaneMat &stress, const LaneMat &stretch) {
  const LaneMat product = stress * stretch;
  return product.xy() - product.yx();
}

/// motion_dof(g).r.
[[gnu::always_inline]] inline Lanes lane_spin(const LaneMat &g) {
  return Lanes(0.5) * (g.yx() - g.xy());
}

struct LaneElasticity {
  Lanes direct;
  Lanes cross;
  Lanes shear;

  [[nodiscard, gnu::always_inline]] LaneMat stress(const LaneMat &strain) const {
    const Lanes tau = shear * (strain.xy() + strain.yx());
    return {
        {direct * strain.xx() + cross * strain.yy(), tau, tau, cross * strain.xx() + direct * strain.yy()}};
  }
  /// As elastic_force(), in turning axes.
  [[nodiscard, gnu::always_inline]] LaneMat force(const LaneMat &stretch,
                                                  const LaneMat &initial_strain) const {
    const LaneMat sigma = stress(stretch - LaneMat::identity() + initial_strain);
    const LaneMat product = sigma * stretch;
    const Lanes no_torque = (product.xy() - product.yx()) / (stretch.xx() + stretch.yy());
    return {{sigma.xx(), sigma.xy() - no_torque, sigma.yx() + no_torque, sigma.yy()}};
  }
};

/// As angle_between(); many turn by little.
inline Lanes lane_angle_between(const LaneMat &from, const LaneMat &to) {
  const LaneVec a{from.xx() + from.yy(), from.yx() - from.xy()};
  const LaneVec b{to.xx() + to.yy(), to.yx() - to.xy()};
  const Lanes along = dot(a, b);
  const Lanes x = cross(a, b) / along;
  const Mask is_small = (along > 0.0) & (abs(x) <= largest_ratio_of_series);
  const Lanes q = x * x;
  const Lanes one = 1.0;
  const Lanes angle =
      x * (one - q * (Lanes(1.0 / 3.0) -
                      q * (Lanes(1.0 / 5.0) -
                           q * (Lanes(1.0 / 7.0) - q * (Lanes(1.0 / 9.0) - q * Lanes(1.0 / 11.0))))));
  if (!(!is_small).any()) {
    return angle;
  }
  const unsigned small = is_small.by_lane();
  return Lanes::of([&](std::size_t i) {
    const auto lane = [i](const LaneMat &f) { return Mat2{f.xx()[i], f.xy()[i], f.yx()[i], f.yy()[i]}; };
    return (small >> i & 1U) != 0 ? angle[i] : angle_between(lane(from), lane(to));
  });
}

/// A motion of the centroid and of F, or its rate.
struct LaneMoving {
  LaneVec u;
  LaneMat gradient;

  /// No less than how far any point goes.
  [[nodiscard, gnu::always_inline]] Lanes most(const Lanes &radius) const {
    const LaneMat &f = gradient;
    return abs(u.x) + abs(u.y) + radius * (abs(f.xx()) + abs(f.xy()) + abs(f.yx()) + abs(f.yy()));
  }
};

/// As most_motion().
[[gnu::always_inline]] inline Lanes lane_most_motion(const LaneMoving &moved, const LaneMoving &velocity,
                                                     const LaneMoving &acceleration, const Lanes &radius,
                                                     double dt) {
  return Lanes(rounding_of_most_motion) *
         (moved.most(radius) + Lanes(dt) * (velocity.most(radius) + Lanes(dt) * acceleration.most(radius)));
}

/// One RigidDof for each lane.
[[gnu::always_inline]] inline void store_dofs(const std::array<RigidDof *, num_lanes> &to, const LaneVec &u,
                                              const Lanes &r) {
  std::array<std::array<double, 4>, num_lanes> row;
  std::array<std::byte *, num_lanes> places;
  for (std::size_t i = 0; i < num_lanes; ++i) {
    places[i] = reinterpret_cast<std::byte *>(&row[i]);
  }
  store_by_lane(places, 0, u.x, u.y, r, r);
  for (std::size_t i = 0; i < num_lanes; ++i) {
    *to[i] = {{row[i][0], row[i][1]}, row[i][2]};
  }
}

inline unsigned step_deformables(BlockSystem &system, DeformableLanes &lanes, const OwnStep &step) {
  std::array<std::size_t, num_lanes> row;
  std::array<std::size_t, num_lanes> given;
  std::array<Deformation *, num_lanes> of;
  for (std::size_t i = 0; i < num_lanes; ++i) { // lanes beyond repeat the last one
    given[i] = i < lanes.count ? i : lanes.count - 1;
    row[i] = lanes.row[given[i]];
    of[i] = &system.deformation_of(row[i]);
  }
  const auto load = [&](Mat2 Deformation::*field) __attribute__((always_inline)) {
    return LaneMat::of([&](std::size_t i) { return &(of[i]->*field); });
  };
  const auto load_u = [&](const std::vector<RigidDof> &field) __attribute__((always_inline)) {
    return LaneVec::of([&](std::size_t i) { return &field[row[i]].u; });
  };
  const LaneMat trial = load(&Deformation::trial);
  const LaneMat gradient = load(&Deformation::gradient);
  const LaneMat rate = load(&Deformation::rate);
  const LaneMat acceleration = load(&Deformation::acceleration);
  const LaneVec a = load_u(system.acceleration);
  const FourLanes stiffness = load_by_lane([&](std::size_t i) { return &of[i]->stiffness_direct; });
  const LaneElasticity elasticity{stiffness[0], stiffness[1], stiffness[2]};
  const LaneFactors factors =
      LaneFactors::of([&](std::size_t i) { return &system.matrix[system.matrix_begin[row[i]]]; });

  const LaneMat turn = lane_rotation_of(trial);
  const LaneMat back = transposed(turn);
  const LaneMat stretch = back * trial;
  // In turning axes, at the spring's time so far known.
  LaneMat stress = elasticity.force(stretch, load(&Deformation::initial_strain));
  if (step.is_implicit) {
    const LaneMat f_base = base_of(step, gradient, rate, acceleration);
    stress = stress + elasticity.stress(back * (f_base - trial));
  }
  LaneMat viscous =
      Lanes(step.stiffness_damping) * elasticity.stress(back * base_rate_of(step, rate, acceleration));

  const double am = step.scheme.alpha_m;
  const double dt = step.time_step;
  const LaneVec force = LaneVec::of([&](std::size_t i) { return &lanes.force[given[i]]; });
  const LaneMat gradient_force = LaneMat::of([&](std::size_t i) { return &lanes.gradient_force[given[i]]; });
  static_assert(offsetof(BlockProperties, radius) == offsetof(BlockProperties, mass) + 3 * sizeof(double));
  const FourLanes masses = load_by_lane([&](std::size_t i) { return &system.properties[row[i]].mass; });
  const Lanes &mass = masses[0];
  const Lanes &radius = masses[3];
  const LaneVec h_u = back(force - am * mass * a);
  const LaneMat h = back * (gradient_force - Lanes(am) * (acceleration * load(&Deformation::second_moment))) -
                    stress - viscous;
  LaneDofs x{h_u.x, h_u.y, h.yx() - h.xy(), h.xx(), h.yy(), Lanes(0.5) * (h.xy() + h.yx())};
  factors.solve(x);
  if (step.is_implicit) {
    // a J added to the elastic force so that all of it, K e included, has no torque. One linear equation: it
    // works on r alone, as the force -2 a against it.
    const Lanes coming = step.spring.coming + step.stiffness_damping * step.spring.rate_coming;
    const LaneMat whole = stress + viscous + coming * elasticity.stress(lane_gradient_of(x));
    const Lanes no_torque =
        lane_moment(whole, stretch) /
        (stretch.xx() + stretch.yy() +
         Lanes(2.0) * coming * lane_moment(elasticity.stress(lane_gradient_of(factors.by_torque)), stretch));
    for (std::size_t k = 0; k < 6; ++k) {
      x[k] = x[k] - Lanes(2.0) * no_torque * factors.by_torque[k];
    }
    stress = stress + (Lanes(step.spring.coming) * elasticity.stress(lane_gradient_of(x)) +
                       LaneMat{{0.0, -no_torque, no_torque, 0.0}});
  }

  const LaneVec a_new = turn(LaneVec{x[0], x[1]});
  const LaneMat acceleration_new = turn * lane_gradient_of(x);
  const LaneMat internal = turn * stress;
  viscous = turn * (viscous + Lanes(step.stiffness_damping * step.spring.rate_coming) *
                                  elasticity.stress(lane_gradient_of(x)));
  const LaneVec v = load_u(system.velocity);
  const LaneVec u_new = position_of(step.scheme, dt, load_u(system.displacement), v, a, a_new);
  const LaneVec v_new = velocity_of(step.scheme, dt, v, a, a_new);
  const LaneMat f_new = position_of(step.scheme, dt, gradient, rate, acceleration, acceleration_new);
  const LaneMat rate_new = velocity_of(step.scheme, dt, rate, acceleration, acceleration_new);

  // Accelerations that are not finite leave their trace in velocities.
  Lanes nothing = Lanes(0.0) * u_new.x + Lanes(0.0) * u_new.y + Lanes(0.0) * v_new.x + Lanes(0.0) * v_new.y;
  for (std::size_t k = 0; k < 4; ++k) {
    nothing += Lanes(0.0) * f_new.entry[k] + Lanes(0.0) * rate_new.entry[k];
  }
  const Mask sound = (nothing == 0.0) & (determinant(f_new) > 0.0);
  const unsigned broken = (!sound).by_lane() & ((1U << lanes.count) - 1U);

  const Lanes r_new = Lanes::of([&](std::size_t i) { return system.displacement[row[i]].r; }) +
                      lane_angle_between(gradient, f_new);
  const LaneMat inverse_new = inverse(f_new);
  const LaneMat velocity_gradient = rate_new * inverse_new;
  const Lanes spin = lane_spin(velocity_gradient);
  const Lanes spin_rate = lane_spin(acceleration_new * inverse_new - velocity_gradient * velocity_gradient);

  Deformation unwanted;
  RigidDof unwanted_dof;
  std::array<RigidDof *, num_lanes> displacement;
  std::array<RigidDof *, num_lanes> velocity;
  std::array<RigidDof *, num_lanes> acceleration_dof;
  std::array<std::byte *, num_lanes> state;
  std::array<std::byte *, num_lanes> viscous_force;
  for (std::size_t i = 0; i < num_lanes; ++i) {
    const bool keep = (broken >> given[i] & 1U) != 0;
    displacement[i] = keep ? &unwanted_dof : &system.displacement[row[i]];
    velocity[i] = keep ? &unwanted_dof : &system.velocity[row[i]];
    acceleration_dof[i] = keep ? &unwanted_dof : &system.acceleration[row[i]];
    state[i] = reinterpret_cast<std::byte *>(keep ? &unwanted : of[i]);
    viscous_force[i] = reinterpret_cast<std::byte *>(&lanes.viscous[given[i]]);
  }
  const auto store = [&](std::size_t offset, const LaneMat &m) __attribute__((always_inline)) {
    store_by_lane(state, offset, m.xx(), m.xy(), m.yx(), m.yy());
  };
  store(offsetof(Deformation, gradient), f_new);
  store(offsetof(Deformation, rate), rate_new);
  store(offsetof(Deformation, acceleration), acceleration_new);
  store(offsetof(Deformation, internal), internal);
  store_dofs(displacement, u_new, r_new);
  store_dofs(velocity, v_new, spin);
  store_dofs(acceleration_dof, a_new, spin_rate);
  store_by_lane(viscous_force, 0, viscous.xx(), viscous.xy(), viscous.yx(), viscous.yy());
  const LaneMoving moved{u_new - load_u(system.refreshed), f_new - load(&Deformation::refreshed)};
  const Lanes most_motion = lane_most_motion(moved, {v_new, rate_new}, {a_new, acceleration_new}, radius, dt);
  for (std::size_t i = 0; i < lanes.count; ++i) {
    lanes.most_motion[i] = most_motion[i];
  }
  return broken;
}

} // namespace gcpdda::GCPDDA_INSTRUCTIONS
