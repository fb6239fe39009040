// B3 and A7: a square slides down a plane, s = a t^2/2 with a = g (sin th - tan phi cos th).

#include "problem.hpp"
#include "support/incline.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

namespace gcpdda::testing::incline_test {
namespace {

constexpr double duration = 2.0;

/// Relative error of the distance slid in `duration`.
double slid_error(const Incline &incline, const std::string &toml) {
  Simulation simulation(Communicator::self(), scene_of(toml));
  run(simulation);
  const double expected = 0.5 * incline.acceleration() * duration * duration;
  return std::abs(dot(displacement_of(simulation, 1).u, incline.downhill()) - expected) / expected;
}

// Closed form against digits of g (sin th - tan phi cos th), then the run. The square starts in the depth and
// tilt in which it slides on, so only round-off is left: 1e-16 m in coordinates over a depth of 2e-5 m.
TEST(Incline, DistanceFromSlidingEquilibrium) {
  struct Case {
    double slope, friction, acceleration;
  };
  for (const Case c : {Case{30, 0, 4.905000}, Case{30, 10, 3.406977}, Case{30, 20, 1.812815},
                       Case{30, 25, 0.943386}, Case{45, 30, 2.931802}}) {
    const Incline incline{.slope_deg = c.slope, .friction_deg = c.friction};
    EXPECT_NEAR(incline.acceleration(), c.acceleration, 1e-6);
    expect_below(
        fmt::format("B3 (i) th={} phi={}, start in depth and tilt: error of s(2 s)", c.slope, c.friction),
        1e-8, slid_error(incline, incline.toml(incline.sliding_square(), {.duration = duration})));
  }
}

// The scene that ships has the same equilibrium written into its vertices.
TEST(Incline, ShippedScene) {
  const Incline incline;
  Simulation simulation(Communicator::self(), shipped_scene("incline"));
  run_until(simulation, duration);
  expect_value("B3 (i) incline.toml: s(2 s)", 0.5 * incline.acceleration() * duration * duration,
               dot(displacement_of(simulation, 1).u, incline.downhill()), 1e-8);
}

// A flat start rocks into its tilt first; once that has been damped out the acceleration is exact.
TEST(Incline, AccelerationAfterFlatStart) {
  for (const double friction : {0.0, 10.0, 15.0}) {
    const Incline incline{.friction_deg = friction};
    Simulation simulation(
        Communicator::self(),
        scene_of(incline.toml(incline.flat_square(incline.static_depth()), {.duration = duration})));
    run_until(simulation, 1.0);
    const Vec2 before = velocity_of(simulation, 1).u;
    run(simulation);
    const double gained = dot(velocity_of(simulation, 1).u - before, incline.downhill());
    expect_value(fmt::format("B3 (ii) th=30 phi={}, flat start: acceleration over 1..2 s", friction),
                 incline.acceleration(), gained, 1e-8);
  }
}

// Truncation: the flat start's delay is a fraction of the rocking period, so the error falls as k_n^-1/2.
TEST(Incline, DistanceAfterFlatStart) {
  std::vector<double> stiffness{1e8, 1e9, 1e10};
  std::vector<double> error;
  for (const double k_n : stiffness) {
    const Incline incline{.normal_stiffness = k_n};
    error.push_back(slid_error(
        incline, incline.toml(incline.flat_square(incline.static_depth()), {.duration = duration})));
    expect_below(fmt::format("B3 (iii) k_n={:g}, flat start: error of s(2 s)", k_n), k_n < 1e9 ? 4e-3 : 1e-3,
                 error.back());
  }
  const double slope = log_slope(stiffness, error);
  expect_below(fmt::format("B3 (iii) exponent of k_n is {:.4f}: distance to -1/2", slope), 0.1,
               std::abs(slope + 0.5));
}

/// Largest difference of the slider's histories, step by step.
double history_difference(const std::string &toml_a, const std::string &toml_b) {
  Simulation a(Communicator::self(), scene_of(toml_a));
  Simulation b(Communicator::self(), scene_of(toml_b));
  EXPECT_EQ(a.plan().num_steps, b.plan().num_steps);
  double difference = 0.0;
  while (!a.finished()) {
    step(a);
    step(b);
    const RigidDof d = displacement_of(a, 1) - displacement_of(b, 1);
    difference = std::max({difference, norm(d.u), std::abs(d.r)});
  }
  return difference;
}

// A7: what the plane looks like elsewhere does not matter. The plane is level and gravity tilted, so that the
// surface is the same line, bit for bit, however far its ends are.
TEST(Incline, FarPartOfThePlaneDoesNotMatter) {
  const Vec2 gravity{earth_gravity * std::sin(30.0 * degree), -earth_gravity * std::cos(30.0 * degree)};
  const std::string start = head({.duration = duration, .gravity = gravity, .friction_deg = 15.0});
  const std::string square = block_toml("slider", rectangle({0.0, -2.2e-5}, {1.0, 1.0 - 2.2e-5}));
  const auto on = [&](const std::vector<Vec2> &plane) {
    return start + block_toml("plane", plane, "fixed = true") + square;
  };
  const std::string usual = on(rectangle({-5.0, -2.0}, {20.0, 0.0}));
  expect_below("A7 plane 100 times larger: difference of histories, m", 1e-12,
               history_difference(usual, on(rectangle({-500.0, -200.0}, {2000.0, 0.0}))));
  expect_below("A7 plane cut shorter and thinner: difference of histories, m", 1e-12,
               history_difference(usual, on(rectangle({-0.5, -1.0}, {8.0, 0.0}))));
  expect_below("A7 plane 100 times larger below the same surface: difference of histories, m", 1e-12,
               history_difference(usual, on({{-5.0, 0.0}, {-500.0, -200.0}, {2000.0, -200.0}, {20.0, 0.0}})));
  expect_below(
      "A7 plane with a far corner cut off: difference of histories, m", 1e-12,
      history_difference(usual, on({{-5.0, -1.0}, {-4.0, -2.0}, {20.0, -2.0}, {20.0, 0.0}, {-5.0, 0.0}})));
}

} // namespace
} // namespace gcpdda::testing::incline_test
