// B9: the angle at which the foot of a falling column slips.
//
// A column of the width b and height h turns about its lower corner, r = sqrt(b^2 + h^2)/2 from its centroid,
// which stands at th from the upright. The moment of inertia about the corner is (4/3) m r^2, whatever b/h,
// so this is the falling rod of the textbooks (Synge and Griffith, Principles of Mechanics; thin rod: b = 0).
// From rest at th_0, c = cos(th), c_0 = cos(th_0):
//     th'^2 = (3g/2r)(c_0 - c),  th'' = (3g/4r) sin(th)
//     T = m g (3/4) sin(th) (3 c - 2 c_0)              friction on the foot, towards the fall
//     N = m g (1/4 + (9/4) c^2 - (3/2) c_0 c)          th_0 = 0: m g (1 - 3 c)^2/4
// The foot slips where |T| = mu N: backwards under a low friction angle, while T > 0; where the largest T/N
// of the first part, about 0.37, is below mu, forwards, after T has changed its sign; always before N = 0.
//
// The corner sinks in by d = sqrt(N/k_n), about, and its friction spring gives way by as much: the foot is no
// point and T lags behind. Without dashpots the error of the angle is a few d/r and falls like k_n^(-1/2).
// Deformable columns start unstrained and ring, so theirs have dashpots; the tangential one takes
// c_t v_t from T, which goes with sqrt(k_t) d or k_n^(-1/4). Slip counts from 13 degrees on, when the ringing
// is over, and th_0 is what th and th' say there.

#include "problem.hpp"
#include "support/contact_regions.hpp"
#include "support/memories.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace gcpdda::testing::falling_column_test {
namespace {

constexpr double width = 0.2;
constexpr double height = 2.0;
constexpr double start = 10.0 * degree; ///< th_0
constexpr double settled = 13.0 * degree;

const double radius = 0.5 * std::hypot(width, height);
const double weight = rock_density * width * height * earth_gravity;

/// What a column that would have come to rest at the angle `rest` gives at `angle`, over the weight.
double friction_at(double angle, double rest) {
  return 0.75 * std::sin(angle) * (3.0 * std::cos(angle) - 2.0 * std::cos(rest));
}
double normal_at(double angle, double rest) {
  const double c = std::cos(angle);
  return 0.25 + 2.25 * c * c - 1.5 * std::cos(rest) * c;
}

/// First angle at which |T| = mu N.
double slip_angle(double mu, double rest) {
  const auto excess = [&](double angle) {
    return std::abs(friction_at(angle, rest)) - mu * normal_at(angle, rest);
  };
  double low = rest;
  double high = rest;
  while (excess(high) < 0.0) {
    low = high;
    high += 0.01 * degree;
  }
  while (high - low > 1e-12) {
    const double middle = 0.5 * (low + high);
    (excess(middle) < 0.0 ? low : high) = middle;
  }
  return high;
}

struct Column {
  double mu = 0.2;
  double normal_stiffness = 1e10; ///< Pa/m
  double youngs_modulus = 0.0;    ///< 0: rigid

  [[nodiscard]] std::string toml(double depth) const {
    // The corner is the origin; the centroid is to its left by atan(b/h) when the column is upright.
    const double turn = start + std::atan(width / height);
    return head({.duration = 4.0,
                 .normal_stiffness = normal_stiffness,
                 .friction_deg = std::atan(mu) / degree,
                 .damping = youngs_modulus > 0.0 ? 0.3 : 0.0,
                 .fidelity = youngs_modulus > 0.0 ? "deformable" : "rigid",
                 .youngs_modulus = youngs_modulus,
                 .poissons_ratio = 0.25}) +
           block_toml("ground", rectangle({-5.0, -2.0}, {5.0, 0.0}), "fixed = true") +
           block_toml("column", placed({{0.0, 0.0}, {0.0, height}, {-width, height}, {-width, 0.0}}, -turn,
                                       {0.0, -depth}));
  }
  [[nodiscard]] Simulation at(double depth) const {
    return Simulation(Communicator::self(), scene_of(toml(depth)));
  }

