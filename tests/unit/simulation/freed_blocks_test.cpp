// Blocks that are fixed at the start and that a later stage sets free.

#include "simulation/simulation.hpp"
#include "support/scenes.hpp"
#include "support/setting.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

namespace gcpdda::testing::freed_blocks_test {
namespace {

constexpr const char *soft = "edge_joints = [\"soft\", \"soft\", \"soft\", \"soft\"]\n";
constexpr const char *free_stage = "[[stage]]\nname = \"free\"\nkind = \"run\"\nduration = 0.01\n";

/// Squares beside each other on a floor.
/// @param joints  their law where it is not the default
/// @param fixed   they are held at the start
std::string row_of_squares(int count, const std::string &joints, bool fixed) {
  std::string toml = "[run]\nfidelity = \"auto\"\n[material.rock]\ndensity = 2600\nyoungs_modulus = 1e9\n"
                     "poissons_ratio = 0.25\n[joint.default]\nnormal_stiffness = 1e9\n"
                     "[joint.soft]\nnormal_stiffness = 1e6\n" +
                     block_toml("floor", rectangle({-1.0, -1.0}, {3.0 * count, 0.0}), "fixed = true");
  for (int k = 0; k < count; ++k) {
    toml += block_toml(fmt::format("s{}", k), rectangle({2.0 * k, 0.0}, {2.0 * k + 1.0, 1.0}),
                       joints + (fixed ? "fixed = true\n" : ""));
  }
  toml += block_toml("aside", rectangle({-9.0, 0.0}, {-8.0, 1.0}), soft);
  return toml + "[[stage]]\nname = \"first\"\nkind = \"run\"\nduration = 0.01\n";
}

// What a block is follows from the stiffest joint that it can meet, whenever it begins to move.
TEST(FreedBlocks, AreOfTheKindThatTheyHaveWhenMobileFromTheStart) {
  for (const bool is_soft : {true, false}) {
    const std::string joints = is_soft ? soft : "";
    const Simulation mobile(Communicator::self(), scene_of(row_of_squares(1, joints, false) + free_stage));
    Simulation freed(Communicator::self(), scene_of(row_of_squares(1, joints, true) + free_stage +
                                                    "set = { \"block.s0.fixed\" = false }\n"));
    run_stages(freed);
    EXPECT_EQ(mobile.blocks().is_deformable(row_of(mobile, 1)), !is_soft) << "the scene must be able to tell";
    EXPECT_EQ(freed.blocks().is_deformable(row_of(freed, 1)), !is_soft);
  }
}

// All blocks that one stage frees fall as freely as one does, and the others stay.
TEST(FreedBlocks, SeveralAtOnceFallAndTheOthersStay) {
  constexpr int count = 7;
  std::string set;
  for (const int k : {5, 0, 3}) {
    set += fmt::format("{}\"block.s{}.fixed\" = false", set.empty() ? "" : ", ", k);
  }
  const std::string toml = row_of_squares(count, "", true) + free_stage + "set = { " + set + " }\n";
  Simulation simulation(Communicator::self(), scene_of(toml));
  run_stages(simulation);
  const BlockSystem &blocks = simulation.blocks();
  ASSERT_EQ(blocks.num_owned, 4U);
  EXPECT_EQ(blocks.num_fixed, 5U);
  EXPECT_TRUE(std::is_sorted(blocks.properties.begin(), blocks.properties.begin() + 4,
                             [](const auto &a, const auto &b) { return a.id < b.id; }));
  for (int k = 0; k < count; ++k) {
    const bool is_free = k == 0 || k == 3 || k == 5;
    EXPECT_EQ(displacement_of(simulation, k + 1).u.y < 0.0, is_free) << k;
  }
}

} // namespace
} // namespace gcpdda::testing::freed_blocks_test
