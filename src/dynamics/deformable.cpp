#include "dynamics/deformable.hpp"

#include <cmath>

namespace gcpdda {

namespace {

double small_arctangent(double x) {
  const double q = x * x;
  return x * (1.0 - q * (1.0 / 3.0 - q * (1.0 / 5.0 - q * (1.0 / 7.0 - q * (1.0 / 9.0 - q * (1.0 / 11.0))))));
}

} // namespace

Mat2 rotation_of(const Mat2 &gradient) {
  const double c = gradient.xx + gradient.yy;
  const double s = gradient.yx - gradient.xy;
  const double unit = 1.0 / std::sqrt(c * c + s * s);
  return {unit * c, -unit * s, unit * s, unit * c};
}

double angle_of(const Mat2 &gradient) {
  return angle_between(Mat2::identity(), gradient);
}

double angle_between(const Mat2 &from, const Mat2 &to) {
  const Vec2 a{from.xx + from.yy, from.yx - from.xy};
  const Vec2 b{to.xx + to.yy, to.yx - to.xy};
  const double along = dot(a, b);
  const double ratio = cross(a, b) / along;
  if (along > 0.0 && std::abs(ratio) <= largest_ratio_of_series) {
    return small_arctangent(ratio);
  }
  return std::atan2(cross(a, b), along);
}

double spin_of(const Mat2 &gradient, const Mat2 &rate) {
  return motion_dof(rate * inverse(gradient)).r;
}

double spin_of(const BlockSystem &system, std::size_t row) {
  if (!system.is_deformable(row)) {
    return system.velocity[row].r;
  }
  const Deformation &d = system.deformation_of(row);
  return spin_of(d.gradient, d.rate);
}

Mat2 elastic_stress(const Deformation &d, const Mat2 &strain) {
  const double shear = d.stiffness_shear * (strain.xy + strain.yx);
  return {d.stiffness_direct * strain.xx + d.stiffness_cross * strain.yy, shear, shear,
          d.stiffness_cross * strain.xx + d.stiffness_direct * strain.yy};
}

Mat2 elastic_force(const Deformation &d, const Mat2 &gradient) {
  const Mat2 turn = rotation_of(gradient);
  const Mat2 stretch = transposed(turn) * gradient;
  const Mat2 stress = elastic_stress(d, stretch - Mat2::identity() + d.initial_strain);
  const Mat2 product = stress * stretch;
  const double no_torque = (product.xy - product.yx) / (stretch.xx + stretch.yy);
  return turn * Mat2{stress.xx, stress.xy - no_torque, stress.yx + no_torque, stress.yy};
}

double strain_energy(const Deformation &d, const Mat2 &gradient) {
  const Mat2 strain = transposed(rotation_of(gradient)) * gradient - Mat2::identity() + d.initial_strain;
  return 0.5 * contract(elastic_stress(d, strain), strain);
}

double applied_strain_energy(const Deformation &d) {
  const GradientDof h = force_dof(transposed(rotation_of(d.trial)) * d.internal);
  const double a = d.stiffness_direct;
  const double b = d.stiffness_cross;
  return 0.5 * ((a * (h.ex * h.ex + h.ey * h.ey) - 2.0 * b * h.ex * h.ey) / (a * a - b * b) +
                h.gxy * h.gxy / d.stiffness_shear);
}

double kinetic_energy(const Deformation &d, const Mat2 &rate) {
  return 0.5 * contract(rate * d.second_moment, rate);
}

Mat2 strain_under(const Deformation &d, const Mat2 &force) {
  const double a = d.stiffness_direct;
  const double b = d.stiffness_cross;
  const double both = a * a - b * b;
  const double shear = 0.5 * force.xy / d.stiffness_shear;
  return {(a * force.xx - b * force.yy) / both, shear, shear, (a * force.yy - b * force.xx) / both};
}

std::array<double, 3> mean_cauchy_stress(const Deformation &d, double area) {
  const Mat2 stress = (1.0 / (area * determinant(d.trial))) * (d.internal * transposed(d.trial));
  return {stress.xx, stress.yy, 0.5 * (stress.xy + stress.yx)};
}

} // namespace gcpdda
