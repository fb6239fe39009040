#include "closed_paths.hpp"
#include "friction_variants.hpp"
#include "stability.hpp"
#include "support/setting.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iostream>

namespace gcpdda::study {

namespace {

using namespace testing;

constexpr double radius = 0.8; ///< spectral radius
constexpr double k_n = 1e9;
const double omega = std::sqrt(k_n / rock_density);

/// Speed of a unit square after a flush rebound from a wide plane over that before. `phase`: share of a step
/// by which the first contact shifts within the step.
double rebound(const std::string &contact_time, double w, double phase) {
  constexpr double depth = 1e-4; ///< m, largest
  const double dt = w / omega;
  const double speed = depth * omega;
  const double gap = speed * dt * (2.0 + phase);
  const int num_steps = static_cast<int>(std::ceil(4.5 / w)) + 20;
  Simulation simulation(Communicator::self(),
                        scene_of(head({.duration = num_steps * dt,
                                       .time_step = dt,
                                       .gravity = {},
                                       .normal_stiffness = k_n,
                                       .damping = 0.0,
                                       .run_keys = fmt::format("contact_time = \"{}\"\nspectral_radius = {}",
                                                               contact_time, radius)}) +
                                 block_toml("plane", rectangle({-3.0, -2.0}, {4.0, 0.0}), "fixed = true") +
                                 block_toml("square", rectangle({0.0, gap}, {1.0, 1.0 + gap}),
                                            fmt::format("velocity = [0.0, {:.17g}, 0.0]", -speed))));
  advance(simulation, simulation.plan().duration);
  return velocity_of(simulation, 1).u.y / speed;
}

// Half a period of contact is pi/W steps. Forces at the start of the step let the amplitude grow by
// (1 - alpha_f) W^2/2 in each.
double predicted(const std::string &contact_time, double w) {
  return contact_time == "start" ? std::exp(std::numbers::pi * w / (2.0 * (1.0 + radius))) : 1.0;
}

void restitution(const Options &options) {
  Table table(options.folder / "restitution.csv", {"contact_time", "spectral_radius", "W", "num_phases",
                                                   "mean", "lowest", "highest", "predicted"});
  const int num_phases = options.quick ? 8 : 40;
  for (const std::string contact_time : {"start", "leapfrog"}) {
    for (const double w : {0.3, 0.1, 0.05, 0.02, 0.01}) {
      double sum = 0.0;
      double lowest = 2.0;
      double highest = 0.0;
      for (int i = 0; i < num_phases; ++i) {
        const double e = rebound(contact_time, w, static_cast<double>(i) / num_phases);
        sum += e;
        lowest = std::min(lowest, e);
        highest = std::max(highest, e);
      }
      const double mean = sum / num_phases;
      table.add({contact_time, radius, w, std::int64_t{num_phases}, mean, lowest, highest,
                 predicted(contact_time, w)});
      std::cout << fmt::format(
          "rebound, contact at {}, W = {}: e = {:.4f} ({:.4f} to {:.4f}), predicted {:.4f}\n", contact_time,
          w, mean, lowest, highest, predicted(contact_time, w));
    }
  }
}

} // namespace

void rejected_variants(const Options &options) {
  restitution(options);
  friction_variants(options);
  closed_paths(options);
}

} // namespace gcpdda::study
