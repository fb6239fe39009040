#include "blockgen/sampling.hpp"
#include "model/joint_plane.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace gcpdda::blockgen::sampling_test {
namespace {

constexpr int num_draws = 40000;

struct Statistics {
  double mean = 0.0;
  double deviation = 0.0;
};

template <class Sample> Statistics statistics(Sample &&sample) {
  double sum = 0.0;
  double squares = 0.0;
  for (int k = 0; k < num_draws; ++k) {
    const double x = sample(Draw(5, 2, k / 100, k % 100, 3));
    sum += x;
    squares += x * x;
  }
  const double mean = sum / num_draws;
  return {mean, std::sqrt(squares / num_draws - mean * mean)};
}

/// Five deviations of a mean, and of a deviation of nearly normal numbers, over the draws.
const double five_sigma = 5.0 / std::sqrt(num_draws);

TEST(Draw, DependsOnItsAddressAlone) {
  const double first = Draw(1, 2, 3, 4, 5).uniform();
  Draw other(1, 2, 3, 5, 5);
  EXPECT_NE(other.uniform(), first);
  EXPECT_NE(other.uniform(), first);
  EXPECT_EQ(Draw(1, 2, 3, 4, 5).uniform(), first);
  for (const Draw &draw : {Draw(2, 2, 3, 4, 5), Draw(1, 3, 3, 4, 5), Draw(1, 2, 4, 4, 5), Draw(1, 2, 3, 4, 6),
                           Draw(1, 2, -3, 4, 5)}) {
    EXPECT_NE(Draw(draw).uniform(), first);
  }
}

TEST(Draw, IsUniformAndNormal) {
  const Statistics uniform = statistics([](Draw draw) { return draw.uniform(); });
  EXPECT_NEAR(uniform.mean, 0.5, five_sigma * std::sqrt(1.0 / 12.0));
  EXPECT_NEAR(uniform.deviation, std::sqrt(1.0 / 12.0), five_sigma);
  const Statistics normal = statistics([](Draw draw) { return draw.normal(); });
  EXPECT_NEAR(normal.mean, 0.0, five_sigma);
  EXPECT_NEAR(normal.deviation, 1.0, five_sigma);
}

TEST(SampleLength, HasTheMomentsAsked) {
  for (const Spread spread : {Spread::normal, Spread::lognormal}) {
    const Statistics s = statistics([&](Draw draw) { return sample_length({2.0, spread, 0.4}, draw); });
    EXPECT_NEAR(s.mean, 2.0, 0.4 * five_sigma);
    EXPECT_NEAR(s.deviation, 0.4, 0.4 * 1.5 * five_sigma); // the lognormal's tail makes deviations less sure
  }
  // Without what lies below 1/100 of it, the mean of the exponential is a hundredth larger, its deviation the
  // same.
  const Statistics s = statistics([&](Draw draw) {
    return sample_length({2.0, Spread::exponential, 0.0}, draw);
  });
  EXPECT_NEAR(s.mean, 2.02, 2.0 * five_sigma);
  EXPECT_NEAR(s.deviation, 2.0, 2.0 * std::sqrt(2.0) * five_sigma);
  EXPECT_EQ(sample_length({2.0, Spread::none, 0.0}, Draw(0, 0, 0, 0, 0)), 2.0);
}

// Moments of the density ~ x^-a from 1 to 50 m: int x^(n-a) dx over int x^-a dx, by hand below for each
// exponent a, among them those where one of the integrals is a logarithm.
TEST(SampleLength, OfAPowerLawHasItsMoments) {
  struct Case {
    double exponent;
    double mean;
    double square;
  };
  const double log50 = std::log(50.0);
  const double root = std::sqrt(50.0);
  for (const Case &c : {Case{0.0, 25.5, (50.0 * 50.0 * 50.0 - 1.0) / 3.0 / 49.0},
                        Case{1.0, 49.0 / log50, 2499.0 / 2.0 / log50},
                        Case{2.0, log50 / (1.0 - 1.0 / 50.0), 49.0 / (1.0 - 1.0 / 50.0)},
                        Case{2.5, 2.0 * (1.0 - 1.0 / root) / ((2.0 / 3.0) * (1.0 - 1.0 / (50.0 * root))),
                             2.0 * (root - 1.0) / ((2.0 / 3.0) * (1.0 - 1.0 / (50.0 * root)))}}) {
    const Scattered length{0.0, Spread::power_law, c.exponent, 1.0, 50.0};
    EXPECT_NEAR(length.mean_of_power_law() / c.mean, 1.0, 1e-13) << c.exponent;
    const double deviation = std::sqrt(c.square - c.mean * c.mean);
    const Statistics s = statistics([&](Draw draw) { return sample_length(length, draw); });
    EXPECT_NEAR(s.mean, c.mean, deviation * five_sigma) << c.exponent;
    EXPECT_NEAR(s.deviation, deviation, 3.0 * deviation * five_sigma) << c.exponent; // long tails
  }
  for (int k = 0; k < 1000; ++k) {
    const double x = sample_length({5.0, Spread::power_law, 3.0, 2.0, 1000.0}, Draw(0, 0, k, 0, 0));
    EXPECT_TRUE(x >= 2.0 && x <= 1000.0) << x;
  }
}

TEST(SampleLength, StaysNearItsMean) {
  for (int k = 0; k < 1000; ++k) {
    EXPECT_GE(sample_length({1.0, Spread::normal, 2.0}, Draw(0, 0, k, 0, 0)), 0.01);
    EXPECT_GE(sample_length({1.0, Spread::exponential, 0.0}, Draw(0, 0, k, 0, 0)), 0.01);
  }
}

TEST(SampleAngle, HasTheMomentsAsked) {
  const Statistics normal = statistics([](Draw draw) {
    return sample_angle({0.3, Spread::normal, 0.1}, draw);
  });
  EXPECT_NEAR(normal.mean, 0.3, 0.1 * five_sigma);
  EXPECT_NEAR(normal.deviation, 0.1, 0.1 * five_sigma);
  // Fisher: the mean cosine of the angle is coth k - 1/k, and 1 - cos a is nearly exponential with the mean
  // 1/k.
  constexpr double k = 50.0;
  const Statistics cosine = statistics([](Draw draw) {
    return std::cos(sample_angle({0.0, Spread::fisher, k}, draw));
  });
  EXPECT_NEAR(cosine.mean, 1.0 / std::tanh(k) - 1.0 / k, five_sigma / k);
  EXPECT_NEAR(statistics([](Draw draw) {
                return sample_angle({0.0, Spread::fisher, k}, draw);
              }).mean,
              0.0, five_sigma * std::sqrt(2.0 / k));
}

// Near their mean, poles scatter by 1/sqrt(k) in each of two directions. The trace of a level plane turns by
// the tilt in the section; that of an upright plane 60 degrees off the section by twice its tilt.
TEST(SampleTraceAngle, ScattersByThePartOfThePoleInTheSection) {
  constexpr double k = 10000.0;
  constexpr double degree = std::numbers::pi / 180.0;
  const Statistics level = statistics([](Draw draw) { return sample_trace_angle({0.0, 0.4, k, 1.0}, draw); });
  EXPECT_NEAR(level.mean, 0.0, five_sigma / std::sqrt(k));
  EXPECT_NEAR(level.deviation, 1.0 / std::sqrt(k), five_sigma / std::sqrt(k));
  const Statistics oblique = statistics([](Draw draw) {
    const double angle = sample_trace_angle({90.0 * degree, 60.0 * degree, k, 1.0}, draw);
    return std::remainder(angle - 0.5 * std::numbers::pi, std::numbers::pi); // about the upright
  });
  EXPECT_NEAR(oblique.mean, 0.0, 2.0 * five_sigma / std::sqrt(k));
  EXPECT_NEAR(oblique.deviation, 2.0 / std::sqrt(k), 2.0 * five_sigma / std::sqrt(k));
}

// Of widely scattered planes those across the section are met more often. The mean square of the angle from
// the upright against a sum over the sphere with the density sin(a) exp(k cos(a)) times the part of the pole
// in the section; without that part it would be 0.437 instead of 0.375.
TEST(SampleTraceAngle, IsThatOfPlanesTheSectionMeets) {
  constexpr double degree = std::numbers::pi / 180.0;
  const JointPlane plane{90.0 * degree, 70.0 * degree, 20.0, 1.0};
  const auto from_upright = [](double angle) {
    return std::remainder(angle - 0.5 * std::numbers::pi, std::numbers::pi);
  };
  double weights = 0.0;
  double squares = 0.0;
  double unweighted = 0.0;
  double density = 0.0;
  for (int i = 0; i < 400; ++i) {
    for (int j = 0; j < 400; ++j) {
      const double a = (i + 0.5) * std::numbers::pi / 400.0;
      const Pole pole = pole_near(plane, a, (j + 0.5) * std::numbers::pi / 200.0);
      const double share = std::sin(a) * std::exp(plane.fisher * (std::cos(a) - 1.0));
      const double square = std::pow(from_upright(trace_angle(pole)), 2);
      weights += share * share_in_section(pole);
      squares += share * share_in_section(pole) * square;
      density += share;
      unweighted += share * square;
    }
  }
  const Statistics angle =
      statistics([&](Draw draw) { return from_upright(sample_trace_angle(plane, draw)); });
  EXPECT_NEAR(angle.mean, 0.0, 0.5 * five_sigma);
  EXPECT_NEAR(angle.deviation * angle.deviation, squares / weights, five_sigma * squares / weights * 1.5);
  EXPECT_GT(unweighted / density, 1.1 * squares / weights);
}

} // namespace
} // namespace gcpdda::blockgen::sampling_test
