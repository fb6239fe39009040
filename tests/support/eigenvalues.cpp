#include "support/eigenvalues.hpp"

#include <Eigen/Eigenvalues>

namespace gcpdda::testing {

double spectral_radius(const Eigen::MatrixXd &matrix) {
  return matrix.eigenvalues().cwiseAbs().maxCoeff();
}

Eigen::VectorXd squared_frequencies(const Eigen::MatrixXd &stiffness, const Eigen::MatrixXd &mass) {
  return Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd>(stiffness, mass, Eigen::EigenvaluesOnly)
      .eigenvalues();
}

} // namespace gcpdda::testing
