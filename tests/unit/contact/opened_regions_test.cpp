// Which region of a pair goes on with an opening.

#include "contact/block_view.hpp"
#include "contact/opened_regions.hpp"
#include "simulation/simulation.hpp"
#include "support/blocks.hpp"
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

/// A comb of so many teeth that stands on them, from x on.
std::vector<Vec2> comb(double x, int teeth) {
  std::vector<Vec2> outline;
  for (int k = 0; k < teeth; ++k) {
    const double left = x + k;
    for (const Vec2 corner : {Vec2{left, 1.0}, {left, 0.0}, {left + 0.5, 0.0}, {left + 0.5, 1.0}}) {
      outline.push_back(corner);
    }
  }
  outline.erase(outline.begin());
  outline.pop_back();
  outline.insert(outline.end(), {{outline.back().x, 2.0}, {x, 2.0}});
  return outline;
}

/// Work of the first of some combs that are turned a little, slide along and open their joints, a region for
/// each tooth, J/m.
double work_of_first_comb(std::size_t combs, double turn) {
  constexpr int teeth = 40;
  constexpr double between = 100.0;
  JointLaws joints = one_law(1e6, 0.3);
  joints.laws[0].tan_dilation = 0.1;
  joints.laws[0].dilation_limit = 1.0;
  std::vector<std::vector<Vec2>> mobile;
  std::vector<std::vector<Vec2>> fixed;
  for (std::size_t k = 0; k < combs; ++k) {
    const double x = between * static_cast<double>(k);
    mobile.push_back(comb(x, teeth));
    fixed.push_back(rectangle({x - 1.0, -1.0}, {x + teeth + 1.0, 0.0}));
  }
  ContactBench bench(system_of(mobile, fixed), joints, 0.0, Instructions::widest, 1.0);
  for (const RigidDof by : {RigidDof{{0.0, -0.01}, turn}, RigidDof{{0.02, 0.0}, 0.0}}) {
    for (std::size_t k = 0; k < combs; ++k) {
      bench.system.trial[k] += by;
    }
    bench.evaluate();
  }
  EXPECT_EQ(bench.regions.all().size(), combs * teeth);
  bench.forces.add_opening_works(bench.candidates, bench.system);
  return bench.system.ledger[0].shear;
}

// They are added in an order that other pairs, whose number hangs on the ranks, do not change.
TEST(OpenedRegions, WorkOfAPairHasTheSameBitsBesideOthers) {
  for (const double turn :
       {1.0e-4, 1.1e-4, 1.2e-4, 1.3e-4, 1.4e-4}) { // some sums have the same bits by chance
    const double alone = work_of_first_comb(1, turn);
    EXPECT_GT(alone, 0.0);
    EXPECT_EQ(work_of_first_comb(2, turn), alone);
    EXPECT_EQ(work_of_first_comb(3, turn), alone);
  }
}

} // namespace
} // namespace gcpdda::testing::opened_regions_test
