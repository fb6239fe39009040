#pragma once

// Eigenvalues for tests and studies, in one place: their templates take the compiler half a minute.

#include <Eigen/Core>

namespace gcpdda::testing {

/// Largest absolute eigenvalue of a square matrix.
double spectral_radius(const Eigen::MatrixXd &matrix);

/// lambda of stiffness x = lambda mass x, ascending; both symmetric, mass positive definite.
Eigen::VectorXd squared_frequencies(const Eigen::MatrixXd &stiffness, const Eigen::MatrixXd &mass);

} // namespace gcpdda::testing
