#pragma once

// Forces and tangent stiffness near one state of a few blocks, by the program's own force function.
//
// Unknowns. A rigid block has (u, v, theta), a deformable one (u, v, F11, F12, F21, F22), all scaled with the
// root of the mass: y = sqrt(m) u, y = sqrt(I) theta, Y = dF C with S = C C^T. The mass matrix is then the
// unit matrix, a force f becomes f/sqrt(m), a force G = int t X^T ds on F becomes G C^-T, and the eigenvalues
// of the tangent K = -df/dy are squared frequencies.
//
// A stick spring follows the way from the last trial configuration to the present one. Each evaluation
// therefore begins with the memory of the base state, and the way is the one from the base state: the forces
// are a function of y, and central differences of it are K. Forces are smooth while no vertex passes an edge
// and no contact becomes longer than ever; two steps, h and h/2, leave an error of fourth order. Steps of a
// hundredth of the depth make it 1e-8 of K, and so does rounding where the depth is 1e-5 of the coordinates.
//
// What K says of motion. With a unit mass matrix a mode exp(i w t) has K x = w^2 x. For an eigenvalue lambda
// with unit vector x, Im lambda = x^H (K - K^T) x/2i: growth is bounded by the norm of the skew part, and
// none of it is left where K is symmetric.

#include "contact/contact_forces.hpp"
#include "simulation/simulation.hpp"

#include <Eigen/Core>

#include <vector>

namespace gcpdda::testing {

/// Which kernels take pairs of convex blocks.
enum class PairPath { plain, general };

class BaseState {
public:
  /// The base state is the trial configuration of the blocks, without memory.
  BaseState(BlockSystem system, const ContactParameters &parameters, PairPath path,
            Instructions instructions = Instructions::widest);
  /// The trial configuration of a run on one rank with all that it remembers.
  explicit BaseState(const Simulation &simulation);

  [[nodiscard]] const BlockSystem &system() const { return system_; }
  [[nodiscard]] const CandidatePair &pair_of(const RegionForce &region) const {
    return candidates_.pairs[region.pair];
  }
  [[nodiscard]] Eigen::Index num_unknowns() const { return begin_.back(); }
  [[nodiscard]] Eigen::Index unknown_of(std::size_t row) const { return begin_[row]; }

  /// Evaluate at the base state, so that its memory becomes that of a step that ended here.
  void visit_base() { visit(Eigen::VectorXd::Zero(num_unknowns())); }
  /// Evaluate at base state + motion, by the way from the last visit, and remember.
  /// @return the force of the contacts
  Eigen::VectorXd visit(const Eigen::VectorXd &motion);
  /// All regions at base state + motion; nothing is remembered of it.
  std::vector<RegionForce> regions_at(const Eigen::VectorXd &motion);
  std::vector<RegionForce> regions() { return regions_at(Eigen::VectorXd::Zero(num_unknowns())); }
  /// set(region, state) for all regions that are remembered at the base state.
  template <class Set> void change_memory(Set &&set) {
    const std::vector<RegionForce> found = regions();
    std::size_t number = 0;
    for (std::size_t k = 0; k < found.size(); ++k) {
      number = k > 0 && found[k].pair == found[k - 1].pair ? number + 1 : 0;
      set(found[k], memory_.state(found[k].pair, number));
    }
  }

  /// Force of the contacts at base state + motion.
  Eigen::VectorXd contact_force(const Eigen::VectorXd &motion);
  /// Elastic force of the blocks at base state + motion.
  [[nodiscard]] Eigen::VectorXd elastic_force(const Eigen::VectorXd &motion) const;
  /// K of the contacts; `step` is how far block boundaries move, m.
  Eigen::MatrixXd contact_stiffness(double step);
  /// K of the blocks.
  [[nodiscard]] Eigen::MatrixXd elastic_stiffness() const;

  /// The unknowns' values in a motion of one row without turning (m).
  [[nodiscard]] Eigen::VectorXd motion_of(std::size_t row, Vec2 shift) const;
  /// How the material point of a block that now is at x moves along a direction, by unknown; nothing of a
  /// fixed block.
  [[nodiscard]] Eigen::VectorXd motion_at(std::size_t row, Vec2 x, Vec2 direction) const;
  /// How the gradient dF F^-1 of a block moves: direction . dF F^-1 along, by unknown.
  [[nodiscard]] Eigen::VectorXd gradient_of(std::size_t row, Vec2 direction, Vec2 along) const;

private:
  void number_unknowns();
  [[nodiscard]] TrialConfiguration moved(std::size_t row, const Eigen::VectorXd &motion) const;
  [[nodiscard]] std::vector<TrialConfiguration> moved(const Eigen::VectorXd &motion) const;
  /// Evaluate at the end of the way, from the memory of the base state.
  void evaluate(const std::vector<TrialConfiguration> &from, const std::vector<TrialConfiguration> &to);
  Eigen::VectorXd evaluated_force();

  BlockSystem system_;
  ContactForces forces_;
  Candidates candidates_;
  ContactHistory history_; ///< of the last evaluation
  ContactHistory memory_;  ///< of the base state
  std::vector<TrialConfiguration> base_;
  std::vector<TrialConfiguration> last_; ///< visited
  std::vector<Eigen::Index> begin_;      ///< of a row's unknowns
  std::vector<Mat2> root_;               ///< C of deformable rows, by row
};

/// Motion about the base state under the forces that balance it there, without damping: leapfrog on contacts
/// and elasticity, y'' = f(y) - f(0).
class Swing {
public:
  /// @param velocity  at the base state
  Swing(BaseState &state, double time_step, const Eigen::VectorXd &velocity);
  void step();
  /// Of the last step, J/m.
  [[nodiscard]] double kinetic_energy() const {
    return 0.5 * (motion_ - before_).squaredNorm() / (time_step_ * time_step_);
  }

private:
  BaseState &state_;
  double time_step_;
  Eigen::VectorXd balance_;
  Eigen::VectorXd before_;
  Eigen::VectorXd motion_;
};

/// |K - K^T|/2|K|, Frobenius norms.
double skewness(const Eigen::MatrixXd &stiffness);

/// Largest growth rate (1/s) of the modes of a tangent in mass-normalised unknowns.
double growth_rate(const Eigen::MatrixXd &stiffness);

} // namespace gcpdda::testing
