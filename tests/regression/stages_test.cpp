// A run in stages: what it writes, that a restart from any of them goes on with the same bits, its exit
// codes.

#include "io/results/frame_reader.hpp"
#include "io/results/run_comparison.hpp"

#include "child_process.hpp"
#include "support/run_facts.hpp"
#include "support/scenes.hpp"

#include <fmt/format.h>
#include <fstream>
#include <gtest/gtest.h>
#include <sstream>

namespace gcpdda::stages_test {
namespace {

namespace fs = std::filesystem;
using testing::count_of;
using testing::file_text;
using testing::Outcome;
using testing::run_gcpdda;
using testing::summary_text;
using testing::WorkFolder;

const std::vector<std::string> none;

const std::string wall = R"([run]
fidelity = "rigid"
[material.rock]
density = 2600.0
[joint.default]
normal_stiffness = 1e9
friction_angle_deg = 35.0
[output]
interval = 0.02
checkpoint_interval = 0.02
[[block]]
name = "floor"
material = "rock"
fixed = true
vertices = [[-1, -1], [9, -1], [9, 0], [-1, 0]]
[[wall]]
name = "w"
material = "rock"
origin = [0.0, 0.0]
rows = 4
columns = 8
block_size = [1.0, 0.5]
[[monitor]]
block = "w.1.5"
)";

const std::vector<std::string> stages{
    "[[stage]]\nname = \"gravity\"\nkind = \"settle\"\nlimit = 1.98\nsolver = \"dynamic\"\ntolerance = "
    "1e-3\n",
    "[[stage]]\nname = \"opening\"\nkind = \"excavate\"\nregion = [[3, 0], [5, 0], [5, 1], [3, 1]]\nrelax = "
    "0.02\n",
    "[[stage]]\nkind = \"run\"\nduration = 0.04\nset = { \"run.rayleigh\" = { ratio = 0.1, frequency = 30.0 "
    "} }\n",
    "[[stage]]\nkind = \"change\"\nset = { \"joint.default.friction_angle_deg\" = 20.0, "
    "\"joint.default.normal_stiffness\" = 5e8 }\n",
    "[[stage]]\nname = \"weak\"\nkind = \"run\"\nduration = 0.04\n"};

std::string scene_of_stages(std::size_t count) {
  std::string text = wall;
  for (std::size_t k = 0; k < count; ++k) {
    text += stages[k];
  }
  return text;
}

std::vector<fs::path> checkpoints(const fs::path &run) {
  std::vector<fs::path> found;
  for (const fs::directory_entry &entry : fs::directory_iterator(run / "checkpoints")) {
    found.push_back(entry.path());
  }
  std::sort(found.begin(), found.end());
  return found;
}

TEST(StagedRun, GoesOnFromAnyStageOnAnyNumberOfRanks) {
  const WorkFolder folder;
  folder.write("scene.toml", scene_of_stages(stages.size()));
  const Outcome whole = run_gcpdda(1, {"run", "scene.toml", "--out", "whole"}, folder);
  ASSERT_EQ(whole.exit_code, 0) << whole.err;
  EXPECT_EQ(summary_text(folder / "whole", "verdict"), "\"completed\"");
  EXPECT_EQ(count_of(whole.err, "stage 'opening' at t = "), 1) << whole.err;
  EXPECT_EQ(count_of(whole.err, "stage 'gravity' settled"), 1) << whole.err;
  for (const std::size_t count : {2U, 3U}) {
    const std::string name = fmt::format("first{}", count);
    folder.write("first.toml", scene_of_stages(count));
    const Outcome first =
        run_gcpdda(1 + static_cast<int>(count % 3), {"run", "first.toml", "--out", name}, folder);
    ASSERT_EQ(first.exit_code, 0) << first.err;
    if (count == 3) { // into the middle of its last stage that takes time
      fs::remove(checkpoints(folder / name).back());
    }
    std::ofstream(folder / name / "scene.toml") << scene_of_stages(stages.size());
    const Outcome rest = run_gcpdda(static_cast<int>(count), {"restart", name}, folder);
    EXPECT_EQ(rest.exit_code, 0) << rest.err;
    EXPECT_EQ(compare_runs(folder / "whole", folder / name), none);
    EXPECT_EQ(summary_text(folder / name, "stages"), summary_text(folder / "whole", "stages"));
  }
}

TEST(StagedRun, CountsExcavatedBlocksNeitherAsMobileNorAsFixed) {
  const WorkFolder folder;
  folder.write("scene.toml", scene_of_stages(3));
  const Outcome first = run_gcpdda(0, {"run", "scene.toml", "--out", "dug"}, folder);
  ASSERT_EQ(first.exit_code, 0) << first.err;
  EXPECT_EQ(count_of(first.err, " 34 mobile and 1 fixed blocks,"), 1) << first.err;
  std::ofstream(folder / "dug/scene.toml") << scene_of_stages(stages.size());
  const Outcome rest = run_gcpdda(2, {"restart", "dug"}, folder);
  EXPECT_EQ(rest.exit_code, 0) << rest.err;
  EXPECT_EQ(count_of(rest.err, " mobile and 1 fixed blocks,"), 1) << rest.err;
  EXPECT_EQ(count_of(rest.err, " 34 mobile"), 0) << rest.err;
}

// What scene.toml says of the past stays what was computed; what is changed is said.
TEST(StagedRun, KeepsStagesThatAreOverInARestart) {
  const WorkFolder folder;
  folder.write("scene.toml", scene_of_stages(3));
  ASSERT_EQ(run_gcpdda(0, {"run", "scene.toml", "--out", "o"}, folder).exit_code, 0);
  const std::string longer = scene_of_stages(stages.size());
  std::ofstream(folder / "o/scene.toml") << longer;
  const Outcome refused = run_gcpdda(
      2, {"restart", "o", "--set", "stage.gravity.limit=2.98", "--set", "stage.opening.relax=0.5"}, folder);
  EXPECT_EQ(refused.exit_code, 3) << refused.err;
  EXPECT_EQ(count_of(refused.err, ": error: a restart cannot change stage.gravity.limit from 1.98 "
                                  "to 2.98, this stage is over in the checkpoint"),
            1)
      << refused.err;
  EXPECT_EQ(count_of(refused.err, "error: a restart cannot change stage.opening.relax"), 1) << refused.err;
  EXPECT_EQ(file_text(folder / "o/scene.toml"), longer) << "a refusal changes nothing";
  const Outcome rest = run_gcpdda(
      2, {"restart", "o", "--set", "stage.weak.duration=0.02", "--set", "joint.default.cohesion=1e3"},
      folder);
  EXPECT_EQ(rest.exit_code, 0) << rest.err;
  EXPECT_EQ(count_of(rest.err,
                     "info: stage.weak.duration changes from 0.04 to 0.02, the run has the new value "
                     "from t = "),
            1)
      << rest.err;
  EXPECT_EQ(count_of(rest.err, "info: joint.default.cohesion changes from its default 0 to 1000, "), 1)
      << rest.err;
  EXPECT_EQ(count_of(rest.err, "info: "), 2) << rest.err;
  const std::string log = file_text(folder / "o/run.log");
  EXPECT_EQ(count_of(log, "joint.default.cohesion changes from its default 0 to 1000"), 1);
}

/// Times of a history's rows.
std::vector<double> times_of(const fs::path &history) {
  std::vector<std::string> lines = testing::lines_of(file_text(history));
  std::vector<double> times;
  for (std::size_t i = 1; i < lines.size(); ++i) {
    times.push_back(std::stod(lines[i]));
  }
  return times;
}

// A history row stands at the end of each stage that takes time, also where it ends between two
// rows; none is written twice where a stage ends on a row; a restart from the middle of a stage writes the
// same bytes. The stages end at: the settled state, + 0.04, + 0.04 s.
TEST(StagedRun, EveryStageEndsWithAHistoryRow) {
  const WorkFolder folder;
  folder.write("scene.toml", scene_of_stages(stages.size()));
  const auto run = [&](int ranks, const std::string &out, const std::string &interval) {
    const Outcome outcome =
        run_gcpdda(ranks,
                   {"run", "scene.toml", "--out", out, "--set", "output.interval=0.04", "--set",
                    "output.history_interval=" + interval, "--set", "stage.gravity.limit=2.0"},
                   folder);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    return outcome;
  };
  const Outcome whole = run(0, "whole", "0.04");
  ASSERT_EQ(count_of(whole.err, "stage 'gravity' settled"), 1) << whole.err;
  const std::vector<double> times = times_of(folder / "whole/history/energy.csv");
  ASSERT_GE(times.size(), 4U);
  const double settled = times.end()[-3];
  EXPECT_EQ(count_of(whole.err, fmt::format("stage 'gravity' settled at t = {:.9g} s", settled)), 1)
      << settled << ": " << whole.err;
  EXPECT_GT(std::abs(std::remainder(settled, 0.04)), 1e-6) << "the stage ends between two rows";
  EXPECT_NEAR(times.end()[-2], settled + 0.04, 1e-12);
  EXPECT_NEAR(times.end()[-1], settled + 0.08, 1e-12);
  EXPECT_EQ(times.size(), 4U + static_cast<std::size_t>(settled / 0.04)) << "no row twice";
  EXPECT_EQ(times_of(folder / "whole/history/w.1.5.csv").back(), settled) << "it is taken away then";
  for (const int ranks : {2, 3}) {
    const std::string name = fmt::format("on{}", ranks);
    run(ranks, name, "0.04");
    EXPECT_EQ(compare_runs(folder / "whole", folder / name), none);
    fs::remove(checkpoints(folder / name).back());
    EXPECT_EQ(run_gcpdda(5 - ranks, {"restart", name}, folder).exit_code, 0);
    EXPECT_EQ(compare_runs(folder / "whole", folder / name), none);
  }
}

// The excavation is the last stage: the frame and the row at its end show what it has left, at the time at
// which the stage before ended. A restart from the end of that stage writes them again.
TEST(StagedRun, ALastStageWithoutStepsHasAFrameAndARow) {
  const WorkFolder folder;
  folder.write("scene.toml", scene_of_stages(2));
  for (const int ranks : {1, 2, 3}) {
    const std::string name = fmt::format("on{}", ranks);
    const Outcome outcome = run_gcpdda(ranks, {"run", "scene.toml", "--out", name}, folder);
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_EQ(compare_runs(folder / "on1", folder / name), none);
  }
  const std::vector<double> times = times_of(folder / "on1/history/energy.csv");
  ASSERT_GE(times.size(), 2U);
  EXPECT_EQ(times.end()[-1], times.end()[-2]);
  std::vector<fs::path> frames;
  for (const fs::directory_entry &entry : fs::directory_iterator(folder / "on1/frames")) {
    if (entry.path().filename().string().starts_with("frame_")) {
      frames.push_back(entry.path());
    }
  }
  std::sort(frames.begin(), frames.end());
  ASSERT_GE(frames.size(), 2U);
  EXPECT_EQ(read_frame(frames.end()[-2]).block.size(), 35U) << "the floor and rows of 8 and 9";
  EXPECT_EQ(read_frame(frames.end()[-1]).block.size(), 30U)
      << "two blocks of the lowest row and three above them";
  const Outcome again = run_gcpdda(2, {"restart", "on3"}, folder);
  EXPECT_EQ(again.exit_code, 0) << again.err;
  EXPECT_EQ(compare_runs(folder / "on1", folder / "on3"), none);
}

std::string two_blocks(const std::string &upper) {
  return "[run]\n[material.rock]\ndensity = 2600.0\nyoungs_modulus = 20e9\npoissons_ratio = 0.2\n"
         "[joint.default]\nnormal_stiffness = 1e8\n[output]\ninterval = 0.02\n" +
         testing::block_toml("floor", testing::rectangle({-2.0, -1.0}, {2.0, 0.0}), "fixed = true") +
         testing::block_toml("upper", testing::rectangle({0.0, 5.0}, {1.0, 6.0}), upper);
}

/// The value of a column in the last row of history/energy.csv.
double last_energy(const fs::path &results, const std::string &column) {
  const std::vector<std::string> rows = testing::lines_of(file_text(results / "history/energy.csv"));
  std::istringstream names(rows.front());
  std::istringstream values(rows.back());
  std::string name;
  std::string value;
  while (std::getline(names, name, ',') && std::getline(values, value, ',') && name != column) {
  }
  return std::stod(value);
}

// A block that falls freely for 0.02 s, fewer steps than between two looks, has moved by g t^2/2, to a few
// terms of the first step; nothing holds its weight.
TEST(StagedRun, TellsHowItStandsBetweenLooks) {
  const WorkFolder folder;
  folder.write("fall.toml", two_blocks("") + "[[stage]]\nkind = \"run\"\nduration = 0.02\n");
  const Outcome outcome = run_gcpdda(0, {"run", "fall.toml"}, folder);
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const fs::path results = folder / "results/fall";
  EXPECT_NEAR(testing::summary_number(results, "moved"), 0.5 * 9.81 * 0.02 * 0.02, 2e-5);
  EXPECT_NEAR(testing::summary_number(results, "unbalanced_ratio"), 1.0, 1e-9);
  EXPECT_NEAR(last_energy(results, "unbalanced_ratio[-]"), 1.0, 1e-9);
}

// Without a block that could move there is nothing to wait for.
TEST(StagedRun, RestsWhereNothingMoves) {
  const WorkFolder folder;
  folder.write("gone.toml", two_blocks("") +
                                "[[stage]]\nkind = \"run\"\nduration = 0.02\n[[stage]]\nkind = "
                                "\"excavate\"\nblocks = [\"upper\"]\n[[stage]]\nkind = "
                                "\"settle\"\nlimit = 1.0\n[[stage]]\nkind = \"run\"\nduration = 0.02\n");
  for (const int ranks : {0, 2}) {
    const Outcome outcome = run_gcpdda(ranks, {"run", "gone.toml", "--overwrite"}, folder);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_NE(outcome.err.find("stage 'stage2' settled"), std::string::npos) << outcome.err;
  }
}

// History and verdict mean the same: fixed points hold, and local damping has no part in the balance.
TEST(StagedRun, HistoryAndVerdictHaveTheSameRatio) {
  const WorkFolder folder;
  for (const std::string fidelity : {"rigid", "deformable"}) {
    const std::string run = "run.fidelity=" + fidelity;
    folder.write("hung.toml", two_blocks("fixed_points = [[0.2, 6.0], [0.8, 6.0]]") +
                                  "[[stage]]\nkind = \"settle\"\nlimit = 4.0\nlocal_damping = 0.8\n");
    const Outcome hung = run_gcpdda(0, {"run", "hung.toml", "--set", run, "--overwrite"}, folder);
    ASSERT_EQ(hung.exit_code, 0) << hung.err;
    const fs::path results = folder / "results/hung";
    EXPECT_EQ(last_energy(results, "unbalanced_ratio[-]"),
              std::stod(testing::json_value(results / "summary.json", "unbalanced_ratio")));
    EXPECT_LE(last_energy(results, "unbalanced_ratio[-]"), 1e-5) << fidelity;
  }
}

// Exit code 7; the state is kept, and a longer limit finds the verdict. Both limits are whole numbers of
// intervals, so that the step is the same.
TEST(StagedRun, WithoutAVerdictEndsWithSeven) {
  const WorkFolder folder;
  folder.write("scene.toml", scene_of_stages(1));
  const Outcome whole = run_gcpdda(0, {"run", "scene.toml", "--out", "whole"}, folder);
  ASSERT_EQ(whole.exit_code, 0) << whole.err;
  EXPECT_EQ(summary_text(folder / "whole", "verdict"), "\"settled\"");
  const Outcome brief =
      run_gcpdda(2, {"run", "scene.toml", "--out", "brief", "--set", "stage.gravity.limit=0.04"}, folder);
  EXPECT_EQ(brief.exit_code, 7) << brief.err;
  EXPECT_EQ(summary_text(folder / "brief", "verdict"), "\"undecided\"");
  EXPECT_EQ(run_gcpdda(0, {"restart", "brief"}, folder).exit_code, 7);
  const Outcome rest = run_gcpdda(3, {"restart", "brief", "--set", "stage.gravity.limit=1.98"}, folder);
  EXPECT_EQ(rest.exit_code, 0) << rest.err;
  EXPECT_EQ(compare_runs(folder / "whole", folder / "brief"), none);
}

// The scene leaves its interval to the limit; a restart keeps it with a longer one, also where it asks for
// other checkpoints.
TEST(StagedRun, KeepsItsIntervalWithALongerLimit) {
  const WorkFolder folder;
  std::string scene = scene_of_stages(1);
  const std::string interval = "interval = 0.02\n";
  scene.erase(scene.find(interval), interval.size());
  folder.write("scene.toml", scene);
  const Outcome brief =
      run_gcpdda(0, {"run", "scene.toml", "--out", "brief", "--set", "stage.gravity.limit=0.047"}, folder);
  ASSERT_EQ(brief.exit_code, 7) << brief.err;
  const Outcome rest = run_gcpdda(
      0, {"restart", "brief", "--set", "stage.gravity.limit=2", "--set", "output.checkpoint_interval=0.1"},
      folder);
  EXPECT_EQ(rest.exit_code, 0) << rest.err;
  EXPECT_EQ(summary_text(folder / "brief", "verdict"), "\"settled\"");
}

/// A block 4 m above the ground, with nothing that holds it.
std::string scene_of_a_fall(double limit) {
  return fmt::format(R"([run]
fidelity = "rigid"
[material.rock]
density = 2600.0
[joint.default]
normal_stiffness = 1e9
[output]
interval = 0.1
checkpoint_interval = 0.3
[[block]]
name = "ground"
material = "rock"
fixed = true
vertices = [[-1, -5], [2, -5], [2, -4], [-1, -4]]
[[block]]
name = "falls"
material = "rock"
vertices = [[0, 0], [1, 0], [1, 1], [0, 1]]
[[stage]]
kind = "settle"
limit = {})",
                     limit);
}

