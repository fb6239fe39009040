// Ticks of axes: round, inside of their range, and neither too few nor too many.

#include "base/round_numbers.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <set>

namespace gcpdda::round_numbers_test {
namespace {

/// The first digit of a number, where it has no other; 0 otherwise.
int only_digit(double x) {
  const double power = std::pow(10.0, std::floor(std::log10(x) + 1e-9));
  const double digit = x / power;
  return std::abs(digit - std::round(digit)) < 1e-9 ? static_cast<int>(std::round(digit)) : 0;
}

TEST(RoundNumbers, OfTwoDigitsAreBelowOrEqual) {
  EXPECT_DOUBLE_EQ(two_digits_below(0.0005), 0.0005);
  EXPECT_DOUBLE_EQ(two_digits_below(0.00025), 0.00025);
  EXPECT_DOUBLE_EQ(two_digits_below(2.29e-4), 2.2e-4);
  EXPECT_DOUBLE_EQ(two_digits_below(999.0), 990.0);
}

TEST(RoundNumbers, AreNearAndRound) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> power(-12.0, 12.0);
  for (int k = 0; k < 1000; ++k) {
    const double x = std::pow(10.0, power(random));
    const double round = round_number(x);
    EXPECT_TRUE((std::set<int>{1, 2, 5}.contains(only_digit(round)))) << x;
    // Round numbers are at most a factor of 2.5 apart: the nearest one is within its root.
    EXPECT_LE(std::abs(std::log(round / x)), 0.5 * std::log(2.5) + 1e-12) << x;
  }
}

TEST(RoundNumbers, TicksFillTheRange) {
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> place(-1e4, 1e4);
  std::uniform_real_distribution<double> power(-2.0, 5.0);
  for (int k = 0; k < 1000; ++k) {
    const double low = place(random);
    const double high = low + std::pow(10.0, power(random));
    const std::vector<double> ticks = round_ticks(low, high, 8);
    ASSERT_GE(ticks.size(), 5U) << low << ' ' << high;
    ASSERT_LE(ticks.size(), 14U) << low << ' ' << high;
    const double step = ticks[1] - ticks[0];
    const double rounding = 1e-8 * step + 1e-11 * std::abs(low);
    EXPECT_GE(ticks.front(), low - rounding);
    EXPECT_LE(ticks.back(), high + rounding);
    EXPECT_GE(ticks.back() + step, high - rounding) << "no tick is missing at the end";
    for (std::size_t i = 1; i < ticks.size(); ++i) {
      EXPECT_NEAR(ticks[i] - ticks[i - 1], step, rounding);
    }
  }
}

TEST(RoundNumbers, TicksHoldBothEnds) {
  EXPECT_EQ(round_ticks(0.0, 5.0, 5), (std::vector<double>{0, 1, 2, 3, 4, 5}));
  EXPECT_EQ(round_ticks(-10.0, 30.0, 4), (std::vector<double>{-10, 0, 10, 20, 30}));
  EXPECT_EQ(round_ticks(3.0, 3.0, 5), std::vector<double>{3.0});
  const std::vector<double> tenths = round_ticks(0.0, 0.3, 3); // 0.3 is no multiple of 0.1 in binary numbers
  EXPECT_EQ(tenths.size(), 4U);
}

TEST(RoundNumbers, TextHasTheDecimalsOfTheStep) {
  EXPECT_EQ(tick_text(0.30000000000000004, 0.1), "0.3");
  EXPECT_EQ(tick_text(-1e-17, 0.1), "0.0");
  EXPECT_EQ(tick_text(15.0, 5.0), "15");
  EXPECT_EQ(tick_text(-1200.0, 200.0), "-1200");
  EXPECT_EQ(tick_text(0.25, 0.05), "0.25");
  EXPECT_EQ(tick_text(2e7, 1e7), "2e+07");
  EXPECT_EQ(tick_text(3e-7, 1e-7), "3e-07");
  EXPECT_EQ(tick_text(4999990.0, 10.0), "4999990") << "ticks beside each other differ in map coordinates";
  EXPECT_EQ(tick_text(5000000.5, 0.5), "5000000.5");
}

} // namespace
} // namespace gcpdda::round_numbers_test
