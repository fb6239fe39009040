// A1 to A3: stability limits, order and exactness of the time integration, measured on runs of the whole
// code.

#include "problem.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

namespace gcpdda::testing::integrator_test {
namespace {

// A unit square flush on a wide plane is an oscillator: force k_n d (1 - d/2) at depth d, so about the depth
// d_0 that carries its weight omega^2 = k_n (1 - d_0)/m. It may rock, but slower by the square root of 2.
constexpr double stiffness = 1e9;
const double depth = 1.0 - std::sqrt(1.0 - 2.0 * rock_density * earth_gravity / stiffness);
const double omega = std::sqrt(stiffness * (1.0 - depth) / rock_density);

/// The square at its depth, thrown up so that it oscillates with an amplitude of `share` depths.
Scene oscillator(double w, int num_steps, double share,
                 const std::string &run_keys = "contact_time = \"leapfrog\"") {
  const double dt = w / omega;
  const std::string scene =
      head({.duration = num_steps * dt, .time_step = dt, .damping = 0.0, .run_keys = run_keys}) +
      block_toml("plane", rectangle({-3.0, -2.0}, {4.0, 0.0}), "fixed = true") +
      block_toml("square", rectangle({0.0, -depth}, {1.0, 1.0 - depth}),
                 fmt::format("velocity = [0.0, {:.17g}, 0.0]", share * depth * omega));
  return scene_of(scene);
}

/// Amplitude of the oscillation that the present state belongs to, in units of the depth.
double amplitude(const Simulation &simulation) {
  return std::hypot(displacement_of(simulation, 1).u.y, velocity_of(simulation, 1).u.y / omega) / depth;
}

// Below the limit the scheme is neutral: its amplitude is the exact one times at most 1/sqrt(1 - W^2/4) = 5
// at W = 1.96, however long the run. At W = 2.04 each step multiplies it by -1.4908.
TEST(Stability, LeapfrogLimitIsTwo) {
  constexpr double start = 1e-4;
  Simulation stable(Communicator::self(), oscillator(1.96, 20000, start));
  double early = 0.0;
  double late = 0.0;
  while (!stable.finished()) {
    step(stable);
    double &largest = stable.step_count() <= 1000 ? early : late;
    largest = std::max(largest, amplitude(stable) / start);
  }
  expect_below("A1 leapfrog at 0.98 of W = 2, 20000 steps: largest amplitude over the exact one", 5.1, late);
  expect_below("A1 leapfrog at 0.98 of W = 2: amplitude of steps 1000..20000 over that of steps 0..1000",
               1.01, late / early);

  constexpr double w = 2.04;
  constexpr double tiny = 1e-8;
  Simulation unstable(Communicator::self(), oscillator(w, 40, tiny));
  std::vector<double> history;
  while (!unstable.finished()) {
    step(unstable);
    history.push_back(amplitude(unstable) / tiny);
  }
  const double half_trace = 0.5 * w * w - 1.0;
  // Truncation: the depth changes the frequency by 1e-4 at most.
  expect_value("A1 leapfrog at 1.02 of W = 2: growth a step",
               half_trace + std::sqrt(half_trace * half_trace - 1.0),
               std::pow(history[29] / history[14], 1.0 / 15.0), 1e-3);
  expect_above("A1 leapfrog at 1.02 of W = 2, 40 steps: amplitude over the first", 1e4, history[39]);
}

TEST(Stability, ForceAtTheStartOfTheStepGrows) {
  constexpr double w = 0.1;
  constexpr double alpha_f = 0.8 / 1.8;
  constexpr int num_steps = 1000;
  const std::string keys = "contact_time = \"start\"\nspectral_radius = 0.8";
  Simulation simulation(Communicator::self(), oscillator(w, num_steps, 1e-3, keys));
  const double first = 1e-3;
  run(simulation);
  // W^3 terms: the method's own estimate is good to 4 %.
  expect_value("A1 contact_time = start, W = 0.1: growth a step", 0.5 * (1.0 - alpha_f) * w * w,
               std::log(amplitude(simulation) / first) / num_steps, 0.04);
}

/// Growth a step of the amplitude, from one far below the depth on: slope of its logarithm over the second
/// half of the steps.
double measured_growth(const std::string &run_keys, double w, int num_steps) {
  constexpr double start = 1e-7;
  Simulation simulation(Communicator::self(), oscillator(w, num_steps, start, run_keys));
  std::vector<double> growth; // e to the number of steps, so that a slope of logarithms is one a step
  std::vector<double> size;
  for (int k = 0; k < num_steps; ++k) {
    step(simulation);
    if (k >= num_steps / 2) {
      growth.push_back(std::exp((k - num_steps) / (0.01 * num_steps)));
      size.push_back(amplitude(simulation));
    }
  }
  EXPECT_FALSE(simulation.fault().has_value());
  return log_slope(growth, size) / (0.01 * num_steps);
}

/// Largest amplitude in the second half of many steps over that of the first.
double lasting_amplitude(const std::string &run_keys, double w) {
  constexpr int num_steps = 8000;
  Simulation simulation(Communicator::self(), oscillator(w, num_steps, 1e-4, run_keys));
  double first = 0.0;
  double second = 0.0;
  while (!simulation.finished()) {
    step(simulation);
    double &largest = simulation.step_count() <= num_steps / 2 ? first : second;
    largest = std::max(largest, amplitude(simulation));
  }
  return second / first;
}

// Limits by eigenvalues of an amplification matrix written down apart from this code, and those of Hulbert
// and Chung, W^2 = 2 (1 - 2 am)/(2 b - g) (doi:10.1016/S0045-7825(96)01036-5), as digits. At 0.98 of the
// limit nothing grows, at 1.02 the amplitude grows as the amplification matrix says.
TEST(Stability, LimitsOfAllSchemes) {
  struct Row {
    std::string what, run_keys;
    SchemeKind kind;
    double radius;
    ContactTime contact_time;
    double limit, digits;
  };
  const auto alpha = [](double radius, const char *name, ContactTime contact_time, double limit,
                        double digits) {
    return Row{fmt::format("{}, r = {}", name, radius),
               fmt::format("contact_time = \"{}\"\nspectral_radius = {}", name, radius),
               SchemeKind::generalized_alpha,
               radius,
               contact_time,
               limit,
               digits};
  };
  const auto hulbert_chung = [](double radius, double limit) {
    return Row{fmt::format("explicit-generalized-alpha, r = {}", radius),
               fmt::format("scheme = \"explicit-generalized-alpha\"\nspectral_radius = {}", radius),
               SchemeKind::explicit_generalized_alpha,
               radius,
               ContactTime::leapfrog,
               limit,
               5e-4};
  };
  std::vector<Row> rows{alpha(0.0, "predictor", ContactTime::predictor, 2.0, 5e-3),
                        alpha(0.5, "predictor", ContactTime::predictor, 1.867, 5e-4),
                        alpha(0.8, "predictor", ContactTime::predictor, 1.396, 5e-4),
                        alpha(0.9, "predictor", ContactTime::predictor, 1.041, 5e-4),
                        alpha(0.5, "predictor-end", ContactTime::predictor_end, 1.55, 5e-3),
                        {"newmark-dda", "scheme = \"newmark-dda\"", SchemeKind::newmark_dda, 0.8,
                         ContactTime::leapfrog, std::sqrt(2.0), 1e-6},
                        {"central-difference", "scheme = \"central-difference\"",
                         SchemeKind::central_difference, 0.8, ContactTime::leapfrog, 2.0, 1e-6},
                        hulbert_chung(0.0, 1.549),
                        hulbert_chung(0.5, 1.867),
                        hulbert_chung(0.8, 1.976),
                        hulbert_chung(1.0, 2.0)};
  for (const double radius : {0.0, 0.25, 0.5, 0.8, 0.9}) {
    rows.push_back(alpha(radius, "leapfrog", ContactTime::leapfrog, 2.0, 1e-6));
  }
  for (const Row &row : rows) {
    const Scheme scheme = make_scheme(row.kind, row.radius, row.contact_time);
    const double limit = stability_limit(scheme, 0.0);
    expect_below("A1 " + row.what + fmt::format(", limit W = {:.4g}: distance from the printed one", limit),
                 row.digits, std::abs(limit - row.limit));
    expect_below("A1 " + row.what + ", 0.98 of the limit: amplitude of steps 4000..8000 over that of 0..4000",
                 1.01, lasting_amplitude(row.run_keys, 0.98 * limit));
    const double growth = std::log(amplification(scheme, 1.02 * limit, 0.0));
    expect_value("A1 " + row.what + ", 1.02 of the limit: growth a step", growth,
                 measured_growth(row.run_keys, 1.02 * limit, static_cast<int>(12.0 / growth)), 1e-3);
  }
}

// At W = 1 an amplitude waves over the few periods that 12 e-foldings take, which the fit averages: 5e-3.
TEST(Stability, UnstableAtEveryStep) {
  for (const double radius : {0.0, 0.25, 0.5, 0.8, 0.9, 1.0}) {
    for (const double w : {0.05, 0.3, 1.0}) {
      const Scheme scheme = make_scheme(SchemeKind::generalized_alpha, radius, ContactTime::start);
      const double growth = std::log(amplification(scheme, w, 0.0));
      expect_value(fmt::format("A1 contact_time = start, r = {}, W = {}: growth a step", radius, w), growth,
                   measured_growth(fmt::format("contact_time = \"start\"\nspectral_radius = {}", radius), w,
                                   static_cast<int>(12.0 / growth)),
                   5e-3);
    }
  }
}

// Five and a quarter periods of the small oscillation; a fine run of the same scene stands in for the exact
// solution, 1/64 of the smallest dt's error.
TEST(Order, ContactOscillation) {
  std::vector<double> steps;
  std::vector<double> errors;
  const double duration = 10.5 * std::numbers::pi;
  const auto state = [&](int num_steps) {
    Simulation simulation(Communicator::self(), oscillator(duration / num_steps, num_steps, 0.1));
    run(simulation);
    return displacement_of(simulation, 1).u.y / depth;
  };
  const double exact = state(64000);
  for (const int num_steps : {250, 350, 500, 700, 1000, 1400, 2000, 2800, 4000}) {
    steps.push_back(1.0 / num_steps);
    errors.push_back(std::abs(state(num_steps) - exact));
  }
  expect_value("A2 contact oscillation: order in dt", 2.0, log_slope(steps, errors), 0.02);
}

// Two tilted squares collide off centre, vertex against face. The force starts with the square of the depth,
// but the moment of first contact falls differently into each dt: hence the fit over many.
TEST(Order, ObliqueCollision) {
  constexpr double duration = 1.0;
  const std::vector<Vec2> square = rectangle({-0.5, -0.5}, {0.5, 0.5});
  const auto outcome = [&](int num_steps) {
    Simulation simulation(
        Communicator::self(),
        scene_of(head({.duration = duration,
                       .time_step = duration / num_steps,
                       .gravity = {},
                       .normal_stiffness = 1e7,
                       .damping = 0.0}) +
                 block_toml("a", placed(square, 0.3, {-0.85, 0.0}), "velocity = [1.0, 0.1, 0.0]") +
                 block_toml("b", placed(square, -0.5, {0.85, 0.25}), "velocity = [-1.0, 0.0, 0.2]")));
    run(simulation);
    EXPECT_GT(simulation.counters().contact_steps, 0);
    return std::pair(velocity_of(simulation, 0), velocity_of(simulation, 1));
  };
  const auto exact = outcome(64000);
  std::vector<double> steps;
  std::vector<double> errors;
  for (int num_steps = 500; num_steps <= 8000; num_steps = num_steps * 28 / 25) {
    const auto got = outcome(num_steps);
    const RigidDof a = got.first - exact.first;
    const RigidDof b = got.second - exact.second;
    steps.push_back(duration / num_steps);
    errors.push_back(std::sqrt(dot(a.u, a.u) + a.r * a.r + dot(b.u, b.u) + b.r * b.r));
  }
  expect_below(fmt::format("A2 oblique collision, {} steps of {:.1e} to {:.1e} s: distance of the order to 2",
                           steps.size(), steps.back(), steps.front()),
               0.15, std::abs(log_slope(steps, errors) - 2.0));
  expect_below("A2 oblique collision: error of velocities at the largest dt, m/s", 1e-2, errors.front());
}

// Round-off of 10000 sums of position and velocity: half an ulp each.
TEST(Order, ConstantAccelerationIsExact) {
  constexpr int num_steps = 10000;
  constexpr double duration = 3.0;
  for (const double radius : {0.0, 0.5, 0.8, 1.0}) {
    Simulation simulation(
        Communicator::self(),
        scene_of(head({.duration = duration,
                       .time_step = duration / num_steps,
                       .run_keys = fmt::format("spectral_radius = {}", radius)}) +
                 block_toml("stone", rectangle({0.0, 0.0}, {1.0, 2.0}), "velocity = [7.0, 20.0, 3.0]")));
    double error = 0.0;
    while (!simulation.finished()) {
      step(simulation);
      const double t = simulation.time();
      const RigidDof d = displacement_of(simulation, 0);
      error = std::max({error, std::abs(d.u.x - 7.0 * t),
                        std::abs(d.u.y - (20.0 - 0.5 * earth_gravity * t) * t), std::abs(d.r - 3.0 * t)});
    }
    expect_below(fmt::format("A3 free flight, spectral radius {}: error of path and turn over 21 m", radius),
                 1e-12, error / (7.0 * duration));
  }
}

} // namespace
} // namespace gcpdda::testing::integrator_test
