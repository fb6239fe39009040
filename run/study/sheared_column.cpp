#include "sheared_column.hpp"

#include "model/block_system.hpp"
#include "support/eigenvalues.hpp"
#include "support/setting.hpp"

#include <array>
#include <cmath>
#include <complex>
#include <random>

namespace gcpdda::study {

namespace {

using namespace testing;

constexpr double tangential_ratio = 0.5;
constexpr double step_of_differences = 3e-3 * ShearedColumn::overlap;

/// Between the lines y = low + x tan(angle) and y = high + x tan(angle), low and high at the left side.
std::vector<Vec2> sheared(double left, double right, double low, double high, double slope, double shift) {
  const auto at = [&](double x, double y) { return Vec2{x, y + x * slope + shift}; };
  return {at(left, low), at(right, low), at(right, high), at(left, high)};
}

/// Slope of the least-squares line through (i, y_i) for i from `first` on.
double slope_of(const std::vector<double> &y, std::size_t first) {
  const auto n = static_cast<double>(y.size() - first);
  double moment = 0.0;
  for (std::size_t i = first; i < y.size(); ++i) {
    moment += (static_cast<double>(i - first) - 0.5 * (n - 1.0)) * y[i];
  }
  return 12.0 * moment / (n * (n * n - 1.0));
}

} // namespace

ShearedColumn::ShearedColumn(const ColumnProblem &problem, ActsAt acts_at)
    : acts_at_(acts_at), state_(make_state(problem)), joints_(state_.regions()) {
  const double angle = problem.joint_angle_deg * degree;
  const Vec2 uphill{std::cos(angle), std::sin(angle)};
  for (const RegionForce &joint : joints_) {
    const double shear = problem.shear_ratio * joint.normal_force;
    const double on_the_one_below = joint.normal.y < 0.0 ? 1.0 : -1.0;
    shear_.push_back(on_the_one_below * shear * dot(perp(joint.normal), uphill));
  }
  std::size_t number = 0;
  state_.change_memory([&](const RegionForce &, RegionState &memory) {
    memory.longest *= 1.01; // not on the edge of the rule for joints that grow
    memory.shear = acts_at == ActsAt::grip ? shear_[number] : 0.0;
    ++number;
  });
  find_dashpots(problem.damping_ratio);
}

double ShearedColumn::joint_frequency() {
  return std::sqrt(normal_stiffness / (rock_density * size));
}

BaseState ShearedColumn::make_state(const ColumnProblem &problem) const {
  const double slope = std::tan(problem.joint_angle_deg * degree);
  const double sunk = overlap * std::hypot(1.0, slope); // along y
  Material rock;
  rock.density = rock_density;
  rock.youngs_modulus = normal_stiffness * size / problem.softness;
  rock.poissons_ratio = 0.25;
  BlockSystem system;
  const auto add = [&](const std::vector<Vec2> &shape, bool is_fixed) {
    SceneBlock block;
    block.vertices = shape;
    block.fixed = is_fixed;
    append_block(system, BlockId{static_cast<std::int64_t>(system.num_rows())}, block, rock,
                 is_fixed ? BlockKind::fixed : BlockKind::deformable);
  };
  add(sheared(0.0, size, 0.0, size, slope, -sunk), false);
  add(sheared(0.0, size, size, 2.0 * size, slope, -2.0 * sunk), false);
  add(sheared(-size, 2.0 * size, -size, 0.0, slope, 0.0), true);
  add(sheared(-size, 2.0 * size, 2.0 * size, 3.0 * size, slope, -3.0 * sunk), true);
  system.num_owned = 2;
  system.num_fixed = 2;
  pose(system, 0, system.num_rows());
  JointLaw law;
  law.normal_stiffness = normal_stiffness;
  law.tangential_ratio = tangential_ratio;
  law.tan_friction = acts_at_ == ActsAt::grip ? 10.0 : 0.0; // nothing slips
  return {std::move(system), {{{law}, {0}, 1}, 0.0, PotentialKind::exact, 0.0}, PairPath::plain};
}

Eigen::VectorXd ShearedColumn::slide_at(const RegionForce &region, Vec2 point, Vec2 along) const {
  const CandidatePair &pair = state_.pair_of(region);
  return state_.motion_at(pair.lower.value, point, along) - state_.motion_at(pair.higher.value, point, along);
}

// Normal dashpots spread along a joint, c' = 2 xi sqrt(k_n m/L) over its length by two points of Gauss, the
// tangential one where friction acts. m: of both blocks together, L: root of the area.
void ShearedColumn::find_dashpots(double damping_ratio) {
  dashpots_.setZero(state_.num_unknowns(), state_.num_unknowns());
  for (const RegionForce &joint : joints_) {
    const CandidatePair &pair = state_.pair_of(joint);
    const Vec2 t = perp(joint.normal);
    const double length = joint.extent_end - joint.extent_begin;
    const Vec2 middle = joint.point + 0.5 * (joint.extent_begin + joint.extent_end) * t;
    const double mass = pair.mass;
    const double root_of_area = std::sqrt(state_.system().properties[0].area);
    const double normal = 2.0 * damping_ratio * std::sqrt(normal_stiffness * mass / root_of_area) * length;
    for (const double side : {-0.5, 0.5}) {
      const Eigen::VectorXd opening =
          slide_at(joint, middle + side / std::sqrt(3.0) * length * t, joint.normal);
      dashpots_ += 0.5 * normal * opening * opening.transpose();
    }
    const double spring = tangential_ratio * normal_stiffness * length;
    const Eigen::VectorXd slide = slide_at(joint, middle, t);
    dashpots_ += 2.0 * damping_ratio * std::sqrt(spring * mass) * slide * slide.transpose();
  }
}

Eigen::VectorXd ShearedColumn::force_of_wandering_friction(const Eigen::VectorXd &from,
                                                           const Eigen::VectorXd &to,
                                                           std::vector<double> &shear) {
  Eigen::VectorXd force = state_.contact_force(to);
  const std::vector<RegionForce> regions = state_.regions_at(to);
  for (std::size_t k = 0; k < regions.size(); ++k) {
    const double length = joints_[k].extent_end - joints_[k].extent_begin;
    const Eigen::VectorXd slide = slide_at(regions[k], regions[k].point, perp(regions[k].normal));
    shear[k] += tangential_ratio * normal_stiffness * length * slide.dot(to - from);
    force -= shear[k] * slide;
  }
  return force;
}

Eigen::MatrixXd ShearedColumn::stiffness() {
  if (acts_at_ == ActsAt::grip) {
    return state_.contact_stiffness(step_of_differences) + state_.elastic_stiffness();
  }
  const Eigen::Index n = state_.num_unknowns();
  const double h = step_of_differences * std::sqrt(state_.system().properties[0].mass);
  const Eigen::VectorXd base = Eigen::VectorXd::Zero(n);
  Eigen::MatrixXd stiffness(n, n);
  for (Eigen::Index k = 0; k < n; ++k) {
    const auto force_at = [&](double by) {
      std::vector<double> shear = shear_;
      return force_of_wandering_friction(base, by * Eigen::VectorXd::Unit(n, k), shear);
    };
    stiffness.col(k) = (force_at(-h) - force_at(h)) / (2.0 * h);
  }
  return stiffness + state_.elastic_stiffness();
}

double ShearedColumn::growth() {
  const Eigen::Index n = state_.num_unknowns();
  const double scale = joint_frequency();
  Eigen::MatrixXd companion = Eigen::MatrixXd::Zero(2 * n, 2 * n);
  companion.topRightCorner(n, n).setIdentity();
  companion.bottomLeftCorner(n, n) = -stiffness() / (scale * scale);
  companion.bottomRightCorner(n, n) = -dashpots_ / scale;
  double largest = 0.0;
  double fastest = 0.0;
  for (const std::complex<double> value : eigenvalues(companion)) {
    largest = std::max(largest, value.real());
    fastest = std::max(fastest, std::abs(value));
  }
  constexpr double rounding = 1e-9; // a share of the fastest mode
  return largest > rounding * fastest ? scale * largest : 0.0;
}

double ShearedColumn::measured_growth(unsigned seed, int num_steps) {
  constexpr double smallest = 1e-7; // shares of the overlap in the first step and where a run ends
  constexpr double largest = 0.02;
  const Eigen::Index n = state_.num_unknowns();
  const double root_of_mass = std::sqrt(state_.system().properties[0].mass);
  const double time_step = 0.2 / std::sqrt(stiffness().norm());
  std::mt19937 engine(seed);
  Eigen::VectorXd before = Eigen::VectorXd::Zero(n);
  Eigen::VectorXd motion(n);
  for (Eigen::Index k = 0; k < n; ++k) {
    motion(k) = smallest * overlap * root_of_mass * (static_cast<double>(engine()) / 2147483648.0 - 1.0);
  }
  std::vector<double> shear = shear_;
  const auto forces = [&](const Eigen::VectorXd &from, const Eigen::VectorXd &to) -> Eigen::VectorXd {
    return state_.elastic_force(to) +
           (acts_at_ == ActsAt::grip ? state_.visit(to) : force_of_wandering_friction(from, to, shear));
  };
  const Eigen::VectorXd balance = forces(before, before);
  std::vector<double> log_speed;
  while (log_speed.size() < static_cast<std::size_t>(num_steps) &&
         motion.norm() < largest * overlap * root_of_mass) {
    const Eigen::VectorXd speed = (motion - before) / time_step;
    const Eigen::VectorXd force = forces(before, motion) - balance - dashpots_ * speed;
    log_speed.push_back(std::log(speed.norm() + 1e-300));
    const Eigen::VectorXd next = 2.0 * motion - before + time_step * time_step * force;
    before = motion;
    motion = next;
  }
  return slope_of(log_speed, 2 * log_speed.size() / 3) / time_step;
}

} // namespace gcpdda::study
