#include "dynamics/eigenvalues.hpp"

#include "base/check.hpp"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <limits>

namespace gcpdda {

namespace {

/// Of the 2x2 block of a quasi-triangular matrix from row i on, whose eigenvalues are a complex pair.
double modulus_of_pair(const Eigen::MatrixXd &t, Eigen::Index i) {
  const double p = 0.5 * (t(i, i) - t(i + 1, i + 1));
  const double scale = std::max({std::abs(p), std::abs(t(i + 1, i)), std::abs(t(i, i + 1))});
  const double product = (t(i + 1, i) / scale) * (t(i, i + 1) / scale);
  const double imaginary = scale * std::sqrt(std::abs((p / scale) * (p / scale) + product));
  return std::hypot(t(i + 1, i + 1) + p, imaginary);
}

} // namespace

// The steps of Eigen::EigenSolver and its bits, without those for eigenvectors: they take the compiler three
// times as long as all the rest.
double spectral_radius(std::span<const double> matrix) {
  const auto n = static_cast<Eigen::Index>(std::lround(std::sqrt(static_cast<double>(matrix.size()))));
  expect(n > 0 && static_cast<std::size_t>(n * n) == matrix.size(), "a square matrix");
  const Eigen::Map<const Eigen::MatrixXd> given(matrix.data(), n, n);
  const double scale = given.cwiseAbs().maxCoeff();
  if (scale < std::numeric_limits<double>::min()) {
    return 0.0;
  }
  const Eigen::HessenbergDecomposition<Eigen::MatrixXd> hessenberg(given / scale);
  Eigen::RealSchur<Eigen::MatrixXd> schur(n);
  schur.computeFromHessenberg(hessenberg.matrixH(), Eigen::MatrixXd(), false);
  const Eigen::MatrixXd t = scale * schur.matrixT();
  double largest = 0.0;
  for (Eigen::Index i = 0; i < n; ++i) {
    const bool is_pair = i + 1 < n && t(i + 1, i) != 0.0;
    largest = std::max(largest, is_pair ? modulus_of_pair(t, i) : std::abs(t(i, i)));
    i += is_pair ? 1 : 0;
  }
  return largest;
}

} // namespace gcpdda
