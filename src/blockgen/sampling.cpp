#include "blockgen/sampling.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace gcpdda::blockgen {

namespace {

double sample_once(const Scattered &length, Draw &draw) {
  switch (length.spread) {
  case Spread::normal:
    return length.mean + length.width * draw.normal();
  case Spread::lognormal: {
    const double share = length.width / length.mean;
    const double log_variance = std::log1p(share * share);
    return length.mean * std::exp(std::sqrt(log_variance) * draw.normal() - 0.5 * log_variance);
  }
  case Spread::exponential:
    return -length.mean * std::log(draw.uniform());
  default:
    return length.mean;
  }
}

} // namespace

double sample_length(const Scattered &length, Draw draw) {
  const double low = Scattered::lowest_share * length.mean;
  const double high = Scattered::highest_share * length.mean;
  constexpr int most_draws = 1000; // only a deviation far beyond the mean comes near it
  for (int i = 0; i < most_draws; ++i) {
    const double x = sample_once(length, draw);
    if (low <= x && x <= high) {
      return x;
    }
  }
  return length.mean;
}

double sample_angle(const Scattered &angle, Draw draw) {
  if (angle.spread == Spread::normal) {
    return angle.mean + angle.width * draw.normal();
  }
  if (angle.spread == Spread::fisher) {
    const double u = draw.uniform();
    const double cosine = 1.0 + std::log1p(-u * -std::expm1(-2.0 * angle.width)) / angle.width;
    const double turn = std::acos(std::clamp(cosine, -1.0, 1.0));
    return angle.mean + (draw.uniform() < 0.5 ? -turn : turn);
  }
  return angle.mean;
}

} // namespace gcpdda::blockgen
