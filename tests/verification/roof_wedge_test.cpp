// C4: the pull-out load of a symmetric roof wedge between two abutments (Crawford and Bray).

#include "problem.hpp"
#include "support/contact_regions.hpp"
#include "support/memories.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace gcpdda::testing::roof_wedge_test {
namespace {

constexpr double apical = 20.0 * degree;   ///< al, half the angle at the apex
constexpr double friction = 40.0 * degree; ///< phi
constexpr double closure = 1e-5;           ///< of a face, m; the faces are 1 m long
constexpr double pressed = 0.2;            ///< s: the abutments have closed in
constexpr double raised = 2.0 * pressed;   ///< s: they begin to rise
constexpr double duration = 1.6;           ///< s

const double sine = std::sin(apical);
const double cosine = std::cos(apical);

/// An abutment closes in along the path on which the wedge is in equilibrium, S0 = N0 tan(al), and then
/// rises.
/// @param side   -1 left, 1 right
/// @param ratio  ks/kn
std::string abutment(double side, double ratio) {
  const double slide = closure * std::tan(apical) / ratio; // S0 = ks slide, N0 = kn closure
  const Vec2 moved{-side * (closure * cosine + slide * sine), slide * cosine - closure * sine};
  const double rise = 2.0 * closure / (duration - raised); // m/s
  const std::string table = fmt::format("velocity_table = [[0, 0, 0, 0], [{}, {:.17g}, {:.17g}, 0], [{}, 0, "
                                        "0, 0], [{}, 0, 0, 0], [{}, 0, {:.17g}, 0]]",
                                        0.5 * pressed, 2.0 / pressed * moved.x, 2.0 / pressed * moved.y,
                                        pressed, raised, raised + 0.05, rise);
  // From the apex down the face of the wedge and on.
  return block_toml(
      side < 0.0 ? "left" : "right",
      {{0.0, cosine}, {side * 1.5 * sine, -0.5 * cosine}, {side * 2.0, -0.5 * cosine}, {side * 2.0, cosine}},
      table);
}

/// Peak load over the horizontal force of a face. The wedge is held while the abutments rise: against it that
/// is a pull downwards, and what the faces carry of it is the load.
double pull_out_load(double ratio) {
  std::string toml = head({.duration = duration,
                           .gravity = {},
                           .normal_stiffness = 1e9,
                           .friction_deg = friction / degree,
                           .damping = 0.1});
  toml.insert(toml.find("friction_angle_deg"), fmt::format("tangential_ratio = {}\n", ratio));
  toml += block_toml("wedge", {{0.0, cosine}, {-sine, 0.0}, {sine, 0.0}},
                     fmt::format("fixed_points = [[{0}, 0], [-{0}, 0]]", 0.5 * sine)) +
          abutment(-1.0, ratio) + abutment(1.0, ratio);
  Simulation simulation(Communicator::self(), scene_of(toml));
  run_until(simulation, raised);
  const auto faces = regions_of(simulation); // the wedge is the lower block of both
  EXPECT_EQ(faces.size(), 2U);
  const double pressing = 0.5 * std::abs(faces[1].force.x - faces[0].force.x);
  EXPECT_LE(std::abs(faces[0].force.y + faces[1].force.y), 2e-4 * pressing) << "it is in equilibrium";
  double peak = 0.0;
  while (!simulation.finished()) {
    step(simulation);
    double load = 0.0;
    for (const RegionForce &face : regions_of(simulation)) {
      load += face.force.y;
    }
    peak = std::max(peak, load);
  }
  EXPECT_FALSE(simulation.fault().has_value());
  EXPECT_EQ(memories(simulation.history())[0].state, ContactState::slip);
  return peak / pressing;
}

// Truncation: the dashpots' share of the load at the speed of rising, and the closure over the length.
TEST(RoofWedge, PullOutLoad) {
  struct Case {
    double ratio, digits;
  };
  for (const Case c : {Case{1.0, 0.727940}, {0.2, 0.551989}, {0.1, 0.481168}, {1e-3, 0.0}, {1e3, 0.0}}) {
    const double load = 2.0 * (c.ratio * cosine * cosine + sine * sine) * std::sin(friction - apical) /
                        (c.ratio * cosine * std::cos(friction) + sine * std::sin(friction));
    if (c.digits > 0.0) {
      EXPECT_NEAR(load, c.digits, 1e-6);
    }
    expect_value(fmt::format("C4 roof wedge, kn/ks = {:g}: P/H0", 1.0 / c.ratio), load,
                 pull_out_load(c.ratio), 5e-4);
  }
}

} // namespace
} // namespace gcpdda::testing::roof_wedge_test
