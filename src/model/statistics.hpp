#pragma once

// The normal distribution, and what a count of trials says of a probability.

#include <cstdint>
#include <span>
#include <vector>

namespace gcpdda {

/// Of a normal variable with mean 0 and deviation 1.
double normal_probability(double x);
/// Its inverse, for p in (0, 1): a rational approximation (Abramowitz and Stegun 26.2.23, error 4.5e-4) made
/// exact up to rounding by Halley's method.
double normal_quantile(double p);

struct Interval {
  double low = 0.0;
  double high = 0.0;
};

/// Where the probability of an event lies that was seen `seen` times in `trials` independent trials: the
/// exact interval of Clopper and Pearson (doi:10.1093/biomet/26.4.404), which holds the probability at least
/// as often as `confidence` says. Its ends are the probabilities at which seeing so many or more, and so many
/// or fewer, has a chance of (1 - confidence)/2.
Interval probability_interval(std::int64_t seen, std::int64_t trials, double confidence);

/// Of a sample; deviation and skewness are those of the population it is from, estimated (n - 1), and 0 where
/// the sample is too small for them.
struct SampleMoments {
  std::int64_t number = 0;
  double mean = 0.0;
  double deviation = 0.0;
  double skewness = 0.0;
  double least = 0.0;
  double most = 0.0;

  [[nodiscard]] double standard_error() const;
};
SampleMoments sample_moments(std::span<const double> sample);

/// The middle one of a sample, or the mean of both in the middle; 0 of none.
double median_of(std::vector<double> sample);

} // namespace gcpdda
