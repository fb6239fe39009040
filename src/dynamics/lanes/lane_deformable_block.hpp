#pragma once

// Deformable blocks before their step, one in each lane, with their matrices; the derivation is in
// deformable.hpp.

#include "base/lanes.hpp"
#include "dynamics/deformable.hpp"
#include "dynamics/lanes/block_lanes.hpp"
#include "dynamics/lanes/lane_ledger.hpp"
#include "dynamics/lanes/lane_matrix.hpp"
#include "geometry/lane_mat.hpp"

#include <array>
#include <cstddef>

namespace gcpdda::GCPDDA_INSTRUCTIONS {

// As the members of BlockSolve: Q is LaneVec or LaneMat.
template <class Q>
[[gnu::always_inline]] inline Q base_of(const BlockSolve &step, const Q &q, const Q &v, const Q &a) {
  return q + (Lanes(step.spring.velocity) * v + Lanes(step.spring.acceleration) * a);
}
template <class Q>
[[gnu::always_inline]] inline Q base_rate_of(const BlockSolve &step, const Q &v, const Q &a) {
  return v + Lanes(step.spring.rate_acceleration) * a;
}
/// A motion of F in turning axes, or a force that works on it: (r, ex, ey, gxy).
using LaneGradientDofs = std::array<Lanes, 4>;

/// What accelerations in turning axes follow from: of the centroid and of F.
struct LaneDofs {
  LaneVec u;
  LaneGradientDofs gradient;

  /// Component by component.
  template <class Function>
  [[gnu::always_inline]] static LaneDofs of(const LaneDofs &a, const LaneDofs &b, Function &&function) {
    LaneDofs x{{function(a.u.x, b.u.x), function(a.u.y, b.u.y)}, {}};
    for (std::size_t k = 0; k < 4; ++k) {
      x.gradient[k] = function(a.gradient[k], b.gradient[k]);
    }
    return x;
  }
  [[gnu::always_inline]] friend LaneDofs operator+(const LaneDofs &a, const LaneDofs &b) {
    const auto plus = [](const Lanes &p, const Lanes &q) __attribute__((always_inline)) {
      return p + q;
    };
    return of(a, b, plus);
  }
  [[gnu::always_inline]] friend LaneDofs operator*(const Lanes &s, const LaneDofs &a) {
    const auto times = [&](const Lanes &p, const Lanes &) __attribute__((always_inline)) {
      return s * p;
    };
    return of(a, a, times);
  }
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

/// A force on F in turning axes.
[[gnu::always_inline]] inline LaneGradientDofs lane_force_dofs(const LaneMat &h) {
  return {h.yx() - h.xy(), h.xx(), h.yy(), Lanes(0.5) * (h.xy() + h.yx())};
}
[[gnu::always_inline]] inline LaneMat lane_force_of(const LaneGradientDofs &h) {
  return {{h[1], h[3] - Lanes(0.5) * h[0], h[3] + Lanes(0.5) * h[0], h[2]}};
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
  [[gnu::always_inline]] FreeMatrix(const LaneDeformable &block, const LaneMasses &of, const BlockSolve &step)
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
  // These three are those of lane_matrix.hpp.
  [[gnu::always_inline]] void to_squares(LaneDofs &x) const {
    gcpdda::GCPDDA_INSTRUCTIONS::to_squares(factor_, x.gradient);
  }
  [[gnu::always_inline]] void from_squares(LaneDofs &x) const {
    gcpdda::GCPDDA_INSTRUCTIONS::from_squares(factor_, x.gradient);
  }
  [[gnu::always_inline]] void to_force(LaneDofs &x) const {
    x.u = (Lanes(1.0) / by_mass_) * x.u;
    gcpdda::GCPDDA_INSTRUCTIONS::to_force(factor_, x.gradient);
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
  /// @param get  the matrix of lane i
  template <class Get> [[gnu::always_inline]] explicit HeldMatrix(const Get &get) {
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
    All all = all_of(x);
    gcpdda::GCPDDA_INSTRUCTIONS::solve(factor_, all);
    x = dofs_of(all);
  }
  [[gnu::always_inline]] void to_squares(LaneDofs &x) const {
    All all = all_of(x);
    gcpdda::GCPDDA_INSTRUCTIONS::to_squares(factor_, all);
    x = dofs_of(all);
  }
  [[gnu::always_inline]] void from_squares(LaneDofs &x) const {
    All all = all_of(x);
    gcpdda::GCPDDA_INSTRUCTIONS::from_squares(factor_, all);
    x = dofs_of(all);
  }
  [[gnu::always_inline]] void to_force(LaneDofs &x) const {
    All all = all_of(x);
    gcpdda::GCPDDA_INSTRUCTIONS::to_force(factor_, all);
    x = dofs_of(all);
  }
  [[nodiscard, gnu::always_inline]] const LaneDofs &by_torque() const { return by_torque_; }

private:
  using All = std::array<Lanes, 6>;
  [[gnu::always_inline]] static All all_of(const LaneDofs &x) {
    return {x.u.x, x.u.y, x.gradient[0], x.gradient[1], x.gradient[2], x.gradient[3]};
  }
  [[gnu::always_inline]] static LaneDofs dofs_of(const All &x) {
    return {{x[0], x[1]}, {x[2], x[3], x[4], x[5]}};
  }

  std::array<Lanes, 21> factor_;
  LaneDofs by_torque_;
};

} // namespace gcpdda::GCPDDA_INSTRUCTIONS
