// Settle stages that do not wait for loose blocks.

#include "simulation/stages.hpp"
#include "support/incline.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

namespace gcpdda::testing::loose_blocks_test {
namespace {

/// A wall of `columns` columns and 25 rows, and so many pebbles that fall beside it, from a height that takes
/// them far longer than the wall needs to come to rest.
std::string wall_and_pebbles(int columns, int pebbles, const std::string &stage_keys, double limit = 60.0) {
  std::string toml =
      "[run]\nfidelity = \"rigid\"\n[material.rock]\ndensity = 2600.0\n[joint.default]\n"
      "normal_stiffness = 1e9\nfriction_angle_deg = 35.0\n[output]\ninterval = 1.0\n" +
      block_toml("floor", rectangle({-1.0, -1.0}, {300.0, 0.0}), "fixed = true") +
      fmt::format("[[wall]]\nname = \"w\"\nmaterial = \"rock\"\norigin = [0, 0]\nrows = 25\ncolumns = {}\n"
                  "block_size = [2.0, 1.0]\n",
                  columns);
  for (int k = 0; k < pebbles; ++k) {
    toml += block_toml(fmt::format("pebble{}", k), rectangle({200.0 + k, 200.0}, {200.1 + k, 200.1}));
  }
  return toml + fmt::format("[[stage]]\nkind = \"settle\"\nlimit = {}\n", limit) + stage_keys;
}

StageResult result_of(Simulation &simulation) {
  return simulation.stage_results().back();
}

/// Of the blocks of the wall, which stand behind floor and pebbles.
double lowest_displacement(Simulation &simulation, int pebbles) {
  double lowest = 0.0;
  for (int id = 1 + pebbles; id <= pebbles + 1000; ++id) {
    lowest = std::min(lowest, displacement_of(simulation, id).u.y);
  }
  return lowest;
}

const std::string dynamic_solver = "solver = \"dynamic\"\n";
const std::string static_solver = "solver = \"static\"\n";

class LooseBlocks : public ::testing::TestWithParam<std::string> {};

// 25 rows of 41 bricks and two halves: one pebble is less than 0.1 % of these, two are more.
TEST_P(LooseBlocks, OneOfAThousandDoesNotHoldUpAStage) {
  Simulation simulation(Communicator::self(), scene_of(wall_and_pebbles(41, 1, GetParam())));
  run_stages(simulation);
  const StageResult result = result_of(simulation);
  EXPECT_EQ(result.verdict, Verdict::settled);
  EXPECT_EQ(result.loose, 1);
  const Diagnostics &notes = simulation.notes();
  EXPECT_EQ(std::count_if(notes.begin(), notes.end(),
                          [](const Diagnostic &note) {
                            return note.what.find("settled but for 1 loose block: 'pebble0'") !=
                                   std::string::npos;
                          }),
            1);

  // What the others come to is what they come to alone.
  Simulation alone(Communicator::self(), scene_of(wall_and_pebbles(41, 0, GetParam())));
  run_stages(alone);
  EXPECT_EQ(result_of(alone).loose, 0);
  const double sag = lowest_displacement(alone, 0);
  EXPECT_LT(sag, -1e-3);
  EXPECT_NEAR(lowest_displacement(simulation, 1), sag, 1e-3 * std::abs(sag));
}

INSTANTIATE_TEST_SUITE_P(Solvers, LooseBlocks, ::testing::Values(dynamic_solver, static_solver),
                         [](const auto &param) {
                           return param.param == static_solver ? "Static" : "Dynamic";
                         });

// Two of a thousand may be the beginning of something.
TEST(LooseBlocksOfSmallModels, AreWaitedFor) {
  Simulation simulation(Communicator::self(), scene_of(wall_and_pebbles(20, 2, dynamic_solver, 2.0)));
  run_stages(simulation);
  EXPECT_EQ(result_of(simulation).verdict, Verdict::undecided); // they fall for 6 s at least
}

} // namespace
} // namespace gcpdda::testing::loose_blocks_test
