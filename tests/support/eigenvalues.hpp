#pragma once

#include <Eigen/Core>

namespace gcpdda::testing {

/// Largest absolute eigenvalue of a square matrix.
double spectral_radius(const Eigen::MatrixXd &matrix);

/// lambda of stiffness x = lambda mass x, ascending; stiffness symmetric, mass the diagonal of its matrix.
Eigen::VectorXd squared_frequencies(const Eigen::MatrixXd &stiffness, const Eigen::VectorXd &mass);

/// All eigenvalues of a square matrix.
Eigen::VectorXcd eigenvalues(const Eigen::MatrixXd &matrix);

} // namespace gcpdda::testing
