#include "jointed_bar.hpp"

#include "eigenvalues.hpp"
#include "setting.hpp"

#include <cmath>

namespace gcpdda::testing {

// Unknowns u_i and e_i L.
double jointed_bar_frequency(int num_blocks, double youngs_modulus, double joint_stiffness) {
  const int n = num_blocks;
  Eigen::VectorXd mass(2 * n);
  Eigen::MatrixXd stiffness = Eigen::MatrixXd::Zero(2 * n, 2 * n);
  for (int i = 0; i < n; ++i) {
    mass(2 * i) = rock_density;
    mass(2 * i + 1) = rock_density / 12.0;
    stiffness(2 * i + 1, 2 * i + 1) += youngs_modulus;
  }
  for (int joint = 0; joint <= n; ++joint) {
    Eigen::VectorXd closing = Eigen::VectorXd::Zero(2 * n);
    if (joint > 0) {
      closing.segment(2 * joint - 2, 2) << 1.0, 0.5;
    }
    if (joint < n) {
      closing.segment(2 * joint, 2) << -1.0, 0.5;
    }
    stiffness += joint_stiffness * closing * closing.transpose();
  }
  return std::sqrt(squared_frequencies(stiffness, mass)(0));
}

} // namespace gcpdda::testing
