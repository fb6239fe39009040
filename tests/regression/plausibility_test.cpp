// What a user is told of implausible scenes.

#include "child_process.hpp"
#include "sample_scenes.hpp"
#include "support/run_facts.hpp"
#include "support/scenes.hpp"

#include <gtest/gtest.h>

#include <fmt/format.h>
#include <sstream>

namespace gcpdda::plausibility_test {
namespace {

namespace fs = std::filesystem;
using testing::count_of;
using testing::file_text;
using testing::Outcome;
using testing::run_gcpdda;
using testing::WorkFolder;

std::vector<std::string> lines_with(const std::string &text, const std::string &word) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) {
    if (line.find(word) != std::string::npos) {
      lines.push_back(line);
    }
  }
  return lines;
}

const std::vector<std::string> wrong_units{
    "--set", "joint.default.cohesion=100", "--set", "joint.default.friction_angle_deg=0.61",
    "--set", "output.interval=5",          "--set", "output.history_interval=0.1"};

// One block at the start of run and log, the same on any number of ranks, and the run goes on to its end.
TEST(Plausibility, IsDoubtedAtTheStartOfARun) {
  const WorkFolder folder;
  folder.write("scene.toml", testing::small_scene());
  std::vector<std::vector<std::string>> told;
  for (const int ranks : {0, 3}) {
    std::vector<std::string> words{"run", "scene.toml", "--out", fmt::format("out{}", ranks)};
    words.insert(words.end(), wrong_units.begin(), wrong_units.end());
    const Outcome outcome = run_gcpdda(ranks, words, folder);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    const std::string log = file_text(folder / fmt::format("out{}/run.log", ranks));
    told.push_back(lines_with(outcome.err, "warning: "));
    EXPECT_EQ(told.back(), lines_with(log, "warning: "));
    ASSERT_EQ(told.back().size(), 3U) << outcome.err;
    const std::size_t first = log.find(told.back()[0]);
    EXPECT_EQ(first, 0U) << log;
    EXPECT_EQ(log.find(told.back()[2]), told.back()[0].size() + told.back()[1].size() + 2) << log;
  }
  EXPECT_EQ(told[0], told[1]);
  EXPECT_EQ(told[0][0].find("--set joint.default.cohesion=100: warning: joint.default.cohesion is 100 Pa"),
            0U);
}

TEST(Plausibility, IsDoubtedByInspect) {
  const WorkFolder folder;
  folder.write("scene.toml", testing::small_scene());
  std::vector<std::string> words{"inspect", "scene.toml"};
  EXPECT_EQ(count_of(run_gcpdda(0, words, folder).out, "warning: "), 0);
  words.insert(words.end(), wrong_units.begin(), wrong_units.end());
  const Outcome outcome = run_gcpdda(0, words, folder);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(count_of(outcome.out, "warning: "), 3) << outcome.out;
}

TEST(PlausibleValuesPage, IsTheOneThatShips) {
  const Outcome outcome = run_gcpdda(0, {"reference", "--values"}, WorkFolder());
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(outcome.out, file_text(fs::path(GCPDDA_SOURCE_DIR) / "run/guide/plausible_values.md"))
      << "run 'gcpdda reference --values > run/guide/plausible_values.md'";
}

TEST(MisspeltLaw, OfASetIsSuggested) {
  const WorkFolder folder;
  folder.write("scene.toml", testing::small_scene());
  const Outcome outcome = run_gcpdda(0, {"run", "scene.toml", "--set", "joint.defualt.cohesion=0"}, folder);
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_EQ(count_of(outcome.err, "for edges that name it, did you mean 'default'?"), 1) << outcome.err;
}

// Ten of a kind and one line for the others; other faults are all told.
TEST(ManyFaults, OfOneKindAreCounted) {
  std::string scene = testing::head_scene(1e8, 1e-3, 0.1);
  for (int k = 0; k < 300; ++k) {
    scene +=
        fmt::format("[[block]]\nname = \"n{}\"\nmaterial = \"rok\"\nvertices = [[0,0],[1,0],[1,1]]\n", k);
  }
  const WorkFolder folder;
  folder.write("scene.toml",
               scene + "[[block]]\nmaterial = \"rock\"\nvertices = [[0,0],[1,1],[1,0],[0,1]]\n");
  const Outcome outcome = run_gcpdda(0, {"run", "scene.toml"}, folder);
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_EQ(count_of(outcome.err, "no material is named 'rok'"), 11) << outcome.err;
  EXPECT_EQ(
      count_of(outcome.err, "error: 290 more like these 10, the last of them: no material is named 'rok'"), 1)
      << outcome.err;
  EXPECT_EQ(count_of(outcome.err, "crosses itself"), 1) << outcome.err;
}

} // namespace
} // namespace gcpdda::plausibility_test
