// One rank and many write the same bytes of stages with the static solver, as in identity_test.cpp.

#include "support/cut_region.hpp"
#include "support/run_facts.hpp"
#include "support/scenes.hpp"
#include "two_runs.hpp"

#include <gtest/gtest.h>

#include <fmt/format.h>
#include <string>

namespace gcpdda::static_identity_test {
namespace {

using testing::expect_same_after_restart;
using testing::summary_number;
using testing::summary_text;
using testing::TwoRuns;

/// Ls with a brick in the notch of each, rigid and deformable ones, at rest on a floor and beside a pillar;
/// weak joints let the wall sag by more than half the skin. Both settle stages have the static solver.
std::string static_wall_toml(int rows, int columns, const std::string &opening) {
  std::string toml = "[run]\ngravity_ramp = 0.1\n[material.rock]\ndensity = 2600.0\nyoungs_modulus = 2e9\n"
                     "poissons_ratio = 0.25\n[joint.default]\nnormal_stiffness = 5e7\n"
                     "friction_angle_deg = 45.0\n[output]\ninterval = 0.02\ncheckpoint_interval = 0.04\n";
  toml += testing::block_toml("floor", testing::rectangle({-2.0, -1.0}, {2.0 * columns + 3.0, 0.0}),
                              "fixed = true");
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const double x = 2.0 * column + 0.5 * (row % 2);
      const double y = row;
      const auto fidelity = [](bool deforms) {
        return fmt::format("fidelity = \"{}\"", deforms ? "deformable" : "rigid");
      };
      toml += testing::block_toml(
          fmt::format("l{}_{}", row, column),
          {{x, y}, {x + 2.0, y}, {x + 2.0, y + 0.5}, {x + 1.0, y + 0.5}, {x + 1.0, y + 1.0}, {x, y + 1.0}},
          fidelity((row + column) % 2 == 0));
      toml += testing::block_toml(fmt::format("b{}_{}", row, column),
                                  testing::rectangle({x + 1.0, y + 0.5}, {x + 2.0, y + 1.0}),
                                  fidelity((row + column) % 3 == 0));
    }
  }
  return toml +
         "[[stage]]\nname = \"weight\"\nkind = \"settle\"\nlimit = 30.0\nsolver = \"static\"\n"
         "[[stage]]\nkind = \"excavate\"\nregion = " +
         opening +
         "\n"
         "[[stage]]\nname = \"opening\"\nkind = \"settle\"\nlimit = 30.0\nsolver = \"static\"\n";
}

// The static solver on rigid, deformable and non-convex blocks, through refreshes, an excavation, and a stop
// in the middle of each of its stages.
TEST(Identity, OfStagesWithTheStaticSolver) {
  const Scene scene = testing::scene_of(static_wall_toml(20, 16, "[[6, 2], [8, 2], [8, 4], [6, 4]]"));
  const TwoRuns runs(scene);
  EXPECT_GE(runs.counted("refreshes"), 2);
  EXPECT_GE(runs.counted("contacts"), 1000);
  if (runs.world().size() > 1) {
    EXPECT_GE(runs.counted("cross_rank_contacts"), 50);
  }
  if (runs.world().is_root()) {
    EXPECT_EQ(testing::file_text(runs.alone() / "run.log").find("goes on with solver"), std::string::npos);
    EXPECT_EQ(summary_text(runs.together(), "stages"), summary_text(runs.alone(), "stages"));
    // A product asks the other ranks once. So does a solution where it begins, and the coarse matrix.
    EXPECT_LE(runs.counted("reductions") - summary_number(runs.alone(), "reductions"),
              runs.counted("products") + 2.0 * runs.counted("steps"));
  }
  expect_same_after_restart(runs, scene);
}

// Water in joints whose law no edge names: blocks know which of their stretches are wet wherever they
// migrate.
TEST(Identity, OfWaterInJoints) {
  const std::string opening = "[[6, 2], [8, 2], [8, 4], [6, 4]]";
  const std::string water = "[water.low]\njoints = [\"default\"]\nphreatic = [[0, 2], [20, 5], [40, 3]]\n";
  const Scene scene = testing::scene_of(static_wall_toml(20, 16, opening) + water);
  const TwoRuns runs(scene);
  if (runs.world().size() > 1) {
    EXPECT_GE(runs.counted("cross_rank_contacts"), 50);
  }
  const TwoRuns dry(testing::scene_of(static_wall_toml(20, 16, opening)));
  if (runs.world().is_root()) {
    EXPECT_NE(summary_text(runs.alone(), "energy"), summary_text(dry.alone(), "energy"));
  }
  expect_same_after_restart(runs, scene);
}