// The static solver finds no rest above the ground. Under local damping of 0.8 the block falls with a fifth
// of g and passes half of its size after 0.71 s: what the static solver has used up does not count.
TEST(StagedRun, DampedMotionHasItsWholeLimit) {
  const WorkFolder folder;
  folder.write("scene.toml", scene_of_a_fall(0.8));
  const Outcome whole = run_gcpdda(0, {"run", "scene.toml", "--out", "whole"}, folder);
  EXPECT_EQ(whole.exit_code, 0) << whole.err;
  EXPECT_EQ(count_of(whole.err, "goes on with solver"), 1) << whole.err;
  EXPECT_EQ(summary_text(folder / "whole", "verdict"), "\"failed\"");
}

TEST(StagedRun, EndsWhereItWouldAfterARestartBehindTheStaticSolver) {
  const WorkFolder folder;
  folder.write("scene.toml", scene_of_a_fall(0.4));
  for (const std::string name : {"whole", "part"}) {
    const Outcome outcome = run_gcpdda(0, {"run", "scene.toml", "--out", name}, folder);
    ASSERT_EQ(outcome.exit_code, 7) << outcome.err;
  }
  ASSERT_GT(checkpoints(folder / "part").size(), 1U);
  fs::remove(checkpoints(folder / "part").back());
  const Outcome rest = run_gcpdda(2, {"restart", "part"}, folder);
  EXPECT_EQ(rest.exit_code, 7) << rest.err;
  EXPECT_EQ(compare_runs(folder / "whole", folder / "part"), none);
}

} // namespace
} // namespace gcpdda::stages_test
