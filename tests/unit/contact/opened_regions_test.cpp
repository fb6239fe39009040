// Which region of a pair goes on with an opening.

#include "contact/block_view.hpp"
#include "contact/opened_regions.hpp"
#include "simulation/simulation.hpp"
#include "support/scenes.hpp"
#include "support/setting.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace gcpdda::testing::opened_regions_test {
namespace {

/// A block in a notch of 57 degrees, closed by `floor` along its floor and by `wall` along its wall, m.
Simulation block_in_notch(double floor, double wall) {
  const double slope = 0.65; // of the wall, which leans over the floor
  const double left = -wall * std::hypot(1.0, slope) - slope * floor;
  return Simulation(
      Communicator::self(),
      scene_of(head({.normal_stiffness = 1e9}) +
               block_toml("notch",
                          {{-3.0, -1.0}, {4.0, -1.0}, {4.0, 0.0}, {0.0, 0.0}, {1.3, 2.0}, {-3.0, 2.0}},
                          "fixed = true") +
               block_toml("block", {{left + 0.01, -floor},
                                    {left + 2.0, -floor},
                                    {left + 2.65, 1.0 - floor},
                                    {left + 0.65, 1.0 - floor},
                                    {left + 0.0065, 0.01 - floor}})));
}

/// The direction in which the region that goes on with this opening pushes; nothing where none does.
Vec2 push_of_region_opened_along(const Simulation &simulation, Vec2 opening) {
  const BlockSystem &system = simulation.blocks();
  const CandidatePair &pair = simulation.candidates().pairs.at(0);
  TrialOutline first;
  TrialOutline second;
  Overlap overlap;
  EXPECT_TRUE(overlap.find(view_of(system, pair.lower.value, first),
                           view_of(system, pair.higher.value, second), PotentialKind::exact));
  RegionMemory memory;
  memory.lower_stretch = overlap.regions().front().faces.first;
  memory.higher_stretch = overlap.regions().front().faces.second;
  // On the floor beside the corner, nearer to the middle of the wall than to that of the floor.
  memory.position = reference_point(system, pair.lower.value, {0.1, 0.0});
  memory.opening = opening;
  const Region *region = region_of(system, pair, overlap, memory);
  if (region == nullptr) {
    return {};
  }
  const Vec2 force = overlap.integrate(*region).force;
  return (1.0 / norm(force)) * force;
}

// On the lower block, the notch, a joint pushes away from the other block, and opens against that.
TEST(OpenedRegions, GoOnInTheJointThatHasOpened) {
  const Vec2 of_floor{0.0, -1.0};
  const Vec2 of_wall = (1.0 / std::hypot(1.0, 0.65)) * Vec2{-1.0, 0.65};
  Simulation both = block_in_notch(1e-4, 1e-4);
  ASSERT_EQ(both.blocks().properties[both.candidates().pairs.at(0).lower.value].is_convex, false);
  const Vec2 by_floor = push_of_region_opened_along(both, 1e-3 * of_floor);
  EXPECT_NEAR(dot(by_floor, of_floor), 1.0, 1e-3) << "of the bowed ends of the joint";
  const Vec2 by_wall = push_of_region_opened_along(both, 1e-3 * of_wall);
  EXPECT_NEAR(dot(by_wall, of_wall), 1.0, 1e-3);
}

// The memory of a joint that has parted does not go on in another one between the same blocks.
TEST(OpenedRegions, DoNotPassToAnotherJoint) {
  const Simulation only_wall = block_in_notch(-1e-3, 1e-4);
  EXPECT_EQ(push_of_region_opened_along(only_wall, {0.0, -1e-3}), Vec2{});
}

} // namespace
} // namespace gcpdda::testing::opened_regions_test
