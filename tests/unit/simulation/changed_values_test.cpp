// Values that stages change: what must stay as it was, and what users are told.

#include "driver/restart.hpp"
#include "gcpdda/driver/run.hpp"
#include "gcpdda/io/run_summary.hpp"
#include "gcpdda/io/scene_reader.hpp"
#include "simulation/ground.hpp"
#include "simulation/results.hpp"
#include "simulation/simulation.hpp"
#include "support/scenes.hpp"
#include "support/setting.hpp"
#include "support/temporary_folder.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace gcpdda::testing::changed_values_test {
namespace {

namespace fs = std::filesystem;
using Strings = std::vector<std::string>;

/// A block of 1 m that hangs from bonds of a soft joint under a fixed one.
std::string hanging_block(const std::string &set) {
  return "[run]\nfidelity = \"rigid\"\n[material.rock]\ndensity = 2500\n[joint.default]\nnormal_stiffness = "
         "1e7\nfriction_angle_deg = 30\ncohesion = 1e8\ntension = 4e5\nresidual_cohesion = 0.0\n" +
         block_toml("top", rectangle({0.0, 1.0}, {1.0, 2.0}), "fixed = true") +
         block_toml("hang", rectangle({0.0, 0.0}, {1.0, 1.0})) +
         "[output]\ninterval = 0.5\n[[stage]]\nname = \"weight\"\nkind = \"settle\"\nlimit = 5.0\n[[stage]]\n"
         "name = \"pull\"\nkind = \"settle\"\nsolver = \"dynamic\"\nlimit = 5.0\nset = { " +
         set + " }\n";
}

// A whole bond is a spring of stiffness k_n l, however far it is stretched. The stage ends with 1e-5 of the
// load out of balance.
TEST(ChangedValues, ABondHoldsWithTheTensionThatAStageGivesIt) {
  constexpr double pull = 0.9e6;
  Simulation simulation(Communicator::self(),
                        scene_of(hanging_block(fmt::format(
                            "\"joint.default.tension\" = 8e6, \"block.hang.load\" = [{{ point = [0.5, 0.5], "
                            "force = [0.0, {}], ramp = 1.0 }}]",
                            -pull))));
  run_stages(simulation);
  ASSERT_FALSE(simulation.fault().has_value());
  const double open = (pull + 2500.0 * earth_gravity) / 1e7;
  EXPECT_NEAR(displacement_of(simulation, 1).u.y, -open, 1e-4 * open);
}

std::string warnings_in(const Simulation &simulation, const std::string &part) {
  std::string texts;
  for (const Diagnostic &note : simulation.notes()) {
    if (note.severity == Severity::warning && note.what.find(part) != std::string::npos) {
      texts += note.what + "\n";
    }
  }
  return texts;
}

TEST(ChangedValues, BondsThatOpenFarAreTold) {
  const Simulation far(Communicator::self(), scene_of(hanging_block("\"joint.default.tension\" = 8e6")));
  EXPECT_EQ(warnings_in(far, "before they break"),
            "from stage 'pull' on bonds of [joint.default] open by 0.8 m before they break\n");
  const Simulation near(Communicator::self(), scene_of(hanging_block("\"joint.default.tension\" = 4.5e5")));
  EXPECT_EQ(warnings_in(near, "before they break"), "");
}

/// A block on a fixed one, with a joint law and a stage.
std::string block_on_floor(const std::string &joint, const std::string &block, const std::string &set) {
  return "[run]\nfidelity = \"rigid\"\n[material.rock]\ndensity = 2500\n[joint.default]\nnormal_stiffness = "
         "1e9\nfriction_angle_deg = 30\n" +
         joint + block_toml("floor", rectangle({-3.0, -1.0}, {3.0, 0.0}), "fixed = true") +
         block_toml("a", rectangle({-1.0, 0.0}, {1.0, 1.0}), block) +
         "[output]\ninterval = 0.1\n[[stage]]\nname = \"weight\"\nkind = \"settle\"\nlimit = 5.0\n[[stage]]\n"
         "name = \"later\"\nkind = \"run\"\nduration = 0.1\nset = { " +
         set + " }\n";
}

Strings errors_of(const std::string &toml) {
  Strings errors;
  for (const Diagnostic &fault : read_scene(toml, "test.toml", {}).diagnostics) {
    errors.push_back(fmt::format("{}: {}", fault.where.line, fault.what));
  }
  return errors;
}

TEST(ChangedValues, AStageGivesNoBonds) {
  for (const std::string key : {"tension", "residual_cohesion", "residual_friction_angle_deg"}) {
    const std::string toml = block_on_floor("cohesion = 1e5\n", "", "\"joint.default." + key + "\" = 10");
    const auto last_line = std::count(toml.begin(), toml.end(), '\n');
    EXPECT_EQ(errors_of(toml),
              Strings{fmt::format("{}: a stage cannot give [joint.default] bonds", last_line)});
    EXPECT_EQ(errors_of(block_on_floor("cohesion = 1e5\n" + key + " = 5\n", "",
                                       "\"joint.default." + key + "\" = 10")),
              Strings{});
  }
  EXPECT_EQ(errors_of(block_on_floor("", "", "\"joint.default.cohesion\" = 1e5")), Strings{});
}

TEST(ChangedValues, ARestartGivesNoBonds) {
  const auto scene = [](const std::string &joint) {
    return scene_of(block_on_floor(joint, "", "\"joint.default.friction_angle_deg\" = 25"));
  };
  const Diagnostics faults =
      unfit_changes(scene("cohesion = 1e5\n"), scene("cohesion = 1e5\ntension = 10\n"));
  ASSERT_EQ(faults.size(), 1U);
  EXPECT_EQ(faults[0].what, "a restart cannot give [joint.default] bonds by tension or residual values");
  EXPECT_TRUE(unfit_changes(scene("cohesion = 1e5\ntension = 10\n"), scene("cohesion = 1e5\ntension = 20\n"))
                  .empty());
}

TEST(ChangedValues, AStiffnessThatChangesUnderStressIsTold) {
  const auto told = [](const std::string &joint, const std::string &set) {
    return warnings_in(Simulation(Communicator::self(), scene_of(block_on_floor(joint, "", set))), "changes");
  };
  EXPECT_EQ(told("", "\"joint.default.normal_stiffness\" = 1e8"),
            "stage 'later' changes k_n of [joint.default] from 1e+09 to 1e+08 Pa/m\n");
  EXPECT_EQ(told("", "\"joint.default.friction_angle_deg\" = 20"), "");
  EXPECT_EQ(told("[joint.other]\nmaterials = [\"rock\", \"rock\"]\nrock_mass_modulus = 5e9\nspacing = 0.5\n"
                 "intact_modulus = 20e9\n",
                 "\"joint.other.intact_modulus\" = 10e9"),
            "stage 'later' changes k_n of [joint.other] from 1.33333e+10 to 2e+10 Pa/m (of rock_mass_modulus "
            "5e+09 Pa in intact rock of 1e+10 Pa)\n");
}

/// A block held by a fixed point alone, above its floor; the second stage stiffens joints that it does not
/// touch.
Scene held_block() {
  return scene_of(
      "[run]\nfidelity = \"rigid\"\n[material.rock]\ndensity = 2500\n[joint.default]\nnormal_stiffness"
      " = 1e9\n" +
      block_toml("floor", rectangle({-3.0, -1.0}, {3.0, 0.0}), "fixed = true") +
      block_toml("a", rectangle({-1.0, 1.0}, {1.0, 2.0}), "fixed_points = [[0.0, 1.5]]") +
      "[[monitor]]\nblock = \"a\"\n[output]\ninterval = 0.05\ncheckpoint_interval = 0.05\n"
      "[[stage]]\nname = \"weight\"\nkind = \"settle\"\nlimit = 5.0\n[[stage]]\nname = \"softer\"\n"
      "kind = \"run\"\nduration = 0.1\nset = { \"joint.default.normal_stiffness\" = 1e7 }\n");
}

// Its spring bears the weight all along: W = 100 k_n sqrt(area) u, with the k_n of the start.
TEST(ChangedValues, FixedPointsKeepTheirStiffness) {
  const double sunk = 2500.0 * 2.0 * earth_gravity / (100.0 * 1e9 * std::sqrt(2.0));
  Simulation simulation(Communicator::self(), held_block());
  run_stages(simulation);
  EXPECT_NEAR(displacement_of(simulation, 1).u.y, -sunk, 1e-4 * sunk);
}

std::string text_of(const fs::path &path) {
  std::ifstream stream(path);
  return {std::istreambuf_iterator<char>(stream), {}};
}

TEST(ChangedValues, FixedPointsKeepTheirStiffnessThroughARestart) {
  const TemporaryFolder folder;
  const fs::path whole = folder.path() / "whole";
  const fs::path cut = folder.path() / "cut";
  const Scene scene = held_block();
  ASSERT_EQ(run_scene(Communicator::self(), scene, {whole, false, false}), 0);
  fs::copy(whole, cut, fs::copy_options::recursive);
  std::vector<fs::path> found;
  for (const fs::directory_entry &entry : fs::directory_iterator(cut / "checkpoints")) {
    found.push_back(entry.path());
  }
  std::sort(found.begin(), found.end());
  ASSERT_EQ(found.size(), 2U);
  fs::remove(found.back()); // back into the second stage
  ASSERT_EQ(restart_scene(Communicator::self(), scene, scene, cut), 0);
  EXPECT_EQ(text_of(cut / "history" / "a.csv"), text_of(whole / "history" / "a.csv"));
}

// The ground shakes before a stage frees a block that stays where it is.
TEST(ChangedValues, AFreedBlockDoesNotTakeTheDisplacementOfAnother) {
  const TemporaryFolder folder;
  const std::string record = (folder.path() / "record.csv").string();
  std::ofstream(record) << "t,ax\n0,0\n0.01,0.1\n0.02,0\n";
  const std::string settle = "kind = \"settle\"\nsolver = \"dynamic\"\nlimit = 5.0\n";
  Simulation simulation(
      Communicator::self(),
      scene_of("[run]\nfidelity = \"rigid\"\n[material.rock]\ndensity = 2500\n[joint.default]\n"
               "normal_stiffness = 1e9\nfriction_angle_deg = 30\n" +
               block_toml("floor", rectangle({-9.0, -1.0}, {9.0, 0.0}), "fixed = true") +
               block_toml("late", rectangle({4.0, 0.0}, {5.0, 1.0}), "fixed = true") +
               block_toml("falls", rectangle({-5.0, 0.3}, {-4.0, 1.3})) +
               fmt::format("[earthquake]\nrecord = \"{}\"\nstage = \"shake\"\nquantity = \"acceleration\"\n",
                           record) +
               "[output]\ninterval = 0.5\n[[stage]]\nname = \"fall\"\n" + settle +
               "[[stage]]\nname = \"shake\"\nkind = \"run\"\nduration = 0.05\n[[stage]]\n" + settle +
               "[[stage]]\n" + settle + "set = { \"block.late.fixed\" = false }\n"));
  run_stages(simulation);
  const auto farthest = permanent_displacement(simulation.state());
  ASSERT_TRUE(farthest.has_value());
  EXPECT_LT(farthest->distance, 0.01) << "'falls' fell by 0.3 m before the ground shook";
}

// Two blocks on each other. While the forces of the upper one fall to zero within 1 s, the lower one bears
// what is left of them on its whole top, and half of its own weight on the mean.
TEST(ChangedValues, StressOfARigidBlockHoldsWhatIsLeftOfExcavatedRock) {
  Simulation simulation(
      Communicator::self(),
      scene_of(
          "[run]\nfidelity = \"rigid\"\n[material.rock]\ndensity = 2500\n[joint.default]\n"
          "normal_stiffness = 1e9\nfriction_angle_deg = 30\n" +
          block_toml("floor", rectangle({-3.0, -1.0}, {3.0, 0.0}), "fixed = true") +
          block_toml("low", rectangle({-1.0, 0.0}, {1.0, 1.0})) +
          block_toml("high", rectangle({-1.0, 1.0}, {1.0, 5.0})) +
          "[output]\ninterval = 0.1\n[[stage]]\nkind = \"settle\"\nlimit = 5.0\n[[stage]]\nkind = "
          "\"excavate\"\nblocks = [\"high\"]\nrelax = 1.0\n[[stage]]\nkind = \"run\"\nduration = 0.4\n"));
  run_stages(simulation);
  std::vector<FrameRow> rows;
  std::vector<Vec2> vertices;
  SimulationFrame(simulation).append(1, 2, rows, vertices);
  ASSERT_EQ(rows.size(), 1U);
  const double weight = 2500.0 * earth_gravity; // of 1 m2
  const double left = 0.6 * 8.0 * weight;
  // The floor swings by the weight that is taken away in a period of the joint, 1e-3 of what is left.
  EXPECT_NEAR(rows[0].stress[1], -(left + 0.5 * 2.0 * weight) / 2.0, 5e-3 * left);
}

TEST(ChangedValues, AnOutlineOfAnExcavationThroughACentroidIsTold) {
  const auto told = [](double top) {
    return warnings_in(
        Simulation(Communicator::self(),
                   scene_of("[run]\nfidelity = \"rigid\"\n[material.rock]\ndensity = 2500\n[joint.default]\n"
                            "normal_stiffness = 1e9\n" +
                            block_toml("floor", rectangle({-3.0, -1.0}, {3.0, 0.0}), "fixed = true") +
                            block_toml("low", rectangle({-1.0, 0.0}, {1.0, 1.0})) +
                            block_toml("high", rectangle({-1.0, 1.0}, {1.0, 2.0})) +
                            "[output]\ninterval = 0.1\n[[stage]]\nkind = \"settle\"\nlimit = 5.0\n[[stage]]\n"
                            "name = \"dig\"\nkind = \"excavate\"\n" +
                            fmt::format("region = [[-2, 1.1], [2, 1.1], [2, {0}], [-2, {0}]]\n", top))),
        "outline");
  };
  EXPECT_EQ(told(1.5005),
            "the outline of 'region' in stage 'dig' passes through the centroids of 1 block, the "
            "first is 'high'\n");
  EXPECT_EQ(told(1.6), "");
}

TEST(ChangedValues, ADrivenBlockThatClosesOnAFixedOneIsTold) {
  const auto told = [](double gap, const std::string &velocity) {
    return warnings_in(
        Simulation(Communicator::self(),
                   scene_of("[run]\nduration = 1.0\nfidelity = \"rigid\"\n[material.rock]\ndensity = 2500\n"
                            "[joint.default]\nnormal_stiffness = 1e9\n[output]\ninterval = 0.1\n" +
                            block_toml("floor", rectangle({-3.0, -1.0}, {3.0, 0.0}), "fixed = true") +
                            block_toml("upper", rectangle({-1.0, gap}, {1.0, 1.0 + gap}), velocity))),
        "driven block");
  };
  // It reaches the floor at 0.1 s; looks are 2 ms apart.
  EXPECT_EQ(told(0.001, "prescribed_velocity = [0, -0.01, 0]"),
            "driven block 'upper' closes on block 'floor' at about t = 0.102 s\n");
  EXPECT_EQ(told(0.001, "velocity = [0, -0.01, 0]"), "");
  EXPECT_EQ(told(0.001, "prescribed_velocity = [0.01, 0, 0]"), "");
}

} // namespace
} // namespace gcpdda::testing::changed_values_test
