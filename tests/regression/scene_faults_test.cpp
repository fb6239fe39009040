// How a bad scene is refused, and what --set does, as a person sees it.

#include "child_process.hpp"
#include "sample_scenes.hpp"
#include "support/run_facts.hpp"
#include "support/scenes.hpp"

#include <gtest/gtest.h>

namespace gcpdda::scene_faults_test {
namespace {

namespace fs = std::filesystem;
using testing::count_of;
using testing::file_text;
using testing::head_scene;
using testing::listing;
using testing::Outcome;
using testing::rectangle;
using testing::run_gcpdda;
using testing::summary_number;
using testing::WorkFolder;

/// Plain start (0) or under mpirun with that many ranks.
class SceneFaults : public ::testing::TestWithParam<int> {
protected:
  /// Exit code 3, each of these once and no other error, nothing created.
  void expect_faults(const std::vector<std::string> &faults, const std::vector<std::string> &arguments = {}) {
    const std::vector<std::string> before = listing(folder_.path());
    std::vector<std::string> words{"run", "scene.toml"};
    words.insert(words.end(), arguments.begin(), arguments.end());
    const Outcome outcome = run_gcpdda(GetParam(), words, folder_);
    EXPECT_EQ(outcome.exit_code, 3) << outcome.err;
    for (const std::string &fault : faults) {
      EXPECT_EQ(count_of(outcome.err, fault), 1) << "expected once: " << fault << "\nin: " << outcome.err;
    }
    EXPECT_EQ(count_of(outcome.err, ": error: "), static_cast<int>(faults.size())) << outcome.err;
    EXPECT_EQ(outcome.out, "");
    EXPECT_EQ(listing(folder_.path()), before) << "something was created";
  }

