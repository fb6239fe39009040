#include "gcpdda/dynamics/frequency_bound.hpp"

#include <Eigen/Dense>

namespace gcpdda {

double contact_frequency_bound(const BlockSystem &system, std::size_t row, double normal_stiffness,
                               double tangential_stiffness) {
  Eigen::Matrix3d stiffness = Eigen::Matrix3d::Zero();
  for (std::size_t k = system.vertex_begin[row]; k < system.vertex_begin[row + 1]; ++k) {
    const Vec2 n = system.reference_normal[k];
    const Vec2 t = perp(n);
    const Vec2 a = system.reference_vertex[k];
    // b is linear along the edge, so two Gauss points integrate b b^T exactly.
    for (const double gauss : {-1.0, 1.0}) {
      const Vec2 x = a + (0.5 + gauss / std::sqrt(12.0)) * system.edge_length[k] * t;
      const Eigen::Vector3d b_n(n.x, n.y, cross(x, n));
      const Eigen::Vector3d b_t(t.x, t.y, cross(x, t));
      const double weight = 0.5 * system.edge_length[k];
      stiffness +=
          weight * (normal_stiffness * b_n * b_n.transpose() + tangential_stiffness * b_t * b_t.transpose());
    }
  }
  const BlockProperties &p = system.properties[row];
  const Eigen::Vector3d scale(1.0 / std::sqrt(p.mass), 1.0 / std::sqrt(p.mass), 1.0 / std::sqrt(p.inertia));
  const Eigen::Matrix3d scaled = scale.asDiagonal() * stiffness * scale.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(scaled, Eigen::EigenvaluesOnly);
  return 2.0 * solver.eigenvalues().maxCoeff();
}

} // namespace gcpdda
