// B7: a block 2 m wide and 0.5 m high, which hardly rocks, on a base that shakes with acceleration a0 sin(2
// pi f t) sticks, slips and slips back.

#include "problem.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

namespace gcpdda::testing::shaken_base_test {
namespace {

constexpr double friction = 0.2;
constexpr double amplitude = 5.0;  ///< a0, m/s2
constexpr double frequency = 1.0;  ///< f, Hz
constexpr double duration = 0.72;  ///< s
constexpr double stiffness = 1e10; ///< Pa/m

/// Velocity of the base, linear between rows: of the sine that the acceleration is, the error is (2 pi f
/// h)^2/8 = 5e-8 for rows h apart.
std::string velocity_table() {
  const double omega = 2.0 * std::numbers::pi * frequency;
  std::string rows;
  constexpr int num_rows = 7200;
  for (int k = 0; k <= num_rows; ++k) {
    const double t = duration * k / num_rows;
    rows += fmt::format("[{:.17g}, {:.17g}, 0, 0], ", t, amplitude / omega * (1.0 - std::cos(omega * t)));
  }
  return "velocity_table = [" + rows + "]";
}

struct Slip {
  double begin = 0.0;    ///< s
  double end = 0.0;      ///< where the base has caught up with the block, s
  double distance = 0.0; ///< then, m
  double back = 0.0;     ///< beginning of the slip the other way, s
};

Slip shaken(double time_step) {
  const double depth = 0.5 * rock_density * earth_gravity / stiffness;
  Simulation simulation(Communicator::self(),
                        scene_of(head({.duration = duration,
                                       .time_step = time_step,
                                       .normal_stiffness = stiffness,
                                       .friction_deg = std::atan(friction) / degree,
                                       .damping = 0.3}) +
                                 block_toml("base", rectangle({-5.0, -1.0}, {5.0, 0.0}), velocity_table()) +
                                 block_toml("block", rectangle({-1.0, -depth}, {1.0, 0.5 - depth}))));
  Slip slip;
  double speed_before = 0.0;
  while (!simulation.finished()) {
    step(simulation);
    const double gap = (displacement_of(simulation, 0) - displacement_of(simulation, 1)).u.x;
    const double speed = (velocity_of(simulation, 0) - velocity_of(simulation, 1)).u.x;
    const RegionForce &joint = simulation.contacts().regions()[0];
    const bool slips = std::abs(joint.shear) >= joint.cap; // friction and its dashpot
    if (slip.begin == 0.0 && slips) {
      slip.begin = simulation.time();
    } else if (slip.end == 0.0 && slip.begin > 0.0 && simulation.time() > 0.5 && speed <= 0.0) {
      slip.end = simulation.time() - time_step * speed / (speed - speed_before);
      slip.distance = gap;
    } else if (slip.end > 0.0 && slip.back == 0.0 && slips && speed < -1e-3) {
      slip.back = simulation.time();
    }
    speed_before = speed;
  }
  EXPECT_FALSE(simulation.fault().has_value());
  return slip;
}

// The beginning is known to a step, 3e-4 of it. Until it slips back the stick spring swings from one cap to
// the other, 2 mu m g/k_t = 0.5 um at 6 m/s2: 0.4 ms.
TEST(ShakenBase, SlipsAndSlipsBack) {
  const Slip slip = shaken(2e-5);
  expect_value("B7 shaken base: slip begins, s", 0.064177, slip.begin, 4e-4);
  expect_value("B7 shaken base: slip ends, s", 0.658273, slip.end, 1e-5);
  expect_value("B7 shaken base: relative displacement then, m", 0.244495, slip.distance, 5e-5);
  expect_below("B7 shaken base: time until it slips back, s", 1e-3, slip.back - slip.end);
  EXPECT_GT(slip.back, slip.end);
}

} // namespace
} // namespace gcpdda::testing::shaken_base_test
