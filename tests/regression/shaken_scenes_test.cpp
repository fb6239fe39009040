// What a user is told of earthquakes, and what the summary of a run has of them.

#include "child_process.hpp"
#include "support/run_facts.hpp"
#include "support/scenes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <numbers>

namespace gcpdda::shaken_scenes_test {
namespace {

using testing::block_toml;
using testing::count_of;
using testing::Outcome;
using testing::placed;
using testing::rectangle;
using testing::run_gcpdda;
using testing::summary_number;
using testing::summary_text;
using testing::WorkFolder;

/// A slab on a plane of 10 degrees with a friction angle of 25 degrees.
std::string slab_toml(const std::string &earthquake, const std::string &stages) {
  constexpr double dip = 10.0 * std::numbers::pi / 180.0;
  return "[run]\nfidelity = \"rigid\"\ncontact_damping = 0.3\n[material.rock]\ndensity = "
         "2600\n[joint.default]\n"
         "normal_stiffness = 1e9\nfriction_angle_deg = 25\n[output]\ninterval = 0.1\n" +
         block_toml("plane", placed(rectangle({-20.0, -2.0}, {20.0, 0.0}), dip, {}), "fixed = true") +
         block_toml("slab", placed(rectangle({-1.0, 0.0}, {1.0, 1.0}), dip, {})) +
         "[earthquake]\nrecord = \"push.csv\"\nquantity = \"acceleration\"\n" + earthquake + stages;
}

const std::string settle = "[[stage]]\nname = \"weight\"\nkind = \"settle\"\nlimit = 5\n";
const std::string shaking = "[[stage]]\nname = \"shaking\"\nkind = \"run\"\nduration = 1\n";
const std::string rest = "[[stage]]\nname = \"rest\"\nkind = \"settle\"\nlimit = 5\n";

/// Two sines of 2 Hz, m/s2; the ground ends at rest, and displaced by 0.3 m.
std::string push_csv() {
  std::string rows;
  for (int k = 0; k <= 200; ++k) {
    const double t = 0.005 * k;
    rows += fmt::format("{:.3f}, {}\n", t, 4.0 * std::sin(4.0 * std::numbers::pi * t));
  }
  return rows;
}

TEST(ShakenScenes, AreDoubtedByRunAndInspect) {
  const WorkFolder folder;
  folder.write("push.csv", push_csv());
  const auto expect_warning = [&](const std::string &earthquake, const std::string &stages,
                                  const std::string &words, const std::vector<std::string> &sets = {}) {
    folder.write("slab.toml", slab_toml(earthquake, stages));
    for (const std::string command : {"run", "inspect"}) {
      std::vector<std::string> line{command, "slab.toml"};
      for (const std::string &set : sets) {
        line.insert(line.end(), {"--set", set});
      }
      if (command == "run") {
        line.insert(line.end(), {"--out", "out", "--overwrite"});
      }
      const Outcome outcome = run_gcpdda(0, line, folder);
      const std::string told = outcome.out + outcome.err;
      EXPECT_EQ(outcome.exit_code, 0) << told;
      EXPECT_EQ(count_of(told, "warning: "), words.empty() ? 0 : 1) << told;
      EXPECT_EQ(count_of(told, "warning: " + words), words.empty() ? 0 : 1) << told;
    }
  };
  expect_warning("stage = \"shaking\"\n", settle + shaking, "");
  expect_warning("", settle + shaking, "the record plays in stage 'weight', which is a settle stage");
  expect_warning("stage = \"shaking\"\n", settle + shaking, "the peak of the record is 400 m/s2",
                 {"earthquake.scale=100"});
  expect_warning("stage = \"shaking\"\n", settle + shaking + rest,
                 "stage 'shaking' ends after 0.5 s of the record", {"stage.shaking.duration=0.5"});
  expect_warning("stage = \"shaking\"\n",
                 settle + shaking + "set = { \"joint.default.friction_angle_deg\" = 0.4 }\n",
                 "joint.default.friction_angle_deg is 0.4 degrees");
}

// The hint is given where it changes something.
TEST(ShakenScenes, AreGivenABaselineThatHelps) {
  const WorkFolder folder;
  folder.write("push.csv", push_csv());
  const auto hint = [&](const std::string &baseline) {
    folder.write("slab.toml", slab_toml("stage = \"shaking\"\n" + baseline, settle + shaking));
    const std::string text = run_gcpdda(0, {"inspect", "slab.toml"}, folder).out;
    const std::size_t begin = text.find("m, earthquake.baseline");
    return begin == std::string::npos ? "" : text.substr(begin + 3, text.find('\n', begin) - begin - 3);
  };
  EXPECT_EQ(hint(""), "earthquake.baseline = \"displacement\" brings the displacement to zero, too");
  EXPECT_EQ(hint("baseline = \"displacement\"\n"), "");
  folder.write("push.csv", "0, 1.0\n1.0, 1.0\n");
  EXPECT_EQ(hint(""), "earthquake.baseline = \"displacement\" brings both to zero");
}

// What moves is measured from the beginning of the shaking on to the end of the run, whatever stages follow.
TEST(ShakenScenes, HaveTheirPermanentDisplacementAtTheEndOfTheRun) {
  const WorkFolder folder;
  folder.write("push.csv", push_csv());
  const auto moved = [&](const std::string &earthquake, const std::string &stages) {
    folder.write("slab.toml", slab_toml(earthquake, stages));
    const Outcome outcome = run_gcpdda(0, {"run", "slab.toml", "--out", "out", "--overwrite"}, folder);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_EQ(summary_text(folder / "out", "permanent_block"), "\"slab\"");
    return summary_number(folder / "out", "permanent_displacement");
  };
  const std::string by_name = "stage = \"shaking\"\n";
  const double shaken = moved(by_name, settle + shaking);
  EXPECT_GT(shaken, 0.02);
  const std::string nothing = "[[stage]]\nkind = \"change\"\nset = { \"run.safety\" = 0.5 }\n";
  EXPECT_NEAR(moved(by_name, settle + shaking + rest), shaken, 1e-3 * shaken);
  EXPECT_NEAR(moved(by_name, settle + shaking + nothing + rest), shaken, 1e-3 * shaken);
  const std::string later = "[[stage]]\nkind = \"run\"\nduration = 4\n";
  EXPECT_NEAR(moved("start = 2.0\n", settle + later + rest), shaken, 1e-2 * shaken);
}

// The run stops in the stage behind the shaking, and another number of ranks goes on.
TEST(ShakenScenes, KeepTheirPermanentDisplacementThroughARestart) {
  const WorkFolder folder;
  folder.write("push.csv", push_csv());
  folder.write("slab.toml", slab_toml("stage = \"shaking\"\n",
                                      settle + shaking + "[[stage]]\nkind = \"run\"\nduration = 1\n"));
  const Outcome outcome =
      run_gcpdda(0, {"run", "slab.toml", "--out", "out", "--set", "output.checkpoint_interval=0.3"}, folder);
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const std::string whole = summary_text(folder / "out", "permanent_displacement");
  const double end = summary_number(folder / "out", "time");
  const std::vector<std::string> checkpoints = testing::listing(folder / "out/checkpoints");
  ASSERT_EQ(checkpoints.size(), 2U);
  std::filesystem::remove(folder / "out/checkpoints" / checkpoints.back());
  const Outcome again = run_gcpdda(2, {"restart", "out"}, folder);
  ASSERT_EQ(again.exit_code, 0) << again.err;
  EXPECT_GT(summary_number(folder / "out", "restarted_at"), end - 0.9) << "in the last stage";
  EXPECT_EQ(summary_text(folder / "out", "permanent_displacement"), whole);
}

} // namespace
} // namespace gcpdda::shaken_scenes_test
