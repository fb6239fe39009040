#include "model/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace gcpdda {

namespace {

/// Chance of at most `seen` events in `trials`, each with probability p in (0, 1).
double chance_of_at_most(std::int64_t seen, std::int64_t trials, double p) {
  const auto n = static_cast<double>(trials);
  double chance = 0.0;
  for (std::int64_t k = 0; k <= seen; ++k) {
    const auto x = static_cast<double>(k);
    chance += std::exp(std::lgamma(n + 1.0) - std::lgamma(x + 1.0) - std::lgamma(n - x + 1.0) +
                       x * std::log(p) + (n - x) * std::log1p(-p));
  }
  return chance;
}

/// The p at which that chance, which falls with p, is `chance`.
double probability_of_chance(std::int64_t seen, std::int64_t trials, double chance) {
  double low = 0.0;
  double high = 1.0;
  constexpr int halvings = 50; // up to rounding
  for (int i = 0; i < halvings; ++i) {
    const double middle = 0.5 * (low + high);
    (chance_of_at_most(seen, trials, middle) > chance ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

} // namespace

double normal_probability(double x) {
  return 0.5 * std::erfc(-x / std::numbers::sqrt2);
}

double normal_quantile(double p) {
  const double tail = std::min(p, 1.0 - p);
  const double t = std::sqrt(-2.0 * std::log(tail));
  double x =
      (2.515517 + t * (0.802853 + t * 0.010328)) / (1.0 + t * (1.432788 + t * (0.189269 + t * 0.001308))) - t;
  for (int i = 0; i < 2; ++i) {
    const double density = std::exp(-0.5 * x * x) / std::sqrt(2.0 * std::numbers::pi);
    const double step = (normal_probability(x) - tail) / density;
    x -= step / (1.0 + 0.5 * x * step);
  }
  return p < 0.5 ? x : -x;
}

Interval probability_interval(std::int64_t seen, std::int64_t trials, double confidence) {
  const double outside = 0.5 * (1.0 - confidence);
  return {seen == 0 ? 0.0 : probability_of_chance(seen - 1, trials, 1.0 - outside),
          seen == trials ? 1.0 : probability_of_chance(seen, trials, outside)};
}

double SampleMoments::standard_error() const {
  return number > 0 ? deviation / std::sqrt(static_cast<double>(number)) : 0.0;
}

SampleMoments sample_moments(std::span<const double> sample) {
  SampleMoments moments;
  moments.number = static_cast<std::int64_t>(sample.size());
  if (sample.empty()) {
    return moments;
  }
  const auto n = static_cast<double>(sample.size());
  for (const double x : sample) {
    moments.mean += x / n;
  }
  double squares = 0.0;
  double cubes = 0.0;
  for (const double x : sample) {
    const double d = x - moments.mean;
    squares += d * d;
    cubes += d * d * d;
  }
  const auto [least, most] = std::minmax_element(sample.begin(), sample.end());
  moments.least = *least;
  moments.most = *most;
  moments.deviation = n > 1.0 ? std::sqrt(squares / (n - 1.0)) : 0.0;
  if (n > 2.0 && moments.deviation > 0.0) {
    moments.skewness = n * cubes / ((n - 1.0) * (n - 2.0) * std::pow(moments.deviation, 3.0));
  }
  return moments;
}

double median_of(std::vector<double> sample) {
  if (sample.empty()) {
    return 0.0;
  }
  std::sort(sample.begin(), sample.end());
  const std::size_t middle = sample.size() / 2;
  return sample.size() % 2 == 1 ? sample[middle] : 0.5 * (sample[middle - 1] + sample[middle]);
}

} // namespace gcpdda
