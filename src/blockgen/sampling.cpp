#include "blockgen/sampling.hpp"

#include "model/joint_plane.hpp"

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

// The inverse of the distribution, with its limits as powers of their ratio: exact for every exponent.
double sample_power_law(const Scattered &length, Draw &draw) {
  const double ratio = std::log(length.high / length.low);
  const double exponent = (1.0 - length.width) * ratio;
  const double u = draw.uniform();
  const double share = exponent == 0.0 ? u : std::log1p(u * std::expm1(exponent)) / exponent;
  return std::clamp(length.low * std::exp(share * ratio), length.low, length.high);
}

/// Angle between a direction and the mean one by Fisher's distribution.
double sample_fisher(double concentration, Draw &draw) {
  const double u = draw.uniform();
  const double cosine = 1.0 + std::log1p(-u * -std::expm1(-2.0 * concentration)) / concentration;
  return std::acos(std::clamp(cosine, -1.0, 1.0));
}

} // namespace

double sample_length(const Scattered &length, Draw draw) {
  if (length.spread == Spread::power_law) {
    return sample_power_law(length, draw);
  }
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

double sample_trace_angle(const JointPlane &plane, Draw draw) {
  constexpr int most_draws = 1000; // a mean plane that meets the section is seldom refused
  for (int i = 0; i < most_draws; ++i) {
    const double angle = sample_fisher(plane.fisher, draw);
    const double around = 2.0 * std::numbers::pi * draw.uniform();
    const Pole pole = pole_near(plane, angle, around);
    if (draw.uniform() < share_in_section(pole)) {
      return trace_angle(pole);
    }
  }
  return trace_angle(pole_of(plane));
}

double sample_angle(const Scattered &angle, Draw draw) {
  if (angle.spread == Spread::normal) {
    return angle.mean + angle.width * draw.normal();
  }
  if (angle.spread == Spread::fisher) {
    const double turn = sample_fisher(angle.width, draw);
    return angle.mean + (draw.uniform() < 0.5 ? -turn : turn);
  }
  return angle.mean;
}

} // namespace gcpdda::blockgen
