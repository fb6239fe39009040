#include "dynamics/frequency_bound.hpp"

#include <Eigen/Eigenvalues>

#include <array>
#include <cmath>

namespace gcpdda {

namespace {

double rigid_bound(const BlockSystem &system, std::size_t row, double normal_stiffness,
                   double tangential_stiffness, std::span<const PointSpring> springs) {
  Eigen::Matrix3d stiffness = Eigen::Matrix3d::Zero();
  for (std::size_t k = system.vertex_begin[row]; k < system.vertex_begin[row + 1]; ++k) {
    const Vec2 n = system.reference_normal[k];
    const Vec2 t = perp(n);
    const Vec2 a = system.reference_vertex[k];
    const double length = reference_length(system, row, k - system.vertex_begin[row]);
    // b is linear along the edge, so two Gauss points integrate b b^T exactly.
    for (const double gauss : {-1.0, 1.0}) {
      const Vec2 x = a + (0.5 + gauss / std::sqrt(12.0)) * length * t;
      const Eigen::Vector3d b_n(n.x, n.y, cross(x, n));
      const Eigen::Vector3d b_t(t.x, t.y, cross(x, t));
      const double weight = 0.5 * length;
      stiffness +=
          weight * (normal_stiffness * b_n * b_n.transpose() + tangential_stiffness * b_t * b_t.transpose());
    }
  }
  for (const PointSpring &spring : springs) {
    for (const Vec2 d : {Vec2{1.0, 0.0}, Vec2{0.0, 1.0}}) {
      const Eigen::Vector3d b(d.x, d.y, cross(spring.point, d));
      stiffness += spring.stiffness * b * b.transpose();
    }
  }
  const BlockProperties &p = system.properties[row];
  const Eigen::Vector3d scale(1.0 / std::sqrt(p.mass), 1.0 / std::sqrt(p.mass), 1.0 / std::sqrt(p.inertia));
  const Eigen::Matrix3d scaled = scale.asDiagonal() * stiffness * scale.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(scaled, Eigen::EigenvaluesOnly);
  return 2.0 * solver.eigenvalues().maxCoeff();
}

/// int (k_n b_n b_n^T + k_t b_t b_t^T) ds over a deformable block's boundary; unknowns (u, F11, F12, F21,
/// F22), in which a traction d at X works as (d, d X^T).
using Matrix6 = Eigen::Matrix<double, 6, 6>;
void add_spring(double spring, Vec2 d, Vec2 x, Matrix6 &stiffness) {
  Eigen::Matrix<double, 6, 1> b;
  b << d.x, d.y, d.x * x.x, d.x * x.y, d.y * x.x, d.y * x.y;
  stiffness += spring * b * b.transpose();
}
Matrix6 boundary_stiffness(std::span<const Vec2> vertices, double normal_stiffness,
                           double tangential_stiffness) {
  Matrix6 stiffness = Matrix6::Zero();
  for (std::size_t k = 0; k < vertices.size(); ++k) {
    const Vec2 edge = vertices[(k + 1) % vertices.size()] - vertices[k];
    const double length = norm(edge);
    const Vec2 t = (1.0 / length) * edge;
    for (const double gauss : {-1.0, 1.0}) { // as above
      const Vec2 x = vertices[k] + (0.5 + gauss / std::sqrt(12.0)) * edge;
      add_spring(0.5 * length * normal_stiffness, -perp(t), x, stiffness);
      add_spring(0.5 * length * tangential_stiffness, t, x, stiffness);
    }
  }
  return stiffness;
}

/// L^-1 K L^-T of a deformable block's mass L L^T, which couples F11 with F12 and F21 with F22 only: what the
/// eigenvalues of M^-1 K are those of. The upper triangle of K is not read.
Matrix6 over_mass(const Matrix6 &stiffness, double mass, const Mat2 &second_moment) {
  const double l_u = std::sqrt(mass);
  const double l_xx = std::sqrt(second_moment.xx);
  const double l_yx = second_moment.yx / l_xx;
  const double l_yy = std::sqrt(second_moment.yy - l_yx * l_yx);
  const std::array<double, 6> inverse{1.0 / l_u, 1.0 / l_u, 1.0 / l_xx, 1.0 / l_yy, 1.0 / l_xx, 1.0 / l_yy};
  Matrix6 scaled = stiffness.selfadjointView<Eigen::Lower>();
  const auto solve = [&](auto &&row) { // row(i) of L^-1 times what has these rows
    for (const Eigen::Index i : {0, 1, 2, 3, 4, 5}) {
      if (i == 3 || i == 5) {
        row(i) -= l_yx * row(i - 1);
      }
      row(i) *= inverse[static_cast<std::size_t>(i)];
    }
  };
  solve([&](Eigen::Index i) { return scaled.row(i); });
  solve([&](Eigen::Index i) { return scaled.col(i); });
  return scaled;
}

/// Of a symmetric matrix. The steps of Eigen::SelfAdjointEigenSolver and its bits, without those for
/// eigenvectors: they take the compiler three times as long as all the rest.
double largest_eigenvalue(const Matrix6 &matrix) {
  const double scale = Matrix6(matrix.triangularView<Eigen::Lower>()).cwiseAbs().maxCoeff();
  const Eigen::Tridiagonalization<Matrix6> tridiagonal(matrix / scale);
  Eigen::SelfAdjointEigenSolver<Matrix6> solver;
  solver.computeFromTridiagonal(tridiagonal.diagonal(), tridiagonal.subDiagonal(), Eigen::EigenvaluesOnly);
  return scale * solver.eigenvalues().maxCoeff();
}

double deformable_bound(const BlockSystem &system, std::size_t row, double normal_stiffness,
                        double tangential_stiffness, Elasticity elasticity,
                        std::span<const PointSpring> springs) {
  const Deformation &d = system.deformation_of(row);
  Matrix6 stiffness = 2.0 * boundary_stiffness(system.of_row(system.reference_vertex, row), normal_stiffness,
                                               tangential_stiffness);
  for (const PointSpring &spring : springs) {
    add_spring(2.0 * spring.stiffness, {1.0, 0.0}, spring.point, stiffness);
    add_spring(2.0 * spring.stiffness, {0.0, 1.0}, spring.point, stiffness);
  }
  if (elasticity == Elasticity::explicit_) {
    Eigen::Matrix<double, 3, 4> strain; // eps_x, eps_y, gamma_xy of F - I
    strain << 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.0;
    Eigen::Matrix3d elastic;
    elastic << d.stiffness_direct, d.stiffness_cross, 0.0, d.stiffness_cross, d.stiffness_direct, 0.0, 0.0,
        0.0, d.stiffness_shear;
    stiffness.bottomRightCorner<4, 4>() += strain.transpose() * elastic * strain;
  }
  return largest_eigenvalue(over_mass(stiffness, system.properties[row].mass, d.second_moment));
}

} // namespace

double contact_frequency_bound(const BlockSystem &system, std::size_t row, double normal_stiffness,
                               double tangential_stiffness, Elasticity elasticity,
                               std::span<const PointSpring> springs) {
  if (system.properties[row].keeps_its_velocity()) {
    return 0.0;
  }
  return system.is_deformable(row)
             ? deformable_bound(system, row, normal_stiffness, tangential_stiffness, elasticity, springs)
             : rigid_bound(system, row, normal_stiffness, tangential_stiffness, springs);
}

} // namespace gcpdda
