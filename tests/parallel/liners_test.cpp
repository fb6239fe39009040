// Liners on many ranks: the same bytes as on one, through migration, refresh, stages and a restart, with both
// solvers.

#include "driver/restart.hpp"
#include "gcpdda/driver/run.hpp"
#include "io/checkpoint/checkpoint_reader.hpp"
#include "io/results/run_comparison.hpp"
#include "shared_folder.hpp"
#include "support/run_facts.hpp"
#include "support/scenes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <fmt/format.h>
#include <sstream>

namespace gcpdda::liners_test {
namespace {

namespace fs = std::filesystem;
using testing::summary_number;

std::string liner_toml(const std::string &name, const std::string &points, bool active,
                       const std::string &support = "layer") {
  return fmt::format("[[liner]]\nname = \"{}\"\nsupport = \"{}\"\npoints = {}\nactive = {}\n", name, support,
                     points, active);
}

/// A thrown wall of rigid and deformable bricks with liners on three faces, whose every second course stands
/// back by half a metre; one is put in and one taken out on the way. They crack, yield and peel off.
std::string lined_wall_toml() {
  std::string toml = testing::mixed_wall_toml(24, 14, 0.02);
  toml.erase(toml.find("duration"), std::string("duration = 0.02\n").size());
  return toml +
         "[support.layer]\nkind = \"liner\"\nthickness = 0.15\nyoungs_modulus = 1e9\n"
         "compressive_strength = 4e6\ntensile_strength = 5e5\nresidual_tensile_strength = 2e5\n"
         "adhesion = 2e4\nbond_width = 0.1\n" +
         liner_toml("left", "[[0.25, 0.2], [0.25, 23.8]]", true) +
         liner_toml("top", "[[0.6, 24], [28.4, 24]]", false) +
         liner_toml("right", "[[28.25, 0.2], [28.25, 23.8]]", true) +
         "[[stage]]\nkind = \"run\"\nduration = 0.01\n"
         "[[stage]]\nkind = \"run\"\nduration = 0.01\n"
         "set = { \"liner.right.active\" = false, \"liner.top.active\" = true }\n";
}

/// A wall at rest, lined on its left face and top. An opening is cut into it and lined once the wall has
/// settled over it; then the wall gets heavier.
std::string settling_wall_toml() {
  std::string toml = "[run]\ngravity_ramp = 0.1\n[material.rock]\ndensity = 2600.0\nyoungs_modulus = 2e9\n"
                     "poissons_ratio = 0.25\n[joint.default]\nnormal_stiffness = 5e8\n"
                     "friction_angle_deg = 45.0\n[output]\ninterval = 0.02\ncheckpoint_interval = 0.04\n";
  const int columns = 32;
  toml +=
      testing::block_toml("floor", testing::rectangle({-2.0, -1.0}, {columns + 3.0, 0.0}), "fixed = true");
  for (int row = 0; row < 26; ++row) {
    for (int column = 0; column < columns; ++column) {
      const Vec2 low{column + 0.5 * (row % 2), 0.5 * row};
      toml += testing::block_toml(
          fmt::format("b{}_{}", row, column), testing::rectangle(low, low + Vec2{1.0, 0.5}),
          fmt::format("fidelity = \"{}\"", (row + column) % 2 == 0 ? "deformable" : "rigid"));
    }
  }
  const std::string settle = "kind = \"settle\"\nlimit = 30.0\nsolver = \"static\"\n";
  return toml +
         "[support.layer]\nkind = \"liner\"\nthickness = 0.3\nyoungs_modulus = 5e9\n"
         "compressive_strength = 3e7\ntensile_strength = 2e6\n"
         "[support.thin]\nkind = \"liner\"\nthickness = 0.1\nyoungs_modulus = 5e9\n" +
         liner_toml("left", "[[0.25, 0.1], [0.25, 12.9]]", true) +
         liner_toml("top", "[[0.6, 13], [32.4, 13]]", true) +
         liner_toml("opening", "[[10.5, 2.5], [10.5, 3], [11.5, 3], [11.5, 2.5], [10.5, 2.5]]", false,
                    "thin") +
         "[[stage]]\nname = \"weight\"\n" + settle +
         "[[stage]]\nkind = \"excavate\"\nblocks = [\"b5_10\"]\n"
         "[[stage]]\nname = \"cut\"\n" +
         settle + "[[stage]]\nname = \"heavier\"\n" + settle +
         "set = { \"liner.opening.active\" = true, \"material.rock.density\" = 3000.0 }\n";
}

/// Sum of a column of history/liners.csv over the rows of its last time.
double last_sum(const fs::path &run, std::size_t column) {
  const std::vector<std::string> lines = testing::lines_of(testing::file_text(run / "history/liners.csv"));
  const std::string time = lines.back().substr(0, lines.back().find(','));
  double sum = 0.0;
  for (const std::string &line : lines) {
    std::istringstream cells(line);
    std::string cell;
    for (std::size_t k = 0; k <= column; ++k) {
      std::getline(cells, cell, ',');
    }
    sum += line.starts_with(time + ",") ? std::stod(cell) : 0.0;
  }
  return sum;
}

/// Run on all ranks, on one, and from the last checkpoint but one, or from the first that is there; all the
/// same.
class ThreeRuns {
public:
  explicit ThreeRuns(const Scene &scene) {
    const testing::CapturedLog log;
    EXPECT_EQ(run_scene(world, scene, {together(), false}), 0);
    world.barrier();
    if (world.is_root()) {
      fs::copy(together(), resumed(), fs::copy_options::recursive);
      std::vector<fs::path> checkpoints = checkpoint_files(resumed());
      EXPECT_EQ(checkpoints.size(), 2U);
      fs::remove(std::max(checkpoints.front(), checkpoints.back()));
    }
    world.barrier();
    EXPECT_EQ(restart_scene(world, scene, scene, resumed()), 0);
    world.barrier();
    if (!world.is_root()) {
      return;
    }
    EXPECT_EQ(run_scene(Communicator::self(), scene, {alone(), false}), 0);
    for (const fs::path &run : {together(), resumed()}) {
      for (const std::string &difference : compare_runs(run, alone())) {
        ADD_FAILURE() << run.filename() << ": " << difference;
      }
      EXPECT_EQ(testing::summary_text(run, "liners"), testing::summary_text(alone(), "liners"));
      EXPECT_EQ(testing::summary_text(run, "energy"), testing::summary_text(alone(), "energy"));
    }
    EXPECT_GE(summary_number(together(), "refreshes"), 1);
    if (world.size() > 1) {
      EXPECT_GE(summary_number(together(), "cross_rank_contacts"), 50);
    }
  }
  ~ThreeRuns() { world.barrier(); }
  ThreeRuns(const ThreeRuns &) = delete;
  ThreeRuns &operator=(const ThreeRuns &) = delete;

