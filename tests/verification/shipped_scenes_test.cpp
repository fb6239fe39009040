// The scenes of run/scenes: that they are sound, and what is known of them, on the scene or a small one like
// it.

#include "problem.hpp"

#include "simulation/energy_ledger.hpp"
#include "support/cut_region.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace gcpdda::testing::shipped_scenes_test {
namespace {

/// With what cuts its region, if it has one.
Scene with_blocks(Scene scene) {
  prepare_region(scene);
  return scene;
}

/// All stages; the verdict of the last one that was begun.
Verdict last_verdict(Simulation &simulation) {
  run_stages(simulation, step);
  EXPECT_FALSE(simulation.fault().has_value());
  return simulation.stage_results().back().verdict;
}

// Read, checked and cut as by the program.
TEST(ShippedScenes, AreSound) {
  int count = 0;
  const std::filesystem::directory_iterator scenes(std::filesystem::path(GCPDDA_SOURCE_DIR) / "run" /
                                                   "scenes");
  for (const auto &entry : scenes) {
    if (entry.path().extension() == ".toml") {
      Scene scene = shipped_scene(entry.path().stem());
      const bool has_region = !scene.region.outline.empty();
      EXPECT_TRUE(has_region || !scene.blocks.empty()) << entry.path();
      const std::string name = entry.path().stem();
      if (has_region && !name.ends_with("_large")) {
        prepare_region(scene);
        EXPECT_GT(scene.region_blocks->make(0, scene.region_blocks->num_tiles()).blocks.size(), 0U)
            << entry.path();
      }
      ++count;
    }
  }
  EXPECT_GE(count, 14);
}

// slope_jointed with one bench: blocks above the bedding plane through the toe, which dips by 35 degrees,
// slide on it when its friction is smaller, and those below stay.
TEST(ShippedScenes, AJointedSlopeSlidesOnItsLowestBedding) {
  constexpr double dip = 35.0 * degree;
  const std::string scene = R"([run]
fidelity = "rigid"
gravity_ramp = 0.2
[material.rock]
density = 2600.0
[joint.default]
normal_stiffness = 1e9
friction_angle_deg = 45.0
[joint.bedding]
friction_angle_deg = 40.0
[region]
material = "rock"
fixed = ["bottom", "left", "right"]
min_width = 0.4
[region.slope]
toe_length = 5
crest_length = 12
depth = 4
[[region.slope.bench]]
height = 20
face_angle_deg = 72
[[joint_set]]
joint = "bedding"
dip_deg = 35
spacing = 4
origin = [0, 2]
[[joint_set]]
dip_deg = 85
dip_scatter = {kind = "normal", deviation_deg = 4}
spacing = 4.3
origin = [2, 0]
trace_length = 15
gap = 1
seed = 3
[output]
interval = 0.5
[[stage]]
kind = "settle"
limit = 20.0
[[stage]]
kind = "settle"
limit = 20.0
set = { "joint.bedding.friction_angle_deg" = 36.0 }
[[stage]]
kind = "run"
limit = 20.0
set = { "joint.bedding.friction_angle_deg" = 33.0 }
)";
  Simulation simulation(Communicator::self(), with_blocks(scene_of(scene)));
  EXPECT_EQ(last_verdict(simulation), Verdict::failed);
  ASSERT_EQ(simulation.stage_results().size(), 3U) << "it stands at 36 degrees";
  double lowest_moved = 1e9; // over that plane, m
  double highest_still = -1e9;
  const BlockSystem &blocks = simulation.blocks();
  for (std::size_t row = 0; row < blocks.num_owned; ++row) {
    const Vec2 centroid = blocks.properties[row].centroid;
    if (centroid.x < 0.0) { // before the slope
      continue;
    }
    const double height = std::cos(dip) * (centroid.y - 2.0) - std::sin(dip) * centroid.x;
    const double moved = norm(blocks.displacement[row].u);
    EXPECT_TRUE(moved < 0.01 || moved > 0.5) << moved;
    (moved > 0.5 ? lowest_moved : highest_still) =
        moved > 0.5 ? std::min(lowest_moved, height) : std::max(highest_still, height);
  }
  expect_above("C5 jointed slope, 33 degrees on bedding of 35: lowest block that slides, m above the plane",
               0.0, lowest_moved);
  expect_below("C5 jointed slope, 33 degrees on bedding of 35: highest block that stays, m above the plane",
               0.0, highest_still);
}