// Joints that dilate, and bonds of which some break: those that hang over the opening.
TEST(Identity, OfStaticStagesWithBondsAndDilation) {
  const std::string opening = "[[6, 2], [8, 2], [8, 4], [6, 4]]";
  const auto with = [&](const std::string &tension) {
    return testing::scene_of(static_wall_toml(20, 16, opening),
                             {"joint.default.dilation_angle_deg=5", "joint.default.dilation_limit=0.01",
                              "joint.default.cohesion=1e5", "joint.default.tension=" + tension,
                              "joint.default.residual_cohesion=0"});
  };
  const TwoRuns runs(with("2e4"));
  EXPECT_GE(runs.counted("refreshes"), 2);
  if (runs.world().size() > 1) {
    EXPECT_GE(runs.counted("cross_rank_contacts"), 50);
  }
  const TwoRuns unbroken(with("1e5"));
  if (runs.world().is_root()) {
    EXPECT_EQ(testing::file_text(runs.alone() / "run.log").find("goes on with solver"), std::string::npos);
    EXPECT_NE(summary_text(runs.alone(), "stages"), summary_text(unbroken.alone(), "stages"))
        << "bonds break";
  }
}

/// A slope whose bedding is bonded on every third part of 3 m. In the second stage the bonds are weakened.
Scene bridged_slope(double cohesion) {
  std::string toml = "[run]\n[material.rock]\ndensity = 2600.0\nyoungs_modulus = 5e9\npoissons_ratio = 0.25\n"
                     "[joint.default]\nnormal_stiffness = 2e9\nfriction_angle_deg = 38.0\n"
                     "[joint.bridge]\nnormal_stiffness = 4e9\ncohesion = 5e5\ntension = 2e5\n"
                     "residual_cohesion = 0.0\n[output]\ninterval = 0.01\ncheckpoint_interval = 0.008\n"
                     "[region]\nmaterial = \"rock\"\nfixed = [\"bottom\", \"left\", \"right\"]\n"
                     "[region.slope]\ntoe_length = 10.0\ncrest_length = 20.0\ndepth = 5.0\n"
                     "[[region.slope.bench]]\nheight = 20.0\nface_angle_deg = 60.0\n"
                     "[[joint_set]]\ndip_deg = 100.0\nspacing = 1.5\n";
  for (int line = 0; line < 15; ++line) {
    for (int part = 0; part < 15; ++part) {
      const double x = 3.0 * part - 12.0;
      const double y = 2.0 * line - 6.0;
      toml += fmt::format("[[fault]]\npoints = [[{}, {}], [{}, {}]]\njoint = \"{}\"\n", x, y + 0.1 * x,
                          x + 3.0, y + 0.1 * (x + 3.0), (part + line) % 3 == 0 ? "bridge" : "default");
    }
  }
  Scene scene = testing::scene_of(
      toml +
      fmt::format("[[stage]]\nname = \"weight\"\nkind = \"settle\"\nlimit = 20.0\nsolver = \"static\"\n"
                  "[[stage]]\nname = \"weak\"\nkind = \"settle\"\nlimit = 20.0\nsolver = \"static\"\n"
                  "set = {{\"joint.bridge.cohesion\" = {0}, \"joint.bridge.tension\" = {0}}}\n"
                  "[[stage]]\nkind = \"run\"\nduration = 0.02\n",
                  cohesion));
  testing::prepare_region(scene);
  return scene;
}

// Bonds on parts of straight sides, of which some break.
TEST(Identity, OfBondedPartsOfSides) {
  const Scene scene = bridged_slope(1e3);
  const TwoRuns runs(scene);
  EXPECT_GE(runs.counted("refreshes"), 1);
  if (runs.world().size() > 1) {
    EXPECT_GE(runs.counted("cross_rank_contacts"), 50);
  }
  const TwoRuns unbroken(bridged_slope(5e5));
  if (runs.world().is_root()) {
    EXPECT_NE(summary_text(runs.alone(), "stages"), summary_text(unbroken.alone(), "stages"))
        << "bonds break";
  }
  expect_same_after_restart(runs, scene);
}

