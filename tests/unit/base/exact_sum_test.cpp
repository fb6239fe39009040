#include "base/exact_sum.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>
#include <vector>

namespace gcpdda::exact_sum_test {
namespace {

__extension__ using Integer = __int128;

using Limits = std::numeric_limits<double>;

double sum_of(const std::vector<double> &values) {
  ExactSum sum;
  for (const double value : values) {
    sum.add(value);
  }
  return sum.value();
}

/// Random bits, any sign, |value| in [2^low, 2^high).
double random_double(std::mt19937_64 &engine, int low, int high) {
  const auto mantissa = static_cast<double>((engine() >> 11) | (std::uint64_t{1} << 52)); // [2^52, 2^53)
  const int exponent = low + static_cast<int>(engine() % static_cast<std::uint64_t>(high - low));
  return std::ldexp((engine() & 1U) != 0 ? mantissa : -mantissa, exponent - 52);
}

TEST(ExactSum, OfNothingIsZero) {
  EXPECT_EQ(ExactSum{}.value(), 0.0);
  EXPECT_EQ(sum_of({0.0, -0.0, 0.0}), 0.0);
}

TEST(ExactSum, OfOneValueIsThatValue) {
  std::mt19937_64 engine(1);
  for (int trial = 0; trial < 10000; ++trial) {
    const double value = random_double(engine, -1070, 1023);
    ASSERT_EQ(sum_of({value}), value);
  }
  for (const double value :
       {Limits::denorm_min(), -Limits::denorm_min(), Limits::min(), -Limits::max(), Limits::max(),
        5.0 * Limits::denorm_min(), Limits::min() - Limits::denorm_min()}) {
    EXPECT_EQ(sum_of({value}), value);
  }
}

TEST(ExactSum, CancelsExactly) {
  EXPECT_EQ(sum_of({1e300, 1.0, -1e300}), 1.0);
  EXPECT_EQ(sum_of({1e300, Limits::denorm_min(), -1e300}), Limits::denorm_min());
  EXPECT_EQ(sum_of({-1e300, -Limits::denorm_min(), 1e300}), -Limits::denorm_min());
  EXPECT_EQ(sum_of({1.0, 1e-30, -1.0, -1e-30}), 0.0);
  EXPECT_EQ(sum_of({Limits::max(), Limits::max(), -Limits::max()}), Limits::max());
  EXPECT_EQ(sum_of(std::vector<double>(1000, -Limits::denorm_min())), -1000.0 * Limits::denorm_min());
}

// Against integers: values are whole numbers of 2^-30 below 2^35, so 65 bits each. The sum is rounded digit
// by digit from the top: within one unit in the last place of the correctly rounded one.
TEST(ExactSum, AgreesWithIntegers) {
  std::mt19937_64 engine(2);
  for (int trial = 0; trial < 300; ++trial) {
    std::vector<double> values;
    Integer exact = 0;
    for (int k = 0; k < 500; ++k) {
      const double value = std::ldexp(std::trunc(random_double(engine, -10, 65)), -30);
      values.push_back(trial % 2 == 0 ? value : -std::abs(value)); // negative totals too
      exact += static_cast<Integer>(std::ldexp(values.back(), 30));
    }
    const double rounded = std::ldexp(static_cast<double>(exact), -30);
    const double sum = sum_of(values);
    ASSERT_LE(sum, std::nextafter(rounded, Limits::infinity()));
    ASSERT_GE(sum, std::nextafter(rounded, -Limits::infinity()));
  }
}

TEST(ExactSum, IsOddInItsSummands) {
  std::mt19937_64 engine(3);
  for (int trial = 0; trial < 200; ++trial) {
    std::vector<double> values;
    std::vector<double> opposite;
    for (int k = 0; k < 50; ++k) {
      values.push_back(random_double(engine, -60, 60));
      opposite.push_back(-values.back());
    }
    ASSERT_EQ(sum_of(opposite), -sum_of(values));
  }
}

TEST(ExactSum, DoesNotDependOnTheOrder) {
  std::mt19937_64 engine(4);
  int plain_sums_differ = 0;
  for (const int high : {-900, -3, 40, 1000}) {
    std::vector<double> values;
    for (int k = 0; k < 1000; ++k) {
      values.push_back(random_double(engine, -1000, high));
    }
    const double sum = sum_of(values);
    const auto plain = [&] {
      double total = 0.0;
      for (const double value : values) {
        total += value;
      }
      return total;
    };
    const double first = plain();
    for (int shuffle = 0; shuffle < 50; ++shuffle) {
      std::shuffle(values.begin(), values.end(), engine);
      ASSERT_EQ(sum_of(values), sum);
      plain_sums_differ += plain() != first ? 1 : 0;
    }
  }
  EXPECT_GT(plain_sums_differ, 50) << "the values must be able to tell";
}

// What ranks do: sums of parts, limbs added as integers, in any cut.
TEST(ExactSum, LimbsOfPartsAdd) {
  std::mt19937_64 engine(5);
  std::vector<double> values;
  for (int k = 0; k < 999; ++k) {
    values.push_back(random_double(engine, -300, 300));
  }
  for (const std::size_t num_parts : {2U, 3U, 7U}) {
    std::vector<ExactSum> parts(num_parts);
    for (const double value : values) {
      parts[engine() % num_parts].add(value);
    }
    for (std::size_t p = 1; p < num_parts; ++p) {
      for (std::size_t k = 0; k < ExactSum::num_limbs; ++k) {
        parts[0].limbs()[k] += parts[p].limbs()[k];
      }
    }
    EXPECT_EQ(parts[0].value(), sum_of(values));
  }
}

// 2^30 summands of the worst digits: limbs doubled 30 times.
TEST(ExactSum, HoldsABillionSummands) {
  for (const double value :
       {1.0 - Limits::epsilon() / 2.0, -1.0 + Limits::epsilon() / 2.0, 4.0 / 3.0, -1e-308}) {
    ExactSum sum;
    sum.add(value);
    for (int doubling = 0; doubling < 30; ++doubling) {
      for (std::int64_t &limb : sum.limbs()) {
        limb *= 2;
      }
    }
    EXPECT_EQ(sum.value(), std::ldexp(value, 30));
  }
}

} // namespace
} // namespace gcpdda::exact_sum_test
