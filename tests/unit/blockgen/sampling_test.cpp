#include "blockgen/sampling.hpp"

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

} // namespace
} // namespace gcpdda::blockgen::sampling_test
