#pragma once

// The step of deformable blocks, one in each lane; the derivation is in deformable.hpp.

#include "block_lanes.hpp"
#include "lane_ledger.hpp"
#include "lane_matrix.hpp"
#include "lane_newmark.hpp"

#include "gcpdda/base/lanes.hpp"
#include "gcpdda/dynamics/deformable.hpp"
#include "gcpdda/geometry/lane_mat.hpp"

#include <array>
#include <cstddef>
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
/// A motion of F in turning axes, or a force that works on it: (r, ex, ey, gxy).
using LaneGradientDofs = std::array<Lanes, 4>;

/// What accelerations in turning axes follow from: of the centroid and of F.
struct LaneDofs {
  LaneVec u;
  LaneGradientDofs gradient;
};

[[gnu::always_inline]] inline LaneMat lane_rotation_of(const LaneMat &gradient) {
  const Lanes c = gradient.xx() + gradient.yy();
  const Lanes s = gradient.yx() - gradient.xy();
  const Lanes unit = Lanes(1.0) / sqrt(c * c + s * s);
  return {{unit * c, -unit * s, unit * s, unit * c}};
}

[[gnu::always_inline]] inline LaneMat lane_gradient_of(const LaneGradientDofs &x) {
  return {{x[1], Lanes(0.5) * x[3] - x[0], Lanes(0.5) * x[3] + x[0], x[2]}};
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

/// Deformable blocks before their step.
struct LaneDeformable {
  LaneVec u;
  LaneVec v;
  LaneVec a;
  LaneMat gradient;
  LaneMat rate;
  LaneMat acceleration;
  LaneMat trial;
  LaneMat second_moment;
  LaneMat initial_strain;
  LaneElasticity elasticity;

  /// All but what stands in lists of RigidDof: of *get(i).
  template <class Get> [[gnu::always_inline]] void load(Get &&get) {
    const auto take = [&](Mat2 Deformation::*field) __attribute__((always_inline)) {
      return LaneMat::of([&](std::size_t i) { return &(get(i)->*field); });
    };
    gradient = take(&Deformation::gradient);
    rate = take(&Deformation::rate);
    acceleration = take(&Deformation::acceleration);
    trial = take(&Deformation::trial);
    second_moment = take(&Deformation::second_moment);
    initial_strain = take(&Deformation::initial_strain);
    const FourLanes stiffness = load_by_lane([&](std::size_t i) { return &get(i)->stiffness_direct; });
    elasticity = {stiffness[0], stiffness[1], stiffness[2]};
  }
};

/// The matrix of blocks that nothing holds: F apart from the centroid, from what the step knows anyway. To
/// read six times as many numbers would take longer than to find these.
class FreeMatrix {
public:
  [[gnu::always_inline]] FreeMatrix(const LaneDeformable &block, const LaneMasses &of, const OwnStep &step)
      : by_mass_(Lanes(1.0) / (Lanes(1.0 - step.scheme.alpha_m) * of.mass)) {
    const Lanes share = 1.0 - step.scheme.alpha_m;
    const Lanes springs =
        (step.is_implicit ? step.spring.coming : 0.0) + step.stiffness_damping * step.spring.rate_coming;
    const LaneMat s = share * block.second_moment;
    const LaneElasticity &k = block.elasticity;
    const Lanes quarter = Lanes(0.25) * (s.xx() + s.yy());
    const Lanes half = Lanes(0.5) * s.xy();
    factor_ = {share * of.inertia,
               -s.xy(),
               s.xx() + springs * k.direct,
               s.xy(),
               springs * k.cross,
               s.yy() + springs * k.direct,
               Lanes(0.5) * (s.xx() - s.yy()),
               half,
               half,
               quarter + springs * k.shear};
    factorise<4>(factor_);
  }
  [[gnu::always_inline]] void solve(LaneDofs &x) const {
    x.u = by_mass_ * x.u;
    gcpdda::GCPDDA_INSTRUCTIONS::solve(factor_, x.gradient);
  }
  /// The solution under a unit torque.
  [[nodiscard, gnu::always_inline]] LaneDofs by_torque() const {
    LaneDofs x{{0.0, 0.0}, {1.0, 0.0, 0.0, 0.0}};
    gcpdda::GCPDDA_INSTRUCTIONS::solve(factor_, x.gradient);
    return x;
  }

private:
  Lanes by_mass_;
  std::array<Lanes, 10> factor_;
};

/// That of blocks on springs of their own, as it stands in the system.
class HeldMatrix {
public:
  template <class Get> [[gnu::always_inline]] explicit HeldMatrix(Get &&get) {
    static_assert(offsetof(BlockMatrix, by_torque) == 21 * sizeof(double));
    const auto load = [&](std::size_t first) __attribute__((always_inline)) {
      return load_by_lane([&](std::size_t i) { return get(i)->factor.data() + first; });
    };
    for (std::size_t k = 0; k < 20; k += 4) {
      const FourLanes four = load(k);
      for (std::size_t j = 0; j < 4; ++j) {
        factor_[k + j] = four[j];
      }
    }
    const FourLanes middle = load(20);
    const FourLanes last = load(23);
    factor_[20] = middle[0];
    by_torque_ = {{middle[1], middle[2]}, {middle[3], last[1], last[2], last[3]}};
  }
  [[gnu::always_inline]] void solve(LaneDofs &x) const {
    std::array<Lanes, 6> all{x.u.x, x.u.y, x.gradient[0], x.gradient[1], x.gradient[2], x.gradient[3]};
    gcpdda::GCPDDA_INSTRUCTIONS::solve(factor_, all);
    x = {{all[0], all[1]}, {all[2], all[3], all[4], all[5]}};
  }
  [[nodiscard, gnu::always_inline]] const LaneDofs &by_torque() const { return by_torque_; }

private:
  std::array<Lanes, 21> factor_;
  LaneDofs by_torque_;
};

/// And after it.
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

/// @param force, gradient_force  all that acts at the trial configuration, without the elasticity
template <class Matrix>
[[gnu::always_inline]] inline LaneStepped step_of(const LaneDeformable &block, const Matrix &matrix,
                                                  const Lanes &mass, const LaneVec &force,
                                                  const LaneMat &gradient_force, const OwnStep &step) {
  const LaneMat turn = lane_rotation_of(block.trial);
  const LaneMat back = transposed(turn);
  const LaneMat stretch = back * block.trial;
  const LaneElasticity &elasticity = block.elasticity;
  // In turning axes, at the spring's time so far known.
  LaneMat stress = elasticity.force(stretch, block.initial_strain);
  if (step.is_implicit) {
    const LaneMat f_base = base_of(step, block.gradient, block.rate, block.acceleration);
    stress = stress + elasticity.stress(back * (f_base - block.trial));
  }
  const bool is_viscous = step.stiffness_damping > 0.0;
  LaneMat viscous{{0.0, 0.0, 0.0, 0.0}};
  LaneMat resisting = stress;
  if (is_viscous) {
    viscous = Lanes(step.stiffness_damping) *
              elasticity.stress(back * base_rate_of(step, block.rate, block.acceleration));
    resisting = resisting + viscous;
  }

  const double am = step.scheme.alpha_m;
  const LaneMat h =
      back * (gradient_force - Lanes(am) * (block.acceleration * block.second_moment)) - resisting;
  LaneDofs x{back(force - am * mass * block.a),
             {h.yx() - h.xy(), h.xx(), h.yy(), Lanes(0.5) * (h.xy() + h.yx())}};
  matrix.solve(x);
  if (step.is_implicit) {
    // a J added to the elastic force so that all of it, K e included, has no torque. One linear equation: it
    // works on r alone, as the force -2 a against it.
    const Lanes coming = step.spring.coming + step.stiffness_damping * step.spring.rate_coming;
    const LaneDofs by_torque = matrix.by_torque();
    const LaneMat whole = resisting + coming * elasticity.stress(lane_gradient_of(x.gradient));
    const Lanes no_torque =
        lane_moment(whole, stretch) /
        (stretch.xx() + stretch.yy() +
         Lanes(2.0) * coming * lane_moment(elasticity.stress(lane_gradient_of(by_torque.gradient)), stretch));
    x.u = x.u - Lanes(2.0) * no_torque * by_torque.u;
    for (std::size_t k = 0; k < 4; ++k) {
      x.gradient[k] = x.gradient[k] - Lanes(2.0) * no_torque * by_torque.gradient[k];
    }
    stress = stress + (Lanes(step.spring.coming) * elasticity.stress(lane_gradient_of(x.gradient)) +
                       LaneMat{{0.0, -no_torque, no_torque, 0.0}});
  }

  LaneStepped now;
  now.a = turn(x.u);
  now.acceleration = turn * lane_gradient_of(x.gradient);
  now.internal = turn * stress;
  now.viscous = viscous;
  if (is_viscous) {
    now.viscous = turn * (viscous + Lanes(step.stiffness_damping * step.spring.rate_coming) *
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

template <class MatrixOf>
inline unsigned step_scattered(BlockSystem &system, DeformableLanes &lanes, const OwnStep &step,
                               MatrixOf &&matrix_of) {
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
  LaneDeformable block;
  block.u = load_u(system.displacement);
  block.v = load_u(system.velocity);
  block.a = load_u(system.acceleration);
  block.load([&](std::size_t i) { return of[i]; });
  const LaneMasses masses = LaneMasses::of([&](std::size_t i) { return &system.properties[row[i]]; });
  LaneVec force = LaneVec::of([&](std::size_t i) { return &system.contact[row[i]].force.u; });
  LaneMat gradient_force = LaneMat::of([&](std::size_t i) { return &of[i]->contact.force; });
  if (lanes.are_held) {
    force = force + LaneVec::of([&](std::size_t i) { return &lanes.held[given[i]].u; });
    gradient_force =
        gradient_force + LaneMat::of([&](std::size_t i) { return &lanes.held[given[i]].gradient; });
  }
  LaneStepped now = step_of(block, matrix_of(block, masses, row), masses.mass, force, gradient_force, step);
  const Mask sound = now.are_sound();
  const unsigned broken = (!sound).by_lane() & ((1U << lanes.count) - 1U);
  if (broken != 0) {
    now.keep_where(sound, block, load(&Deformation::internal));
  }
  const Lanes most_motion =
      now.most_motion(load_u(system.refreshed), load(&Deformation::refreshed), masses.radius, step.time_step);
  std::array<std::byte *, num_lanes> state;
  std::array<std::byte *, num_lanes> viscous;
  for (std::size_t i = 0; i < num_lanes; ++i) {
    state[i] = reinterpret_cast<std::byte *>(of[i]);
    viscous[i] = reinterpret_cast<std::byte *>(&lanes.viscous[given[i]]);
  }
  now.store(state);
  store_by_lane(viscous, 0, now.viscous.xx(), now.viscous.xy(), now.viscous.yx(), now.viscous.yy());
  for (std::size_t i = 0; i < lanes.count; ++i) {
    system.displacement[row[i]].u = {now.u.x[i], now.u.y[i]};
    system.displacement[row[i]].r += now.turned[i];
    system.velocity[row[i]].u = {now.v.x[i], now.v.y[i]};
    system.acceleration[row[i]].u = {now.a.x[i], now.a.y[i]};
    lanes.turned[i] = now.turned[i];
    lanes.most_motion[i] = most_motion[i];
  }
  return broken;
}

inline unsigned step_deformables(BlockSystem &system, DeformableLanes &lanes, const OwnStep &step) {
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
