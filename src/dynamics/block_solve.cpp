#include "dynamics/block_solve.hpp"

#include "dynamics/block_matrix.hpp"
#include "dynamics/deformable.hpp"
#include "dynamics/own_springs.hpp"
#include "dynamics/viscous_sides.hpp"

#include <array>
#include <cmath>
#include <optional>

namespace gcpdda {

namespace {

bool is_finite(const Vec2 &a) {
  return std::isfinite(a.x) && std::isfinite(a.y);
}
bool is_finite(const RigidDof &a) {
  return is_finite(a.u) && std::isfinite(a.r);
}

/// Their work goes by the trapezoid over increments of x*: this half now, the other after the next predict().
void note_anchors(BlockSystem &system, std::size_t row, const RigidDof &force) {
  system.applied_to(row)->anchor = force;
  system.ledger[row].load += 0.5 * work(force, system.motion[row].increment());
}

using Dofs = std::array<double, 6>;

/// A rigid block with anchors or a dashpot, in the axes of theta*. Its points at the spring's time are linear
/// about theta*, which is O(dt^2) away.
bool step_rigid(BlockSystem &system, std::size_t row, const RigidDof &force, const BlockSolve &step) {
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

/// Anchors and dashpots of a deformable row, as they are before its step.
class OwnSprings {
public:
  OwnSprings(const BlockSystem &system, std::size_t row, const BlockSolve &step)
      : anchors_(system.anchors_of(row)), dashpot_(system.dashpot_of(row)), step_(step) {
    const Deformation &d = system.deformation_of(row);
    const Vec2 a = system.acceleration[row].u;
    turn_ = rotation_of(d.trial);
    u_ = step.base(system.displacement[row].u, system.velocity[row].u, a);
    gradient_ = step.base(d.gradient, d.rate, d.acceleration);
    u_rate_ = step.base_rate(system.velocity[row].u, a);
    gradient_rate_ = step.base_rate(d.rate, d.acceleration);
  }

  /// Under the coming accelerations.
  [[nodiscard]] AnchorForce force(Vec2 a, const Mat2 &gradient) const {
    const SpringTime &time = step_.spring;
    return force(u_ + time.coming * a, gradient_ + time.coming * gradient, u_rate_ + time.rate_coming * a,
                 gradient_rate_ + time.rate_coming * gradient);
  }
  /// So far.
  [[nodiscard]] AnchorForce force() const { return force(u_, gradient_, u_rate_, gradient_rate_); }

private:
  [[nodiscard]] AnchorForce force(Vec2 u, const Mat2 &gradient, Vec2 u_rate,
                                  const Mat2 &gradient_rate) const {
    AnchorForce sum = anchor_force(anchors_, u, gradient);
    if (dashpot_ != nullptr) {
      const Mat2 back = transposed(turn_);
      const Vec2 v = back(u_rate);
      const GradientDof g = motion_dof(back * gradient_rate);
      const Dofs x = dashpot_force(*dashpot_, {v.x, v.y, g.r, g.ex, g.ey, g.gxy}, back(step_.wave));
      sum.u += turn_(Vec2{x[0], x[1]});
      sum.gradient += turn_ * force_matrix({x[2], x[3], x[4], x[5]});
    }
    return sum;
  }

  std::span<const Anchor> anchors_;
  const Dashpot *dashpot_;
  const BlockSolve &step_;
  Mat2 turn_;
  Vec2 u_; // at the spring's time so far known
  Mat2 gradient_;
  Vec2 u_rate_;
  Mat2 gradient_rate_;
};

/// Anchors of a deformable row of which the new state is known.
void note_springs(BlockSystem &system, std::size_t row, const OwnSprings &springs) {
  Deformation &d = system.deformation_of(row);
  const AnchorForce force = springs.force(system.acceleration[row].u, d.acceleration);
  note_anchors(system, row, {force.u, 0.0});
  system.ledger[row].load += 0.5 * contract(force.gradient, system.gradient_increment(row));
  d.anchor_force = force.gradient;
}

/// The other half goes with the dashpots of contacts.
void note_viscous(BlockSystem &system, std::size_t row, const Mat2 &viscous) {
  Deformation &d = system.deformation_of(row);
  d.contact.damping += -1.0 * viscous;
  system.ledger[row].damping -= 0.5 * contract(viscous, system.gradient_increment(row));
}

void note_local_damping(BlockSystem &system, std::size_t row, const AnchorForce &damped, double half_work) {
  BlockContactSum &sum = system.contact[row];
  BlockGradientSum &on_gradient = system.deformation_of(row).contact;
  sum.force.u += damped.u;
  sum.damping.u += damped.u;
  on_gradient.force += damped.gradient;
  on_gradient.damping += damped.gradient;
  system.ledger[row].damping += half_work;
}

/// Deformable rows on their way to the lanes, those on springs of their own apart from others.
class DeformableSteps {
public:
  DeformableSteps(BlockSystem &system, const BlockSolve &step, double safe_motion, AdvanceReport &report,
                  Instructions instructions)
      : system_(system), step_(step), safe_motion_(safe_motion), report_(report),
        block_lanes_(block_lanes(instructions)) {
    held_.are_held = true;
  }

  void add(std::size_t row) {
    DeformableLanes &lanes = system_.has_matrix(row) ? held_ : free_;
    const std::size_t i = lanes.count++;
    lanes.row[i] = row;
    if (lanes.are_held) {
      lanes.held[i] = springs_[i].emplace(system_, row, step_).force();
    }
    if (lanes.count == block_lanes_.width) {
      flush(lanes);
    }
  }
  void flush() {
    flush(free_);
    flush(held_);
  }

private:
  void flush(DeformableLanes &lanes) {
    if (lanes.count == 0) {
      return;
    }
    const unsigned broken = block_lanes_.step_deformables(system_, lanes, step_);
    for (std::size_t i = 0; i < lanes.count; ++i) {
      const std::size_t row = lanes.row[i];
      if (!(lanes.most_motion[i] <= safe_motion_)) {
        report_.rows_to_check.push_back({row, row + 1});
      }
      if ((broken >> i & 1U) != 0) {
        report_.add_broken(row);
        continue;
      }
      report_.add_turn(std::abs(lanes.turned[i]));
      if (lanes.are_held) {
        note_springs(system_, row, *springs_[i]);
      }
      if (step_.local_damping > 0.0) {
        note_local_damping(system_, row, lanes.damped[i], lanes.damped_work[i]);
      }
      if (step_.stiffness_damping > 0.0) {
        note_viscous(system_, row, lanes.viscous[i]);
      }
    }
    lanes.count = 0;
  }

  BlockSystem &system_;
  const BlockSolve &step_;
  double safe_motion_;
  AdvanceReport &report_;
  const BlockLanes &block_lanes_;
  DeformableLanes free_;
  DeformableLanes held_;
  std::array<std::optional<OwnSprings>, most_lanes> springs_; ///< of held_
};

} // namespace

BlockSolve block_solve(const OwnForces &forces, const Scheme &scheme, double time_step,
                       Elasticity elasticity) {
  return {scheme,
          time_step,
          spring_time(scheme, time_step),
          forces.wave,
          forces.stiffness_damping,
          forces.local_damping,
          elasticity_of(scheme, elasticity) == Elasticity::implicit};
}

void solve_by_matrix(BlockSystem &system, const BlockSolve &step, std::size_t first, std::size_t last,
                     double safe_motion, AdvanceReport &report, Instructions instructions) {
  if (system.matrix.empty() && system.deformation.empty()) {
    return;
  }
  DeformableSteps deformables(system, step, safe_motion, report, instructions);
  for (std::size_t row = first; row < last; ++row) {
    if (deforms_freely(system, row)) {
      deformables.add(row);
    } else if (system.has_matrix(row) && !step_rigid(system, row, system.contact[row].force, step)) {
      report.add_broken(row);
    }
  }
  deformables.flush();
}

} // namespace gcpdda
