#include "gcpdda/model/ensemble.hpp"

#include "model/draw.hpp"
#include "model/statistics.hpp"

#include <algorithm>
#include <cmath>

namespace gcpdda {

namespace {

constexpr double most_seeds = 1e9;

/// Mean and deviation of the logarithm of a lognormal variable.
struct OfLogarithm {
  double mean;
  double deviation;

  explicit OfLogarithm(const Variation &variation) {
    const double share = variation.deviation / variation.mean;
    const double variance = std::log1p(share * share);
    mean = std::log(variation.mean) - 0.5 * variance;
    deviation = std::sqrt(variance);
  }
};

} // namespace

double Variation::probability(double x) const {
  if (distribution == Distribution::lognormal) {
    const OfLogarithm log(*this);
    return x > 0.0 ? normal_probability((std::log(x) - log.mean) / log.deviation) : 0.0;
  }
  return normal_probability((x - mean) / deviation);
}

double Variation::whole_quantile(double p) const {
  if (distribution == Distribution::lognormal) {
    const OfLogarithm log(*this);
    return std::exp(log.mean + log.deviation * normal_quantile(p));
  }
  return mean + deviation * normal_quantile(p);
}

double Variation::share_within() const {
  const bool has_ends = distribution == Distribution::normal || distribution == Distribution::lognormal;
  return has_ends ? probability(max) - probability(min) : 1.0;
}

double Variation::quantile(double p) const {
  switch (distribution) {
  case Distribution::uniform:
    return min + p * (max - min);
  case Distribution::triangular: { // its distribution function is two parabolas
    const double rising = (mode - min) / (max - min);
    return p < rising ? min + std::sqrt(p * (max - min) * (mode - min))
                      : max - std::sqrt((1.0 - p) * (max - min) * (max - mode));
  }
  case Distribution::seed:
    return std::floor(p * most_seeds);
  default:
    return std::clamp(whole_quantile(probability(min) + p * share_within()), min, max);
  }
}

std::vector<double> lower_factor(const std::vector<double> &matrix, std::size_t n) {
  std::vector<double> factor(n * n);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      double rest = matrix[i * n + j];
      for (std::size_t k = 0; k < j; ++k) {
        rest -= factor[i * n + k] * factor[j * n + k];
      }
      if (i == j && !(rest > 1e-12)) { // of entries of size one
        return {};
      }
      factor[i * n + j] = i == j ? std::sqrt(rest) : rest / factor[j * n + j];
    }
  }
  return factor;
}

std::vector<double> sample(const Ensemble &ensemble, std::int64_t member) {
  const std::size_t n = ensemble.variations.size();
  std::vector<double> probabilities;
  for (std::size_t i = 0; i < n; ++i) {
    probabilities.push_back(Draw(ensemble.seed, member, i).uniform());
  }
  if (!ensemble.correlation_factor.empty()) {
    std::vector<double> independent(n);
    std::transform(probabilities.begin(), probabilities.end(), independent.begin(), normal_quantile);
    for (std::size_t i = 0; i < n; ++i) {
      double normal = 0.0;
      for (std::size_t k = 0; k <= i; ++k) {
        normal += ensemble.correlation_factor[i * n + k] * independent[k];
      }
      // Beyond 8 deviations the probability is 1 up to rounding.
      probabilities[i] = normal_probability(std::clamp(normal, -8.0, 8.0));
    }
  }
  std::vector<double> values;
  for (std::size_t i = 0; i < n; ++i) {
    values.push_back(ensemble.variations[i].quantile(probabilities[i]));
  }
  return values;
}

} // namespace gcpdda
