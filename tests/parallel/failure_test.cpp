// A run that cannot go on: all ranks stop in the same step with the same words and leave files that can be
// read.

#include "gcpdda/driver/run.hpp"
#include "geometry/polygon.hpp"
#include "io/results/frame_reader.hpp"
#include "io/results/run_comparison.hpp"
#include "partition/partition_cells.hpp"
#include "shared_folder.hpp"
#include "simulation/balance.hpp"
#include "simulation/simulation.hpp"
#include "support/run_facts.hpp"
#include "support/scenes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fmt/format.h>

namespace gcpdda::failure_test {
namespace {

namespace fs = std::filesystem;
using testing::rectangle;
using testing::summary_number;
using testing::summary_text;

/// The head of a scene, and a row of bystanders on the floor so that every rank has blocks.
std::string scene_head(double duration, double time_step, double normal_stiffness) {
  std::string toml = fmt::format(R"([run]
duration = {0}
time_step = {1}
fidelity = "rigid"
[material.rock]
density = 2600.0
[joint.default]
normal_stiffness = {2}
[output]
interval = {3}
[[monitor]]
block = "bystander3"
)",
                                 duration, time_step, normal_stiffness, duration / 4.0);
  toml += testing::block_toml("floor", rectangle({-5.0, -2.0}, {45.0, 0.0}), "fixed = true");
  for (int k = 0; k < 20; ++k) {
    toml +=
        testing::block_toml(fmt::format("bystander{}", k), rectangle({2.0 * k, 0.0}, {2.0 * k + 1.0, 1.0}));
  }
  return toml;
}

int number_of_frames(const fs::path &run) {
  int count = 0;
  for (const fs::directory_entry &entry : fs::directory_iterator(run / "frames")) {
    count += entry.path().filename().string().starts_with("frame_") ? 1 : 0;
  }
  return count;
}

/// One failing scene, run by all ranks and by one alone.
class FailedRuns {
public:
  explicit FailedRuns(const std::string &toml) : folder_(world_) {
    const Scene scene = testing::scene_of(toml);
    const testing::CapturedLog log;
    EXPECT_EQ(run_scene(world_, scene, {directory(), false}), 5) << "on rank " << world_.rank();
    log_ = log.text();
    world_.barrier();
    if (world_.is_root()) {
      EXPECT_EQ(run_scene(Communicator::self(), scene, {folder_.path("alone"), false}), 5);
      for (const std::string &difference : compare_runs(directory(), folder_.path("alone"))) {
        ADD_FAILURE() << difference;
      }
      for (const char *fact :
           {"message", "verdict", "steps", "time", "contacts", "contact_steps", "max_overlap"}) {
        EXPECT_EQ(summary_text(directory(), fact), summary_text(folder_.path("alone"), fact)) << fact;
      }
    }
    world_.barrier();
    expect_files_of_a_failure();
  }

  [[nodiscard]] fs::path directory() const { return folder_.path("together"); }
  [[nodiscard]] std::string message() const { return summary_text(directory(), "message"); }
  [[nodiscard]] double time() const { return summary_number(directory(), "time"); }
  [[nodiscard]] FrameContent last_frame() const {
    return read_frame(directory() / fmt::format("frames/frame_{:06}.hdf", number_of_frames(directory()) - 1));
  }

private:
  // Every rank looks: the files are complete when run_scene returns and a barrier is passed.
  void expect_files_of_a_failure() const {
    EXPECT_EQ(summary_text(directory(), "verdict"), "\"failed\"");
    EXPECT_EQ(last_frame().time, time());
    EXPECT_NE(message().find(fmt::format("t = {:.9g} s", time())), std::string::npos) << message();
    EXPECT_EQ(testing::count_of(log_, "error: failed: "), world_.is_root() ? 1 : 0) << log_;
    const std::string history = testing::file_text(directory() / "history/bystander3.csv");
    const std::string last_row = testing::lines_of(history).back();
    EXPECT_EQ(std::stod(last_row.substr(0, last_row.find(','))), time());
    const FrameContent frame = last_frame();
    EXPECT_EQ(static_cast<double>(frame.block.size()),
              summary_number(directory(), "blocks") + summary_number(directory(), "fixed_blocks"));
    for (const auto &velocity : frame.velocity) {
      EXPECT_TRUE(std::isfinite(velocity[0]) && std::isfinite(velocity[1]) && std::isfinite(velocity[2]));
    }
  }

