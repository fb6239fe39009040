// Runs that are stopped, killed or run out of disk go on to the same files.

#include "io/results/run_comparison.hpp"

#include "checkpoints.hpp"
#include "child_process.hpp"
#include "sample_scenes.hpp"
#include "support/run_facts.hpp"
#include "support/scenes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <fmt/format.h>
#include <fstream>
#include <functional>
#include <random>
#include <thread>

namespace gcpdda::resumed_wall_test {
namespace {

namespace fs = std::filesystem;
using restart_test::checkpoints;
using testing::count_of;
using testing::file_text;
using testing::gcpdda_words;
using testing::listing;
using testing::Outcome;
using testing::Process;
using testing::run_gcpdda;
using testing::summary_number;
using testing::summary_text;
using testing::WorkFolder;

const std::vector<std::string> none;

/// Rigid, deformable, non-convex and driven blocks with friction. One run that nobody stops and that writes
/// no checkpoints, to compare with; and runs of the same scene that go through one or more of them.
class RestartOfAWall : public ::testing::Test {
protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<WorkFolder>();
    folder_->write("wall.toml", testing::mixed_wall_toml(24, 14, 0.04));
    outcome_ =
        run_gcpdda(1, {"run", "wall.toml", "--out", "whole", "--set", "output.interval=0.01"}, *folder_);
  }
  static void TearDownTestSuite() { folder_.reset(); }
  void SetUp() override { ASSERT_EQ(outcome_.exit_code, 0) << outcome_.err; }

  static fs::path whole() { return *folder_ / "whole"; }
  static std::vector<std::string> run_to(const std::string &out, const std::string &interval) {
    return {"run",   "wall.toml",
            "--out", out,
            "--set", "output.interval=0.01",
            "--set", "output.checkpoint_interval=" + interval};
  }
  static void expect_crossing(const fs::path &run) {
    EXPECT_GE(summary_number(run, "cross_rank_contacts"), 50);
    EXPECT_GE(summary_number(run, "migrations"), 1);
    EXPECT_GE(summary_number(run, "refreshes"), 1);
  }

