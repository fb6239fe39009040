// The files a run leaves: names, columns, keys, first and last times; and the same bytes for any ranks when
// started as users start it.

#include "io/results/run_comparison.hpp"

#include "child_process.hpp"
#include "io/results/frame_reader.hpp"
#include "sample_scenes.hpp"
#include "support/run_facts.hpp"
#include "support/scenes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <fmt/format.h>
#include <set>

namespace gcpdda::result_folder_test {
namespace {

namespace fs = std::filesystem;
using testing::count_of;
using testing::file_text;
using testing::lines_of;
using testing::Outcome;
using testing::run_gcpdda;
using testing::run_program;
using testing::summary_number;
using testing::summary_text;
using testing::WorkFolder;

std::vector<double> first_column(const fs::path &history) {
  std::vector<double> times;
  for (const std::string &line : lines_of(file_text(history))) {
    if (!line.starts_with("time")) {
      times.push_back(std::stod(line.substr(0, line.find(','))));
    }
  }
  return times;
}

/// Two runs of the small scene, shared by the tests of its files: 4 outputs and 8 history rows in 0.1 s.
class ResultFolder : public ::testing::Test {
protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<WorkFolder>();
    folder_->write("scene.toml", testing::small_scene());
    outcome_ = run_gcpdda(3, {"run", "scene.toml", "--out", "out"}, *folder_);
  }
  static void TearDownTestSuite() { folder_.reset(); }
  void SetUp() override { ASSERT_EQ(outcome_.exit_code, 0) << outcome_.err; }
  static fs::path out() { return *folder_ / "out"; }