  Communicator world_ = Communicator::world();
  testing::SharedFolder folder_;
  std::string log_;
};

// A soft joint: the hammer sinks into bystander 9 until the force would reverse.
TEST(Failure, OfATooDeepOverlapNamesBothBlocks) {
  std::string toml = scene_head(0.4, 1e-3, 1e6);
  toml += testing::block_toml("hammer", rectangle({18.1, 1.5}, {18.9, 2.3}), "velocity = [0, -12, 0]");
  const FailedRuns runs(toml);
  const std::string message = runs.message();
  for (const char *part : {"'hammer'", "'bystander9'", "overlaps", "narrowest width", "normal_stiffness"}) {
    EXPECT_NE(message.find(part), std::string::npos) << part << " is not in " << message;
  }
  EXPECT_GT(runs.time(), 0.5 / 12.0);
  EXPECT_LT(runs.time(), 0.4);
  EXPECT_GT(summary_number(runs.directory(), "max_overlap"), 0.4);
}

// Free fall until a step is longer than a quarter of the narrowest block's width: 0.125 m in 0.00625 s is 20
// m/s.
TEST(Failure, OfASpeedThatCouldTunnel) {
  std::string toml = scene_head(1.0, 0.00625, 1e5);
  toml += testing::block_toml("meteor", rectangle({10.0, 60.0}, {11.0, 60.5}), "velocity = [0, -17, 0]");
  const FailedRuns runs(toml);
  const std::string message = runs.message();
  for (const char *part : {"'meteor'", "in one step", "pass through", "time_step"}) {
    EXPECT_NE(message.find(part), std::string::npos) << part << " is not in " << message;
  }
  EXPECT_NEAR(runs.time(), 3.0 / 9.81, 0.05);
}

// Two hammers strike in the same step, far apart, so on different ranks: the lower id speaks.
TEST(Failure, OfTwoAtOnceNamesTheLowerId) {
  std::string toml = scene_head(0.4, 1e-3, 1e6);
  toml += testing::block_toml("right", rectangle({38.1, 1.5}, {38.9, 2.3}), "velocity = [0, -12, 0]");
  toml += testing::block_toml("left", rectangle({0.1, 1.5}, {0.9, 2.3}), "velocity = [0, -12, 0]");
  const std::string message = FailedRuns(toml).message();
  EXPECT_NE(message.find("'bystander0'"), std::string::npos) << message;
  EXPECT_NE(message.find("'left'"), std::string::npos) << message;
}

// Two causes in the same step: the first block of the scene grows too fast while the last one sinks too deep.
// Which of them is named must not depend on whether one rank sees both.
TEST(Failure, OfTwoCausesAtOnceIsTheSameOnAnyRanks) {
  const double step = 0.01;
  // An eighth of a metre in a step is a quarter of the narrowest width: (v + g dt) dt is just below it after
  // two steps, and above it after the third.
  const std::string racer =
      testing::block_toml("racer", rectangle({0.0, 40.0}, {1.0, 40.5}), "velocity = [0, -12.16, 0]");
  // The trial configuration lies 2/3 of a step ahead: 0.20 m in the second step, 0.32 m in the third; half
  // the width is 0.25 m.
  const std::string hammer =
      testing::block_toml("hammer", rectangle({38.1, 1.001}, {38.9, 1.501}), "velocity = [0, -11.9, 0]");
  const std::string head = scene_head(0.4, step, 1e5);
  const std::size_t blocks = head.find("[[block]]");
  const auto with_racer = [&](const std::string &toml) { return std::string(toml).insert(blocks, racer); };
  for (const std::string &alone : {with_racer(head), head + hammer}) {
    EXPECT_DOUBLE_EQ(FailedRuns(alone).time(), 3.0 * step);
  }
  const FailedRuns runs(with_racer(head + hammer));
  EXPECT_DOUBLE_EQ(runs.time(), 3.0 * step);
  EXPECT_NE(runs.message().find("'racer'"), std::string::npos) << "the lower id speaks: " << runs.message();
}

// A fault that is there before the first step: the initial state is the last one.
TEST(Failure, BeforeTheFirstStep) {
  std::string toml = scene_head(0.4, 0.02, 1e5);
  toml += testing::block_toml("bullet", rectangle({10.0, 60.0}, {11.0, 60.5}), "velocity = [0, -300, 0]");
  const FailedRuns runs(toml);
  EXPECT_EQ(runs.time(), 0.0);
  EXPECT_NE(runs.message().find("'bullet'"), std::string::npos) << runs.message();
}

// The cells are laid between the centroids, so one of the twins is on each side.
TEST(InitialOverlaps, OfTwinsOnTwoRanksAreRefusedOnAllRanks) {
  const Communicator world = Communicator::world();
  for (const double by : {1e-6, 1e-3}) {
    const auto one = rectangle({-0.5 - 0.5 * by, 0.0}, {0.5 - 0.5 * by, 1.0});
    const auto other = rectangle({-0.5 + 0.5 * by, 0.0}, {0.5 + 0.5 * by, 1.0});
    std::string toml = scene_head(0.1, 1e-3, 1e8);
    toml.resize(toml.find("[[monitor]]"));
    const Scene scene = testing::scene_of(
        toml + testing::block_toml("floor", rectangle({-5.0, -2.0}, {5.0, 0.0}), "fixed = true") +
        testing::block_toml("one", one) + testing::block_toml("other", other));
    const std::vector<Vec2> centroids =
        world.is_root() ? std::vector<Vec2>{polygon_moments(one).centroid, polygon_moments(other).centroid}
                        : std::vector<Vec2>{};
    DomainMap map;
    map.grid = lay_grid(world, centroids);
    const std::vector<std::int64_t> equal(centroids.size(), 1);
    map = partition_cells(map.grid, weights_by_cell(world, map.grid, centroids, equal), world.size());
    if (world.size() > 1) {
      EXPECT_NE(map.rank_of(polygon_moments(one).centroid), map.rank_of(polygon_moments(other).centroid))
          << "the scene must be able to tell";
    }
    try {
      const Simulation simulation(world, scene);
      ADD_FAILURE() << "twins moved by " << by << " m were accepted";
    } catch (const SceneError &error) {
      ASSERT_EQ(error.diagnostics().size(), 1U);
      EXPECT_EQ(error.diagnostics()[0].what, "blocks 'one' and 'other' lie at the same place");
    }
  }
}

} // namespace
} // namespace gcpdda::failure_test
