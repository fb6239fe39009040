#pragma once

// A column of two deformable blocks between fixed plates, with three parallel joints under load: what a small
// motion does, with friction where the program has it and where it was rejected.

#include "support/base_state.hpp"

#include <Eigen/Core>

#include <vector>

namespace gcpdda::study {

/// Where friction acts and its elongation is taken.
enum class ActsAt { grip, centre_of_pressure };

struct ColumnProblem {
  double joint_angle_deg = 0.0;
  double softness = 1.0;    ///< k_n L/E
  double shear_ratio = 0.0; ///< T/N of every joint; positive as under compression along the column
  double damping_ratio = 0.0;
};

/// Unknowns as in testing::BaseState. The loads are dead and balance the column where it is.
///
/// Friction at the centre of pressure is the study's own: normal forces and the regions come from the program
/// with a frictionless law, and F_t += k_t b . dy, f = -F_t b with b at the region's x_r along its t_r, for
/// motions so small that b may be linear in them.
class ShearedColumn {
public:
  static constexpr double normal_stiffness = 1e10; ///< Pa/m
  static constexpr double size = 1.0;              ///< L: height and width of the column's blocks, m
  static constexpr double overlap = 1e-5;          ///< of the joints, m

  ShearedColumn(const ColumnProblem &problem, ActsAt acts_at);

  /// Of the joints' opening as one, sqrt(k_n/(rho L)), rad/s.
  static double joint_frequency();
  /// Largest growth rate of a mode, 1/s, of y'' + C y' + K y = 0; 0 where none grows beyond rounding.
  double growth();
  /// The same from a run of the leapfrog from a small random motion.
  double measured_growth(unsigned seed, int num_steps);

private:
  [[nodiscard]] testing::BaseState make_state(const ColumnProblem &problem) const;
  void find_dashpots(double damping_ratio);
  /// Of contacts with friction, after a way from `from`, with the springs' elongations at its end.
  Eigen::VectorXd force_of_wandering_friction(const Eigen::VectorXd &from, const Eigen::VectorXd &to,
                                              std::vector<double> &shear);
  Eigen::MatrixXd stiffness();
  [[nodiscard]] Eigen::VectorXd slide_at(const RegionForce &region, Vec2 point, Vec2 along) const;

  ActsAt acts_at_;
  testing::BaseState state_;
  std::vector<RegionForce> joints_; ///< at the base state
  std::vector<double> shear_;       ///< of the joints there, N/m
  Eigen::MatrixXd dashpots_;
};

} // namespace gcpdda::study
