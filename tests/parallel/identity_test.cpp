// One rank and many write the same bytes. Each test also proves that there was something to get wrong: blocks
// in contact across ranks, blocks that changed their rank, neighbourhoods made anew.

#include "gcpdda/io/run_comparison.hpp"
#include "gcpdda/simulation/run.hpp"
#include "shared_folder.hpp"
#include "support/run_facts.hpp"
#include "support/scenes.hpp"

#include <gtest/gtest.h>

#include <fmt/format.h>
#include <random>
#include <set>

namespace gcpdda {
namespace {

namespace fs = std::filesystem;
using testing::summary_number;
using testing::summary_text;

/// A wall of bricks in running bond, pressed together a little, each with its own velocity: contacts in the
/// middle of everything, whatever way the wall is cut.
std::string shaken_wall_toml(int rows, int columns, double duration) {
  const double squeeze = 0.004;
  std::string toml = fmt::format(R"([run]
duration = {0}
fidelity = "rigid"
[material.rock]
density = 2600.0
[joint.default]
normal_stiffness = 2e8
friction_angle_deg = 30.0
[output]
interval = {1}
[[monitor]]
block = "brick3_2"
)",
                                 duration, duration / 2.0);
  toml += testing::block_toml(
      "floor", testing::rectangle({-2.0, -1.0}, {columns + 3.0, squeeze}), "fixed = true");
  std::mt19937 random(4);
  const auto speed = [&](double most) { return most * (static_cast<double>(random()) / 2147483648.0 - 1.0); };
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const Vec2 low{column + 0.5 * (row % 2), 0.5 * row};
      const Vec2 high{low.x + 1.0 + squeeze, low.y + 0.5 + squeeze};
      const double vx = speed(2.0);
      const double vy = speed(2.0);
      toml += testing::block_toml(fmt::format("brick{}_{}", row, column), testing::rectangle(low, high),
                                  fmt::format("velocity = [{:.6g}, {:.6g}, {:.6g}]", vx, vy, speed(0.5)));
    }
  }
  return toml;
}

/// Folders of one scene run by all ranks and by one alone, and whether they are the same.
class TwoRuns {
public:
  explicit TwoRuns(const Scene &scene) : folder_(world_) {
    const testing::CapturedLog log;
    const int code = run_scene(world_, scene, {together(), false});
    EXPECT_EQ(code, 0) << "together";
    world_.barrier();
    if (world_.is_root()) {
      EXPECT_EQ(run_scene(Communicator::self(), scene, {alone(), false}), 0) << "alone";
      compare();
    }
    world_.barrier();
  }

  [[nodiscard]] const Communicator &world() const { return world_; }
  [[nodiscard]] fs::path together() const { return folder_.path("together"); }
  [[nodiscard]] fs::path alone() const { return folder_.path("alone"); }
  /// A counter of the run together, on every rank.
  [[nodiscard]] double counted(const std::string &key) const { return summary_number(together(), key); }

private:
  void compare() const {
    for (const std::string &difference : compare_runs(together(), alone())) {
      ADD_FAILURE() << difference;
    }
    // These facts of the summary do not depend on the ranks either.
    for (const char *fact : {"blocks", "fixed_blocks", "steps", "time", "time_step", "contacts",
                             "contact_steps", "max_overlap", "energy", "refreshes", "normals_undefined",
                             "verdict", "message"}) {
      EXPECT_EQ(summary_text(together(), fact), summary_text(alone(), fact)) << fact;
    }
    EXPECT_EQ(summary_number(together(), "ranks"), world_.size());
    EXPECT_EQ(summary_number(alone(), "ranks"), 1);
    for (const char *crossing : {"cross_rank_contacts", "migrations", "messages_per_step"}) {
      EXPECT_EQ(summary_number(alone(), crossing), 0) << crossing;
    }
  }

  Communicator world_ = Communicator::world();
  testing::SharedFolder folder_;
};

/// Ranks that own a block at the start.
std::set<std::string> ranks_with_blocks(const fs::path &run) {
  std::set<std::string> ranks;
  for (const std::string &line : testing::lines_of(testing::file_text(run / "decomposition/owners_0.csv"))) {
    const std::string rank = line.substr(line.find(',') + 1);
    if (rank != "rank" && rank != "-1") { // fixed blocks have no owner
      ranks.insert(rank);
    }
  }
  return ranks;
}

TEST(Identity, OfAFallingPile) {
  const TwoRuns runs(testing::scene_of(testing::falling_pile_toml(160, 1.0)));
  EXPECT_GE(runs.counted("refreshes"), 1);
  EXPECT_GE(runs.counted("contacts"), 100);
  EXPECT_EQ(ranks_with_blocks(runs.together()).size(), static_cast<std::size_t>(runs.world().size()));
  if (runs.world().size() > 1) {
    EXPECT_GE(runs.counted("migrations"), 1);
    EXPECT_GE(runs.counted("cross_rank_contacts"), 4);
  }
}

TEST(Identity, OfAShakenWall) {
  const TwoRuns runs(testing::scene_of(shaken_wall_toml(50, 25, 0.06)));
  EXPECT_GE(runs.counted("refreshes"), 1);
  EXPECT_GE(runs.counted("contacts"), 1000);
  if (runs.world().size() > 1) {
    EXPECT_GE(runs.counted("migrations"), 1);
    EXPECT_GE(runs.counted("cross_rank_contacts"), 50);
  }
}

} // namespace
} // namespace gcpdda
