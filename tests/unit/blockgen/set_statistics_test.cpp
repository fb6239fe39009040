// What joint sets draw, measured against what is asked of them.

#include "blockgen/set_statistics.hpp"
#include "model/joint_plane.hpp"
#include "support/regions.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace gcpdda::blockgen::set_statistics_test {
namespace {

using testing::per_degree;
using testing::rectangle_of;
using testing::region_scene;
using testing::through_going;

RockRegion region_of(JointSet set, double side = 100.0) {
  RockRegion region = region_scene(rectangle_of(side, side)).region;
  region.joint_sets = {std::move(set)};
  return region;
}

// A hundred level lines of 100 m in a square of 100 m.
TEST(SetStatistics, OfEvenLinesAreThoseAsked) {
  const SetStatistics one = set_statistics(region_of(through_going(0.0, 1.0, 0, {0.0, 0.5})))[0];
  EXPECT_EQ(one.lines, 100);
  EXPECT_EQ(one.joints, 100);
  EXPECT_NEAR(one.drawn.spacing, 1.0, 1e-13);
  EXPECT_NEAR(one.drawn.intensity, 1.0, 1e-13);
  EXPECT_EQ(one.asked.intensity, 1.0);
  EXPECT_EQ(one.drawn.angle, 0.0);
  EXPECT_EQ(one.drawn.trace_length, 0.0);
}

// In a window half of which lies outside of the region.
TEST(SetStatistics, CountWhereTheSetIs) {
  JointSet set = through_going(0.0, 1.0, 0, {0.0, 0.5});
  set.within = {{80.0, 20.0}, {120.0, 20.0}, {120.0, 60.0}, {80.0, 60.0}};
  const SetStatistics one = set_statistics(region_of(std::move(set)))[0];
  EXPECT_EQ(one.lines, 40);
  EXPECT_EQ(one.joints, 40);
  EXPECT_NEAR(one.drawn.intensity, 1.0, 1e-13);
}

// Intensity, lengths and angles of a scattered set, within five deviations of their means. 100 lines with
// exponential spacing (deviation 10 % of their number) dominate: the sum over 10 seeds has 3.2 %.
TEST(SetStatistics, OfAScatteredSetAreNearThoseAsked) {
  JointSet set = through_going(30.0, 1.0, 0);
  set.through_going = false;
  set.spacing.spread = Spread::lognormal;
  set.spacing.width = 0.5;
  set.trace = {0.0, Spread::power_law, 2.5, 1.0, 20.0};
  set.trace.mean = set.trace.mean_of_power_law();
  set.gap = {1.0, Spread::exponential, 0.0};
  set.dip.spread = Spread::normal;
  set.dip.width = 5.0 * per_degree;
  double intensity = 0.0;
  double length = 0.0;
  double angle = 0.0;
  double scatter = 0.0;
  double spacing = 0.0;
  double joints = 0.0;
  constexpr int seeds = 10;
  JointSetMeasures asked;
  for (int seed = 0; seed < seeds; ++seed) {
    set.seed = seed;
    const SetStatistics one = set_statistics(region_of(set))[0];
    asked = one.asked;
    intensity += one.drawn.intensity / seeds;
    length += one.drawn.trace_length / seeds;
    spacing += one.drawn.spacing / seeds;
    angle += one.drawn.angle / seeds;
    scatter += one.drawn.scatter / seeds;
    joints += static_cast<double>(one.joints);
  }
  EXPECT_NEAR(asked.intensity, set.trace.mean / (set.trace.mean + 1.0), 1e-15);
  // About 1,350 lines: spacing to 0.5/sqrt(1350) = 1.4 %. Some 40,000 lengths with a deviation of about their
  // mean. Gaps without their smallest are 1 % longer, which takes 0.3 % of the intensity away.
  EXPECT_NEAR(spacing, 1.0, 5.0 * 0.014);
  EXPECT_NEAR(intensity / asked.intensity, 1.0, 5.0 * 0.014);
  EXPECT_NEAR(length / asked.trace_length, 1.0, 5.0 / std::sqrt(joints));
  EXPECT_NEAR(angle, 30.0 * per_degree, 5.0 * set.dip.width / std::sqrt(joints));
  EXPECT_EQ(asked.scatter, set.dip.width);
  // A deviation of n normal numbers has one of 1/sqrt(2n) of itself. Some joints are turned out of corners.
  EXPECT_NEAR(scatter / asked.scatter, 1.0, 5.0 / std::sqrt(2.0 * joints) + 0.01);
}

// Planes in space, through-going: as many metres of trace per area of the section as across the planes, times
// the part of the pole that lies in the section.
TEST(SetStatistics, OfPlanesInSpaceAreThoseOfTheirTraces) {
  const JointPlane plane{60.0 * per_degree, 50.0 * per_degree, 400.0, 0.8};
  const double share = share_in_section(pole_of(plane));
  JointSet set = through_going(0.0, 0.8 / share, 0);
  set.dip.mean = trace_angle(pole_of(plane));
  set.plane = plane;
  const SetStatistics one = set_statistics(region_of(std::move(set)))[0];
  EXPECT_NEAR(one.drawn.intensity, share / 0.8, 0.05 * share / 0.8); // some joints are turned out of corners
  // Traces scatter by 1/(share sqrt(k)) about the apparent dip.
  EXPECT_NEAR(one.drawn.angle, one.asked.angle,
              5.0 / (share * std::sqrt(400.0) * std::sqrt(static_cast<double>(one.joints))));
  EXPECT_NEAR(one.drawn.scatter / one.asked.scatter, 1.0,
              5.0 / std::sqrt(2.0 * static_cast<double>(one.joints)) + 0.05);
}

} // namespace
} // namespace gcpdda::blockgen::set_statistics_test
