#include "dynamics/own_springs.hpp"

#include "dynamics/block_matrix.hpp"

#include <algorithm>
#include <cmath>

namespace gcpdda {

SpringTime spring_time(const Scheme &s, double time_step) {
  const double square = time_step * time_step;
  const double at = 1.0 - s.alpha_f;
  const double by_old = at * (1.0 - s.gamma) * time_step;
  const double by_coming = at * s.gamma * time_step;
  if (is_explicit(s)) {
    return {s.trial_velocity * time_step, (s.trial_acceleration + 0.5 * s.alpha_m) * square,
            0.5 * (1.0 - s.alpha_m) * square, by_old, by_coming};
  }
  return {at * time_step, at * (0.5 - s.beta) * square, at * s.beta * square, by_old, by_coming};
}

AnchorForce anchor_force(std::span<const Anchor> anchors, Vec2 u, const Mat2 &arm) {
  AnchorForce sum;
  const Mat2 turned = arm - Mat2::identity();
  for (const Anchor &anchor : anchors) {
    const Vec2 force = -anchor.stiffness * (u + turned(anchor.point) - anchor.held);
    sum.u += force;
    sum.gradient += outer(force, anchor.point);
  }
  return sum;
}

namespace {

using Packed = std::array<double, 21>;

/// Of DDA's simplex integrals, about the centroid.
void add_mass(const BlockSystem &system, std::size_t row, double share, Packed &matrix) {
  const BlockProperties &p = system.properties[row];
  matrix[packed(0, 0)] += share * p.mass;
  matrix[packed(1, 1)] += share * p.mass;
  matrix[packed(2, 2)] += share * p.inertia;
  if (!system.is_deformable(row)) {
    return;
  }
  const Mat2 &s = system.deformation_of(row).second_moment;
  matrix[packed(3, 2)] -= share * s.xy;
  matrix[packed(4, 2)] += share * s.xy;
  matrix[packed(5, 2)] += share * 0.5 * (s.xx - s.yy);
  matrix[packed(3, 3)] += share * s.xx;
  matrix[packed(4, 4)] += share * s.yy;
  matrix[packed(5, 3)] += share * 0.5 * s.xy;
  matrix[packed(5, 4)] += share * 0.5 * s.xy;
  matrix[packed(5, 5)] += share * 0.25 * (s.xx + s.yy);
}

void add_elasticity(const Deformation &d, double share, Packed &matrix) {
  matrix[packed(3, 3)] += share * d.stiffness_direct;
  matrix[packed(4, 3)] += share * d.stiffness_cross;
  matrix[packed(4, 4)] += share * d.stiffness_direct;
  matrix[packed(5, 5)] += share * d.stiffness_shear;
}

/// p T^T T: springs that are alike in all directions are so in turning axes too.
void add_anchor(const Anchor &anchor, double share, Packed &matrix) {
  const Vec2 x = anchor.point;
  const std::array<Vec2, 6> column{
      {{1.0, 0.0}, {0.0, 1.0}, {-x.y, x.x}, {x.x, 0.0}, {0.0, x.y}, {0.5 * x.y, 0.5 * x.x}}};
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      matrix[packed(i, j)] += share * anchor.stiffness * dot(column[i], column[j]);
    }
  }
}

/// Stiffness of a row's anchors, Pa.
double anchor_stiffness(const BlockSystem &system, std::size_t row, double normal_stiffness) {
  constexpr double anchor_over_block = 100.0;
  const double area = system.properties[row].area;
  double stiffness = normal_stiffness * std::sqrt(area);
  if (system.is_deformable(row)) {
    stiffness = std::max(stiffness, system.deformation_of(row).stiffness_direct / area);
  }
  return anchor_over_block * stiffness;
}

BlockMatrix own_matrix(const BlockSystem &system, std::size_t row, const Scheme &scheme, double time_step,
                       Elasticity elasticity, double stiffness_damping) {
  const SpringTime time = spring_time(scheme, time_step);
  const double coming = time.coming;
  Packed matrix{};
  add_mass(system, row, 1.0 - scheme.alpha_m, matrix);
  if (system.is_deformable(row)) {
    const Deformation &d = system.deformation_of(row);
    if (elasticity_of(scheme, elasticity) == Elasticity::implicit) {
      add_elasticity(d, coming, matrix);
    }
    add_elasticity(d, stiffness_damping * time.rate_coming, matrix);
  }
  for (const Anchor &anchor : system.anchors_of(row)) {
    add_anchor(anchor, coming, matrix);
  }
  if (const Dashpot *dashpot = system.dashpot_of(row)) {
    for (std::size_t k = 0; k < matrix.size(); ++k) {
      matrix[k] += time.rate_coming * dashpot->damping[k];
    }
  }
  if (!system.is_deformable(row)) {
    return factorise<3>(matrix);
  }
  BlockMatrix factors = factorise<6>(matrix);
  factors.by_torque = solve<6>(factors, {0.0, 0.0, 1.0, 0.0, 0.0, 0.0});
  return factors;
}

} // namespace

HeldAcceleration accelerate_held(const BlockSystem &system, std::size_t row, const RigidDof &force,
                                 const Mat2 &gradient_force) {
  constexpr double penalty_over_mass = 1e6;
  Packed matrix{};
  add_mass(system, row, 1.0, matrix);
  for (Anchor anchor : system.anchors_of(row)) {
    anchor.stiffness = 1.0;
    add_anchor(anchor, penalty_over_mass * system.properties[row].mass, matrix);
  }
  if (!system.is_deformable(row)) {
    const Rotation angle = Rotation::of(system.trial[row].r);
    const Mat2 turn{angle.c, -angle.s, angle.s, angle.c};
    const Vec2 u = transposed(turn)(force.u);
    const auto x = solve<3>(factorise<3>(matrix), {u.x, u.y, force.r});
    return {{turn(Vec2{x[0], x[1]}), x[2]}, {}};
  }
  const Mat2 turn = rotation_of(system.deformation_of(row).trial);
  const Vec2 u = transposed(turn)(force.u);
  const GradientDof h = force_dof(transposed(turn) * gradient_force);
  const auto x = solve<6>(factorise<6>(matrix), {u.x, u.y, h.r, h.ex, h.ey, h.gxy});
  return {{turn(Vec2{x[0], x[1]}), 0.0}, turn * motion_matrix({x[2], x[3], x[4], x[5]})};
}

void stiffen_anchors(BlockSystem &system, double normal_stiffness) {
  for (std::size_t row = 0; row < system.num_rows(); ++row) {
    for (std::size_t k = system.anchor_begin[row]; k < system.anchor_begin[row + 1]; ++k) {
      Anchor &anchor = system.anchor[k];
      if (anchor.stiffness == 0.0) {
        anchor.stiffness = anchor_stiffness(system, row, normal_stiffness);
      }
    }
  }
}

void make_block_matrices(BlockSystem &system, const Scheme &scheme, double time_step, Elasticity elasticity,
                         double normal_stiffness, double stiffness_damping) {
  stiffen_anchors(system, normal_stiffness);
  system.matrix_begin.clear();
  system.matrix.clear();
  for (std::size_t row = 0; row < system.num_rows(); ++row) {
    if (!system.properties[row].keeps_its_velocity() &&
        (!system.anchors_of(row).empty() || system.dashpot_of(row) != nullptr)) {
      system.matrix.push_back(own_matrix(system, row, scheme, time_step, elasticity, stiffness_damping));
    }
    system.matrix_begin.push_back(static_cast<std::uint32_t>(system.matrix.size()));
  }
}

} // namespace gcpdda
