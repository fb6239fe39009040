// Growth per step and limits of every scheme, measured on one contact oscillation.

#include "amplification_matrix.hpp"
#include "chain_limits.hpp"
#include "stability.hpp"
#include "support/eigenvalues.hpp"
#include "support/setting.hpp"

#include <Eigen/Eigenvalues>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <span>

namespace gcpdda::study {

namespace {

using namespace testing;

// A unit square flush on a wide plane: force k_n d (1 - d/2) at depth d, linear about its depth at rest to a
// share of the amplitude in m. Coordinates are known to 1e-16 m. So amplitudes stay within 1e-12 to 1e-5 m.
constexpr double k_n = 1e8;
const double depth = 1.0 - std::sqrt(1.0 - 2.0 * rock_density * earth_gravity / k_n);
const double omega = std::sqrt(k_n * (1.0 - depth) / rock_density);

Scene oscillator(const Member &member, double w, double damping_ratio, int num_steps, double kick) {
  const double dt = w / omega;
  return scene_of(head({.duration = num_steps * dt,
                        .time_step = dt,
                        .normal_stiffness = k_n,
                        .damping = damping_ratio,
                        .run_keys = member.run_keys()}) +
                  block_toml("plane", rectangle({-3.0, -2.0}, {4.0, 0.0}), "fixed = true") +
                  block_toml("square", rectangle({0.0, -depth}, {1.0, 1.0 - depth}),
                             fmt::format("velocity = [0.0, {:.17g}, 0.0]", kick * omega)));
}

/// What one oscillation did, step by step.
struct Oscillation {
  std::vector<double> displacement;  ///< m
  std::vector<double> log_amplitude; ///< of m
};

struct Kick {
  double start = 0.0; ///< amplitude, m
  double low = 0.0;   ///< the run ends outside [low, high]
  double high = 0.0;
};

Oscillation oscillate(const Member &member, double w, double damping_ratio, int num_steps, const Kick &kick) {
  Simulation simulation(Communicator::self(), oscillator(member, w, damping_ratio, num_steps, kick.start));
  Oscillation history;
  double amplitude = kick.start;
  while (!simulation.finished() && amplitude >= kick.low && amplitude <= kick.high) {
    simulation.step();
    const double displacement = displacement_of(simulation, 1).u.y;
    amplitude = std::hypot(displacement, velocity_of(simulation, 1).u.y / omega);
    history.displacement.push_back(displacement);
    history.log_amplitude.push_back(std::log(amplitude));
  }
  return history;
}

/// Slope of the least-squares line through (i, y_i).
double slope(std::span<const double> y) {
  const auto n = static_cast<double>(y.size());
  double moment = 0.0;
  for (std::size_t i = 0; i < y.size(); ++i) {
    moment += (static_cast<double>(i) - 0.5 * (n - 1.0)) * y[i];
  }
  return 12.0 * moment / (n * (n * n - 1.0));
}

/// Largest root of the recurrence x_{i+3} = p x_{i+2} + q x_{i+1} + s x_i that fits best: three unknowns a
/// step cannot obey a longer one. `rate`: log of the growth so far known, which scales the equations alike.
double recurrence_root(std::span<const double> x, double rate) {
  constexpr double excited = 3e-4; // of the largest singular value
  const double largest_x = std::abs(
      *std::max_element(x.begin(), x.end(), [](double a, double b) { return std::abs(a) < std::abs(b); }));
  const auto scaled = [&](std::size_t i) {
    return x[i] / largest_x * std::exp(-rate * static_cast<double>(i));
  };
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i + 3 < x.size(); ++i) {
    const Eigen::Vector3d before(scaled(i), scaled(i + 1), scaled(i + 2));
    normal += before * before.transpose();
    moment += scaled(i + 3) * before;
  }
  // A root that is not excited has no equation; least norm puts it inside.
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> parts(normal);
  Eigen::Vector3d fit = Eigen::Vector3d::Zero();
  for (Eigen::Index k = 0; k < 3; ++k) {
    if (parts.eigenvalues()(k) > excited * excited * parts.eigenvalues()(2)) {
      const Eigen::Vector3d direction = parts.eigenvectors().col(k);
      fit += direction.dot(moment) / parts.eigenvalues()(k) * direction;
    }
  }
  Eigen::Matrix3d companion;
  companion << 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, fit(0), fit(1), fit(2);
  return std::exp(rate) * spectral_radius(companion);
}

// The amplitude oscillates by a share of W within a period. That leaves 3/n^2 in the slope of n steps: 28
// periods or more keep it below 1e-4 W^2. Where the amplitude leaves the linear range before, too few steps
// average it out: there the recurrence tells.
double measured_growth(const Member &member, double w) {
  // With r = 1 a root at -1 stays; a predictor lets it grow from next to nothing, by W^2/4 a step.
  const bool is_slow = member.contact_time.starts_with("predictor") && member.spectral_radius == 1.0;
  const int num_steps = std::max(3000, static_cast<int>(is_slow ? 140.0 / (w * w) : 250.0 / w));
  constexpr Kick small{1e-12, 0.0, 1e-6};
  Oscillation history = oscillate(member, w, 0.0, num_steps, is_slow ? small : Kick{1e-7, 1e-8, 1e-6});
  if (!is_slow && history.log_amplitude.size() < 1000) {
    const bool grew = history.log_amplitude.back() > std::log(1e-7);
    history = oscillate(member, w, 0.0, num_steps, grew ? small : Kick{1e-6, 1e-13, 1e-5});
  }
  const std::size_t count = history.displacement.size();
  const bool is_long = count >= 1000 && !is_slow;
  const std::size_t first = is_long ? 0 : std::min(3 * count / 5, count - std::min<std::size_t>(count, 10));
  const double rate = slope(std::span(history.log_amplitude).subspan(first));
  return count < 1000 && !is_slow ? recurrence_root(std::span(history.displacement).subspan(first), rate)
                                  : std::exp(rate);
}

/// From `lowest` to 3, equal ratios.
std::vector<double> frequencies(int count, double lowest) {
  std::vector<double> values;
  for (int i = 0; i < count; ++i) {
    values.push_back(lowest * std::pow(3.0 / lowest, static_cast<double>(i) / (count - 1)));
  }
  return values;
}

void growth(const Options &options) {
  Table table(options.folder / "growth.csv",
              {"scheme", "contact_time", "spectral_radius", "W", "theory", "measured"});
  double worst = 0.0;
  double worst_weak = 0.0;
  for (const Member &member : all_members()) {
    for (const double w : options.quick ? frequencies(6, 0.1) : frequencies(25, 0.01)) {
      const double theory = oscillator_growth(member, w);
      const double measured = measured_growth(member, w);
      table.add({member.scheme, member.contact_time, member.spectral_radius, w, theory, measured});
      worst = std::max(worst, std::abs(measured / theory - 1.0));
      if (w < 0.5) {
        worst_weak = std::max(worst_weak, std::abs(measured - theory) / (w * w));
      }
    }
  }
  std::cout << fmt::format("growth per step, measured against theory: within {:.1e}; below W = 0.5 within "
                           "{:.1e} W^2\n",
                           worst, worst_weak);
}

/// Largest W without growth, by bisection on runs; 0 if even a small one grows.
double measured_limit(const Member &member, double damping_ratio, double accuracy) {
  const auto explodes = [&](double w) {
    constexpr Kick kick{1e-9, 0.0, 1e-6};
    return oscillate(member, w, damping_ratio, 5000, kick).log_amplitude.back() > std::log(kick.high);
  };
  if (damping_ratio == 0.0 && measured_growth(member, 0.05) > 1.0 + 1e-7) {
    return 0.0;
  }
  double low = 0.05;
  double high = 2.5;
  while (high - low > accuracy * low) {
    const double middle = 0.5 * (low + high);
    (explodes(middle) ? high : low) = middle;
  }
  return 0.5 * (low + high);
}

void limits(const Options &options) {
  Table table(options.folder / "limits.csv", {"scheme", "contact_time", "spectral_radius", "damping_ratio",
                                              "theory", "measured", "product"});
  double worst = 0.0;
  int both_zero = 0;
  const auto add = [&](const Member &member, double damping_ratio) {
    const double theory = oscillator_limit(member, damping_ratio);
    const double measured = measured_limit(member, damping_ratio, options.quick ? 5e-3 : 1e-3);
    const Simulation simulation(Communicator::self(), oscillator(member, 0.1, damping_ratio / 1.4, 1, 0.0));
    const double product = simulation.bound().always_unstable ? 0.0 : simulation.bound().limit;
    table.add({member.scheme, member.contact_time, member.spectral_radius, damping_ratio, theory, measured,
               product});
    if (theory == 0.0 && measured == 0.0) {
      ++both_zero;
    } else {
      worst = std::max(worst, std::abs(measured - theory) / std::max(theory, measured));
    }
  };
  for (const Member &member : all_members()) {
    add(member, 0.0);
  }
  for (const double r : {0.5, 0.8}) {
    add({.spectral_radius = r}, 0.05);
  }
  std::cout << fmt::format("limits W, measured against theory: within {:.2f} %; {} unstable for every W\n",
                           100.0 * worst, both_zero);
}

} // namespace

void linear_stability(const Options &options) {
  growth(options);
  limits(options);
  chain_limits(options);
}

} // namespace gcpdda::study
