// C1: does a block on a slope stay, slide, topple, or do both?

#include "problem.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace gcpdda::testing {
namespace {

/// A block 1 m high and tan(slenderness) m wide.
struct SlopeCase {
  double slope, slenderness, friction; ///< degrees
  const char *expected;
};

struct Motion {
  double slid = 0.0;   ///< of the toe along the slope, m
  double turned = 0.0; ///< towards the valley, rad
};

/// Motion until something is plain: the toe has slid 0.1 m, the block has turned by 0.02 rad, or 2.5 s have
/// passed. The slope is level and gravity tilted; x points downhill.
Motion released(const SlopeCase &c) {
  const Vec2 gravity{earth_gravity * std::sin(c.slope * degree), -earth_gravity * std::cos(c.slope * degree)};
  // Near the borders the resultant passes 1 cm from the toe, which must sink by far less: stiff joints. The
  // load is put on slowly, or the block rocks past the border at first.
  const double width = std::tan(c.slenderness * degree);
  Simulation simulation(Communicator::self(),
                        scene_of(head({.duration = 2.5,
                                       .gravity = gravity,
                                       .normal_stiffness = 1e11,
                                       .friction_deg = c.friction,
                                       .damping = 0.3,
                                       .run_keys = "gravity_ramp = 1.0"}) +
                                 block_toml("slope", rectangle({-5.0, -3.0}, {20.0, 0.0}), "fixed = true") +
                                 block_toml("block", rectangle({0.0, 0.0}, {width, 1.0}))));
  Motion motion;
  while (!simulation.finished() && motion.slid < 0.1 && motion.turned < 0.02) {
    simulation.step();
    const std::size_t row = row_of(simulation, 1);
    const Vec2 toe = current_vertices(simulation.blocks(), row)[1];
    motion = {toe.x - width, -displacement_of(simulation, 1).r};
  }
  EXPECT_FALSE(simulation.fault().has_value());
  return motion;
}

// At least 1 degree off every border. With the toe as a hinge nothing slides: less than 1 % of the top's
// motion is the joint's own shear and the shift of the pressure under the edge.
std::string judged(const Motion &motion) {
  const bool turns = motion.turned > 0.005;
  const bool slides = motion.slid > (turns ? 0.02 * motion.turned : 1e-3);
  return turns ? (slides ? "both" : "topples") : (slides ? "slides" : "stays");
}

constexpr SlopeCase cases[] = {
    {9, 20, 11, "stays"},          {20, 25, 35, "stays"},      {29, 31, 31, "stays"},
    {20, 15, 13.9, "slides"},      {30, 20, 18.9, "slides"},   {30, 35, 28.9, "slides"},
    {30, 45, 10, "slides"},        {20, 10, 14, "topples"},    {20, 15, 17.5, "topples"},
    {30, 20, 24, "topples"},       {30, 20, 45, "topples"},    {30, 11.30993, 17.5, "topples"},
    {40, 21.80141, 28, "topples"}, {20, 10, 11.3, "both"},     {30, 20, 21.3, "both"},
    {30, 11.30993, 14, "both"},    {40, 21.80141, 24, "both"}, {40, 21.80141, 25.4, "both"}};

TEST(BlockOnSlope, ChartOfSlidingAndToppling) {
  int wrong = 0;
  for (const SlopeCase &c : cases) {
    const Motion motion = released(c);
    const std::string got = judged(motion);
    fmt::print("    C1 slope {:g}, slenderness {:g}, friction {:g}: expected {}, got {} (toe slid {:.2e} m, "
               "turned {:.2e} rad)\n",
               c.slope, c.slenderness, c.friction, c.expected, got, motion.slid, motion.turned);
    wrong += got == c.expected ? 0 : 1;
  }
  expect_below(fmt::format("C1 wrong verdicts of {}", std::size(cases)), 0.0, wrong);
}

} // namespace
} // namespace gcpdda::testing
