// What settle stages say of blocks that have slid to where they hold.

#include "support/incline.hpp"

#include "support/scenes.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>

namespace gcpdda::testing::slid_blocks_test {
namespace {

std::string settling(double normal_stiffness, double friction_deg, const std::string &blocks,
                     const std::string &stage_keys) {
  return fmt::format("[run]\nfidelity = \"rigid\"\n[material.rock]\ndensity = 2600.0\n[joint.default]\n"
                     "normal_stiffness = {}\nfriction_angle_deg = {}\n[output]\ninterval = 1.0\n",
                     normal_stiffness, friction_deg) +
         blocks + "[[stage]]\nkind = \"settle\"\nlimit = 20.0\n" + stage_keys;
}

StageResult settled(const std::string &toml) {
  Simulation simulation(Communicator::self(), scene_of(toml));
  run_stages(simulation);
  const StageResult result = simulation.stage_results().back();
  EXPECT_EQ(result.verdict, Verdict::settled);
  return result;
}

/// A square of 2 m on a plane, 0.2 m above a wall.
std::string square_above_wall(double slope_deg) {
  const Rotation turn = Rotation::of(-slope_deg * std::acos(-1.0) / 180.0);
  const auto at = [&](double x, double y) { return turn(Vec2{x, y}); };
  return block_toml("plane", {at(-5.0, -1.0), at(8.0, -1.0), at(8.0, 0.0), at(-5.0, 0.0)}, "fixed = true") +
         block_toml("wall", {at(2.2, 0.05), at(3.0, 0.05), at(3.0, 2.0), at(2.2, 2.0)}, "fixed = true") +
         block_toml("square", {at(0.0, 0.0), at(2.0, 0.0), at(2.0, 2.0), at(0.0, 2.0)});
}

TEST(SlidBlocks, SayHowFarTheySlidToAWall) {
  for (const std::string solver : {"static", "dynamic"}) {
    const std::string stage = "solver = \"" + solver + "\"\n";
    const StageResult slid = settled(settling(1e9, 15.0, square_above_wall(30.0), stage));
    EXPECT_NEAR(slid.slide_distance, 0.2, 0.005) << solver;
    EXPECT_NEAR(slid.slide, 0.1, 0.0025) << solver;
    EXPECT_EQ(slid.slid_block, 2) << solver;
    EXPECT_EQ(slid.slid_blocks, 1) << solver;
    EXPECT_TRUE(slid.has_slid()) << solver;
    const StageResult held = settled(settling(1e9, 40.0, square_above_wall(30.0), stage));
    EXPECT_FALSE(held.has_slid()) << solver;
    EXPECT_EQ(held.slid_blocks, 0) << solver;
  }
}

// The second stage finds the square at the wall: what has slid before is no slide of it.
TEST(SlidBlocks, HaveSlidInOneStage) {
  EXPECT_LT(
      settled(settling(1e9, 15.0, square_above_wall(30.0),
                       "[[stage]]\nkind = \"settle\"\nlimit = 20.0\nset = { \"run.gravity\" = [0, -10] }\n"))
          .slide,
      1e-3);
}

// The uppermost block sinks by a twentieth of its size while the joints below it close.
TEST(SlidBlocks, AreNoneInAStackThatSags) {
  std::string stack = block_toml("floor", rectangle({-5.0, -1.0}, {5.0, 0.0}), "fixed = true");
  for (int k = 0; k < 20; ++k) {
    stack += block_toml(fmt::format("b{}", k), rectangle({0.0, 1.0 * k}, {4.0, 1.0 + k}));
  }
  const StageResult sagged = settled(settling(5e7, 30.0, stack, ""));
  EXPECT_GT(sagged.moved, 2.0 * StageResult::telling_slide);
  EXPECT_LT(sagged.slide, 1e-3);
}

// A block that falls has no contact that could slip.
TEST(SlidBlocks, HaveFallen) {
  const StageResult fallen =
      settled(settling(1e9, 30.0,
                       block_toml("floor", rectangle({-5.0, -1.0}, {5.0, 0.0}), "fixed = true") +
                           block_toml("stone", rectangle({0.0, 0.3}, {1.0, 1.3})),
                       "solver = \"dynamic\"\n"));
  EXPECT_NEAR(fallen.slide, 0.3, 0.01);
  EXPECT_EQ(fallen.slid_block, 1);
}

} // namespace
} // namespace gcpdda::testing::slid_blocks_test