  static std::unique_ptr<WorkFolder> folder_;
  static Outcome outcome_;
};

std::unique_ptr<WorkFolder> RestartOfAWall::folder_;
Outcome RestartOfAWall::outcome_;

class RestartOnOtherRanks : public RestartOfAWall,
                            public ::testing::WithParamInterface<std::pair<int, int>> {};

INSTANTIATE_TEST_SUITE_P(Regression, RestartOnOtherRanks,
                         ::testing::Values(std::pair(1, 3), std::pair(2, 1), std::pair(4, 7)),
                         [](const auto &ranks) {
                           return fmt::format("From{}To{}", ranks.param.first, ranks.param.second);
                         });

// The run reaches its end, then is put back to its middle: what was written later is in the way.
TEST_P(RestartOnOtherRanks, GivesTheSameFiles) {
  const auto [before, after] = GetParam();
  const std::string name = fmt::format("from{}to{}", before, after);
  const fs::path run = *folder_ / name;
  const Outcome first = run_gcpdda(before, run_to(name, "0.02"), *folder_);
  ASSERT_EQ(first.exit_code, 0) << first.err;
  EXPECT_EQ(compare_runs(whole(), run), none) << "writing checkpoints changed the run";
  if (before > 1) {
    expect_crossing(run);
  }
  const std::vector<fs::path> files = checkpoints(run);
  ASSERT_EQ(files.size(), 2U) << "one in the middle, one at the end";
  const std::string last = file_text(files[1]);
  fs::remove(files[1]);
  std::ofstream(run / "history/energy.csv", std::ios::app) << "0.0401,3,4"; // killed in a row
  std::ofstream(run / "frames/frame_000007.hdf") << "later";

  const Outcome second = run_gcpdda(after, {"restart", name}, *folder_);
  ASSERT_EQ(second.exit_code, 0) << second.err;
  EXPECT_EQ(count_of(second.err, "restart from " + name + "/checkpoints/"), 1) << second.err;
  EXPECT_EQ(compare_runs(whole(), run), none);
  EXPECT_EQ(file_text(files[1]) == last, true) << "checkpoints of " << before << " and " << after << " ranks";
  EXPECT_EQ(summary_number(run, "ranks"), after);
  for (const char *fact : {"blocks", "steps", "time", "contacts", "contact_steps", "max_overlap", "energy"}) {
    EXPECT_EQ(summary_text(run, fact), summary_text(whole(), fact)) << fact;
  }
  if (after > 1) {
    expect_crossing(run);
  }
}

// To mpirun, which passes it on; then to one rank alone, which takes the others along.
TEST_F(RestartOfAWall, ASignalStopsAllRanksWithACheckpoint) {
  Process both(gcpdda_words(2, run_to("signal", "0")), folder_->path());
  both.wait_until([] { return fs::exists(*folder_ / "signal/frames/frame_000000.hdf"); });
  kill(both.id(), SIGUSR1);
  const Outcome stopped = both.wait();
  EXPECT_EQ(stopped.exit_code, 6) << stopped.err;
  EXPECT_EQ(count_of(stopped.err, "stopped by a signal at t = "), 1) << stopped.err;
  EXPECT_EQ(summary_text(*folder_ / "signal", "verdict"), "\"stopped\"");
  EXPECT_EQ(checkpoints(*folder_ / "signal").size(), 1U);

  Process three(gcpdda_words(3, {"restart", "signal"}), folder_->path());
  three.wait_until([] { return count_of(file_text(*folder_ / "signal/run.log"), "restart from") == 1; });
  const std::vector<pid_t> ranks = three.children();
  ASSERT_EQ(ranks.size(), 3U);
  kill(ranks[1], SIGUSR1);
  EXPECT_EQ(three.wait().exit_code, 6);

  const Outcome rest = run_gcpdda(2, {"restart", "signal"}, *folder_);
  EXPECT_EQ(rest.exit_code, 0) << rest.err;
  EXPECT_EQ(compare_runs(whole(), *folder_ / "signal"), none);
}

// One rank, then all and mpirun, each at a random moment after the first checkpoint.
TEST_F(RestartOfAWall, KilledAtRandomMomentsGoesOn) {
  std::random_device random;
  std::vector<std::string> words = run_to("killed", "0.0012");
  const int num_ranks[] = {3, 2};
  for (int kills = 0; kills < 2; ++kills) {
    Process process(gcpdda_words(num_ranks[kills], words), folder_->path());
    const std::string log = kills == 0 ? "" : file_text(*folder_ / "killed/run.log");
    process.wait_until([&] {
      return fs::exists(*folder_ / "killed/run.log") &&
             count_of(file_text(*folder_ / "killed/run.log"), "checkpoint at t") >
                 count_of(log, "checkpoint at t");
    });
    std::this_thread::sleep_for(std::chrono::milliseconds(random() % 150));
    const std::vector<pid_t> ranks = process.children();
    ASSERT_EQ(ranks.size(), static_cast<std::size_t>(num_ranks[kills]))
        << "the run ended before it was killed";
    if (kills == 0) {
      kill(ranks[random() % ranks.size()], SIGKILL);
    } else {
      kill(process.id(), SIGKILL);
      for (const pid_t rank : ranks) {
        kill(rank, SIGKILL);
      }
    }
    EXPECT_NE(process.wait().exit_code, 0);
    testing::wait_until([&] {
      return std::all_of(ranks.begin(), ranks.end(), [](pid_t rank) { return kill(rank, 0) != 0; });
    });
    EXPECT_GE(checkpoints(*folder_ / "killed").size(), 1U);
    words = {"restart", "killed"};
  }
  const Outcome rest = run_gcpdda(2, words, *folder_);
  EXPECT_EQ(rest.exit_code, 0) << rest.err;
  for (const std::string &name : listing(*folder_ / "killed/frames")) {
    if (name.ends_with(".tmp")) {
      fs::remove(*folder_ / "killed/frames" / name);
    }
  }
  EXPECT_EQ(compare_runs(whole(), *folder_ / "killed"), none);
}

// No file may grow larger than this: what a full disk is to a checkpoint, the largest file of the run.
TEST_F(RestartOfAWall, AFullDiskLeavesTheLastCheckpoint) {
  const Outcome first = run_gcpdda(1, run_to("full", "0.03"), *folder_);
  ASSERT_EQ(first.exit_code, 0) << first.err;
  const std::vector<fs::path> files = checkpoints(*folder_ / "full");
  ASSERT_EQ(files.size(), 2U);
  const std::uintmax_t needed = fs::file_size(files[1]);
  fs::remove(files[1]);
  const std::string good = file_text(files[0]);
  std::uintmax_t largest_frame = 0;
  for (const fs::directory_entry &entry : fs::directory_iterator(*folder_ / "full/frames")) {
    largest_frame = std::max(largest_frame, entry.file_size());
  }
  ASSERT_LT(largest_frame, needed - 65536);
  // Where it ends is among rows, or in what HDF5 writes for itself.
  for (const auto &[ranks, missing] : {std::pair("1", 4U), {"2", 4U}, {"2", 7U}, {"2", 12U}, {"2", 40U}}) {
    // The ranks alone have the limit, and no shared memory, which would be under it.
    const std::string limited =
        fmt::format("trap '' XFSZ; ulimit -f {}; exec \"$0\" \"$@\"", needed / 1024 - missing);
    const std::vector<std::string> words{
        GCPDDA_MPIEXEC, "-n",   ranks, "--oversubscribe", "--bind-to",       "none",    "--mca", "btl",
        "tcp,self",     "bash", "-c",  limited,           GCPDDA_EXECUTABLE, "restart", "full"};
    const Outcome full = testing::run_program(words, folder_->path());
    EXPECT_EQ(full.exit_code, 4) << full.err;
    EXPECT_GE(count_of(full.err, files[1].filename().string()), 1) << full.err;
    EXPECT_EQ(checkpoints(*folder_ / "full"), std::vector{files[0]}) << "what failed is gone";
    EXPECT_EQ(file_text(files[0]) == good, true) << "the last good one is harmed";
  }
  const Outcome rest = run_gcpdda(2, {"restart", "full"}, *folder_);
  EXPECT_EQ(rest.exit_code, 0) << rest.err;
  EXPECT_EQ(compare_runs(whole(), *folder_ / "full"), none);
}

} // namespace
} // namespace gcpdda::resumed_wall_test
