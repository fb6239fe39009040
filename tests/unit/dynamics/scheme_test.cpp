// Limits of the step by closed forms and by eigenvalues of an amplification matrix that was written down
// apart from this code, with as many digits as stand in the rows, and that the product's step does what the
// matrix says.

#include "dynamics/scheme.hpp"

#include "base/check.hpp"
#include "dynamics/eigenvalues.hpp"
#include "dynamics/integrate.hpp"
#include "support/blocks.hpp"
#include "support/eigenvalues.hpp"
#include "support/scenes.hpp"

#include <Eigen/Core>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace gcpdda::scheme_test {
namespace {

using namespace testing;

constexpr double epsilon = std::numeric_limits<double>::epsilon();

Scheme alpha(double r, ContactTime contact_time) {
  return make_scheme(SchemeKind::generalized_alpha, r, contact_time);
}

double undamped_limit(double r, ContactTime contact_time) {
  return stability_limit(alpha(r, contact_time), 0.0);
}

// Limits found by bisection to 1e-12, blurred by the allowed growth of 1e-9 where the radius rises slowly.
constexpr double closed_form = 1e-6;

TEST(StabilityLimit, LeapfrogIsTwoForEverySpectralRadius) {
  for (const double r : {0.0, 0.25, 0.5, 0.8, 0.9, 1.0}) {
    EXPECT_NEAR(undamped_limit(r, ContactTime::leapfrog), 2.0, closed_form) << r;
  }
}

// Half a unit of the last printed digit, here and below.
TEST(StabilityLimit, PredictorAsPrinted) {
  EXPECT_NEAR(undamped_limit(0.0, ContactTime::predictor), 2.0, 0.005);
  EXPECT_NEAR(undamped_limit(0.5, ContactTime::predictor), 1.867, 0.0005);
  EXPECT_NEAR(undamped_limit(0.8, ContactTime::predictor), 1.396, 0.0005);
  EXPECT_NEAR(undamped_limit(0.9, ContactTime::predictor), 1.041, 0.0005);
  EXPECT_EQ(undamped_limit(1.0, ContactTime::predictor), 0.0);
  EXPECT_NEAR(undamped_limit(0.5, ContactTime::predictor_end), 1.55, 0.005);
}

TEST(StabilityLimit, StartIsUnstableForEveryStep) {
  for (const double r : {0.0, 0.25, 0.5, 0.8, 0.9, 1.0}) {
    const Scheme scheme = alpha(r, ContactTime::start);
    EXPECT_EQ(stability_limit(scheme, 0.0), 0.0);
    for (double w = 0.02; w <= 3.0; w += 0.02) {
      EXPECT_GT(amplification(scheme, w, 0.0), 1.0) << r << " " << w;
    }
    const double w = 0.1;
    const double growth = (1.0 - scheme.alpha_f) * w * w / 2.0;
    EXPECT_NEAR(amplification(scheme, w, 0.0) - 1.0, growth, 0.04 * growth) << r;
  }
}

TEST(StabilityLimit, OtherSchemes) {
  // Central difference: the leapfrog. b = 1/2, g = 1 with the force at x + dt v: |trace| = 1 + det at W^2
  // = 2.
  EXPECT_NEAR(stability_limit(make_scheme(SchemeKind::central_difference, 0.8, {}), 0.0), 2.0, closed_form);
  EXPECT_NEAR(stability_limit(make_scheme(SchemeKind::newmark_dda, 0.8, {}), 0.0), std::sqrt(2.0),
              closed_form);
  const auto hulbert_chung = [](double r) {
    return make_scheme(SchemeKind::explicit_generalized_alpha, r, {});
  };
  for (const double r : {0.0, 0.25, 0.5, 0.8, 0.9}) { // 0/0 at r = 1
    const Scheme s = hulbert_chung(r);
    const double limit = std::sqrt(2.0 * (1.0 - 2.0 * s.alpha_m) / (2.0 * s.beta - s.gamma));
    EXPECT_NEAR(stability_limit(s, 0.0), limit, closed_form) << r;
  }
  EXPECT_NEAR(stability_limit(hulbert_chung(0.0), 0.0), 1.549, 0.0005);
  EXPECT_NEAR(stability_limit(hulbert_chung(0.5), 0.0), 1.867, 0.0005);
  EXPECT_NEAR(stability_limit(hulbert_chung(0.8), 0.0), 1.976, 0.0005);
  EXPECT_NEAR(stability_limit(hulbert_chung(1.0), 0.0), 2.0, 0.0005);
}

// One unit of the last printed digit: three entries (1.94, 1.94, 1.57) lie 0.005 to 0.006 above the limits of
// the matrix (1.9342, 1.9344, 1.5649).
TEST(StabilityLimit, WithADashpotAsPrinted) {
  struct Row {
    double xi, at_08, at_05;
  };
  for (const Row row : {Row{0.02, 1.94, 1.97},
                        {0.05, 1.89, 1.94},
                        {0.1, 1.82, 1.87},
                        {0.2, 1.69, 1.75},
                        {0.3, 1.57, 1.64},
                        {0.5, 1.35, 1.44},
                        {1.0, 0.97, 1.07}}) {
    EXPECT_NEAR(stability_limit(alpha(0.8, ContactTime::leapfrog), row.xi), row.at_08, 0.01) << row.xi;
    EXPECT_NEAR(stability_limit(alpha(0.5, ContactTime::leapfrog), row.xi), row.at_05, 0.01) << row.xi;
  }
}

TEST(Amplification, LeapfrogIsNeutralBelowItsLimit) {
  for (const double r : {0.0, 0.25, 0.5, 0.8, 0.9}) {
    for (double w = 0.05; w < 1.99; w += 0.05) {
      // The pair on the unit circle is simple there; its radius is known to some epsilon/w.
      EXPECT_NEAR(amplification(alpha(r, ContactTime::leapfrog), w, 0.0), 1.0, 1e-12) << r << " " << w;
    }
    EXPECT_GT(amplification(alpha(r, ContactTime::leapfrog), 2.01, 0.0), 1.01);
  }
}

std::vector<Scheme> all_schemes() {
  std::vector<Scheme> schemes{make_scheme(SchemeKind::newmark_dda, 0.8, {}),
                              make_scheme(SchemeKind::central_difference, 0.8, {})};
  for (const double r : {0.0, 0.25, 0.5, 0.8, 0.9, 1.0}) {
    for (const ContactTime when :
         {ContactTime::leapfrog, ContactTime::start, ContactTime::predictor, ContactTime::predictor_end}) {
      schemes.push_back(alpha(r, when));
    }
    schemes.push_back(make_scheme(SchemeKind::explicit_generalized_alpha, r, {}));
  }
  return schemes;
}

/// A free block of 1 kg that the product's step advances.
BlockSystem free_block() {
  return system_of({rectangle({-0.5, -0.5}, {0.5, 0.5})}, {}, 1.0);
}

/// One step of the product under a force law f(x*, v_n) in x.
template <class Force>
void advance(BlockSystem &system, const Scheme &scheme, double time_step, Force &&force) {
  predict(system, scheme, time_step);
  system.contact[0].force = {{force(system.trial[0].u.x, system.velocity[0].u.x), 0.0}, 0.0};
  ASSERT_FALSE(solve_and_update(system, {}, scheme, time_step, Elasticity::implicit));
}

// Roots of (z - 0.5)(z^2 - 2 a z + a^2 + b^2), real and in pairs, the larger ones first and last.
TEST(SpectralRadius, OfACompanionMatrix) {
  for (const auto &[a, b] :
       {std::pair{0.3, 0.9}, std::pair{-0.2, 0.1}, std::pair{1.0, 0.0}, std::pair{0.0, 3.0}}) {
    const double square = a * a + b * b;
    const std::array<double, 9> matrix{0.0,         0.0, 0.5 * square, 1.0,          0.0,
                                       -square - a, 0.0, 1.0,          2.0 * a + 0.5};
    // A double root is known to the square root of rounding.
    const double tolerance = b == 0.0 ? 1e-7 : 1e-14;
    EXPECT_NEAR(gcpdda::spectral_radius(matrix), std::max(0.5, std::sqrt(square)), tolerance)
        << a << " " << b;
  }
  EXPECT_EQ(gcpdda::spectral_radius(std::array{-3.0}), 3.0);
  EXPECT_EQ(gcpdda::spectral_radius(std::array{0.0, 0.0, 0.0, 0.0}), 0.0);
  EXPECT_THROW(gcpdda::spectral_radius(std::array{1.0, 2.0, 3.0}), InternalError);
}

// The columns of the matrix that the product's step applies to unit states, with dt = 1, and its spectrum.
TEST(Amplification, IsTheSpectralRadiusOfTheStep) {
  for (const Scheme &scheme : all_schemes()) {
    for (const double w : {0.1, 0.7, 1.5, 2.5}) {
      for (const double xi : {0.0, 0.05, 0.5}) {
        Eigen::Matrix3d matrix;
        for (int column = 0; column < 3; ++column) {
          BlockSystem block = free_block();
          block.displacement[0].u.x = column == 0 ? 1.0 : 0.0;
          block.velocity[0].u.x = column == 1 ? 1.0 : 0.0;
          block.acceleration[0].u.x = column == 2 ? 1.0 : 0.0;
          advance(block, scheme, 1.0, [&](double x, double v) { return -w * w * x - 2.0 * xi * w * v; });
          matrix.col(column) << block.displacement[0].u.x, block.velocity[0].u.x, block.acceleration[0].u.x;
        }
        const double radius = spectral_radius(matrix);
        // Eigenvalues may be double: half the digits.
        EXPECT_NEAR(amplification(scheme, w, xi), radius, 1e-7 * radius);
      }
    }
  }
}

// Amplitude of an oscillator written out by hand, over many steps: growth to the power of their number.
TEST(Amplification, IsTheGrowthOfAnOscillator) {
  for (const Scheme &s : all_schemes()) {
    const double w = 0.6;
    const double xi = 0.03;
    double d = 1.0;
    double v = 0.3;
    double a = -w * w;
    const auto size = [&] { return std::hypot(d, v / w, a / (w * w)); };
    double growth = 0.0; // logarithm
    double first = 0.0;
    double last = 0.0;
    constexpr int steps = 4000;
    for (int k = 0; k < steps; ++k) {
      const double trial = d + s.trial_velocity * v + s.trial_acceleration * a;
      const double a_new = ((-w * w * trial - 2.0 * xi * w * v) - s.alpha_m * a) / (1.0 - s.alpha_m);
      d += v + (0.5 - s.beta) * a + s.beta * a_new;
      v += (1.0 - s.gamma) * a + s.gamma * a_new;
      a = a_new;
      growth += std::log(size());
      const double now = size();
      d /= now;
      v /= now;
      a /= now;
      (k == steps / 2 ? first : last) = growth;
    }
    // Norm and phase make the logarithm wave by up to about 2 over half of the steps.
    const double per_step = (last - first) / (steps - 1 - steps / 2);
    EXPECT_NEAR(per_step, std::log(amplification(s, w, xi)), 2.0 / (steps / 2.0));
  }
}

/// Whether an oscillator with a dashpot and local damping ends with less than it began with, from many
/// phases.
bool calms_down(const Scheme &s, double w, double xi, double local_damping) {
  for (int phase = 0; phase < 12; ++phase) {
    const double start = w * std::cos(phase * 0.5);
    double d = std::sin(phase * 0.5);
    double v = start;
    double a = 0.0;
    for (int k = 0; k < 3000; ++k) {
      const double trial = d + s.trial_velocity * v + s.trial_acceleration * a;
      double force = -w * w * trial - 2.0 * xi * w * v;
      force -= local_damping * std::copysign(force, v);
      const double a_new = (force - s.alpha_m * a) / (1.0 - s.alpha_m);
      d += v + (0.5 - s.beta) * a + s.beta * a_new;
      v += (1.0 - s.gamma) * a + s.gamma * a_new;
      a = a_new;
      if (std::abs(d) > 1e6) {
        return false;
      }
    }
    if (std::hypot(d, v / w) > 0.1) {
      return false;
    }
  }
  return true;
}

// What swings fastest starts to grow where the formula says, to a few percent: the smaller the excess, the
// rarer are the phases that lead there.
TEST(StabilityLimit, OfLocalDampingIsThatOfAnOscillator) {
  for (const double r : {0.0, 0.5, 0.8}) {
    const Scheme scheme = alpha(r, ContactTime::leapfrog);
    for (const double xi : {0.0, 0.1, 0.3}) {
      for (const double share : {0.1, 0.3, 0.8}) {
        const double limit = stability_limit(scheme, xi, share);
        EXPECT_LT(limit, stability_limit(scheme, xi));
        EXPECT_TRUE(calms_down(scheme, 0.95 * limit, xi, share)) << r << ' ' << xi << ' ' << share;
        EXPECT_FALSE(calms_down(scheme, 1.05 * limit, xi, share)) << r << ' ' << xi << ' ' << share;
      }
    }
    EXPECT_NEAR(stability_limit(scheme, 0.0, 0.8), 2.0 / std::sqrt(1.8), closed_form);
  }
}

// The central claim: x*_{n+1} - 2 x*_n + x*_{n-1} = dt^2 f(x*_n)/m, exactly, for a force with a kink and a
// jump in stiffness and for any r.
TEST(Leapfrog, TrialConfigurationsObeyItForANonLinearForce) {
  const auto force = [](double x, double) {
    return x > 0.0    ? -40.0 * x - 300.0 * x * x * x
           : x < -1.0 ? 90.0 * std::sqrt(-1.0 - x)
                      : std::sin(5.0 * x);
  };
  for (const double r : {0.0, 0.25, 0.5, 0.8, 0.9}) {
    const Scheme scheme = alpha(r, ContactTime::leapfrog);
    constexpr double time_step = 0.05;
    BlockSystem block = free_block();
    block.displacement[0].u.x = 0.2;
    block.velocity[0].u.x = -3.0;
    block.acceleration[0].u.x = force(0.2, 0.0);
    std::vector<double> trial;
    for (int k = 0; k < 2000; ++k) {
      advance(block, scheme, time_step, force);
      trial.push_back(block.trial[0].u.x);
    }
    double largest = 0.0;
    double size = 0.0;
    // From the second pair on: before, a_{n-1} belongs to no step.
    for (std::size_t k = 2; k + 1 < trial.size(); ++k) {
      const double second = trial[k + 1] - 2.0 * trial[k] + trial[k - 1];
      largest = std::max(largest, std::abs(second - time_step * time_step * force(trial[k], 0.0)));
      size = std::max(size, std::abs(trial[k]));
    }
    EXPECT_GT(size, 0.5);
    // Some tens of roundings of numbers of the size of x; 1/(1 - am) <= 10 for r <= 0.9 magnifies a few.
    EXPECT_LE(largest, 200.0 * epsilon * size) << r;
  }
}

// Constant acceleration is exact with a consistent a_0, for every scheme of second order.
TEST(Schemes, ConstantAccelerationIsExact) {
  for (const double r : {0.0, 0.5, 0.8}) {
    for (const Scheme &scheme : {alpha(r, ContactTime::leapfrog), alpha(r, ContactTime::predictor),
                                 make_scheme(SchemeKind::explicit_generalized_alpha, r, {})}) {
      BlockSystem block = free_block();
      block.velocity[0].u.x = 2.0;
      block.acceleration[0].u.x = -9.81;
      constexpr double time_step = 0.01;
      constexpr int steps = 1000;
      for (int k = 0; k < steps; ++k) {
        advance(block, scheme, time_step, [](double, double) { return -9.81; });
      }
      const double t = steps * time_step;
      // A thousand roundings of numbers up to 470.
      EXPECT_NEAR(block.displacement[0].u.x, 2.0 * t - 0.5 * 9.81 * t * t, 1000 * epsilon * 470.0);
      EXPECT_NEAR(block.velocity[0].u.x, 2.0 - 9.81 * t, 1000 * epsilon * 100.0);
    }
  }
}

TEST(Schemes, BrokenStateIsKeptAndReported) {
  BlockSystem block = free_block();
  const Scheme scheme = alpha(0.8, ContactTime::leapfrog);
  const RigidDof before = block.displacement[0];
  block.contact[0].force.u.x = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(solve_and_update(block, {}, scheme, 0.1, Elasticity::implicit), std::optional<std::size_t>(0));
  EXPECT_EQ(block.displacement[0], before);
}

// The stale flag of the neighbourhood relies on it: no point moves farther in the next trial configuration.
TEST(Schemes, MotionBoundBoundsTheNextTrialConfiguration) {
  std::mt19937 engine(31);
  for (const Scheme &scheme : all_schemes()) {
    BlockSystem block = free_block();
    block.velocity[0] = {{uniform(engine, -1.0, 1.0), uniform(engine, -1.0, 1.0)},
                         uniform(engine, -1.0, 1.0)};
    block.acceleration[0] = {{uniform(engine, -9.0, 9.0), 2.0}, uniform(engine, -9.0, 9.0)};
    constexpr double time_step = 0.05;
    const std::vector<Vec2> before = current_vertices(block, 0);
    predict(block, scheme, time_step);
    for (std::size_t k = 0; k < before.size(); ++k) {
      EXPECT_LE(norm(TrialOutline(block, 0).vertex[k] - before[k]),
                motion_bound(block, 0, time_step) + epsilon);
    }
  }
}

} // namespace
} // namespace gcpdda::scheme_test
