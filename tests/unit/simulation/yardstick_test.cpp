// Small blocks beside large forces come to rest where they would alone.

#include "simulation/stages.hpp"
#include "support/incline.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>

namespace gcpdda::testing::yardstick_test {
namespace {

const std::string head = "[run]\nfidelity = \"rigid\"\n[material.rock]\ndensity = 2500.0\n[joint.default]\n"
                         "normal_stiffness = 1e10\nfriction_angle_deg = {}\n[output]\ninterval = 6.0\n";

std::string stage(const std::string &solver) {
  return fmt::format("[[stage]]\nkind = \"settle\"\nlimit = 6.0\nsolver = \"{}\"\n", solver);
}

/// A stone of 0.3 m and 2.2 kN/m on a plane of 30 degrees; beside it a pier that touches neither bears a
/// load.
std::string stone_beside_a_pier(double friction_deg, double load, const std::string &solver) {
  return fmt::format(fmt::runtime(head), friction_deg) +
         block_toml("base", rectangle({-50.0, -10.0}, {250.0, 0.0}), "fixed = true") +
         "[[block]]\nname = \"plane\"\nmaterial = \"rock\"\nfixed = true\n"
         "vertices = [[0, 0], [100, 0], [100, 2.2649730810374393], [0, 60]]\n"
         "[[block]]\nname = \"stone\"\nmaterial = \"rock\"\n"
         "vertices = [[50.0, 31.13248654051872], [50.25980762113533, 30.98248654051872], "
         "[50.40980762113533, 31.24229416165405], [50.15, 31.39229416165405]]\n" +
         block_toml("pier", rectangle({-20.0, 0.0}, {-10.0, 10.0})) +
         fmt::format("[[block.load]]\npoint = [-15, 10]\nforce = [0, {}]\n", -load) + stage(solver);
}

/// A stone of 0.1 m, 50 m above the ground, beside a block of 100 m.
std::string stone_in_the_air(const std::string &solver) {
  return fmt::format(fmt::runtime(head), 30.0) +
         block_toml("base", rectangle({-50.0, -10.0}, {250.0, 0.0}), "fixed = true") +
         block_toml("large", rectangle({0.0, 0.0}, {100.0, 100.0})) +
         block_toml("stone", rectangle({150.0, 50.0}, {150.1, 50.1})) + stage(solver);
}

Verdict verdict_of(const std::string &toml) {
  Simulation simulation(Communicator::self(), scene_of(toml));
  run_stages(simulation);
  return simulation.stage_results().back().verdict;
}

class Yardstick : public ::testing::TestWithParam<std::string> {};

// With 28 degrees of friction 8 % of what drives the stone is left, less than a millionth of the load.
TEST_P(Yardstick, AStoneSlidesWhateverALoadElsewhere) {
  for (const double load : {1.0, 2e8}) {
    EXPECT_NE(verdict_of(stone_beside_a_pier(28.0, load, GetParam())), Verdict::settled) << load;
    EXPECT_EQ(verdict_of(stone_beside_a_pier(31.0, load, GetParam())), Verdict::settled) << load;
  }
}

TEST_P(Yardstick, NoStoneRestsInTheAir) {
  EXPECT_NE(verdict_of(stone_in_the_air(GetParam())), Verdict::settled);
}

INSTANTIATE_TEST_SUITE_P(Solvers, Yardstick, ::testing::Values("dynamic", "static"),
                         [](const auto &param) { return param.param == "static" ? "Static" : "Dynamic"; });

} // namespace
} // namespace gcpdda::testing::yardstick_test
