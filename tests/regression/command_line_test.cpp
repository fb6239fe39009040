// What the command line promises: exit codes, one voice however many ranks, nothing touched on trouble.

#include "child_process.hpp"
#include "sample_scenes.hpp"
#include "support/run_facts.hpp"
#include "support/scenes.hpp"

#include <gtest/gtest.h>

namespace gcpdda::command_line_test {
namespace {

namespace fs = std::filesystem;
using testing::count_of;
using testing::file_text;
using testing::listing;
using testing::Outcome;
using testing::run_gcpdda;
using testing::run_program;
using testing::summary_number;
using testing::summary_text;
using testing::WorkFolder;

/// Plain start (0) or under mpirun with that many ranks.
class CommandLine : public ::testing::TestWithParam<int> {
protected:
  /// The files stay as they were, and what is said is said once.
  void expect_refusal(const std::vector<std::string> &arguments, int exit_code, const std::string &said) {
    const std::vector<std::string> before = listing(folder_.path());
    const Outcome outcome = run_gcpdda(GetParam(), arguments, folder_);
    EXPECT_EQ(outcome.exit_code, exit_code) << outcome.err;
    EXPECT_EQ(count_of(outcome.err, said), 1) << "expected once: " << said << "\nin: " << outcome.err;
    EXPECT_EQ(listing(folder_.path()), before) << "something was created";
  }

