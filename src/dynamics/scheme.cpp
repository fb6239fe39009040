#include "dynamics/scheme.hpp"

#include "base/check.hpp"
#include "dynamics/eigenvalues.hpp"

#include <Eigen/Core>

#include <cmath>

namespace gcpdda {

namespace {

Scheme coefficients(SchemeKind kind, double r, ContactTime contact_time) {
  Scheme s;
  switch (kind) {
  case SchemeKind::generalized_alpha:
    s.alpha_m = (2.0 * r - 1.0) / (r + 1.0);
    s.alpha_f = r / (r + 1.0);
    s.gamma = 0.5 - s.alpha_m + s.alpha_f;
    s.beta = 0.25 * (1.0 - s.alpha_m + s.alpha_f) * (1.0 - s.alpha_m + s.alpha_f);
    switch (contact_time) {
    case ContactTime::leapfrog:
      s.trial_velocity = 1.0 - s.alpha_f;
      s.trial_acceleration = (2.0 * r - 1.0) * (1.0 - r) / (2.0 * (1.0 + r) * (1.0 + r));
      break;
    case ContactTime::start:
      break;
    case ContactTime::predictor:
      s.trial_velocity = 1.0 - s.alpha_f;
      s.trial_acceleration = (1.0 - s.alpha_f) * (0.5 - s.beta);
      break;
    case ContactTime::predictor_end:
      s.trial_velocity = 1.0;
      s.trial_acceleration = 0.5 - s.beta;
      break;
    }
    return s;
  case SchemeKind::newmark_dda:
    s.beta = 0.5;
    s.gamma = 1.0;
    s.trial_velocity = 1.0;
    return s;
  case SchemeKind::central_difference:
    s.gamma = 0.5;
    s.trial_velocity = 1.0;
    s.trial_acceleration = 0.5;
    return s;
  case SchemeKind::explicit_generalized_alpha:
    // doi:10.1016/S0045-7825(96)01036-5: forces at t_n.
    s.alpha_m = (2.0 * r - 1.0) / (1.0 + r);
    s.alpha_f = 1.0;
    s.beta = (5.0 - 3.0 * r) / ((1.0 + r) * (1.0 + r) * (2.0 - r));
    s.gamma = 1.5 - s.alpha_m;
    return s;
  }
  throw InternalError("unknown scheme");
}

} // namespace

Scheme make_scheme(SchemeKind kind, double spectral_radius, ContactTime contact_time) {
  Scheme s = coefficients(kind, spectral_radius, contact_time);
  s.load_time = 1.0 - s.alpha_f;
  return s;
}

double amplification(const Scheme &s, double w, double xi) {
  // State (d, dt v, dt^2 a); f dt^2/M = -w^2 d* - 2 xi w (dt v).
  const Eigen::RowVector3d trial(1.0, s.trial_velocity, s.trial_acceleration);
  const Eigen::RowVector3d d(1.0, 0.0, 0.0);
  const Eigen::RowVector3d v(0.0, 1.0, 0.0);
  const Eigen::RowVector3d a(0.0, 0.0, 1.0);
  const Eigen::RowVector3d a_new = (-w * w * trial - 2.0 * xi * w * v - s.alpha_m * a) / (1.0 - s.alpha_m);
  Eigen::Matrix3d step;
  step.row(0) = d + v + (0.5 - s.beta) * a + s.beta * a_new;
  step.row(1) = v + (1.0 - s.gamma) * a + s.gamma * a_new;
  step.row(2) = a_new;
  return spectral_radius(std::span(step.data(), 9));
}

double stability_limit(const Scheme &scheme, double damping_ratio, double local_damping) {
  if (local_damping > 0.0) {
    const double faster = std::sqrt(1.0 + local_damping);
    return stability_limit(scheme, faster * damping_ratio) / faster;
  }
  // Two eigenvalues meet on the unit circle at W = 0 and at the limit, where they are sensitive to rounding
  // as its square root: hence the step away from 0 and the bound on growth.
  constexpr double first = 0.01;
  constexpr double step = 0.005;
  constexpr double growth = 1e-9;
  const auto stable = [&](double w) { return amplification(scheme, w, damping_ratio) <= 1.0 + growth; };
  if (!stable(first)) {
    return 0.0;
  }
  double low = first;
  while (stable(low + step) && low < 10.0) {
    low += step;
  }
  double high = low + step;
  for (int i = 0; i < 40; ++i) {
    const double middle = 0.5 * (low + high);
    (stable(middle) ? low : high) = middle;
  }
  return low;
}

} // namespace gcpdda
