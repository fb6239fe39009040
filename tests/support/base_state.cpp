#include "base_state.hpp"

#include "contact/contact_sums.hpp"
#include "contact_regions.hpp"
#include "dynamics/deformable.hpp"
#include "eigenvalues.hpp"

#include <cmath>
#include <complex>
#include <limits>
#include <utility>

namespace gcpdda::testing {

namespace {

/// Lower triangular C with C C^T = S.
Mat2 root_of(const Mat2 &s) {
  const double xx = std::sqrt(s.xx);
  const double yx = s.yx / xx;
  return {xx, 0.0, yx, std::sqrt(s.yy - yx * yx)};
}

std::vector<std::pair<BlockIndex, BlockIndex>> all_pairs(const BlockSystem &system) {
  std::vector<std::pair<BlockIndex, BlockIndex>> pairs;
  for (std::uint32_t i = 0; i < system.num_owned; ++i) {
    for (std::uint32_t j = i + 1; j < system.num_rows(); ++j) {
      pairs.emplace_back(BlockIndex{i}, BlockIndex{j});
    }
  }
  return pairs;
}

void take_none_as_plain(Candidates &candidates) {
  for (std::uint32_t k = 0; k < candidates.pairs.size(); ++k) {
    candidates.pairs[k].is_plain = false;
  }
  candidates.general.resize(candidates.pairs.size());
  for (std::uint32_t k = 0; k < candidates.pairs.size(); ++k) {
    candidates.general[k] = k;
  }
  candidates.num_interior_general = candidates.pairs.size();
  candidates.num_interior_plain = 0;
  candidates.plain.clear();
  candidates.groups = {PairGroup{.is_last = true}};
  candidates.waiting = candidates.general;
  candidates.is_added.assign(candidates.is_added.size(), 0);
  candidates.are_added.assign(candidates.are_added.size(), 0);
}

} // namespace

BaseState::BaseState(BlockSystem system, const ContactParameters &parameters, PairPath path,
                     Instructions instructions)
    : system_(std::move(system)), forces_(parameters, instructions) {
  candidates_ = make_candidates(system_, all_pairs(system_), parameters, {}, history_,
                                std::numeric_limits<double>::infinity());
  if (path == PairPath::general) {
    take_none_as_plain(candidates_);
  }
  memory_ = history_;
  number_unknowns();
  visit_base();
  visit_base(); // no region is new
}

BaseState::BaseState(const Simulation &simulation)
    : system_(simulation.blocks()), forces_(contact_parameters(simulation.scene())),
      candidates_(simulation.candidates()), history_(simulation.history()), memory_(history_) {
  number_unknowns();
}

void BaseState::number_unknowns() {
  begin_.push_back(0);
  root_.resize(system_.num_owned);
  for (std::size_t row = 0; row < system_.num_owned; ++row) {
    base_.push_back({system_.trial[row], {}});
    if (system_.is_deformable(row)) {
      base_.back().gradient = system_.deformation_of(row).trial;
      root_[row] = root_of(system_.deformation_of(row).second_moment);
    }
    begin_.push_back(begin_.back() + (system_.is_deformable(row) ? 6 : 3));
  }
  last_ = base_;
}

TrialConfiguration BaseState::moved(std::size_t row, const Eigen::VectorXd &motion) const {
  TrialConfiguration trial = base_[row];
  const Eigen::Index k = begin_[row];
  const double by_mass = 1.0 / std::sqrt(system_.properties[row].mass);
  trial.motion.u += by_mass * Vec2{motion(k), motion(k + 1)};
  if (system_.is_deformable(row)) {
    trial.gradient += Mat2{motion(k + 2), motion(k + 3), motion(k + 4), motion(k + 5)} * inverse(root_[row]);
  } else {
    trial.motion.r += motion(k + 2) / std::sqrt(system_.properties[row].inertia);
  }
  return trial;
}

std::vector<TrialConfiguration> BaseState::moved(const Eigen::VectorXd &motion) const {
  std::vector<TrialConfiguration> all;
  for (std::size_t row = 0; row < system_.num_owned; ++row) {
    all.push_back(moved(row, motion));
  }
  return all;
}

void BaseState::evaluate(const std::vector<TrialConfiguration> &from,
                         const std::vector<TrialConfiguration> &to) {
  history_ = memory_;
  for (std::size_t row = 0; row < system_.num_owned; ++row) {
    set_trial(system_, row, from[row]);
    set_trial(system_, row, to[row]);
  }
  pose(system_, 0, system_.num_rows());
  forces_.evaluate(system_, candidates_, history_);
}

Eigen::VectorXd BaseState::visit(const Eigen::VectorXd &motion) {
  const std::vector<TrialConfiguration> to = moved(motion);
  evaluate(last_, to);
  memory_ = history_;
  last_ = to;
  return evaluated_force();
}

std::vector<RegionForce> BaseState::regions_at(const Eigen::VectorXd &motion) {
  evaluate(base_, moved(motion));
  return Regions(system_, candidates_, history_, forces_).all();
}

Eigen::VectorXd BaseState::contact_force(const Eigen::VectorXd &motion) {
  evaluate(base_, moved(motion));
  return evaluated_force();
}

Eigen::VectorXd BaseState::evaluated_force() {
  forces_.finish_sums(system_, candidates_);
  Eigen::VectorXd force(num_unknowns());
  for (std::size_t row = 0; row < system_.num_owned; ++row) {
    const RigidDof &sum = forces_.sums().of_blocks()[row].force;
    const Eigen::Index k = begin_[row];
    const double by_mass = 1.0 / std::sqrt(system_.properties[row].mass);
    force.segment(k, 2) << by_mass * sum.u.x, by_mass * sum.u.y;
    if (system_.is_deformable(row)) {
      const Mat2 &to_reference = system_.trial_inverse[system_.deformation_begin[row]];
      const Mat2 on_gradient = in_reference_axes(system_.deformation_of(row).contact, to_reference).force;
      const Mat2 g = on_gradient * transposed(inverse(root_[row]));
      force.segment(k + 2, 4) << g.xx, g.xy, g.yx, g.yy;
    } else {
      force(k + 2) = sum.r / std::sqrt(system_.properties[row].inertia);
    }
  }
  return force;
}

Eigen::VectorXd BaseState::elastic_force(const Eigen::VectorXd &motion) const {
  Eigen::VectorXd force = Eigen::VectorXd::Zero(num_unknowns());
  for (std::size_t row = 0; row < system_.num_owned; ++row) {
    if (system_.is_deformable(row)) {
      const Mat2 g = gcpdda::elastic_force(system_.deformation_of(row), moved(row, motion).gradient) *
                     transposed(inverse(root_[row]));
      force.segment(begin_[row] + 2, 4) << -g.xx, -g.xy, -g.yx, -g.yy;
    }
  }
  return force;
}

Eigen::MatrixXd BaseState::contact_stiffness(double step) {
  Eigen::MatrixXd stiffness(num_unknowns(), num_unknowns());
  for (std::size_t row = 0; row < system_.num_owned; ++row) {
    const BlockProperties &block = system_.properties[row];
    for (Eigen::Index k = begin_[row]; k < begin_[row + 1]; ++k) {
      const bool is_shift = k < begin_[row] + 2;
      const double h =
          step * std::sqrt(is_shift ? block.mass : block.inertia / (block.radius * block.radius));
      const auto difference = [&](double by) -> Eigen::VectorXd {
        const Eigen::VectorXd motion = by * Eigen::VectorXd::Unit(num_unknowns(), k);
        return (contact_force(-motion) - contact_force(motion)) / (2.0 * by);
      };
      stiffness.col(k) = (4.0 * difference(0.5 * h) - difference(h)) / 3.0;
    }
  }
  return stiffness;
}

Eigen::MatrixXd BaseState::elastic_stiffness() const {
  Eigen::MatrixXd stiffness = Eigen::MatrixXd::Zero(num_unknowns(), num_unknowns());
  for (std::size_t row = 0; row < system_.num_owned; ++row) {
    for (Eigen::Index k = begin_[row] + 2; system_.is_deformable(row) && k < begin_[row + 1]; ++k) {
      const double h = 1e-6 * root_[row].xx;
      const Eigen::VectorXd by = h * Eigen::VectorXd::Unit(num_unknowns(), k);
      stiffness.col(k) = (elastic_force(-by) - elastic_force(by)) / (2.0 * h);
    }
  }
  return stiffness;
}

Eigen::VectorXd BaseState::motion_of(std::size_t row, Vec2 shift) const {
  Eigen::VectorXd motion = Eigen::VectorXd::Zero(num_unknowns());
  const double root = std::sqrt(system_.properties[row].mass);
  motion.segment(begin_[row], 2) << root * shift.x, root * shift.y;
  return motion;
}

Eigen::VectorXd BaseState::gradient_of(std::size_t row, Vec2 direction, Vec2 along) const {
  Eigen::VectorXd by = Eigen::VectorXd::Zero(num_unknowns());
  const Eigen::Index k = begin_[row];
  if (system_.is_deformable(row)) { // direction . Y C^-1 F^-1 along
    const Vec2 a = (inverse(root_[row]) * inverse(base_[row].gradient))(along);
    by.segment(k + 2, 4) << direction.x * a.x, direction.x * a.y, direction.y * a.x, direction.y * a.y;
  } else {
    by(k + 2) = dot(direction, perp(along)) / std::sqrt(system_.properties[row].inertia);
  }
  return by;
}

Eigen::VectorXd BaseState::motion_at(std::size_t row, Vec2 x, Vec2 direction) const {
  if (system_.is_fixed(row)) {
    return Eigen::VectorXd::Zero(num_unknowns());
  }
  Eigen::VectorXd by =
      gradient_of(row, direction, x - (system_.properties[row].centroid + base_[row].motion.u));
  const double by_mass = 1.0 / std::sqrt(system_.properties[row].mass);
  by(begin_[row]) += by_mass * direction.x;
  by(begin_[row] + 1) += by_mass * direction.y;
  return by;
}

Swing::Swing(BaseState &state, double time_step, const Eigen::VectorXd &velocity)
    : state_(state), time_step_(time_step), before_(Eigen::VectorXd::Zero(state.num_unknowns())),
      motion_(time_step * velocity) {
  balance_ = state.visit(before_) + state.elastic_force(before_);
}

void Swing::step() {
  const Eigen::VectorXd force = state_.visit(motion_) + state_.elastic_force(motion_) - balance_;
  const Eigen::VectorXd next = 2.0 * motion_ - before_ + time_step_ * time_step_ * force;
  before_ = std::exchange(motion_, next);
}

double skewness(const Eigen::MatrixXd &stiffness) {
  return (stiffness - stiffness.transpose()).norm() / (2.0 * stiffness.norm());
}

double growth_rate(const Eigen::MatrixXd &stiffness) {
  double largest = 0.0;
  for (const std::complex<double> squared : eigenvalues(stiffness)) {
    largest = std::max(largest, std::abs(std::sqrt(squared).imag()));
  }
  return largest;
}

} // namespace gcpdda::testing