  WorkFolder folder_;
};

INSTANTIATE_TEST_SUITE_P(Regression, CommandLine, ::testing::Values(0, 3), [](const auto &ranks) {
  return ranks.param == 0 ? std::string("plain") : "ranks" + std::to_string(ranks.param);
});

TEST_P(CommandLine, UsageErrorsAreTwo) {
  folder_.write("scene.toml", testing::small_scene());
  expect_refusal({}, 2, "subcommand is required");
  expect_refusal({"walk", "scene.toml"}, 2, "subcommand is required");
  expect_refusal({"run"}, 2, "SCENE is required");
  expect_refusal({"run", "scene.toml", "--bogus"}, 2, "--bogus");
  expect_refusal({"run", "scene.toml", "second.toml"}, 2, "second.toml");
  expect_refusal({"run", "scene.toml", "--set"}, 2, "--set");
  expect_refusal({"run", "scene.toml", "--out"}, 2, "--out");
}

TEST_P(CommandLine, HelpIsNoError) {
  const Outcome outcome = run_gcpdda(GetParam(), {"--help"}, folder_);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(count_of(outcome.out, "Usage:"), 1) << outcome.out;
  const Outcome of_run = run_gcpdda(GetParam(), {"run", "--help"}, folder_);
  EXPECT_EQ(of_run.exit_code, 0) << of_run.err;
  for (const char *option : {"SCENE", "--out", "--set", "--overwrite"}) {
    EXPECT_NE(of_run.out.find(option), std::string::npos) << option;
  }
}

TEST_P(CommandLine, VersionNamesTheLibrariesAndIsThatOfResults) {
  const Outcome outcome = run_gcpdda(GetParam(), {"--version"}, folder_);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  for (const char *name : {"gcpdda ", "MPI v", "\nHDF5 1.", "\nMETIS 5.", "\nGEOS 3.", "\nEigen 3."}) {
    EXPECT_EQ(count_of(outcome.out, name), 1) << name << " in: " << outcome.out;
  }
  folder_.write("two words.toml", testing::small_scene());
  ASSERT_EQ(run_gcpdda(GetParam(), {"run", "two words.toml", "--out", "kept"}, folder_).exit_code, 0);
  const std::string version = summary_text(folder_ / "kept", "version");
  EXPECT_TRUE(outcome.out.starts_with("gcpdda " + version.substr(1, version.size() - 2) + '\n'))
      << version << " and " << outcome.out;
  EXPECT_TRUE(summary_text(folder_ / "kept", "command").ends_with("gcpdda run 'two words.toml' --out kept\""))
      << summary_text(folder_ / "kept", "command");
}

TEST_P(CommandLine, AMissingSceneIsFour) {
  fs::create_directory(folder_ / "folder.toml");
  expect_refusal({"run", "nowhere.toml"}, 4, "nowhere.toml");
  expect_refusal({"run", "folder.toml"}, 4, "folder.toml");
}

TEST_P(CommandLine, AnUnusableResultFolderIsFour) {
  folder_.write("scene.toml", testing::small_scene());
  folder_.write("file", "not a folder");
  expect_refusal({"run", "scene.toml", "--out", "file"}, 4, "file");
  expect_refusal({"run", "scene.toml", "--out", "file/below"}, 4, "file/below");
  // Its own folder holds the input under the name of an output.
  expect_refusal({"run", "scene.toml", "--out", "."}, 4, "scene.toml");
  EXPECT_EQ(file_text(folder_ / "scene.toml"), testing::small_scene());
}

TEST_P(CommandLine, ACompletedRunIsZeroAndLandsInResultsStem) {
  folder_.write("slope.v2.toml", testing::small_scene());
  const Outcome outcome = run_gcpdda(GetParam(), {"run", "slope.v2.toml"}, folder_);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(outcome.out, "") << "standard output belongs to the user";
  EXPECT_EQ(count_of(outcome.err, "completed: reached t = 0.1 s"), 1) << outcome.err;
  const fs::path results = folder_ / "results/slope.v2";
  EXPECT_EQ(summary_text(results, "verdict"), "\"completed\"");
  EXPECT_EQ(summary_number(results, "ranks"), std::max(1, GetParam()));
  EXPECT_EQ(file_text(results / "run.log"), outcome.err) << "the log holds what was said";
}

TEST_P(CommandLine, AFolderThatHoldsARunIsKept) {
  folder_.write("scene.toml", testing::small_scene());
  ASSERT_EQ(run_gcpdda(0, {"run", "scene.toml", "--out", "kept"}, folder_).exit_code, 0);
  const std::string summary = file_text(folder_ / "kept/summary.json");
  expect_refusal({"run", "scene.toml", "--out", "kept", "--set", "run.duration=0.2"}, 4, "--overwrite");
  EXPECT_EQ(file_text(folder_ / "kept/summary.json"), summary);
}

TEST_P(CommandLine, OverwriteRemovesItsOwnFilesOnly) {
  folder_.write("scene.toml", testing::small_scene());
  ASSERT_EQ(run_gcpdda(0, {"run", "scene.toml", "--out", "kept"}, folder_).exit_code, 0);
  const std::vector<std::string> foreign{"kept/notes.txt", "kept/frames/picture.png", "kept/history/mine.csv",
                                         "kept/decomposition/map.txt", "kept/frames/frame_x.hdf"};
  for (const std::string &name : foreign) {
    folder_.write(name, "precious " + name);
  }
  const Outcome outcome = run_gcpdda(
      GetParam(), {"run", "scene.toml", "--out", "kept", "--overwrite", "--set", "output.interval=0.05"},
      folder_);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  for (const std::string &name : foreign) {
    EXPECT_EQ(file_text(folder_ / name), "precious " + name);
  }
  EXPECT_TRUE(fs::exists(folder_ / "kept/frames/frame_000002.hdf"));
  EXPECT_FALSE(fs::exists(folder_ / "kept/frames/frame_000003.hdf")) << "a frame of the old run is left";
}

// Deep in, at t > 0; the scene itself is sound.
TEST_P(CommandLine, ANumericalFailureIsFive) {
  folder_.write("soft.toml", testing::head_scene(1e5, 1e-3, 0.4) +
                                 testing::block_toml("hammer", testing::rectangle({0.0, 0.5}, {1.0, 1.5}),
                                                     "velocity = [0, -8, 0]"));
  const Outcome outcome = run_gcpdda(GetParam(), {"run", "soft.toml", "--out", "out"}, folder_);
  EXPECT_EQ(outcome.exit_code, 5) << outcome.err;
  EXPECT_EQ(count_of(outcome.err, "error: failed: block 'floor' at t = "), 1) << outcome.err;
  EXPECT_NE(outcome.err.find("'hammer'"), std::string::npos) << outcome.err;
  EXPECT_EQ(summary_text(folder_ / "out", "verdict"), "\"failed\"");
}

// Without mpirun, but a launcher says there are more: as N separate copies they would spoil each other's
// files.
TEST(SerialCopies, AreRefused) {
  const WorkFolder folder;
  folder.write("scene.toml", testing::small_scene());
  for (const char *variable : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "SLURM_STEP_NUM_TASKS"}) {
    const std::vector<std::string> words{GCPDDA_EXECUTABLE, "run", "scene.toml"};
    const Outcome two = run_program(words, folder.path(), {std::string(variable) + "=2"});
    EXPECT_EQ(two.exit_code, 2) << variable << two.err;
    EXPECT_EQ(count_of(two.err, "mpirun"), 1) << variable << two.err;
    EXPECT_EQ(listing(folder.path()), std::vector<std::string>{"scene.toml"});
    const Outcome one = run_program(words, folder.path(), {std::string(variable) + "=1"});
    EXPECT_EQ(one.exit_code, 0) << variable << one.err;
    fs::remove_all(folder / "results");
  }
}

// A reservation of many tasks in which one was started is no fault.
TEST(SerialCopies, AreNotSeenInAnAllocation) {
  const WorkFolder folder;
  folder.write("scene.toml", testing::small_scene());
  EXPECT_EQ(
      run_program({GCPDDA_EXECUTABLE, "run", "scene.toml"}, folder.path(), {"SLURM_NTASKS=8"}).exit_code, 0);
}

} // namespace
} // namespace gcpdda::command_line_test
