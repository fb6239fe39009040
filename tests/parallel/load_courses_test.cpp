// Loads and stress on sides that stages change slowly: the same on any number of ranks, and through a restart
// in the middle of the change.

#include "blockgen/region_cutter.hpp"
#include "driver/restart.hpp"
#include "gcpdda/driver/run.hpp"
#include "io/results/run_comparison.hpp"
#include "shared_folder.hpp"
#include "support/run_facts.hpp"
#include "support/scenes.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>

namespace gcpdda::load_courses_test {
namespace {

namespace fs = std::filesystem;

/// Rock under stress on top and on the right, that grows while a first change of it is not over; on it
/// stand blocks that loads push from cell to cell.
Scene pushed_rock(const std::string &fidelity) {
  std::string toml = R"([run]
fidelity = ")" + fidelity +
                     R"("
[material.rock]
density = 2600.0
youngs_modulus = 5e9
poissons_ratio = 0.2
[joint.default]
normal_stiffness = 5e9
friction_angle_deg = 35.0
[region]
material = "rock"
polygon = [[-4, -4], [20, -4], [20, 8], [-4, 8]]
roller = ["bottom", "left"]
stress = ["right"]
min_width = 0.2
[[joint_set]]
dip_deg = 20.0
spacing = 0.7
[[joint_set]]
dip_deg = 100.0
spacing = 0.8
[in_situ]
principal_stresses = [1e6, 0.0]
[output]
interval = 0.005
checkpoint_interval = 0.012
)";
  for (int k = 0; k < 10; ++k) {
    toml += testing::block_toml(fmt::format("p{}", k), testing::rectangle({1.0 * k, 8.0}, {k + 1.0, 9.0}),
                                fmt::format("[[block.load]]\npoint = [{}, 8.5]\nforce = [1e7, 0.0]\n{}\n",
                                            k + 0.5,
                                            k % 2 == 0 ? "ramp = 0.004" : "table = [[0, 0], [0.004, 1]]"));
  }
  toml += R"([[stage]]
kind = "run"
duration = 0.01
[[stage]]
kind = "change"
ramp = 0.02
[stage.set]
"in_situ.principal_stresses" = [2e6, 1e5]
"region.stress" = ["right", "top"]
"block.p3.load" = [ { point = [3.5, 8.5], force = [5e6, 1e5] } ]
"block.p4.load" = [ { point = [4.2, 8.5], force = [6e6, 0.0], table = [[0, 1], [0.01, 2], [0.02, 0.5]] } ]
[[stage]]
kind = "run"
duration = 0.01
[[stage]]
kind = "run"
duration = 0.02
ramp = 0.03
set = { "in_situ.principal_stresses" = [3e6, 2e5], "block.p3.load" = [ { point = [3.5, 8.5], force = [0.0, 0.0] } ] }
)";
  Scene scene = testing::scene_of(toml);
  scene.region_blocks = std::make_shared<RegionCutter>(scene, 40);
  return scene;
}

void expect_same(const testing::SharedFolder &folder, const std::string &a, const std::string &b) {
  EXPECT_EQ(compare_runs(folder.path(a), folder.path(b)), std::vector<std::string>()) << a << " and " << b;
}

class LoadCourses : public ::testing::TestWithParam<const char *> {};

TEST_P(LoadCourses, AreTheSameOnAnyNumberOfRanksAndThroughARestart) {
  const Communicator world = Communicator::world();
  const testing::SharedFolder folder(world);
  const testing::CapturedLog log;
  const Scene scene = pushed_rock(GetParam());
  EXPECT_EQ(run_scene(world, scene, {folder.path("together"), false, false}), 0);
  if (world.is_root()) {
    EXPECT_EQ(run_scene(Communicator::self(), scene, {folder.path("alone"), false, false}), 0);
    expect_same(folder, "together", "alone");
    EXPECT_GE(testing::summary_number(folder.path("alone"), "contacts"), 200);
    EXPECT_GE(testing::summary_number(folder.path("together"), "refreshes"), 1);
    if (world.size() > 1) {
      EXPECT_GE(testing::summary_number(folder.path("together"), "cross_rank_contacts"), 50);
      EXPECT_GE(testing::summary_number(folder.path("together"), "migrations"), 1);
    }
    // Back into the second change.
    fs::copy(folder.path("alone"), folder.path("cut"), fs::copy_options::recursive);
    std::vector<fs::path> found;
    for (const fs::directory_entry &entry : fs::directory_iterator(folder.path("cut") / "checkpoints")) {
      found.push_back(entry.path());
    }
    std::sort(found.begin(), found.end());
    EXPECT_EQ(found.size(), 2U);
    fs::remove(found.back());
  }
  world.barrier();
  EXPECT_EQ(restart_scene(world, scene, scene, folder.path("cut")), 0);
  world.barrier();
  if (world.is_root()) {
    expect_same(folder, "alone", "cut");
    const double restarted_at = testing::summary_number(folder.path("cut"), "restarted_at");
    EXPECT_GT(restarted_at, 0.02);
    EXPECT_LT(restarted_at, 0.04);
  }
  world.barrier();
}

INSTANTIATE_TEST_SUITE_P(Kinds, LoadCourses, ::testing::Values("rigid", "deformable"),
                         [](const auto &kind) { return std::string(kind.param); });

} // namespace
} // namespace gcpdda::load_courses_test
