// Many steps: rigid polygons that bounce without loss in a closed box keep their energy without trend.

#include "stability.hpp"

#include "simulation/energy_ledger.hpp"
#include "support/setting.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <numbers>
#include <random>

namespace gcpdda::study {

namespace {

using testing::block_toml;
using testing::placed;
using testing::random_polygon;
using testing::rectangle;

constexpr int num_columns = 10;
constexpr int num_polygons = num_columns * num_columns;
constexpr double spacing = 1.3;  ///< m
constexpr double safety = 0.025; ///< W = 2 safety = 0.05 at most, at a block touched all around

/// Regular and irregular polygons on a grid with random velocities, between four fixed walls.
std::string box(double duration) {
  std::mt19937 engine(20261121);
  const auto share = [&] { return static_cast<double>(engine()) / 4294967296.0; };
  constexpr double high = num_columns * spacing;
  std::string toml = testing::head({.duration = duration,
                                    .gravity = {},
                                    .normal_stiffness = stiffness(1.0, 1.0),
                                    .damping = 0.0,
                                    .run_keys = fmt::format("safety = {}", safety)}) +
                     block_toml("low", rectangle({-2.0, -2.0}, {high + 2.0, 0.0}), "fixed = true") +
                     block_toml("high", rectangle({-2.0, high}, {high + 2.0, high + 2.0}), "fixed = true") +
                     block_toml("left", rectangle({-2.0, 0.0}, {0.0, high}), "fixed = true") +
                     block_toml("right", rectangle({high, 0.0}, {high + 2.0, high}), "fixed = true");
  for (int k = 0; k < num_polygons; ++k) {
    const Vec2 centre{spacing * (k % num_columns + 0.5), spacing * (k / num_columns + 0.5)};
    const int num_vertices = 3 + k % 6;
    std::vector<Vec2> shape;
    if (k % 2 == 0) {
      for (int i = 0; i < num_vertices; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / num_vertices;
        shape.push_back({0.6 * std::cos(angle), 0.6 * std::sin(angle)});
      }
      shape = placed(shape, share(), centre);
    } else {
      shape = random_polygon(static_cast<unsigned>(engine()), num_vertices, 0.6, centre);
    }
    const double vx = 2.0 * share() - 1.0;
    const double vy = 2.0 * share() - 1.0;
    toml += block_toml(fmt::format("p{}", k), shape,
                       fmt::format("velocity = [{:.17g}, {:.17g}, {:.17g}]", vx, vy, 2.0 * share() - 1.0));
  }
  return toml;
}

/// Straight line through points, and how well its slope is known.
struct Trend {
  double slope = 0.0;
  double error = 0.0; ///< standard error of the slope, were the points independent
  double scatter = 0.0;
};

Trend trend_of(const std::vector<double> &x, const std::vector<double> &y) {
  const auto n = static_cast<double>(x.size());
  double mean_x = 0.0;
  double mean_y = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    mean_x += x[i] / n;
    mean_y += y[i] / n;
  }
  double sxx = 0.0;
  double sxy = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    sxx += (x[i] - mean_x) * (x[i] - mean_x);
    sxy += (x[i] - mean_x) * (y[i] - mean_y);
  }
  Trend trend{sxy / sxx, 0.0, 0.0};
  double squares = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double off = y[i] - mean_y - trend.slope * (x[i] - mean_x);
    squares += off * off;
  }
  trend.scatter = std::sqrt(squares / (n - 2.0));
  trend.error = trend.scatter / std::sqrt(sxx);
  return trend;
}

} // namespace

void soak(const Options &options) {
  constexpr int num_rows = 50;
  const double block_steps = options.quick ? 3e5 : 6e7;
  const double step = Simulation(Communicator::self(), testing::scene_of(box(1.0))).bound().time_step;
  const double duration = step * block_steps / num_polygons;
  Simulation simulation(Communicator::self(), testing::scene_of(box(duration)));
  const EnergyLedger ledger(simulation.state());
  const double start = ledger.row(simulation.state()).kinetic;
  Table table(options.folder / "soak.csv", {"steps", "block_steps", "time", "energy_ratio"});
  std::vector<double> millions;
  std::vector<double> logs;
  Cost cost;
  for (int row = 1; row <= num_rows && !simulation.fault(); ++row) {
    const Cost part = advance(simulation, duration * row / num_rows);
    cost.cpu += part.cpu;
    cost.contact_steps += part.contact_steps;
    const EnergyRow energy = ledger.row(simulation.state());
    const double ratio = (energy.kinetic + energy.contact_normal) / start;
    table.add({simulation.step_count(), simulation.step_count() * num_polygons, simulation.time(), ratio});
    millions.push_back(1e-6 * static_cast<double>(simulation.step_count() * num_polygons));
    logs.push_back(std::log(ratio));
  }
  const Trend trend = trend_of(millions, logs);
  double largest = 0.0;
  for (const double value : logs) {
    largest = std::max(largest, std::abs(value));
  }
  std::cout << fmt::format(
      "Soak: {} polygons, W <= {:g}, {} steps, {:.3g} block-steps, {} contact-steps, {:.1f} s{}\n"
      "    ln(E/E0): slope {:.2e} +- {:.1e} per 1e6 block-steps, {:.1e} in all, scatter {:.1e}, largest "
      "{:.2e}\n",
      num_polygons, 2.0 * safety, simulation.step_count(), 1e6 * millions.back(), cost.contact_steps,
      cost.cpu, simulation.fault() ? ", STOPPED by a fault" : "", trend.slope, trend.error,
      trend.slope * millions.back(), trend.scatter, largest);
}

} // namespace gcpdda::study
