// gcpdda restart: the same files as a run that was never stopped, whatever stopped it and on any number of
// ranks; a clear refusal where that cannot be; nothing already written is harmed.

#include "io/results/run_comparison.hpp"

#include "checkpoints.hpp"
#include "child_process.hpp"
#include "io/results/frame_reader.hpp"
#include "sample_scenes.hpp"
#include "support/block_file_writer.hpp"
#include "support/run_facts.hpp"
#include "support/scenes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <csignal>
#include <fmt/format.h>
#include <fstream>
#include <hdf5.h>

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
                 {"cannot restart run: no checkpoint can be used",
                  old + ": it is damaged or no checkpoint of gcpdda: its 0 bytes begin with no seal",
                  last + ": it is damaged: its checksum is wrong"});
  std::ofstream(files_[0], std::ios::binary) << "notes";
  fs::copy_file(folder_ / "run/frames/frame_000000.hdf", files_[1], fs::copy_options::overwrite_existing);
  expect_refusal(0, {"restart", "run"}, 4,
                 {old + ": it is damaged or no checkpoint of gcpdda: its 5 bytes begin with no seal",
                  last + ": it is an HDF5 file, but no checkpoint of gcpdda"});
  fs::remove(files_[0]);
  std::ofstream(files_[1], std::ios::binary) << good;
  overwrite(files_[1], good.find("version 20") + 8, '1');
  expect_refusal(0, {"restart", "run"}, 4,
                 {last + ": it has format version 10, this gcpdda reads version 20"});
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
  for (const auto &[set, part] : {std::pair("joint.default.friction_angle_deg=20", "[joint]"),
                                  {"run.gravity=[0, -9.8]", "[run]"},
                                  {"block.slider.load=[{point=[0.5, 0.5], force=[1, 0]}]", "[[block]]"}}) {
    replace_by_run_with(set);
    expect_refusal(0, {"restart", "run"}, 4,
                   {last + ": it is of another scene: " + part + " had other values when it was computed"});
  }
  replace_by_run_with("block.tower.fixed=true");
  expect_refusal(0, {"restart", "run"}, 4,
                 {last + ": it is of another scene: 3 blocks of which 1 can move, this one has 3 and 2"});
}

