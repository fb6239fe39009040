#include "amplification_matrix.hpp"

#include "support/eigenvalues.hpp"

#include <Eigen/LU>

#include <fmt/format.h>

#include <stdexcept>

namespace gcpdda::study {

namespace {

constexpr double radii[] = {0.0, 0.25, 0.5, 0.8, 0.9, 1.0};

/// Newmark's update, the balance (1 - alpha_m) a' + alpha_m a, elasticity at (1 - alpha_f) d' + alpha_f d and
/// contact at d + velocity_share dt v + acceleration_share dt^2 a.
struct Coefficients {
  double alpha_m = 0.0;
  double alpha_f = 0.0;
  double beta = 0.0;
  double gamma = 0.0;
  double velocity_share = 0.0;
  double acceleration_share = 0.0;
};

Coefficients chung_hulbert(const std::string &contact_time, double r) {
  Coefficients c;
  c.alpha_m = (2.0 * r - 1.0) / (r + 1.0);
  c.alpha_f = r / (r + 1.0);
  c.beta = 1.0 / ((1.0 + r) * (1.0 + r));
  c.gamma = 0.5 * (3.0 - r) / (1.0 + r);
  const double middle = 1.0 / (1.0 + r);
  if (contact_time == "leapfrog") {
    c.velocity_share = middle;
    c.acceleration_share = 0.5 * (2.0 * r - 1.0) * (1.0 - r) * c.beta;
  } else if (contact_time == "predictor") {
    c.velocity_share = middle;
    c.acceleration_share = middle * (0.5 - c.beta);
  } else if (contact_time == "predictor-end") {
    c.velocity_share = 1.0;
    c.acceleration_share = 0.5 - c.beta;
  } else if (contact_time != "start") {
    throw std::logic_error("unknown contact time " + contact_time);
  }
  return c;
}

Coefficients coefficients(const Member &member) {
  const double r = member.spectral_radius;
  if (member.scheme == "generalized-alpha") {
    return chung_hulbert(member.contact_time, r);
  }
  if (member.scheme == "newmark-dda") { // a' = 2 (d' - d - dt v)/dt^2, contact at d + dt v
    return {0.0, 0.0, 0.5, 1.0, 1.0, 0.0};
  }
  if (member.scheme == "central-difference") { // d' is known before a'
    return {0.0, 0.0, 0.0, 0.5, 1.0, 0.5};
  }
  if (member.scheme == "explicit-generalized-alpha") {
    const double alpha_m = (2.0 * r - 1.0) / (1.0 + r);
    return {alpha_m, 1.0, (5.0 - 3.0 * r) / ((1.0 + r) * (1.0 + r) * (2.0 - r)), 1.5 - alpha_m, 0.0, 0.0};
  }
  throw std::logic_error("unknown scheme " + member.scheme);
}

} // namespace

std::string Member::run_keys() const {
  std::string keys = fmt::format("scheme = \"{}\"", scheme);
  if (!contact_time.empty()) {
    keys += fmt::format("\ncontact_time = \"{}\"", contact_time);
  }
  if (scheme.ends_with("generalized-alpha")) {
    keys += fmt::format("\nspectral_radius = {}", spectral_radius);
  }
  return keys;
}

std::vector<Member> all_members() {
  std::vector<Member> members;
  for (const char *contact_time : {"leapfrog", "start", "predictor", "predictor-end"}) {
    for (const double r : radii) {
      members.push_back({"generalized-alpha", contact_time, r});
    }
  }
  for (const char *scheme : {"newmark-dda", "central-difference"}) {
    members.push_back({scheme, "", 0.0});
  }
  for (const double r : radii) {
    members.push_back({"explicit-generalized-alpha", "", r});
  }
  return members;
}

Eigen::MatrixXd amplification_matrix(const Member &member, const LinearSystem &system, Elastic elastic) {
  const Coefficients c = coefficients(member);
  const Eigen::Index n = system.contact.rows();
  const Eigen::MatrixXd one = Eigen::MatrixXd::Identity(n, n);
  const Eigen::MatrixXd zero = Eigen::MatrixXd::Zero(n, n);
  const bool implicit = elastic == Elastic::implicit;
  const Eigen::MatrixXd later = implicit ? system.elastic : zero;
  const Eigen::MatrixXd at_trial = implicit ? system.contact : system.contact + system.elastic;

  Eigen::MatrixXd left(3 * n, 3 * n);
  left << one, zero, -c.beta * one, zero, one, -c.gamma * one, (1.0 - c.alpha_f) * later, zero,
      (1.0 - c.alpha_m) * one;
  Eigen::MatrixXd right(3 * n, 3 * n);
  right << one, one, (0.5 - c.beta) * one, zero, one, (1.0 - c.gamma) * one, -at_trial - c.alpha_f * later,
      -c.velocity_share * at_trial - system.dashpot, -c.acceleration_share * at_trial - c.alpha_m * one;
  return left.partialPivLu().solve(right);
}

double oscillator_growth(const Member &member, double w, double damping_ratio) {
  const auto number = [](double x) { return Eigen::MatrixXd::Constant(1, 1, x); };
  return testing::spectral_radius(
      amplification_matrix(member, {number(w * w), number(2.0 * damping_ratio * w), number(0.0)}));
}

double oscillator_limit(const Member &member, double damping_ratio) {
  // Eigenvalues that meet on the unit circle are known to the square root of rounding.
  const auto grows = [&](double w) { return oscillator_growth(member, w, damping_ratio) > 1.0 + 1e-7; };
  constexpr double stride = 0.01;
  double low = 0.03;
  if (grows(low)) {
    return 0.0;
  }
  while (!grows(low + stride)) {
    low += stride;
  }
  double high = low + stride;
  while (high - low > 1e-6) {
    const double middle = 0.5 * (low + high);
    (grows(middle) ? high : low) = middle;
  }
  return low;
}

} // namespace gcpdda::study
