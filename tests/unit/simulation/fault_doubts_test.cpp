// Faults that bound nothing, and those on which the toe of a slope holds every block.

#include "simulation/fault_doubts.hpp"

#include "support/regions.hpp"

#include <gtest/gtest.h>

#include <utility>

namespace gcpdda::testing::fault_doubts_test {
namespace {

/// A slope of 10 m at 45 degrees whose toe is the origin.
Scene slope(std::vector<std::vector<Vec2>> faults) {
  Scene scene =
      region_scene({{-10.0, -5.0}, {30.0, -5.0}, {30.0, 10.0}, {10.0, 10.0}, {0.0, 0.0}, {-10.0, 0.0}});
  for (std::vector<Vec2> &points : faults) {
    scene.region.faults.push_back({"fault 'plane'", 1, std::move(points), {}});
  }
  return scene;
}

std::optional<Diagnostic> idle_of(const Scene &scene) {
  const std::vector<SceneBlock> blocks = all_blocks(scene);
  return doubt_idle_faults(Communicator::self(), scene.region, blocks, 0, 0);
}

std::optional<Diagnostic> held_of(const Scene &scene) {
  return doubt_faults_at_corners(scene.region, {0.0, -9.81});
}

TEST(FaultDoubts, TellOfFaultsThatBoundNothing) {
  EXPECT_FALSE(idle_of(slope({{{-11.0, -2.0}, {31.0, 8.0}}, {{0.5, 0.5}, {25.0, 11.0}}})));
  // One ends in rock at both ends, one ends below the toe.
  const auto idle = idle_of(
      slope({{{-11.0, -4.0}, {31.0, -3.0}}, {{12.0, 2.0}, {20.0, 4.0}}, {{0.0, -0.1}, {20.0, 12.0}}}));
  ASSERT_TRUE(idle);
  EXPECT_EQ(idle->what, "fault 'plane' bounds no block, nor does 1 other fault");
}

// All of these reach the crest. The tip of a block on the first three meets the rock before the toe.
TEST(FaultDoubts, TellOfBlocksThatTheToeHolds) {
  EXPECT_TRUE(held_of(slope({{{0.0, 0.0}, {31.0, 12.0}}})));
  EXPECT_TRUE(held_of(slope({{{31.0, 15.5}, {-4.0, -2.0}}})));
  EXPECT_TRUE(held_of(slope({{{0.0, 0.01}, {31.0, 12.0}}})));
  EXPECT_FALSE(held_of(slope({{{0.0, 0.0}, {31.0, 0.0}}}))) << "level: it slides out over the ground";
  EXPECT_FALSE(held_of(slope({{{1.0, 1.0}, {31.0, 12.0}}}))) << "above the toe";
  EXPECT_FALSE(held_of(slope({{{-5.0, 5.0}, {5.0, -6.0}}}))) << "dips into the slope";
  EXPECT_FALSE(held_of(slope({{{10.0, 10.0}, {5.0, -6.0}}}))) << "through the crest";
}

} // namespace
} // namespace gcpdda::testing::fault_doubts_test
