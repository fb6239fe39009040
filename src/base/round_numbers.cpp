#include "base/round_numbers.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <utility>

namespace gcpdda {

double round_number(double x) {
  const double power = std::pow(10.0, std::floor(std::log10(x)));
  for (const auto &[limit, number] :
       {std::pair(std::sqrt(2.0), 1.0), std::pair(std::sqrt(10.0), 2.0), std::pair(std::sqrt(50.0), 5.0)}) {
    if (x < limit * power) {
      return number * power;
    }
  }
  return 10.0 * power;
}

double two_digits_below(double x) {
  constexpr double rounding = 1e-12;
  const double unit = std::pow(10.0, std::floor(std::log10(x)) - 1.0);
  return std::floor(x / unit * (1.0 + rounding)) * unit;
}

double two_digits_above(double x) {
  const double unit = std::pow(10.0, std::floor(std::log10(x)) - 1.0);
  return std::ceil(x / unit) * unit;
}

std::vector<double> round_ticks(double low, double high, int about) {
  if (!(high > low)) {
    return {low};
  }
  const double step = round_number((high - low) / about);
  constexpr double rounding = 1e-9; // of a step: an end of the range that is a multiple is a tick
  std::vector<double> ticks;
  const double first = std::ceil(low / step - rounding);
  const auto number = static_cast<int>(std::floor(high / step + rounding) - first) + 1;
  for (int k = 0; k < number; ++k) {
    ticks.push_back((first + k) * step);
  }
  return ticks;
}

std::string tick_text(double value, double step) {
  std::array<char, 32> text{};
  constexpr double largest_plain = 1e15;
  if (std::abs(value) >= largest_plain || step >= 1e6 || step < 1e-5) {
    std::snprintf(text.data(), text.size(), "%.6g", value);
  } else {
    const int decimals = std::max(0, -static_cast<int>(std::floor(std::log10(step) + 1e-9)));
    const double nothing = 0.5 * std::pow(10.0, -decimals);
    std::snprintf(text.data(), text.size(), "%.*f", decimals, std::abs(value) < nothing ? 0.0 : value);
  }
  return text.data();
}

} // namespace gcpdda
