// A slope whose sides become viscous when it begins to shake: the same on any number of ranks, and through a
// restart in the middle of the shaking.

#include "blockgen/region_cutter.hpp"
#include "driver/restart.hpp"
#include "gcpdda/driver/run.hpp"
#include "io/results/run_comparison.hpp"
#include "shared_folder.hpp"
#include "support/run_facts.hpp"
#include "support/scenes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

namespace gcpdda::earthquake_test {
namespace {

namespace fs = std::filesystem;

Scene shaken_slope(const std::string &fidelity) {
  Scene scene = testing::scene_of(R"([run]
fidelity = ")" + fidelity + R"("
rayleigh = { ratio = 0.2, frequency = 20.0 }
[material.rock]
density = 2600.0
youngs_modulus = 5e8
poissons_ratio = 0.2
[joint.default]
normal_stiffness = 1e9
friction_angle_deg = 35.0
[region]
material = "rock"
polygon = [[0, 0], [24, 0], [24, 14], [14, 14], [8, 5], [0, 5]]
fixed = ["bottom"]
roller = ["left", "right"]
min_width = 0.4
[[joint_set]]
dip_deg = 20.0
spacing = 1.3
[[joint_set]]
dip_deg = 100.0
spacing = 1.5
trace_length = 6.0
gap = 1.0
[earthquake]
record = "in memory"
stage = "shaking"
viscous = ["bottom", "left", "right"]
[output]
interval = 0.02
checkpoint_interval = 0.011
[[stage]]
kind = "run"
duration = 0.02
[[stage]]
name = "shaking"
kind = "run"
duration = 0.03
set = { "run.rayleigh" = { ratio = 0.05, frequency = 20.0 } }
)");
  for (int k = 0; k <= 20; ++k) {
    const double t = 0.002 * k;
    scene.earthquake.record.push_back({t, {0.4 * std::sin(150.0 * t), 0.2 * std::sin(90.0 * t)}});
  }
  scene.region_blocks = std::make_shared<RegionCutter>(scene, 40);
  return scene;
}

void expect_same(const testing::SharedFolder &folder, const std::string &a, const std::string &b) {
  EXPECT_EQ(compare_runs(folder.path(a), folder.path(b)), std::vector<std::string>()) << a << " and " << b;
}

class Earthquake : public ::testing::TestWithParam<const char *> {};

TEST_P(Earthquake, IsTheSameOnAnyNumberOfRanksAndThroughARestart) {
  const Communicator world = Communicator::world();
  const testing::SharedFolder folder(world);
  const testing::CapturedLog log;
  const Scene scene = shaken_slope(GetParam());
  EXPECT_EQ(run_scene(world, scene, {folder.path("together"), false, false}), 0);
  if (world.is_root()) {
    EXPECT_EQ(run_scene(Communicator::self(), scene, {folder.path("alone"), false, false}), 0);
    expect_same(folder, "together", "alone");
    EXPECT_GE(testing::summary_number(folder.path("alone"), "contacts"), 100);
    EXPECT_GT(testing::summary_number(folder.path("alone"), "permanent_displacement"), 1e-4);
    EXPECT_EQ(testing::summary_number(folder.path("alone"), "fixed_blocks"), 0);
    if (world.size() > 1) {
      EXPECT_GE(testing::summary_number(folder.path("together"), "cross_rank_contacts"), 20);
      EXPECT_GE(testing::summary_number(folder.path("together"), "refreshes"), 1);
    }
    // Back into the shaking.
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
    EXPECT_LT(restarted_at, 0.05);
    EXPECT_EQ(testing::summary_text(folder.path("cut"), "permanent_displacement"),
              testing::summary_text(folder.path("alone"), "permanent_displacement"));
  }
  world.barrier();
}

INSTANTIATE_TEST_SUITE_P(Kinds, Earthquake, ::testing::Values("rigid", "deformable"),
                         [](const auto &kind) { return std::string(kind.param); });

} // namespace
} // namespace gcpdda::earthquake_test
