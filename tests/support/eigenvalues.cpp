#include "eigenvalues.hpp"

#include "dynamics/eigenvalues.hpp"

#include <Eigen/Eigenvalues>

#include <complex>

namespace gcpdda::testing {

double spectral_radius(const Eigen::MatrixXd &matrix) {
  return gcpdda::spectral_radius({matrix.data(), static_cast<std::size_t>(matrix.size())});
}

// Without eigenvectors, as gcpdda::spectral_radius does.
Eigen::VectorXcd eigenvalues(const Eigen::MatrixXd &matrix) {
  const Eigen::Index n = matrix.rows();
  const double scale = matrix.cwiseAbs().maxCoeff();
  const Eigen::HessenbergDecomposition<Eigen::MatrixXd> hessenberg(matrix / scale);
  Eigen::RealSchur<Eigen::MatrixXd> schur(n);
  schur.computeFromHessenberg(hessenberg.matrixH(), Eigen::MatrixXd(), false);
  const Eigen::MatrixXd &t = schur.matrixT();
  Eigen::VectorXcd values(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    if (i + 1 == n || t(i + 1, i) == 0.0) {
      values(i) = scale * t(i, i);
      continue;
    }
    const double mean = 0.5 * (t(i, i) + t(i + 1, i + 1));
    const double half = 0.5 * (t(i, i) - t(i + 1, i + 1));
    const std::complex<double> root =
        std::sqrt(std::complex<double>(half * half + t(i + 1, i) * t(i, i + 1)));
    values(i) = scale * (mean + root);
    values(i + 1) = scale * (mean - root);
    ++i;
  }
  return values;
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
