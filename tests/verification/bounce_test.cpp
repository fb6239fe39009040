// A6: what an elastic impact returns. W = omega dt with omega of the whole face in contact.

#include "problem.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

namespace gcpdda::testing::bounce_test {
namespace {

constexpr double stiffness = 1e9;
constexpr double speed = 1.0; ///< m/s

/// Velocity of the trial configurations: constant to round-off while a block flies.
Vec2 trial_velocity(const Simulation &simulation, int block) {
  const BlockSystem &blocks = simulation.blocks();
  const std::size_t row = row_of(simulation, block);
  return (1.0 / simulation.plan().time_step) * blocks.motion[row].step;
}

bool touching(const Simulation &simulation) {
  return !simulation.history().empty();
}

constexpr int num_phases = 12;

// Truncation, O(W^2): the impact begins somewhere within a step.
TEST(Bounce, EqualSquaresExchangeVelocities) {
  constexpr double w = 0.1;
  const double dt = w / std::sqrt(2.0 * stiffness / rock_density); // reduced mass m/2
  double error = 0.0;
  for (int phase = 0; phase < num_phases; ++phase) {
    const double gap = (5.0 + static_cast<double>(phase) / num_phases) * speed * dt;
    Simulation simulation(
        Communicator::self(),
        scene_of(
            head({.duration = 80 * dt, .time_step = dt, .gravity = {}, .damping = 0.0}) +
            block_toml("moving", rectangle({-1.0 - gap, 0.0}, {-gap, 1.0}), "velocity = [1.0, 0.0, 0.0]") +
            block_toml("resting", rectangle({0.0, 0.0}, {1.0, 1.0}))));
    run(simulation);
    EXPECT_FALSE(touching(simulation));
    error = std::max(
        {error, norm(trial_velocity(simulation, 0)), norm(trial_velocity(simulation, 1) - Vec2{speed, 0.0})});
  }
  expect_below("A6 head-on equal squares, W = 0.1, 12 phases: error of the exchanged velocity", 2e-3, error);
}

/// A block 3 m thick with a face of 1 m flies between two walls, `flight` steps from one to the other. (With
/// this shape the tilt that rounding brings in stays bounded from bounce to bounce; a square's could grow.)
Simulation between_walls(double w, double flight, double duration_steps) {
  constexpr double thickness = 3.0;
  const double dt = w / std::sqrt(stiffness / (rock_density * thickness));
  const double gap = flight * speed * dt;
  const double half = 0.5 * gap;
  return Simulation(
      Communicator::self(),
      scene_of(head({.duration = duration_steps * dt, .time_step = dt, .gravity = {}, .damping = 0.0}) +
               block_toml("left", rectangle({-2.5 - half, -2.0}, {-1.5 - half, 2.0}), "fixed = true") +
               block_toml("right", rectangle({1.5 + half, -2.0}, {2.5 + half, 2.0}), "fixed = true") +
               block_toml("flyer", rectangle({-1.5, -0.5}, {1.5, 0.5}),
                          fmt::format("velocity = [{}, 0.0, 0.0]", speed))));
}

/// Energy over the initial one after `bounces` impacts.
double energy_after(double w, double flight, int bounces) {
  Simulation simulation = between_walls(w, flight, 1e7);
  const auto row = row_of(simulation, 2);
  int count = 0;
  bool was_touching = false;
  while (count < bounces && !simulation.fault()) {
    step(simulation);
    const bool touches = touching(simulation);
    count += was_touching && !touches ? 1 : 0;
    was_touching = touches;
  }
  step(simulation); // two trial configurations out of touch
  EXPECT_FALSE(simulation.fault().has_value());
  EXPECT_FALSE(touching(simulation));
  EXPECT_LE(std::abs(simulation.blocks().displacement[row].r), 1e-6);
  const double v = norm(trial_velocity(simulation, 2));
  return v * v / (speed * speed);
}

TEST(Bounce, SingleImpact) {
  for (const double w : {0.05, 0.1, 0.2}) {
    double error = 0.0;
    for (int phase = 0; phase < 10 * num_phases; ++phase) {
      error = std::max(error, std::abs(energy_after(w, 7.0 + phase / (10.0 * num_phases), 1) - 1.0));
    }
    expect_below(fmt::format("A6 single impact, W = {}, 120 phases: |E/E0 - 1|", w), 0.5 * w * w, error);
  }
}

// The errors of single impacts add up like a random walk.
TEST(Bounce, TenThousandBounces) {
  struct Case {
    double w, limit;
    int phases; // fewer, unless all may take its time
  };
  const int some = full_size() ? num_phases : num_phases / 3;
  for (const Case c : {Case{0.05, 0.02, some}, Case{0.1, 0.2, some}}) {
    double worst = 0.0;
    for (int phase = 0; phase < c.phases; ++phase) {
      worst = std::max(worst, std::abs(std::log(energy_after(c.w, 10.0 + 1.7 * phase / c.phases, 10000))));
    }
    expect_below(fmt::format("A6 10000 bounces from {} phases, W = {}: |ln E/E0|", c.phases, c.w), c.limit,
                 worst);
  }
}

/// Kinetic energy after over before: two squares meet face to face, half a side off, and not at right angles.
double oblique_energy(double w, double phase) {
  constexpr double soft =
      1e7; // the impact takes 36 ms, turns the squares, and ends before their corners meet
  const double dt = w / std::sqrt(2.0 * soft / rock_density);
  const double gap = 1e-3 + phase * speed * dt;
  Simulation simulation(
      Communicator::self(),
      scene_of(head({.duration = 0.1,
                     .time_step = 0.1 / std::ceil(0.1 / dt),
                     .gravity = {},
                     .normal_stiffness = soft,
                     .damping = 0.0}) +
               block_toml("moving", rectangle({-1.0 - gap, 0.5}, {-gap, 1.5}), "velocity = [1.0, 0.2, 0.0]") +
               block_toml("resting", rectangle({0.0, 0.0}, {1.0, 1.0}))));
  run(simulation);
  EXPECT_GT(simulation.counters().contact_steps, 0);
  EXPECT_FALSE(touching(simulation));
  const auto kinetic = [&](int block) {
    const RigidDof &v = velocity_of(simulation, block);
    const BlockProperties &p = simulation.blocks().properties[row_of(simulation, block)];
    return 0.5 * (p.mass * dot(v.u, v.u) + p.inertia * v.r * v.r);
  };
  EXPECT_GT(std::abs(velocity_of(simulation, 0).r), 0.1);
  return (kinetic(0) + kinetic(1)) / (0.5 * rock_density * 1.04);
}

// Truncation, whose sign and size go with the phase of the step in which the impact begins: root of the mean
// square over phases.
TEST(Bounce, ObliqueImpactOfOffsetSquares) {
  std::vector<double> steps;
  std::vector<double> errors;
  for (double w = 0.1; w > 4e-5; w *= 0.25) {
    double sum = 0.0;
    for (int phase = 0; phase < num_phases; ++phase) {
      sum += std::pow(oblique_energy(w, static_cast<double>(phase) / num_phases) - 1.0, 2);
    }
    steps.push_back(w);
    errors.push_back(std::sqrt(sum / num_phases));
  }
  expect_below(
      fmt::format("A6 oblique elastic impact, half a side off, W = {:.1e}, 12 phases: rms error of the "
                  "energy",
                  steps.back()),
      1e-9, errors.back());
  expect_value("A6 oblique elastic impact: order of the energy error in dt", 2.0, log_slope(steps, errors),
               0.05);
}

} // namespace
} // namespace gcpdda::testing::bounce_test