// Friction does not hold this opening: the dynamic solver takes over in the middle of a stage and finds that
// it has failed.
TEST(Identity, OfAStaticStageThatIsLeft) {
  const TwoRuns runs(testing::scene_of(static_wall_toml(20, 16, "[[4, 2], [9, 2], [9, 5], [4, 5]]"),
                                       {"joint.default.friction_angle_deg=30"}));
  if (runs.world().size() > 1) {
    EXPECT_GE(runs.counted("cross_rank_contacts"), 20);
  }
  if (runs.world().is_root()) {
    EXPECT_NE(testing::file_text(runs.alone() / "run.log").find("goes on with solver"), std::string::npos);
    EXPECT_EQ(summary_text(runs.together(), "verdict"), "\"failed\"");
  }
}

// All of the weight at once closes soft joints by more than half of a block: a step is taken back on all
// ranks, and the dynamic solver goes on to the limit of the stage.
TEST(Identity, OfAStaticStepThatIsTakenBack) {
  const TwoRuns runs(testing::scene_of(static_wall_toml(20, 16, "[[6, 2], [8, 2], [8, 4], [6, 4]]"),
                                       {"joint.default.normal_stiffness=3e6", "stage.weight.increments=1",
                                        "stage.weight.limit=0.5"}),
                     exit_code::undecided);
  if (runs.world().size() > 1) {
    EXPECT_GE(runs.counted("cross_rank_contacts"), 50);
  }
  if (runs.world().is_root()) {
    EXPECT_NE(
        testing::file_text(runs.alone() / "run.log").find("would have closed by more than half of a block"),
        std::string::npos);
    EXPECT_EQ(summary_text(runs.together(), "stages"), summary_text(runs.alone(), "stages"));
  }
}

// With weaker bedding the foot of this slope slides out. From the 98th evaluation on the motion has begun
// anew ten times in a row within few evaluations, which changes the stiffness of what slips; a checkpoint is
// written after the ninth time. The stage ends while they slide.
TEST(Identity, OfAStaticStageThatSwings) {
  Scene scene = testing::scene_of(testing::walked_slope_toml() +
                                      "[[stage]]\nkind = \"change\"\n"
                                      "set = { \"joint.bedding.friction_angle_deg\" = 32.2 }\n"
                                      "[[stage]]\nname = \"slide\"\nkind = \"settle\"\nlimit = 0.08\n",
                                  {"output.checkpoint_interval=0.0475"});
  testing::prepare_region(scene);
  const TwoRuns runs(scene, exit_code::undecided);
  if (runs.world().size() > 1) {
    EXPECT_GE(runs.counted("cross_rank_contacts"), 20);
  }
  expect_same_after_restart(runs, scene, exit_code::undecided);
}

// At most evaluations the static solver moves a block that falls and leaves out the wall beside it; rigid
// ones, or deformable ones on two ranks and on four. That pairs are left out is seen from the summary: all of
// them would be more than there are contacts at each step.
TEST(Identity, OfAStaticStageInWhichFewMove) {
  const std::string fidelity = Communicator::world().size() % 2 == 1 ? "rigid" : "deformable";
  const Scene scene = testing::scene_of(
      testing::fall_from_shelf_toml(fidelity, 32, 16, "interval = 0.02\ncheckpoint_interval = 0.032\n"));
  const TwoRuns runs(scene);
  EXPECT_GE(runs.counted("refreshes"), 1);
  if (runs.world().size() > 1) {
    EXPECT_GE(runs.counted("cross_rank_contacts"), 50);
    EXPECT_GE(runs.counted("migrations"), 1);
  }
  if (runs.world().is_root()) {
    const std::string evaluations = summary_text(runs.alone(), "evaluations_per_rank");
    EXPECT_LT(std::stod(evaluations.substr(1)), summary_number(runs.alone(), "contact_steps"));
    EXPECT_EQ(testing::file_text(runs.alone() / "run.log").find("goes on with solver"), std::string::npos);
  }
  expect_same_after_restart(runs, scene);
}

} // namespace
} // namespace gcpdda::static_identity_test