  static std::unique_ptr<WorkFolder> folder_;
  static Outcome outcome_;
};

std::unique_ptr<WorkFolder> ResultFolder::folder_;
Outcome ResultFolder::outcome_;

TEST_F(ResultFolder, HoldsTheFilesOfTheContractAndNoOthers) {
  std::set<std::string> expected{"contacts.hdf.series",
                                 "decomposition",
                                 "decomposition/owners_0.csv",
                                 "frames",
                                 "frames/topology_000000.h5",
                                 "history",
                                 "history/energy.csv",
                                 "history/floor.csv",
                                 "history/slider.csv",
                                 "run.hdf.series",
                                 "run.log",
                                 "run.xdmf",
                                 "scene.toml",
                                 "summary.json"};
  expected.insert(fmt::format("decomposition/owners_{:.0f}.csv", summary_number(out(), "steps")));
  for (int index = 0; index <= 4; ++index) {
    expected.insert(fmt::format("frames/frame_{:06}.hdf", index));
    expected.insert(fmt::format("frames/contacts_{:06}.hdf", index));
  }
  const std::vector<std::string> found = testing::listing(out());
  EXPECT_EQ(std::set<std::string>(found.begin(), found.end()), expected);
}

TEST_F(ResultFolder, HasHistoriesWithTheirColumns) {
  for (const char *name : {"slider", "floor"}) {
    const auto lines = lines_of(file_text(out() / "history" / (std::string(name) + ".csv")));
    EXPECT_EQ(lines.at(0), "time[s],x[m],y[m],rotation[rad],vx[m/s],vy[m/s],omega[rad/s],sxx[Pa],syy[Pa],"
                           "sxy[Pa],fx[N/m],fy[N/m],ux[m],uy[m]");
    EXPECT_EQ(lines.size(), 10U) << "header, t = 0 and 8 rows";
    for (const std::string &line : lines) {
      EXPECT_EQ(count_of(line, ","), 13) << line;
    }
  }
  const auto energy = lines_of(file_text(out() / "history/energy.csv"));
  EXPECT_EQ(energy.at(0),
            "time[s],kinetic[J/m],strain[J/m],contact_normal[J/m],contact_stick[J/m],gravity[J/m],"
            "friction_loss[J/m],damping_loss[J/m],boundary_work[J/m],residual[J/m],"
            "unbalanced_ratio[-],max_speed[m/s]");
  EXPECT_EQ(energy.size(), 10U);
  for (const std::string &line : energy) {
    EXPECT_EQ(count_of(line, ","), 11) << line;
  }
}

TEST_F(ResultFolder, TellsAtZeroWhatTheSceneSays) {
  const std::string slider = lines_of(file_text(out() / "history/slider.csv")).at(1);
  EXPECT_TRUE(slider.starts_with("0,0.5,0.5,0,1.5,0,0,")) << slider;
  const FrameContent frame = read_frame(out() / "frames/frame_000000.hdf");
  EXPECT_EQ(frame.time, 0.0);
  EXPECT_EQ(frame.block, (std::vector<std::int64_t>{0, 1, 2})) << "rows in BlockId order";
  EXPECT_EQ(frame.kind, (std::vector<std::uint8_t>{0, 1, 1}));
  EXPECT_EQ(frame.offsets, (std::vector<std::int64_t>{0, 4, 8, 12}));
  EXPECT_EQ(frame.velocity[1][0], 1.5);
}

TEST_F(ResultFolder, EndsAtTheDurationExactly) {
  const double last = 0.1;
  EXPECT_EQ(summary_number(out(), "time"), last);
  EXPECT_EQ(read_frame(out() / "frames/frame_000004.hdf").time, last);
  EXPECT_EQ(read_contact_frame(out() / "frames/contacts_000004.hdf").time, last);
  for (const char *name : {"slider", "floor", "energy"}) {
    const std::vector<double> times = first_column(out() / "history" / (std::string(name) + ".csv"));
    EXPECT_EQ(times.front(), 0.0);
    EXPECT_EQ(times.back(), last);
    for (std::size_t row = 0; row < times.size(); ++row) {
      EXPECT_NEAR(times[row], 0.0125 * static_cast<double>(row), 1e-15);
    }
  }
}

TEST_F(ResultFolder, HasASummaryOfAllKeys) {
  const std::string text = file_text(out() / "summary.json");
  for (const char *key : {"ranks",
                          "blocks",
                          "fixed_blocks",
                          "steps",
                          "time",
                          "time_step",
                          "time_step_min",
                          "contacts",
                          "contact_steps",
                          "evaluations_per_rank",
                          "wall_s",
                          "cpu_s",
                          "setup_wall_s",
                          "output_wall_s",
                          "total_wall_s",
                          "max_overlap",
                          "energy",
                          "imbalance",
                          "bytes_sent_per_step",
                          "messages_per_step",
                          "phases",
                          "verdict",
                          "message"}) {
    EXPECT_EQ(count_of(text, fmt::format("\"{}\": ", key)), 1) << key;
  }
  EXPECT_EQ(summary_number(out(), "ranks"), 3);
  EXPECT_EQ(summary_number(out(), "blocks"), 2);
  EXPECT_EQ(summary_number(out(), "fixed_blocks"), 1);
  EXPECT_EQ(summary_number(out(), "contacts"), 2) << "slider and tower on the floor";
  EXPECT_EQ(count_of(summary_text(out(), "evaluations_per_rank"), ","), 2) << "one number a rank";
  EXPECT_GT(summary_number(out(), "max_overlap"), 0.0);
  // The row of energies is the last one of the history.
  const std::string row = lines_of(file_text(out() / "history/energy.csv")).back();
  const auto comma = row.find(',');
  EXPECT_EQ(summary_number(out(), "kinetic"), std::stod(row.substr(comma + 1)));
}

TEST_F(ResultFolder, HasASeriesOfAllFrames) {
  const std::string series = file_text(out() / "run.hdf.series");
  EXPECT_EQ(count_of(series, "\"file-series-version\": \"1.0\""), 1) << series;
  EXPECT_EQ(count_of(series, "\"name\""), 5) << series;
  for (int index = 0; index <= 4; ++index) {
    EXPECT_EQ(count_of(series, fmt::format("\"name\": \"frames/frame_{:06}.hdf\", \"time\": ", index)), 1);
  }
  const std::string key = "\"time\": ";
  EXPECT_EQ(std::stod(series.substr(series.rfind(key) + key.size())), 0.1);
}

TEST_F(ResultFolder, HasTheOwnerOfEveryMobileBlock) {
  const auto lines = lines_of(file_text(out() / "decomposition/owners_0.csv"));
  ASSERT_EQ(lines.size(), 4U);
  EXPECT_EQ(lines[0], "block,rank");
  EXPECT_EQ(lines[1], "0,-1") << "the floor is everybody's";
  for (const std::size_t block : {1U, 2U}) {
    const int rank = std::stoi(lines[block + 1].substr(lines[block + 1].find(',') + 1));
    EXPECT_GE(rank, 0);
    EXPECT_LT(rank, 3);
  }
}

// Output at times that are not multiples of each other: the last row and frame are extra, not shifted.
TEST(Times, OfAnIntervalThatDoesNotDivideTheDuration) {
  const WorkFolder folder;
  folder.write("scene.toml", testing::small_scene());
  const Outcome outcome = run_gcpdda(0,
                                     {"run", "scene.toml", "--out", "out", "--set", "output.interval=0.04",
                                      "--set", "output.history_interval=0.02", "--set", "run.duration=0.11"},
                                     folder);
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const fs::path out = folder / "out";
  EXPECT_EQ(first_column(out / "history/energy.csv"),
            (std::vector<double>{0.0, 0.02, 0.04, 0.06, 0.08, 0.1, 0.11}));
  for (const auto &[index, time] : {std::pair(1, 0.04), std::pair(2, 0.08), std::pair(3, 0.11)}) {
    EXPECT_EQ(read_frame(out / fmt::format("frames/frame_{:06}.hdf", index)).time, time);
  }
  EXPECT_FALSE(fs::exists(out / "frames/frame_000004.hdf"));
}

TEST(Times, AGivenStepThatDoesNotFitIsLoweredOnce) {
  const WorkFolder folder;
  folder.write("scene.toml", testing::small_scene());
  const Outcome outcome =
      run_gcpdda(0, {"run", "scene.toml", "--out", "out", "--set", "run.time_step=9e-4"}, folder);
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(count_of(outcome.err, "info: the time step is lowered from 0.0009 s to "), 1) << outcome.err;
  const double step = summary_number(folder / "out", "time_step");
  EXPECT_LE(step, 9e-4);
  EXPECT_NEAR(step * summary_number(folder / "out", "steps"), 0.1, 1e-15);
}

TEST(Times, AGivenStepAboveTheBoundIsUsedWithAWarning) {
  const WorkFolder folder;
  folder.write("scene.toml", testing::small_scene());
  const Outcome outcome =
      run_gcpdda(0, {"run", "scene.toml", "--out", "out", "--set", "run.time_step=3.125e-3"}, folder);
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(count_of(outcome.err, "warning: the time step 0.003125 s is above the recommended "), 1)
      << outcome.err;
  EXPECT_EQ(summary_number(folder / "out", "time_step"), 3.125e-3);
  EXPECT_EQ(summary_number(folder / "out", "steps"), 32);
}

TEST(Contacts, AreLeftOutOnRequest) {
  const WorkFolder folder;
  folder.write("scene.toml", testing::small_scene());
  const Outcome outcome =
      run_gcpdda(0, {"run", "scene.toml", "--out", "out", "--set", "output.contacts=false"}, folder);
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  for (const std::string &name : testing::listing(folder / "out/frames")) {
    EXPECT_FALSE(name.starts_with("contacts")) << name;
  }
}

// As users start it. How it crosses ranks is asserted by the tests in tests/parallel; here the way through
// mpirun, the reader and the command line is added.
TEST(Identity, OfRunsStartedByMpirun) {
  const WorkFolder folder;
  folder.write("pile.toml", testing::falling_pile_toml(40, 0.4));
  for (const int ranks : {0, 1, 2, 3}) {
    const Outcome outcome =
        run_gcpdda(ranks, {"run", "pile.toml", "--out", fmt::format("on{}", ranks)}, folder);
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_EQ(summary_number(folder / fmt::format("on{}", ranks), "ranks"), std::max(1, ranks));
    EXPECT_EQ(compare_runs(folder / "on0", folder / fmt::format("on{}", ranks)), std::vector<std::string>())
        << ranks << " ranks";
  }
  EXPECT_GE(summary_number(folder / "on3", "cross_rank_contacts"), 1);
  EXPECT_GE(summary_number(folder / "on3", "migrations"), 1);
  EXPECT_GE(summary_number(folder / "on3", "refreshes"), 1);
}

/// Every kind of file: frames of blocks, contacts and bolts, two topologies, histories, indices, checkpoints.
std::string scene_of_all_files() {
  std::string toml = testing::head_scene(1e8, 1e-3, 0.032);
  toml.erase(toml.find("duration"), std::string("duration = 0.032\n").size());
  toml.insert(toml.find("interval ="), "checkpoint_interval = 0.016\n");
  for (int k = 0; k < 8; ++k) {
    toml += testing::block_toml(fmt::format("tower{}", k),
                                testing::rectangle({3.0 * k, 0.0}, {3.0 * k + 1.0, 2.0}));
  }
  return toml + "[support.cable]\nkind = \"anchored\"\naxial_stiffness = 1e7\n"
                "[[bolt]]\nname = \"b\"\nsupport = \"cable\"\nfrom = [0.5, 0.5]\nto = [0.5, -1.5]\n"
                "[[monitor]]\nblock = \"tower0\"\n"
                "[[stage]]\nkind = \"run\"\nduration = 0.008\n"
                "[[stage]]\nkind = \"excavate\"\nblocks = [\"tower3\"]\n"
                "[[stage]]\nkind = \"run\"\nduration = 0.008\n";
}

// The C library fills memory that is allocated, and memory that is freed, with the two bytes that the
// variable gives: where any of it reached a file, the files would differ. What is exempt is measured, or is
// about ranks.
TEST(Identity, OfEveryByteWhateverMemoryHolds) {
  const WorkFolder folder;
  folder.write("scene.toml", scene_of_all_files());
  const auto run = [&](int ranks, int pattern) {
    const std::string out = fmt::format("on{}", ranks);
    const Outcome outcome = run_program(testing::gcpdda_words(ranks, {"run", "scene.toml", "--out", out}),
                                        folder.path(), {fmt::format("MALLOC_PERTURB_={}", pattern)});
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    return folder / out;
  };
  const auto is_exempt = [](const std::string &name) {
    return name == "summary.json" || name == "run.log" || name.starts_with("decomposition");
  };
  const fs::path alone = run(1, 90);
  std::vector<std::string> files = testing::listing(alone);
  std::erase_if(files, is_exempt);
  for (const char *name : {"frames/bolts_000002.hdf", "frames/contacts_000002.hdf",
                           "frames/topology_000002.h5", "checkpoints/checkpoint_000000016.h5"}) {
    EXPECT_EQ(std::count(files.begin(), files.end(), name), 1) << name;
  }
  for (const auto &[ranks, pattern] : {std::pair(3, 165), std::pair(13, 7)}) {
    const fs::path together = run(ranks, pattern);
    std::vector<std::string> of_these = testing::listing(together);
    std::erase_if(of_these, is_exempt);
    EXPECT_EQ(of_these, files);
    for (const std::string &name : files) {
      if (fs::is_regular_file(alone / name)) {
        EXPECT_TRUE(file_text(alone / name) == file_text(together / name)) << name << " on " << ranks;
      }
    }
  }
}

} // namespace
} // namespace gcpdda::result_folder_test