/// Six equal columns with smooth sides on a plane of 30 degrees, cut from a block of rock.
Verdict columns_on_a_plane(double height, const std::string &solver) {
  const Vec2 along{std::cos(30.0 * degree), std::sin(30.0 * degree)};
  const Vec2 up{-along.y, along.x};
  const std::vector<Vec2> rock{{}, 6.0 * along, 6.0 * along + height * up, height * up};
  std::string outline;
  for (const Vec2 v : rock) {
    outline += fmt::format("[{:.17g}, {:.17g}], ", v.x, v.y);
  }
  const std::string scene =
      R"([run]
fidelity = "rigid"
gravity_ramp = 0.5
[material.rock]
density = 2600.0
[joint.default]
normal_stiffness = 1e10
friction_angle_deg = 40.0
[joint.smooth]
normal_stiffness = 1e10
friction_angle_deg = 0.0
[output]
interval = 0.5
)" + block_toml("base", {-1.0 * up, 6.0 * along - 1.0 * up, 6.0 * along, {}}, "fixed = true") +
      fmt::format("[region]\nmaterial = \"rock\"\npolygon = [{}]\n[[joint_set]]\ndip_deg = 120\nspacing = 1\n"
                  "joint = \"smooth\"\n[[stage]]\nkind = \"settle\"\nlimit = 40.0\nsolver = \"{}\"\n",
                  outline, solver);
  Simulation simulation(Communicator::self(), with_blocks(scene_of(scene)));
  EXPECT_EQ(simulation.blocks().num_owned, 6U);
  return last_verdict(simulation);
}

// None pushes another before it topples by itself, at width/height = tan 30 degrees. The corner that a column
// turns about sinks in: some per cent. With rough sides columns that press on each other could stand higher.
TEST(ShippedScenes, EqualColumnsToppleWhereOneDoes) {
  const double limit = 1.0 / std::tan(30.0 * degree);
  for (const char *solver : {"static", "dynamic"}) {
    EXPECT_EQ(columns_on_a_plane(0.95 * limit, solver), Verdict::settled) << solver;
    EXPECT_EQ(columns_on_a_plane(1.03 * limit, solver), Verdict::failed) << solver;
  }
}

/// masonry_wall, one brick wide and ten courses high: without a stair it overturns as one.
Verdict pier_tilted_by(double degrees) {
  const std::string pier = "region.polygon=[[0, 0], [0.4, 0], [0.4, 2.0], [0, 2.0]]";
  Scene scene = shipped_scene("masonry_wall", {pier, "joint.default.normal_stiffness=2e10",
                                               fmt::format("run.gravity=[{:.17g}, {:.17g}]",
                                                           -earth_gravity * std::sin(degrees * degree),
                                                           -earth_gravity * std::cos(degrees * degree))});
  scene.monitors.clear();
  scene.stages.resize(1); // gravity is tilted from the start
  Simulation simulation(Communicator::self(), with_blocks(std::move(scene)));
  return last_verdict(simulation);
}

TEST(ShippedScenes, APierOfBricksOverturnsAtItsSlenderness) {
  const double limit = std::atan(0.4 / 2.0) / degree;
  EXPECT_EQ(pier_tilted_by(0.88 * limit), Verdict::settled);
  EXPECT_EQ(pier_tilted_by(1.01 * limit), Verdict::failed);
}

// One wedge bears 1.1 of its weight, the other 0.9: it falls when gravity has come to that.
TEST(ShippedScenes, ARoofWedgeFallsUnderItsPullOutLoad) {
  Simulation simulation(Communicator::self(), shipped_scene("wedge_roof"));
  const auto block = [&](const std::string &name) {
    const auto &all = simulation.scene().blocks;
    return static_cast<int>(
        std::find_if(all.begin(), all.end(), [&](const SceneBlock &b) { return b.name == name; }) -
        all.begin());
  };
  const int falling = block("falls");
  while (!simulation.finished() && velocity_of(simulation, falling).u.y > -1e-3) {
    step(simulation);
  }
  const double share = simulation.time() / simulation.scene().run.gravity_ramp;
  // The speed is reached some hundredths of a second after the slip.
  expect_value("C4 roof wedge of 0.9 of the pull-out load: gravity at which it falls over the full one", 0.9,
               share * share * (3.0 - 2.0 * share), 5e-3);
  run(simulation);
  expect_below("C4 roof wedge of 1.1 of the pull-out load: sinking, m", 1e-3,
               -displacement_of(simulation, block("held")).u.y);
}

// Impacts, friction and dashpots only take energy: the sum never rises by more than rounding beside the
// energy that was there to be lost, and but for the error of the steps in the impacts the ledger knows what
// took it.
TEST(ShippedScenes, FallingRocksNeverGainEnergy) {
  Simulation simulation(Communicator::self(), shipped_scene("rockfall", {"run.duration=4.0"}));
  const EnergyLedger ledger(simulation.state());
  const auto total = [&] {
    const EnergyRow row = ledger.row(simulation.state());
    return row.kinetic + row.strain + row.contact_normal + row.contact_stick + row.gravity;
  };
  const double start = total();
  double least = start;
  double risen = 0.0;
  while (!simulation.finished()) {
    for (int k = 0; k < 50 && !simulation.finished(); ++k) {
      step(simulation);
    }
    const double now = total();
    risen = std::max(risen, now - least);
    least = std::min(least, now);
  }
  EXPECT_FALSE(simulation.fault().has_value());
  expect_above("A6 rockfall: energy lost in 4 s, J/m", 1e6, start - least);
  expect_below("A6 rockfall: largest gain of energy over the energy lost", 1e-6, risen / (start - least));
  expect_below("A6 rockfall: residual over the energy lost", 2e-3,
               std::abs(ledger.row(simulation.state()).residual) / (start - least));
}

} // namespace
} // namespace gcpdda::testing::shipped_scenes_test