  WorkFolder folder_;
};

INSTANTIATE_TEST_SUITE_P(Regression, SceneFaults, ::testing::Values(0, 3), [](const auto &ranks) {
  return ranks.param == 0 ? std::string("plain") : "ranks" + std::to_string(ranks.param);
});

TEST_P(SceneFaults, AreAllListedWithTheirPlaces) {
  folder_.write("scene.toml", R"([run]
duration = -1.0
time_stp = 1e-3
[material.rock]
density = "heavy"
[joint.default]
normal_stiffness = 1e8
[[block]]
name = "a"
material = "rok"
vertices = [[0,0],[1,1],[1,0],[0,1]]
)");
  expect_faults({"scene.toml:2:12: error: 'duration'", "scene.toml:3:1: error: unknown key 'time_stp'",
                 "scene.toml:5:11: error: 'density'", "scene.toml:10:12: error: no material is named 'rok'",
                 "scene.toml:11:12: error: block 'a' crosses itself"});
  const Outcome outcome = run_gcpdda(GetParam(), {"run", "scene.toml"}, folder_);
  EXPECT_NE(outcome.err.find("did you mean 'time_step'?"), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.err.find("did you mean 'rock'?"), std::string::npos) << outcome.err;
}

TEST_P(SceneFaults, OfSyntaxHaveAPlaceToo) {
  folder_.write("scene.toml", "[run]\nduration = = 2\n");
  expect_faults({"scene.toml:2:12: error: not valid TOML"});
}

TEST_P(SceneFaults, OfSetNameTheArgument) {
  folder_.write("scene.toml", testing::small_scene());
  expect_faults({"--set run.durration=1: error: unknown key 'durration' in [run], did you mean 'duration'?"},
                {"--set", "run.durration=1"});
  expect_faults({"--set block.slyder.fixed=true: error: no block is named 'slyder', did you mean 'slider'?",
                 "--set run.scheme=leapfrog: error: 'scheme'"},
                {"--set", "run.scheme=leapfrog", "--set", "block.slyder.fixed=true"});
  expect_faults({"--set nonsense: error: not of the form path=value"}, {"--set", "nonsense"});
}

// No whole number of steps: found when the step is planned, after the scene was read.
TEST_P(SceneFaults, OfTimesWithoutACommonStep) {
  folder_.write("scene.toml", testing::small_scene());
  expect_faults({"scene.toml: error: run.duration = 0.1 s and output.interval"},
                {"--set", "output.interval=0.031415926", "--set", "output.history_interval=0.031415926"});
}

TEST_P(SceneFaults, OfDeepInitialOverlapsNameBothBlocks) {
  // 5 % of the narrower width, 1 m: 0.06 m is too deep, 0.04 m is not; two of the three pairs are named.
  folder_.write("scene.toml", head_scene(1e8, 1e-3, 0.1) +
                                  testing::block_toml("a", rectangle({0.0, -0.06}, {1.0, 1.0})) +
                                  testing::block_toml("b", rectangle({2.0, -0.04}, {4.0, 1.0})) +
                                  testing::block_toml("c", rectangle({3.8, 0.0}, {8.0, 1.0})));
  expect_faults({"error: blocks 'floor' and 'a' overlap by 0.06 m", "error: blocks 'b' and 'c' overlap by "});
}

TEST_P(SceneFaults, OfASceneThatNoMemoryHoldsComeBeforeTheWork) {
  folder_.write("scene.toml", head_scene(1e8, 1e-3, 0.1) +
                                  "[[wall]]\nmaterial = \"rock\"\norigin = [0, 0]\nrows = 1000000\ncolumns = "
                                  "2000\nblock_size = [1.0, 1.0]\nbond = 0\n");
  expect_faults({"scene.toml: error: about 2e+09 blocks need at least "});
}

// Where outlines coincide, the depth of the overlap vanishes: the area tells.
TEST_P(SceneFaults, OfABlockThatIsThereTwice) {
  const std::vector<Vec2> notched{{0.0, 0.0}, {2.0, 0.0}, {2.0, 1.0}, {1.0, 1.0}, {1.0, 2.0}, {0.0, 2.0}};
  std::string toml = head_scene(1e8, 1e-3, 0.01);
  const auto add_twins = [&](const std::string &name, const std::vector<Vec2> &outline, double x, Vec2 by,
                             const std::string &extra) {
    toml += testing::block_toml(name, testing::placed(outline, 0.0, {x, 0.0}), extra);
    toml += testing::block_toml(name + "2", testing::placed(outline, 0.0, Vec2{x, 0.0} + by), extra);
  };
  const std::vector<Vec2> square = rectangle({0.0, 0.0}, {1.0, 1.0});
  add_twins("exact", square, -18.0, {}, "");
  add_twins("micron", square, -15.0, {1e-6, 0.0}, "");
  add_twins("millimetre", square, -12.0, {1e-3, 0.0}, "");
  add_twins("notched", notched, -9.0, {0.0, 1e-3}, "");
  add_twins("support", square, -6.0, {1e-3, 1e-3}, "fixed = true");
  add_twins("driven", square, -3.0, {0.0, 0.0}, "prescribed_velocity = [0.1, 0.0, 0.0]");
  toml += testing::block_toml("host", rectangle({0.0, 0.0}, {1.0, 1.0}));
  toml += testing::block_toml("guest", rectangle({0.0, 0.0}, {1.0, 0.6}));
  toml += testing::block_toml("core", rectangle({6.2, 0.2}, {6.8, 0.8}));
  toml += testing::block_toml("brick", rectangle({3.0, 0.0}, {4.0, 1.0}));
  toml += "[[wall]]\nname = \"left\"\nmaterial = \"rock\"\norigin = [3.0, 0.0]\nrows = 1\ncolumns = "
          "4\nblock_size = [1.0, 1.0]\n";
  toml += "[[wall]]\nname = \"right\"\nmaterial = \"rock\"\norigin = [4.0, 0.0]\nrows = 1\ncolumns = "
          "2\nblock_size = [1.0, 1.0]\n";
  folder_.write("scene.toml", toml);
  expect_faults({"blocks 'exact' and 'exact2' lie at the same place, 100 % of the larger one's area",
                 "blocks 'micron' and 'micron2' lie at the same place",
                 "blocks 'millimetre' and 'millimetre2' lie at the same place, 99.9 % of the larger",
                 "blocks 'notched' and 'notched2' lie at the same place",
                 "blocks 'support' and 'support2' lie at the same place",
                 "blocks 'driven' and 'driven2' lie at the same place",
                 "blocks 'host' and 'guest' overlap by 0.6 m2, that is 100 % of the smaller one's area",
                 "blocks 'core' and 'left.0.3' overlap by 0.36 m2",
                 "blocks 'brick' and 'left.0.0' lie at the same place",
                 "blocks 'left.0.1' and 'right.0.0' lie at the same place",
                 "blocks 'left.0.2' and 'right.0.1' lie at the same place"});
}

// Supports that share an edge or a good part of their area, and blocks at rest on them, are no slips.
TEST(InitialOverlap, OfSupportsAndOfBlocksAtRestIsNoFault) {
  const WorkFolder folder;
  const std::string fixed = "fixed = true";
  folder.write("scene.toml",
               head_scene(1e8, 1e-3, 0.01) + testing::block_toml("wall", rectangle({-9, 0}, {-5, 4}), fixed) +
                   testing::block_toml("next", rectangle({-5, 0}, {-4, 4}), fixed) +
                   testing::block_toml("within", rectangle({-9, 0}, {-7, 4}), fixed) +
                   testing::block_toml("across", rectangle({-9.5, 1}, {-4.2, 4}), fixed) +
                   testing::block_toml(
                       "tray", {{0, 0}, {3, 0}, {3, 1}, {2, 1}, {2, 0.5}, {1, 0.5}, {1, 1}, {0, 1}}, fixed) +
                   testing::block_toml("lying", rectangle({0.99, 0.49}, {2.01, 1.5})));
  const Outcome outcome = run_gcpdda(0, {"inspect", "scene.toml"}, folder);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(count_of(outcome.err, "error"), 0) << outcome.err;
}

TEST(InitialOverlap, ThatIsThinIsAContact) {
  const WorkFolder folder;
  folder.write("scene.toml", head_scene(1e8, 1e-3, 0.01) +
                                 testing::block_toml("a", rectangle({0.0, -0.01}, {1.0, 1.0})) +
                                 testing::block_toml("b", rectangle({2.0, -0.02}, {3.0, 1.0})));
  const Outcome outcome = run_gcpdda(0, {"run", "scene.toml"}, folder);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(
      count_of(outcome.err, "info: the deepest initial overlap is 0.02 m between blocks 'floor' and 'b'"), 1)
      << outcome.err;
}

TEST(InitialOverlap, OfTwoFixedBlocksIsNoFault) {
  const WorkFolder folder;
  folder.write("scene.toml",
               head_scene(1e8, 1e-3, 0.01) +
                   testing::block_toml("wall", rectangle({-20.0, -2.0}, {-10.0, 5.0}), "fixed = true") +
                   testing::block_toml("a", rectangle({0.0, 0.0}, {1.0, 1.0})));
  EXPECT_EQ(run_gcpdda(0, {"run", "scene.toml"}, folder).exit_code, 0);
}

/// Run the small scene with these arguments of --set; it must complete.
fs::path run_with(const WorkFolder &folder, const std::vector<std::string> &sets) {
  folder.write("scene.toml", testing::small_scene());
  std::vector<std::string> words{"run", "scene.toml", "--out", "out"};
  for (const std::string &set : sets) {
    words.insert(words.end(), {"--set", set});
  }
  const Outcome outcome = run_gcpdda(0, words, folder);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  return folder / "out";
}

TEST(Set, TakesNumbersAndTheLastOneCounts) {
  const WorkFolder folder;
  const fs::path out = run_with(folder, {"run.time_step=1e-3", "run.time_step=5e-4", "run.duration=0.05"});
  EXPECT_EQ(summary_number(out, "time"), 0.05);
  EXPECT_EQ(summary_number(out, "time_step"), 5e-4);
  EXPECT_EQ(summary_number(out, "steps"), 100);
}

TEST(Set, TakesABareWordAsAString) {
  const WorkFolder folder;
  const fs::path out = run_with(folder, {"run.scheme=central-difference", "run.time_step=auto"});
  const std::string resolved = file_text(out / "scene.toml");
  EXPECT_NE(resolved.find("central-difference"), std::string::npos) << resolved;
  EXPECT_NE(resolved.find("auto"), std::string::npos) << resolved;
  EXPECT_NE(summary_number(out, "steps"), 100) << "the step is still the scene's";
}

TEST(Set, FindsABlockByItsName) {
  const WorkFolder folder;
  const fs::path out = run_with(folder, {"block.tower.fixed=true", "block.slider.velocity=[0.5, 0, 0]"});
  EXPECT_EQ(summary_number(out, "fixed_blocks"), 2);
  EXPECT_EQ(summary_number(out, "blocks"), 1);
  const auto first_row = testing::lines_of(file_text(out / "history/energy.csv")).at(1);
  EXPECT_EQ(first_row.substr(0, 6), "0,325,") << "1 m2 of 2600 kg/m3 at 0.5 m/s: " << first_row;
}

// What was run can be run again.
TEST(Set, StandsInTheResolvedScene) {
  const WorkFolder folder;
  const fs::path out = run_with(folder, {"run.gravity=[0, -5]", "block.slider.velocity=[2, 0, 0]"});
  const Outcome again = run_gcpdda(0, {"run", "out/scene.toml", "--out", "again"}, folder);
  EXPECT_EQ(again.exit_code, 0) << again.err;
  for (const char *history : {"history/energy.csv", "history/slider.csv"}) {
    EXPECT_EQ(file_text(folder / "again" / history), file_text(out / history)) << history;
  }
}

} // namespace
} // namespace gcpdda::scene_faults_test