  /// Depth of the corner at which it bears N of the start: N goes with the square of the depth.
  [[nodiscard]] double start_depth() const {
    double depth = 1e-5;
    for (int k = 0; k < 4; ++k) {
      Simulation simulation = at(depth);
      depth *= std::sqrt(normal_at(start, start) * weight / regions_of(simulation)[0].normal_force);
    }
    return depth;
  }
};

struct Slip {
  double expected = 0.0;
  double angle = 0.0;
  double friction = 0.0; ///< on the foot, towards the fall, N/m
};

Slip measured(const Column &column) {
  Simulation simulation = column.at(column.start_depth());
  const auto angle = [&] { return start - displacement_of(simulation, 1).r; };
  Slip result;
  double before = angle();
  double slipped = 0.0;
  while (!simulation.finished() && result.angle == 0.0) {
    step(simulation);
    const double now = angle();
    const std::vector<RegionMemory> known = memories(simulation.history());
    const double slip = known.empty() ? 0.0 : known[0].slip;
    if (before < settled && now >= settled) {
      const double rate = (now - before) / simulation.plan().time_step;
      const double middle = 0.5 * (now + before);
      const double rest = std::acos(std::cos(middle) + 2.0 * radius / (3.0 * earth_gravity) * rate * rate);
      result.expected = slip_angle(column.mu, rest);
      slipped = slip;
    }
    if (now >= settled && slip > slipped) {
      result.angle = now;
      result.friction = -regions_of(simulation)[0].shear_force.x;
    }
    before = now;
  }
  EXPECT_FALSE(simulation.fault().has_value());
  return result;
}

std::string name_of(const Column &column) {
  return fmt::format(
      "B9 falling column, mu = {}, k_n = {:g} Pa/m, {}: angle of slip, degrees", column.mu,
      column.normal_stiffness,
      column.youngs_modulus > 0.0 ? fmt::format("deformable, E = {:g} Pa", column.youngs_modulus) : "rigid");
}

/// The foot slips backwards with little friction, forwards with much.
void expect_direction(const Column &column, const Slip &slip) {
  EXPECT_GT(column.mu < 0.37 ? slip.friction : -slip.friction, 0.0) << name_of(column);
}

TEST(FallingColumn, FootSlipsAtTheAngleOfTheRod) {
  for (const double mu : {0.2, 0.3, 0.6, 1.0}) {
    const std::vector<double> stiffness{1e9, 1e10, 1e11};
    std::vector<double> errors;
    for (const double k_n : stiffness) {
      const Column column{mu, k_n};
      const Slip slip = measured(column);
      expect_value(name_of(column), slip.expected / degree, slip.angle / degree,
                   4.0 * std::sqrt(weight / k_n) / radius);
      expect_direction(column, slip);
      errors.push_back(std::abs(slip.angle - slip.expected));
    }
    const double order = log_slope(stiffness, errors);
    expect_value(fmt::format("B9 falling column, mu = {}, rigid: power of k_n in the error", mu), -0.5, order,
                 0.1);
  }
}

TEST(FallingColumn, FootOfADeformableOneSlipsThereToo) {
  for (const double youngs_modulus : {1e9, 3e10}) {
    for (const double mu : {0.2, 0.3, 0.6, 1.0}) {
      for (const double k_n : {1e9, 1e11}) {
        const Column column{mu, k_n, youngs_modulus};
        const Slip slip = measured(column);
        expect_value(name_of(column), slip.expected / degree, slip.angle / degree,
                     0.025 * std::pow(1e9 / k_n, 0.25));
        expect_direction(column, slip);
      }
    }
  }
}

} // namespace
} // namespace gcpdda::testing::falling_column_test
