// gcpdda restart: the same files as a run that was never stopped, whatever stopped it and on any number of
// ranks; a clear refusal where that cannot be; nothing already written is harmed.

#include "gcpdda/io/run_comparison.hpp"

#include "child_process.hpp"
#include "sample_scenes.hpp"
#include "support/block_file_writer.hpp"
#include "support/run_facts.hpp"
#include "support/scenes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <fmt/format.h>
#include <fstream>
#include <hdf5.h>
#include <random>
#include <thread>

namespace gcpdda::restart_test {
namespace {

namespace fs = std::filesystem;
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

std::vector<fs::path> checkpoints(const fs::path &run) {
  std::vector<fs::path> found;
  if (fs::exists(run / "checkpoints")) {
    for (const fs::directory_entry &entry : fs::directory_iterator(run / "checkpoints")) {
      found.push_back(entry.path());
    }
  }
  std::sort(found.begin(), found.end());
  return found;
}

void set_number(const fs::path &file, const char *dataset, std::int64_t value) {
  const hid_t id = H5Fopen(file.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  const hid_t number = H5Dopen2(id, dataset, H5P_DEFAULT);
  EXPECT_GE(H5Dwrite(number, H5T_NATIVE_INT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, &value), 0);
  H5Dclose(number);
  H5Fclose(id);
}

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

/// A short run of two blocks with two checkpoints, at 0.05 s and at the end, 0.1 s.
class Restart : public ::testing::Test {
protected:
  static void SetUpTestSuite() {
    made_ = std::make_unique<WorkFolder>();
    made_->write("scene.toml", testing::small_scene());
    outcome_ = run_gcpdda(0, run_words("run"), *made_);
  }
  static void TearDownTestSuite() { made_.reset(); }
  void SetUp() override {
    ASSERT_EQ(outcome_.exit_code, 0) << outcome_.err;
    fs::copy(made_->path(), folder_.path(), fs::copy_options::recursive);
    fs::copy(folder_ / "run", folder_ / "whole", fs::copy_options::recursive);
    files_ = checkpoints(folder_ / "run");
    ASSERT_EQ(files_.size(), 2U);
  }
  static std::vector<std::string> run_words(const std::string &out) {
    return {"run",   "scene.toml",          "--out", out, "--set", "output.checkpoint_interval=0.05",
            "--set", "output.interval=0.05"};
  }
  /// Refused with this text, and the folder stays byte for byte as it was.
  void expect_refusal(int ranks, const std::vector<std::string> &arguments, int exit_code,
                      const std::vector<std::string> &said) {
    fs::remove_all(folder_ / "before");
    fs::copy(folder_ / "run", folder_ / "before", fs::copy_options::recursive);
    const Outcome outcome = run_gcpdda(ranks, arguments, folder_);
    EXPECT_EQ(outcome.exit_code, exit_code) << outcome.err;
    for (const std::string &text : said) {
      EXPECT_EQ(count_of(outcome.err, text), 1) << "expected once: " << text << "\nin: " << outcome.err;
    }
    ASSERT_EQ(listing(folder_ / "run"), listing(folder_ / "before"));
    for (const std::string &name : listing(folder_ / "run")) {
      if (!fs::is_directory(folder_ / "run" / name)) {
        EXPECT_EQ(file_text(folder_ / "run" / name) == file_text(folder_ / "before" / name), true) << name;
      }
    }
  }
  void overwrite(const fs::path &file, std::size_t where, char byte) const {
    std::string bytes = file_text(file);
    bytes.at(where) = byte;
    std::ofstream(file, std::ios::binary) << bytes;
  }

  static std::unique_ptr<WorkFolder> made_;
  static Outcome outcome_;
  WorkFolder folder_;
  std::vector<fs::path> files_;
};

std::unique_ptr<WorkFolder> Restart::made_;
Outcome Restart::outcome_;

TEST_F(Restart, OfAFinishedRunSaysSoAndDoesNothing) {
  for (const int ranks : {0, 3}) {
    expect_refusal(ranks, {"restart", "run"}, 0, {"the run in run is finished at t = 0.1 s"});
  }
  fs::remove_all(folder_ / "run/checkpoints");
  expect_refusal(0, {"restart", "run"}, 0, {"the run in run is finished, there is nothing to do"});
}

TEST_F(Restart, WithALongerDurationGoesOnFromTheEnd) {
  const std::vector<std::string> longer{"--set", "run.duration=0.15"};
  std::vector<std::string> words{"restart", "run"};
  words.insert(words.end(), longer.begin(), longer.end());
  const Outcome outcome = run_gcpdda(2, words, folder_);
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  words = run_words("long");
  words.insert(words.end(), longer.begin(), longer.end());
  ASSERT_EQ(run_gcpdda(0, words, folder_).exit_code, 0);
  EXPECT_EQ(compare_runs(folder_ / "long", folder_ / "run"), none);
  // The new scene is the folder's from now on.
  EXPECT_EQ(file_text(folder_ / "run/scene.toml"), file_text(folder_ / "long/scene.toml"));
}

TEST_F(Restart, OfATruncatedCheckpointTakesTheOneBefore) {
  fs::resize_file(files_[1], fs::file_size(files_[1]) / 2);
  const Outcome outcome = run_gcpdda(3, {"restart", "run"}, folder_);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(count_of(outcome.err, "warning: a checkpoint is not used, " +
                                      ("run" / files_[1].lexically_relative(folder_ / "run")).string()),
            1)
      << outcome.err;
  EXPECT_EQ(compare_runs(folder_ / "whole", folder_ / "run"), none);
  EXPECT_EQ(checkpoints(folder_ / "run"), files_);
}

// Every file that was tried is named, with the reason.
TEST_F(Restart, WithoutAValidCheckpointIsRefused) {
  const std::string old = fs::path("run/checkpoints") / files_[0].filename();
  const std::string last = fs::path("run/checkpoints") / files_[1].filename();
  const std::string good = file_text(files_[1]);
  fs::resize_file(files_[0], 0);
  // One bit of a number: of the velocity of the slider along x, the last one in the file.
  const double speed = read_frame(folder_ / "run/frames/frame_000002.hdf").velocity[1][0];
  std::string bytes(reinterpret_cast<const char *>(&speed), sizeof(speed));
  overwrite(files_[1], good.find(bytes), static_cast<char>(good[good.find(bytes)] ^ 1));
  expect_refusal(2, {"restart", "run"}, 4,
                 {"cannot restart run: no checkpoint can be used", old + ": cannot open ",
                  last + ": it is damaged: its checksum is wrong"});
  std::ofstream(files_[0], std::ios::binary) << "notes";
  fs::copy_file(folder_ / "run/frames/frame_000000.hdf", files_[1], fs::copy_options::overwrite_existing);
  expect_refusal(0, {"restart", "run"}, 4,
                 {old + ": cannot open ", last + ": it is an HDF5 file, but no checkpoint of gcpdda"});
  fs::remove(files_[0]);
  std::ofstream(files_[1], std::ios::binary) << good;
  set_number(files_[1], "/version", 1000);
  expect_refusal(0, {"restart", "run"}, 4,
                 {last + ": it has format version 1000, this gcpdda reads version 7"});
  fs::remove_all(folder_ / "run/checkpoints");
  fs::remove(folder_ / "run/summary.json");
  expect_refusal(0, {"restart", "run"}, 4, {"there is no checkpoint in run/checkpoints"});
  expect_refusal(3, {"restart", "nowhere"}, 4, {"nowhere/scene.toml"});
}

TEST_F(Restart, OfAForeignCheckpointIsRefused) {
  const std::string last = fs::path("run/checkpoints") / files_[1].filename();
  fs::remove(files_[0]);
  const auto replace_by_run_with = [&](const std::string &set) {
    fs::remove_all(folder_ / "other");
    std::vector<std::string> words = run_words("other");
    words.insert(words.end(), {"--set", set});
    ASSERT_EQ(run_gcpdda(0, words, folder_).exit_code, 0);
    fs::copy_file(checkpoints(folder_ / "other").back(), files_[1], fs::copy_options::overwrite_existing);
  };
  replace_by_run_with("block.slider.velocity=[1, 0, 0]");
  expect_refusal(0, {"restart", "run"}, 4,
                 {last + ": it is of another scene, or its block file has changed"});
  replace_by_run_with("material.rock.density=2601");
  expect_refusal(2, {"restart", "run"}, 4,
                 {last + ": it is of another scene: a material has another density"});
  replace_by_run_with("block.tower.fixed=true");
  expect_refusal(0, {"restart", "run"}, 4,
                 {last + ": it is of another scene: 3 blocks of which 1 can move, this one has 3 and 2"});
}

TEST_F(Restart, RefusesChangesUnderWhichTheStateMeansNothing) {
  expect_refusal(2,
                 {"restart", "run", "--set", "material.rock.density=2500", "--set",
                  "block.slider.vertices=[[0, 0], [1, 0], [1, 2]]", "--set", "run.spectral_radius=0.8"},
                 3,
                 {"error: a restart cannot change material.rock.density, ",
                  "error: a restart cannot change block 'slider', ",
                  "error: a restart cannot change run.spectral_radius, "});
  expect_refusal(0, {"restart", "run", "--set", "run.durration=3"}, 3, {"did you mean 'duration'?"});
  fs::remove(files_[1]);
  expect_refusal(0,
                 {"restart", "run", "--set", "run.time_step=0.0112", "--set",
                  "output.interval=0.03333333333333333", "--set",
                  "output.history_interval=0.03333333333333333"},
                 3, {"error: the checkpoint at t = 0.05 s is between two steps of "});
}

TEST_F(Restart, TakesOtherFrictionGravityAndTimeStep) {
  fs::remove(files_[1]);
  const Outcome outcome = run_gcpdda(2,
                                     {"restart", "run", "--set", "joint.default.friction_angle_deg=40",
                                      "--set", "run.gravity=[0, -20]", "--set", "run.time_step=5e-4"},
                                     folder_);
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(count_of(outcome.err, "warning: the time step changes from 0.000961538 s to 0.0005 s"), 1)
      << outcome.err;
  EXPECT_EQ(summary_number(folder_ / "run", "time_step"), 5e-4);
  EXPECT_EQ(summary_number(folder_ / "run", "steps"), 200) << "100 of them in the second half";
  EXPECT_EQ(summary_number(folder_ / "run", "restarted_at"), 0.05);
  const FrameContent middle = read_frame(folder_ / "run/frames/frame_000001.hdf");
  const FrameContent end = read_frame(folder_ / "run/frames/frame_000002.hdf");
  EXPECT_EQ(end.time, 0.1);
  // Without friction the slider keeps its speed to rounding; tan 40 degrees of 20 m/s2 take 0.8 m/s in the
  // mean, more or less while it rocks.
  EXPECT_NEAR(middle.velocity[1][0], 1.5, 1e-12);
  EXPECT_LT(end.velocity[1][0], 1.5 - 0.4);
}

// The state a failure ended in is written as a frame, never as a checkpoint.
TEST_F(Restart, AfterANumericalFailureGoesOnFromTheLastGoodState) {
  folder_.write("soft.toml", testing::head_scene(1e5, 1e-3, 0.4) +
                                 testing::block_toml("hammer", testing::rectangle({0.0, 0.5}, {1.0, 1.5}),
                                                     "velocity = [0, -8, 0]"));
  const Outcome failed = run_gcpdda(
      0, {"run", "soft.toml", "--out", "soft", "--set", "output.checkpoint_interval=0.02"}, folder_);
  ASSERT_EQ(failed.exit_code, 5) << failed.err;
  const std::string message = summary_text(folder_ / "soft", "message");
  const double end = summary_number(folder_ / "soft", "time");
  const std::vector<fs::path> good = checkpoints(folder_ / "soft");
  ASSERT_GE(good.size(), 1U);
  EXPECT_EQ(run_gcpdda(2, {"restart", "soft"}, folder_).exit_code, 5);
  EXPECT_EQ(summary_text(folder_ / "soft", "message"), message);
  EXPECT_EQ(summary_number(folder_ / "soft", "time"), end);
  EXPECT_EQ(checkpoints(folder_ / "soft"), good);
  const Outcome stiffer =
      run_gcpdda(0, {"restart", "soft", "--set", "joint.default.normal_stiffness=1e7"}, folder_);
  EXPECT_EQ(stiffer.exit_code, 0) << stiffer.err;
}

TEST_F(Restart, FindsItsBlockFileFromAnywhereAndKnowsItAgain) {
  std::vector<SceneBlock> blocks(3);
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    const double x = 2.0 * static_cast<double>(i) + 6.0;
    blocks[i].vertices = {{x, 0}, {x + 1, 0}, {x + 1, 1}, {x, 1}};
  }
  fs::create_directories(folder_ / "in/elsewhere");
  testing::BlockFileWriter(blocks).write(folder_ / "in/blocks.h5");
  folder_.write("in/many.toml", testing::small_scene() + "[blocks]\nfile = \"blocks.h5\"\n");
  ASSERT_EQ(run_gcpdda(0,
                       {"run", "in/many.toml", "--out", "many", "--set", "output.checkpoint_interval=0.05"},
                       folder_)
                .exit_code,
            0);
  fs::remove(checkpoints(folder_ / "many").back());
  const std::vector<std::string> words = gcpdda_words(2, {"restart", (folder_ / "many").string()});
  const Outcome found = testing::run_program(words, folder_ / "in/elsewhere");
  EXPECT_EQ(found.exit_code, 0) << found.err;

  blocks[2].vertices[2].y = 1.25;
  testing::BlockFileWriter(blocks).write(folder_ / "in/blocks.h5");
  fs::remove(checkpoints(folder_ / "many").back());
  const Outcome changed = testing::run_program(words, folder_ / "in/elsewhere");
  EXPECT_EQ(changed.exit_code, 4) << changed.err;
  EXPECT_EQ(count_of(changed.err, "its block file has changed"), 1) << changed.err;
}

TEST_F(Restart, IsRefusedWhileTheRunGoesOn) {
  Process process(gcpdda_words(0, {"run", "scene.toml", "--out", "busy", "--set", "run.duration=1000"}),
                  folder_.path());
  process.wait_until([&] { return fs::exists(folder_ / "busy/frames/frame_000000.hdf"); });
  for (const std::vector<std::string> &words :
       {std::vector<std::string>{"restart", "busy"}, {"run", "scene.toml", "--out", "busy", "--overwrite"}}) {
    const Outcome second = run_gcpdda(0, words, folder_);
    EXPECT_EQ(second.exit_code, 4) << second.err;
    EXPECT_EQ(count_of(second.err, "the folder busy is in use: another gcpdda runs in it"), 1) << second.err;
  }
  kill(process.id(), SIGUSR1);
  EXPECT_EQ(process.wait().exit_code, 6);
}

TEST_F(Restart, OverwriteRemovesCheckpoints) {
  const Outcome outcome = run_gcpdda(0, {"run", "scene.toml", "--out", "run", "--overwrite"}, folder_);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(checkpoints(folder_ / "run"), std::vector<fs::path>());
}

} // namespace
} // namespace gcpdda::restart_test
