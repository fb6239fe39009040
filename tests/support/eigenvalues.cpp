#include "support/eigenvalues.hpp"

#include "gcpdda/dynamics/eigenvalues.hpp"

#include <Eigen/Eigenvalues>

namespace gcpdda::testing {

double spectral_radius(const Eigen::MatrixXd &matrix) {
  return gcpdda::spectral_radius({matrix.data(), static_cast<std::size_t>(matrix.size())});
}

// By way of the tridiagonal matrix: a solver that could give eigenvectors too takes the compiler a quarter of
// a minute.
Eigen::VectorXd squared_frequencies(const Eigen::MatrixXd &stiffness, const Eigen::VectorXd &mass) {
  const Eigen::VectorXd scale = mass.cwiseSqrt().cwiseInverse();
  const Eigen::Tridiagonalization<Eigen::MatrixXd> tridiagonal(scale.asDiagonal() * stiffness *
                                                               scale.asDiagonal());
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver;
  solver.computeFromTridiagonal(tridiagonal.diagonal(), tridiagonal.subDiagonal(), Eigen::EigenvaluesOnly);
  return solver.eigenvalues();
}

} // namespace gcpdda::testing
