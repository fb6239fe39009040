// B4: a square that friction holds on a slope stays where it is.

#include "problem.hpp"
#include "support/incline.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace gcpdda::testing::static_incline_test {
namespace {

constexpr double settling = 60.0; ///< s
constexpr double watch = 100.0;   ///< s

/// Largest distance of any point of the block from where it was when the watch began.
double drift(Simulation &simulation) {
  run_until(simulation, settling);
  const RigidDof rest = displacement_of(simulation, 1);
  const double radius = simulation.blocks().properties[row_of(simulation, 1)].radius;
  double largest = 0.0;
  while (!simulation.finished()) {
    step(simulation);
    const RigidDof moved = displacement_of(simulation, 1) - rest;
    largest = std::max(largest, norm(moved.u) + radius * std::abs(moved.r));
  }
  EXPECT_FALSE(simulation.fault().has_value());
  return largest;
}

// Round-off: 1e-12 block sizes and 4 ulp of the largest coordinate (its spacing of doubles).
TEST(StaticIncline, StaysWhereItIs) {
  struct Case {
    double slope, friction, x;
  };
  for (const Case c : {Case{30, 35, 0}, Case{20, 21, 0}, Case{30, 35, 1000}, Case{20, 21, 1000}}) {
    const Incline incline{.slope_deg = c.slope, .friction_deg = c.friction, .foot = {c.x, 0.0}};
    Simulation simulation(Communicator::self(),
                          scene_of(incline.toml(incline.flat_square(0.0), {.duration = settling + watch})));
    const double largest = c.x + 1.0;
    const double limit = 1e-12 + 4.0 * (std::nextafter(largest, 2.0 * largest) - largest);
    expect_below(fmt::format("B4 th={} phi={} at x={} m: motion from 60 to 160 s", c.slope, c.friction, c.x),
                 limit, drift(simulation));
  }
}

// A block that touches nothing changes no bit of the others while the step is given; it does cause refreshes
// of the neighbourhood at other times.
TEST(StaticIncline, AnotherBlockFarAwayChangesNoBit) {
  const Incline incline{.friction_deg = 35.0};
  const std::string alone = incline.toml(incline.flat_square(0.0), {.duration = 2.0, .time_step = 2e-4});
  const std::string accompanied =
      alone + block_toml("falling", rectangle({200.0, 50.0}, {200.3, 50.3}), "velocity = [3.0, 0.0, 1.0]");
  Simulation a(Communicator::self(), scene_of(alone));
  Simulation b(Communicator::self(), scene_of(accompanied));
  std::int64_t different = 0;
  while (!a.finished()) {
    step(a);
    step(b);
    const bool same =
        displacement_of(a, 1) == displacement_of(b, 1) && velocity_of(a, 1) == velocity_of(b, 1);
    different += same ? 0 : 1;
  }
  ASSERT_GT(b.counters().refreshes, a.counters().refreshes);
  expect_below(fmt::format("B4 another block far away: steps with a different bit of {}", a.step_count()),
               0.0, static_cast<double>(different));
}

} // namespace
} // namespace gcpdda::testing::static_incline_test
