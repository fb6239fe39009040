#include "own_step.hpp"

#include "gcpdda/dynamics/block_matrix.hpp"
#include "gcpdda/dynamics/deformable.hpp"
#include "gcpdda/dynamics/viscous_sides.hpp"
#include "own_springs.hpp"

#include <array>
#include <cmath>

namespace gcpdda {

namespace {

/// One step of the family, and where it takes springs.
struct Step {
  const Scheme &scheme;
  double time_step;
  SpringTime spring;
  Vec2 wave;                ///< velocity of the one that comes in through viscous sides, m/s
  double stiffness_damping; ///< s

  /// Q is Vec2, RigidDof or Mat2. At the spring's time but for the coming acceleration.
  template <class Q> [[nodiscard]] Q base(const Q &q, const Q &v, const Q &a) const {
    return q + (spring.velocity * v + spring.acceleration * a);
  }
  /// And its rate there.
  template <class Q> [[nodiscard]] Q base_rate(const Q &v, const Q &a) const {
    return v + spring.rate_acceleration * a;
  }
  template <class Q> [[nodiscard]] Q position(const Q &q, const Q &v, const Q &a, const Q &a_new) const {
    return q + (time_step * v + time_step * time_step * ((0.5 - scheme.beta) * a + scheme.beta * a_new));
  }
  template <class Q> [[nodiscard]] Q velocity(const Q &v, const Q &a, const Q &a_new) const {
    return v + time_step * ((1.0 - scheme.gamma) * a + scheme.gamma * a_new);
  }
};

bool is_finite(const Vec2 &a) {
  return std::isfinite(a.x) && std::isfinite(a.y);
}
bool is_finite(const RigidDof &a) {
  return is_finite(a.u) && std::isfinite(a.r);
}
bool is_finite(const Mat2 &a) {
  return std::isfinite(a.xx) && std::isfinite(a.xy) && std::isfinite(a.yx) && std::isfinite(a.yy);
}

/// Their work goes by the trapezoid over increments of x*: this half now, the other after the next predict().
void note_anchors(BlockSystem &system, std::size_t row, const RigidDof &force) {
  BlockLedger &ledger = system.ledger[row];
  ledger.anchor_force = force;
  ledger.load_work += 0.5 * work(force, system.trial[row] - system.trial_previous[row]);
}

using Dofs = std::array<double, 6>;

/// A rigid block with anchors or a dashpot, in the axes of theta*. Its points at the spring's time are linear
/// about theta*, which is O(dt^2) away.
bool step_rigid(BlockSystem &system, std::size_t row, const RigidDof &force, const Step &step) {
  const BlockProperties &p = system.properties[row];
  const RigidDof d = system.displacement[row];
  const RigidDof v = system.velocity[row];
  const RigidDof a = system.acceleration[row];
  const Rotation angle = Rotation::of(system.trial[row].r);
  const Mat2 turn{angle.c, -angle.s, angle.s, angle.c};
  const auto spring_force = [&](const RigidDof &at) -> RigidDof {
    const double ahead = at.r - system.trial[row].r;
    const Mat2 arm = turn * Mat2{1.0, -ahead, ahead, 1.0};
    const AnchorForce sum = anchor_force(system.anchors_of(row), at.u, arm);
    return {sum.u, force_dof(transposed(turn) * sum.gradient).r};
  };

  const Dashpot *dashpot = system.dashpot_of(row);
  const auto beyond = [&](const RigidDof &rate) -> RigidDof {
    if (dashpot == nullptr) {
      return {};
    }
    const Vec2 v_own = transposed(turn)(rate.u);
    const Dofs f = dashpot_force(*dashpot, {v_own.x, v_own.y, rate.r}, transposed(turn)(step.wave));
    return {turn(Vec2{f[0], f[1]}), f[2]};
  };

  const RigidDof base = step.base(d, v, a);
  const RigidDof base_rate = step.base_rate(v, a);
  const RigidDof rest = force + spring_force(base) + beyond(base_rate);
  const Vec2 u = transposed(turn)(rest.u - step.scheme.alpha_m * p.mass * a.u);
  const auto x = solve<3>(system.matrix[system.matrix_begin[row]],
                          {u.x, u.y, rest.r - step.scheme.alpha_m * p.inertia * a.r});
  const RigidDof a_new{turn(Vec2{x[0], x[1]}), x[2]};
  const RigidDof d_new = step.position(d, v, a, a_new);
  const RigidDof v_new = step.velocity(v, a, a_new);
  if (!is_finite(a_new) || !is_finite(v_new) || !is_finite(d_new)) {
    return false;
  }
  note_anchors(system, row,
               spring_force(base + step.spring.coming * a_new) +
                   beyond(base_rate + step.spring.rate_coming * a_new));
  system.acceleration[row] = a_new;
  system.displacement[row] = d_new;
  system.velocity[row] = v_new;
  return true;
}

/// New accelerations of a deformable block and the forces of its own springs that they came with.
struct OwnSolution {
  Vec2 u;
  Mat2 gradient;
  Mat2 internal;
  Mat2 viscous; ///< what beta K adds to it
  AnchorForce anchors;
};

Mat2 gradient_of(const Dofs &x) {
  return motion_matrix({x[2], x[3], x[4], x[5]});
}

/// tr(J stress stretch): minus the torque of a force on F in turning axes.
double moment(const Mat2 &stress, const Mat2 &stretch) {
  const Mat2 product = stress * stretch;
  return product.xy - product.yx;
}

/// Adds a J to the elastic force so that all of it, K e included, has no torque, and its motion to x. Returns
/// a. One linear equation: a J works on r alone, as the force -2 a against it.
double remove_torque(const BlockMatrix &matrix, const Deformation &d, double coming, const Mat2 &stretch,
                     const Mat2 &stress_at_base, Dofs &x) {
  const Dofs &unit = matrix.by_torque;
  const Mat2 stress = stress_at_base + coming * elastic_stress(d, gradient_of(x));
  const double a =
      moment(stress, stretch) /
      (stretch.xx + stretch.yy + 2.0 * coming * moment(elastic_stress(d, gradient_of(unit)), stretch));
  for (std::size_t k = 0; k < 6; ++k) {
    x[k] -= 2.0 * a * unit[k];
  }
  return a;
}

OwnSolution solve_deformable(const BlockSystem &system, std::size_t row, Vec2 force,
                             const Mat2 &gradient_force, const Step &step, bool implicit) {
  const Deformation &d = system.deformation_of(row);
  const BlockMatrix &matrix = system.matrix[system.matrix_begin[row]];
  const Vec2 a = system.acceleration[row].u;
  const Mat2 turn = rotation_of(d.trial);
  const Mat2 back = transposed(turn);
  const Vec2 u_base = step.base(system.displacement[row].u, system.velocity[row].u, a);
  const Mat2 f_base = step.base(d.gradient, d.rate, d.acceleration);
  const Vec2 u_rate = step.base_rate(system.velocity[row].u, a);
  const Mat2 f_rate = step.base_rate(d.rate, d.acceleration);
  const Dashpot *dashpot = system.dashpot_of(row);
  const auto beyond = [&](Vec2 u, const Mat2 &f) -> AnchorForce {
    if (dashpot == nullptr) {
      return {};
    }
    const Vec2 v = back(u);
    const GradientDof g = motion_dof(back * f);
    const Dofs x = dashpot_force(*dashpot, {v.x, v.y, g.r, g.ex, g.ey, g.gxy}, back(step.wave));
    return {turn(Vec2{x[0], x[1]}), turn * force_matrix({x[2], x[3], x[4], x[5]})};
  };
  const auto with_beyond = [&](AnchorForce sum, Vec2 u, const Mat2 &f) {
    const AnchorForce more = beyond(u, f);
    return AnchorForce{sum.u + more.u, sum.gradient + more.gradient};
  };
  const AnchorForce held = with_beyond(anchor_force(system.anchors_of(row), u_base, f_base), u_rate, f_rate);
  Mat2 stress = back * elastic_force(d, d.trial); // in turning axes, at the spring's time so far known
  if (implicit) {
    stress += elastic_stress(d, back * (f_base - d.trial));
  }
  Mat2 viscous = step.stiffness_damping * elastic_stress(d, back * f_rate);

  const double am = step.scheme.alpha_m;
  const Vec2 h_u = back(force + held.u - am * system.properties[row].mass * a);
  const GradientDof h = force_dof(
      back * (gradient_force + held.gradient - am * (d.acceleration * d.second_moment)) - stress - viscous);
  Dofs x = solve<6>(matrix, {h_u.x, h_u.y, h.r, h.ex, h.ey, h.gxy});
  if (implicit) {
    const double coming = step.spring.coming + step.stiffness_damping * step.spring.rate_coming;
    const double no_torque = remove_torque(matrix, d, coming, back * d.trial, stress + viscous, x);
    stress += step.spring.coming * elastic_stress(d, gradient_of(x)) + Mat2{0.0, -no_torque, no_torque, 0.0};
  }

  OwnSolution s;
  s.u = turn(Vec2{x[0], x[1]});
  s.gradient = turn * gradient_of(x);
  s.internal = turn * stress;
  viscous += (step.stiffness_damping * step.spring.rate_coming) * elastic_stress(d, gradient_of(x));
  s.viscous = turn * viscous;
  s.anchors =
      with_beyond(anchor_force(system.anchors_of(row), u_base + step.spring.coming * s.u,
                               f_base + step.spring.coming * s.gradient),
                  u_rate + step.spring.rate_coming * s.u, f_rate + step.spring.rate_coming * s.gradient);
  return s;
}

bool step_deformable(BlockSystem &system, std::size_t row, Vec2 force, const Mat2 &gradient_force,
                     const Step &step, bool implicit) {
  const OwnSolution s = solve_deformable(system, row, force, gradient_force, step, implicit);
  Deformation &d = system.deformation_of(row);
  const Vec2 a = system.acceleration[row].u;
  const Vec2 u_new = step.position(system.displacement[row].u, system.velocity[row].u, a, s.u);
  const Vec2 v_new = step.velocity(system.velocity[row].u, a, s.u);
  const Mat2 f_new = step.position(d.gradient, d.rate, d.acceleration, s.gradient);
  const Mat2 rate_new = step.velocity(d.rate, d.acceleration, s.gradient);
  if (!is_finite(s.u) || !is_finite(u_new) || !is_finite(v_new) || !is_finite(s.gradient) ||
      !is_finite(f_new) || !is_finite(rate_new) || determinant(f_new) <= 0.0) {
    return false;
  }
  if (!system.anchors_of(row).empty() || system.dashpot_of(row) != nullptr) {
    note_anchors(system, row, {s.anchors.u, 0.0});
    system.ledger[row].load_work += 0.5 * contract(s.anchors.gradient, d.trial - d.trial_previous);
    d.anchor_force = s.anchors.gradient;
  }
  if (step.stiffness_damping > 0.0) { // the other half goes with the dashpots of contacts
    d.damping_force += -1.0 * s.viscous;
    system.ledger[row].damping_work -= 0.5 * contract(s.viscous, d.trial - d.trial_previous);
  }
  d.internal = s.internal;
  const double turned = angle_between(d.gradient, f_new);
  d.gradient = f_new;
  d.rate = rate_new;
  d.acceleration = s.gradient;
  system.displacement[row] = {u_new, system.displacement[row].r + turned};
  system.velocity[row] = {v_new, spin_of(f_new, rate_new)};
  system.acceleration[row] = {s.u, spin_rate_of(f_new, rate_new, s.gradient)};
  return true;
}

} // namespace

bool step_by_own_matrix(BlockSystem &system, std::size_t row, const BlockForces &forces, const Scheme &scheme,
                        double time_step, Elasticity elasticity) {
  const Step step{scheme, time_step, spring_time(scheme, time_step), forces.wave, forces.stiffness_damping};
  if (!system.is_deformable(row)) {
    return step_rigid(system, row, forces.rigid[row], step);
  }
  return step_deformable(system, row, forces.rigid[row].u, forces.gradient[system.deformation_begin[row]],
                         step, elasticity_of(scheme, elasticity) == Elasticity::implicit);
}

} // namespace gcpdda