// A length in a checkpoint that a bit flip has made enormous is not believed, on any rank.
TEST_F(Restart, OfACheckpointWithAnAbsurdLengthTakesTheOneBefore) {
  const hid_t file = H5Fopen(files_[1].c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  const hid_t counts = H5Dopen2(file, "/stage/counts", H5P_DEFAULT);
  const haddr_t place = H5Dget_offset(counts);
  H5Dclose(counts);
  H5Fclose(file);
  for (const std::size_t byte : {std::size_t{3}, std::size_t{5}}) {
    fs::remove_all(folder_ / "run");
    fs::copy(folder_ / "whole", folder_ / "run", fs::copy_options::recursive);
    overwrite(files_[1], place + byte, '\x40');
    const Outcome outcome = run_gcpdda(2, {"restart", "run"}, folder_);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_EQ(count_of(outcome.err, "it is damaged: its checksum is wrong"), 1) << outcome.err;
    EXPECT_EQ(compare_runs(folder_ / "whole", folder_ / "run"), none);
  }
}

// What is missing behind the older checkpoint is computed again; what is missing before it cannot be.
TEST_F(Restart, NoticesResultsThatAreNotWhole) {
  const auto lose = [&](const char *what) {
    fs::remove_all(folder_ / "run");
    fs::copy(folder_ / "whole", folder_ / "run", fs::copy_options::recursive);
    const std::string text = file_text(folder_ / "run/history/energy.csv");
    if (std::string(what) == "frame") {
      fs::remove(folder_ / "run/frames/frame_000002.hdf");
    } else if (std::string(what) == "contacts") {
      fs::resize_file(folder_ / "run/frames/contacts_000002.hdf", 1000);
    } else {
      std::ofstream(folder_ / "run/history/energy.csv", std::ios::binary) << text.substr(0, text.size() - 9);
    }
  };
  const std::string last = fs::path("run/checkpoints") / files_[1].filename();
  for (const auto &[what, told] : {std::pair("frame", "frames/frame_000002.hdf is missing"),
                                   {"contacts", "frames/contacts_000002.hdf is damaged, it has 1000 of "},
                                   {"history", "history/energy.csv is cut short, it has 8 of 9 rows"}}) {
    lose(what);
    const Outcome outcome = run_gcpdda(2, {"restart", "run"}, folder_);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_EQ(count_of(outcome.err, "warning: a checkpoint is not used, " + last +
                                        ": results before it are not whole: " + told),
              1)
        << outcome.err;
    EXPECT_EQ(compare_runs(folder_ / "whole", folder_ / "run"), none);
    EXPECT_EQ(file_text(folder_ / "run/history/energy.csv"), file_text(folder_ / "whole/history/energy.csv"));
  }
  lose("frame");
  fs::remove(files_[0]);
  expect_refusal(2, {"restart", "run"}, 4,
                 {"cannot restart run: no checkpoint can be used", "frames/frame_000002.hdf is missing",
                  "or go on without them: gcpdda restart --accept-gaps"});
  const Outcome accepted =
      run_gcpdda(2, {"restart", "run", "--accept-gaps", "--set", "run.duration=0.15"}, folder_);
  EXPECT_EQ(accepted.exit_code, 0) << accepted.err;
  EXPECT_EQ(count_of(accepted.err, "warning: earlier results have a gap that stays: frames/frame_000002.hdf "
                                   "is missing"),
            1)
      << accepted.err;
  const std::string index = file_text(folder_ / "run/run.hdf.series");
  EXPECT_EQ(count_of(index, "frame_000002.hdf"), 0) << "an index tells of files that are there";
  EXPECT_EQ(count_of(index, "frame_000003.hdf"), 1);
  // A gap is told once: the checkpoints behind it do not miss the file.
  EXPECT_EQ(run_gcpdda(0, {"restart", "run", "--set", "run.duration=0.2"}, folder_).exit_code, 0);
}

// Friction and the like are changed by --set; the state from before the change stays one of this run.
TEST_F(Restart, GoesOnAfterAChangeThatHasNoCheckpointYet) {
  fs::remove(files_[1]);
  const std::string old = file_text(files_[0]);
  const std::vector<std::string> changed{"restart", "run", "--set", "joint.default.friction_angle_deg=40"};
  ASSERT_EQ(run_gcpdda(0, changed, folder_).exit_code, 0);
  const std::string whole = file_text(folder_ / "run/history/energy.csv");
  fs::remove(checkpoints(folder_ / "run")[1]); // as if it had been killed before its first
  ASSERT_EQ(file_text(files_[0]) == old, true);
  const Outcome again = run_gcpdda(2, {"restart", "run"}, folder_);
  EXPECT_EQ(again.exit_code, 0) << again.err;
  EXPECT_EQ(file_text(folder_ / "run/history/energy.csv"), whole);
  // In scene.toml nobody can tell it from a foreign checkpoint.
  const std::string scene = file_text(folder_ / "whole/scene.toml");
  fs::remove_all(folder_ / "run");
  fs::copy(folder_ / "whole", folder_ / "run", fs::copy_options::recursive);
  std::string edited = scene;
  edited.insert(edited.find("[run]\n") + 6, "gravity_ramp = 0.5\n");
  std::ofstream(folder_ / "run/scene.toml", std::ios::binary) << edited;
  const Outcome refused = run_gcpdda(0, {"restart", "run"}, folder_);
  EXPECT_EQ(refused.exit_code, 4) << refused.err;
  EXPECT_EQ(count_of(refused.err, "a change that is meant goes into gcpdda restart --set"), 2) << refused.err;
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
