// Bolts on many ranks: the same bytes as on one, through migration, refresh, stages and a restart.

#include "gcpdda/io/checkpoint.hpp"
#include "gcpdda/io/run_comparison.hpp"
#include "gcpdda/simulation/restart.hpp"
#include "gcpdda/simulation/run.hpp"
#include "shared_folder.hpp"
#include "support/run_facts.hpp"
#include "support/scenes.hpp"

#include <gtest/gtest.h>

#include <fmt/format.h>
#include <sstream>

namespace gcpdda::bolts_test {
namespace {

namespace fs = std::filesystem;
using testing::summary_number;

/// A thrown wall of rigid and deformable bricks that tears at grouted bolts through its courses and cables
/// right across it; half of them are put in, and one cable taken out, on the way. Steel yields and breaks.
std::string bolted_wall_toml() {
  std::string toml = testing::mixed_wall_toml(24, 14, 0.02);
  toml.erase(toml.find("duration"), std::string("duration = 0.02\n").size());
  toml += "[support.bolt]\nkind = \"grouted\"\naxial_stiffness = 4e8\naxial_yield = 3e5\nshear_stiffness = "
          "1e8\nshear_yield = 1e5\nactive_length = 0.2\nrupture_strain = 0.01\npretension = 5e4\n"
          "bond_strength = 4e5\nspacing = 2.0\n"
          "[support.cable]\nkind = \"anchored\"\naxial_rigidity = 2e8\naxial_yield = 4e5\npretension = 2e5\n";
  for (int k = 0; k < 12; ++k) {
    toml += fmt::format("[[bolt]]\nname = \"bolt{0}\"\nsupport = \"bolt\"\nfrom = [{1}, 23.6]\nto = [{2}, "
                        "0.4]\nactive = {3}\n",
                        k, 1.3 + 2 * k, 1.9 + 2 * k, k % 2 == 0);
  }
  for (int k = 0; k < 5; ++k) {
    toml += fmt::format(
        "[[bolt]]\nname = \"cable{0}\"\nsupport = \"cable\"\nfrom = [0.4, {1}]\nto = [26.2, {2}]\n", k,
        1.3 + 4 * k, 2.1 + 3.9 * k);
  }
  toml += "[[stage]]\nkind = \"run\"\nduration = 0.01\n"
          "[[stage]]\nkind = \"run\"\nduration = 0.01\nset = { \"bolt.cable2.active\" = false";
  for (int k = 1; k < 12; k += 2) {
    toml += fmt::format(", \"bolt.bolt{}.active\" = true", k);
  }
  return toml + " }\n";
}

/// Sum of a column of history/bolts.csv over the rows of its last time.
double last_sum(const fs::path &run, std::size_t column) {
  const std::vector<std::string> lines = testing::lines_of(testing::file_text(run / "history/bolts.csv"));
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

TEST(Bolts, AreTheSameOnAnyNumberOfRanksAndThroughARestart) {
  const Communicator world = Communicator::world();
  const testing::SharedFolder folder(world);
  const testing::CapturedLog log;
  const Scene scene = testing::scene_of(bolted_wall_toml(), {"output.interval=0.01"});
  const fs::path together = folder.path("together");
  const fs::path alone = folder.path("alone");
  const fs::path resumed = folder.path("resumed");
  EXPECT_EQ(run_scene(world, scene, {together, false}), 0);
  world.barrier();
  if (world.is_root()) { // back to the end of the first stage
    fs::copy(together, resumed, fs::copy_options::recursive);
    const std::vector<fs::path> checkpoints = checkpoint_files(resumed);
    EXPECT_EQ(checkpoints.size(), 2U);
    fs::remove(checkpoints.back());
  }
  world.barrier();
  EXPECT_EQ(restart_scene(world, scene, scene, resumed), 0);
  world.barrier();
  if (world.is_root()) {
    EXPECT_EQ(run_scene(Communicator::self(), scene, {alone, false}), 0);
    for (const fs::path &run : {together, resumed}) {
      for (const std::string &difference : compare_runs(run, alone)) {
        ADD_FAILURE() << run.filename() << ": " << difference;
      }
    }
    EXPECT_EQ(testing::summary_text(together, "energy"), testing::summary_text(alone, "energy"));
    EXPECT_EQ(summary_number(resumed, "restarted_at"), 0.01);
    constexpr std::size_t joints = 10;
    EXPECT_GE(last_sum(alone, joints), 100);
    EXPECT_GE(last_sum(alone, joints + 1), 20) << "yielded";
    EXPECT_GE(last_sum(alone, joints + 2), 5) << "broken";
    EXPECT_GE(summary_number(together, "refreshes"), 1);
    if (world.size() > 1) {
      EXPECT_GE(summary_number(together, "migrations"), 1);
      EXPECT_GE(summary_number(together, "cross_rank_contacts"), 50);
    }
  }
  world.barrier();
}

} // namespace
} // namespace gcpdda::bolts_test