  [[nodiscard]] fs::path together() const { return folder_.path("together"); }
  [[nodiscard]] fs::path alone() const { return folder_.path("alone"); }
  [[nodiscard]] fs::path resumed() const { return folder_.path("resumed"); }

  const Communicator world = Communicator::world(); ///< collective to make

private:
  const testing::SharedFolder folder_{world};
};

constexpr std::size_t elements = 2; ///< columns of history/liners.csv
constexpr std::size_t cracked = 16;
constexpr std::size_t yielded = 17;
constexpr std::size_t broken = 18;

TEST(Liners, AreTheSameOnAnyNumberOfRanksAndThroughARestart) {
  const ThreeRuns runs(testing::scene_of(lined_wall_toml(), {"output.interval=0.01"}));
  if (!runs.world.is_root()) {
    return;
  }
  EXPECT_TRUE(fs::exists(runs.resumed() / "frames/liners_000002.hdf"));
  EXPECT_EQ(summary_number(runs.resumed(), "restarted_at"), 0.01);
  EXPECT_GE(last_sum(runs.alone(), elements), 40); // of the left and the upper face
  EXPECT_GE(last_sum(runs.alone(), cracked), 10);
  EXPECT_GE(last_sum(runs.alone(), yielded), 10);
  EXPECT_GE(last_sum(runs.alone(), broken), 5);
  EXPECT_LT(last_sum(runs.alone(), broken), last_sum(runs.alone(), elements));
  if (runs.world.size() > 1) {
    EXPECT_GE(summary_number(runs.together(), "migrations"), 1);
  }
}

TEST(Liners, AreTheSameInStaticStages) {
  const ThreeRuns runs(testing::scene_of(settling_wall_toml()));
  if (!runs.world.is_root()) {
    return;
  }
  EXPECT_EQ(testing::file_text(runs.alone() / "run.log").find("goes on with solver"), std::string::npos);
  EXPECT_GE(last_sum(runs.alone(), elements), 56);
  EXPECT_GE(last_sum(runs.alone(), 3), 1e4) << "thrust";
}

} // namespace
} // namespace gcpdda::liners_test
