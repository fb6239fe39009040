// One rank and many write the same bytes. Each test also proves that there was something to get wrong: blocks
// in contact across ranks, blocks that changed their rank, neighbourhoods made anew.

#include "blockgen/region_cutter.hpp"
#include "io/results/frame_reader.hpp"
#include "io/results/run_comparison.hpp"
#include "model/contact_history.hpp"
#include "support/cut_region.hpp"
#include "support/run_facts.hpp"
#include "support/scenes.hpp"
#include "two_runs.hpp"

#include <gtest/gtest.h>

#include <fmt/format.h>
#include <memory>
#include <random>
#include <set>

namespace gcpdda::identity_test {
namespace {

namespace fs = std::filesystem;
using testing::expect_same_after_restart;
using testing::summary_number;
using testing::summary_text;
using testing::TwoRuns;

/// A wall of bricks in running bond, pressed together a little, thrown as a whole and each with a velocity of
/// its own: contacts in the middle of everything, whatever way the wall is cut.
std::string shaken_wall_toml(int rows, int columns, double duration) {
  const double squeeze = 0.004;
  std::string toml = testing::rock_toml(duration, duration / 2.0, "brick3_2");
  toml += testing::block_toml("floor", testing::rectangle({-2.0, -1.0}, {columns + 3.0, squeeze}),
                              "fixed = true");
  std::mt19937 random(4);
  const auto speed = [&](double most) { return most * (static_cast<double>(random()) / 2147483648.0 - 1.0); };
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const Vec2 low{column + 0.5 * (row % 2), 0.5 * row};
      const Vec2 high{low.x + 1.0 + squeeze, low.y + 0.5 + squeeze};
      const double vx = 4.0 + speed(2.0);
      const double vy = 2.0 + speed(2.0);
      toml += testing::block_toml(fmt::format("brick{}_{}", row, column), testing::rectangle(low, high),
                                  fmt::format("velocity = [{:.6g}, {:.6g}, {:.6g}]", vx, vy, speed(0.5)));
    }
  }
  return toml;
}

/// Bricks of a running bond that lie exactly on each other; bedding and upright joints are two families with
/// bonds.
std::string glued_wall_toml(int rows, int columns, double duration) {
  std::string toml = fmt::format("[run]\nduration = {}\nfidelity = \"rigid\"\ntime_step = 1e-4\n"
                                 "[material.rock]\ndensity = 2600.0\n"
                                 "[joint.default]\nnormal_stiffness = 2e8\nfriction_angle_deg = 30.0\n"
                                 "[joint.bedding]\ncohesion = 1e6\ntension = 5e5\n"
                                 "dilation_angle_deg = 8.0\ndilation_limit = 2e-3\n"
                                 "[joint.upright]\nnormal_stiffness = 4e8\ncohesion = 2e6\ntension = 1e6\n"
                                 "residual_friction_angle_deg = 20.0\n"
                                 "[output]\ninterval = 0.01\ncheckpoint_interval = 0.01\n",
                                 duration);
  std::mt19937 random(4);
  const auto speed = [&](double most) { return most * (static_cast<double>(random()) / 2147483648.0 - 1.0); };
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const Vec2 low{column + 0.5 * (row % 2), 0.5 * row};
      const double vx = 50.0 + speed(2.0);
      const double vy = 2.0 + speed(2.0);
      toml += testing::block_toml(
          fmt::format("brick{}_{}", row, column), testing::rectangle(low, low + Vec2{1.0, 0.5}),
          fmt::format("velocity = [{:.6g}, {:.6g}, 0]\n"
                      "edge_joints = [\"bedding\", \"upright\", \"bedding\", \"upright\"]",
                      vx, vy));
    }
  }
  return toml;
}

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

// Long and chaotic: one bit lost anywhere is seen at the end. Few contacts lie between two ranks at a time,
// but more than fifty come to lie there.
TEST(Identity, OfAFallingPile) {
  const TwoRuns runs(testing::scene_of(testing::falling_pile_toml(160, 1.6)));
  EXPECT_GE(runs.counted("refreshes"), 1);
  EXPECT_GE(runs.counted("contacts"), 100);
  EXPECT_EQ(ranks_with_blocks(runs.together()).size(), static_cast<std::size_t>(runs.world().size()));
  if (runs.world().size() > 1) {
    EXPECT_GE(runs.counted("migrations"), 100);
    EXPECT_GE(runs.counted("rebalances"), 2);
    EXPECT_GE(runs.counted("cross_rank_contacts_formed"), 50);
  }
}

// More than fifty contacts between ranks at a time, whatever way the wall is cut.
TEST(Identity, OfAShakenWall) {
  const TwoRuns runs(testing::scene_of(shaken_wall_toml(50, 25, 0.06)));
  EXPECT_GE(runs.counted("refreshes"), 1);
  EXPECT_GE(runs.counted("contacts"), 1000);
  if (runs.world().size() > 1) {
    EXPECT_GE(runs.counted("migrations"), 1);
    EXPECT_GE(runs.counted("cross_rank_contacts"), 50);
  }
}

/// Bonds in a frame of contacts.
std::int64_t num_bonds(const fs::path &folder, int frame) {
  const std::vector<std::uint8_t> states =
      read_contact_frame(folder / "frames" / fmt::format("contacts_{:06}.hdf", frame)).state;
  return std::count(states.begin(), states.end(), static_cast<std::uint8_t>(ContactState::bonded));
}

/// Broken bedding joints that slip has opened, in a frame of contacts.
std::int64_t num_dilated(const fs::path &folder, int frame, std::int32_t bedding) {
  const ContactFrameContent contacts =
      read_contact_frame(folder / "frames" / fmt::format("contacts_{:06}.hdf", frame));
  std::int64_t count = 0;
  for (std::size_t k = 0; k < contacts.state.size(); ++k) {
    const bool bonded = contacts.state[k] == static_cast<std::uint8_t>(ContactState::bonded);
    count += !bonded && contacts.joint[k] == bedding && contacts.slip[k] > 0.0 ? 1 : 0;
  }
  return count;
}

// Bricks glued to each other, thrown and torn apart: bonds of two families break while they migrate, and one
// family dilates then. A run that stops in the middle and goes on is the same.
TEST(Identity, OfAWallThatTearsApart) {
  const std::string toml = glued_wall_toml(52, 28, 0.02);
  const Scene scene = testing::scene_of(toml);
  const TwoRuns runs(scene);
  EXPECT_GE(runs.counted("refreshes"), 1);
  if (runs.world().size() > 1) {
    EXPECT_GE(runs.counted("migrations"), 1);
    EXPECT_GE(runs.counted("cross_rank_contacts"), 50);
  }
  const Scene half = testing::scene_of(toml, {"run.duration=0.01"});
  const testing::SharedFolder folder(runs.world());
  const testing::CapturedLog log;
  EXPECT_EQ(run_scene(runs.world(), half, {folder.path("run"), false}), 0);
  EXPECT_EQ(restart_scene(runs.world(), half, scene, folder.path("run")), 0);
  runs.world().barrier();
  if (runs.world().is_root()) {
    for (const std::string &difference : compare_runs(folder.path("run"), runs.alone())) {
      ADD_FAILURE() << "restarted: " << difference;
    }
    const std::int64_t at_start = num_bonds(runs.alone(), 0);
    const std::int64_t at_end = num_bonds(runs.alone(), 2);
    EXPECT_GE(at_start, 2000);
    EXPECT_LE(at_end, at_start - 200);
    EXPECT_GE(at_end, 200);
    EXPECT_GE(num_dilated(runs.alone(), 1, 1), 20) << "when it is stopped";
  }
}

// Rock slides out over the ends of its cross joints, which differ from its bedding in strength and stiffness:
// contacts take over the strength of other edges.
TEST(Identity, OfASlopeThatRunsOut) {
  Scene scene = testing::scene_of(R"(
[run]
duration = 0.4
fidelity = "rigid"
[material.rock]
density = 2600.0
[joint.default]
normal_stiffness = 2e8
friction_angle_deg = 30.0
[joint.bedding]
friction_angle_deg = 5.0
[joint.cross]
normal_stiffness = 1e8
friction_angle_deg = 40.0
[region]
material = "rock"
fixed = ["bottom", "left", "right"]
min_width = 0.2
[region.slope]
toe_length = 5.0
crest_length = 15.0
depth = 4.0
bench = [{height = 20.0, face_angle_deg = 65.0}]
[[joint_set]]
joint = "bedding"
dip_deg = 35.0
spacing = 0.9
[[joint_set]]
joint = "cross"
dip_deg = 110.0
spacing = 1.1
[output]
interval = 0.1
checkpoint_interval = 0.2
)");
  scene.region_blocks = std::make_shared<RegionCutter>(scene, 40);
  const TwoRuns runs(scene);
  EXPECT_GE(runs.counted("refreshes"), 1);
  if (runs.world().size() > 1) {
    EXPECT_GE(runs.counted("migrations"), 1);
    EXPECT_GE(runs.counted("cross_rank_contacts"), 50);
  }
  if (runs.world().is_root()) {
    constexpr double far = 0.1; // m: more than a tenth of half the width of any block but slivers
    const ContactFrameContent contacts = read_contact_frame(runs.alone() / "frames" / "contacts_000004.hdf");
    EXPECT_GE(std::ranges::count_if(contacts.slip, [](double slip) { return slip > far; }), 30);
  }
}

// Rigid, deformable, non-convex and driven blocks with friction; a monitored point.
TEST(Identity, OfAMixedWall) {
  const TwoRuns runs(testing::scene_of(testing::mixed_wall_toml(24, 14, 0.02)));
  EXPECT_GE(runs.counted("refreshes"), 1);
  EXPECT_GE(runs.counted("contacts"), 300);
  if (runs.world().size() > 1) {
    EXPECT_GE(runs.counted("migrations"), 1);
    EXPECT_GE(runs.counted("cross_rank_contacts"), 50);
  }
}

// The same, with what local damping takes within the step of a deformable block.
TEST(Identity, OfAMixedWallThatIsDamped) {
  const TwoRuns runs(testing::scene_of(testing::mixed_wall_toml(24, 14, 0.04), {"run.local_damping=0.3"}));
  EXPECT_GE(runs.counted("refreshes"), 1);
  EXPECT_GE(runs.counted("contacts"), 300);
  if (runs.world().size() > 1) {
    EXPECT_GE(runs.counted("migrations"), 1);
    EXPECT_GE(runs.counted("cross_rank_contacts"), 50);
  }
}

// Blocks go, those around are unloaded slowly, parameters change, and a verdict ends the run: all in flight,
// so that blocks of every kind cross the ranks meanwhile. Frames lose rows from one to the next.
TEST(Identity, OfAMixedWallInStages) {
  std::string toml = testing::mixed_wall_toml(24, 14, 0.02);
  toml.erase(toml.find("duration"), std::string("duration = 0.02\n").size());
  toml += "[[stage]]\nkind = \"run\"\nduration = 0.005\n"
          "[[stage]]\nkind = \"excavate\"\nregion = [[2, 2], [9, 2], [9, 8], [2, 8]]\nrelax = 0.004\n"
          "blocks = [\"l2_2\"]\n"
          "[[stage]]\nkind = \"run\"\nduration = 0.005\nset = { \"run.gravity\" = [1.0, -9.0], "
          "\"joint.default.normal_stiffness\" = 2e9, "
          "\"material.rock.density\" = 2000 }\n"
          "[[stage]]\nkind = \"run\"\nlimit = 0.08\nfailure_motion = 0.02\n";
  const TwoRuns runs(testing::scene_of(toml, {"output.interval=0.0025"}));
  EXPECT_GE(runs.counted("refreshes"), 1);
  EXPECT_GE(runs.counted("contacts"), 300);
  if (runs.world().size() > 1) {
    EXPECT_GE(runs.counted("migrations"), 1);
    EXPECT_GE(runs.counted("cross_rank_contacts"), 50);
  }
  if (runs.world().is_root()) {
    EXPECT_EQ(summary_text(runs.together(), "verdict"), "\"failed\"");
    EXPECT_EQ(summary_text(runs.together(), "stages"), summary_text(runs.alone(), "stages"));
    EXPECT_TRUE(fs::exists(runs.together() / "frames/topology_000003.h5"));
  }
}

// Blocks are held while another one falls, wake when it hits them, and are held again; rigid ones, or
// deformable ones on two ranks and on four.
TEST(Identity, OfBlocksThatAreHeld) {
  const std::string fidelity = Communicator::world().size() % 2 == 1 ? "rigid" : "deformable";
  const Scene scene = testing::scene_of(
      testing::falling_block_toml(fidelity, 32, 16, "interval = 0.5\ncheckpoint_interval = 0.5\n",
                                  "local_damping = 0.7\n"),
      {"joint.default.normal_stiffness=5e7"});
  const TwoRuns runs(scene);
  EXPECT_GE(runs.counted("refreshes"), 3);
  if (runs.world().size() > 1) {
    EXPECT_GE(runs.counted("cross_rank_contacts"), 50);
    EXPECT_GE(runs.counted("migrations"), 1);
  }
  expect_same_after_restart(runs, scene);
}

// Sixteen columns: only a few contacts can lie between ranks. Friction is lowered so that they slide, and
// leave their cells.
TEST(Identity, OfAToppledSlope) {
  const TwoRuns runs(testing::shipped_scene(
      "goodman_bray", {"run.duration=2.5", "run.gravity_ramp=0.2", "joint.default.friction_angle_deg=20",
                       "output.interval=0.5", "output.history_interval=0.25"}));
  EXPECT_GE(runs.counted("refreshes"), 10);
  EXPECT_GE(runs.counted("contacts"), 16);
  if (runs.world().size() > 1) {
    EXPECT_GE(runs.counted("migrations"), 1);
    EXPECT_GE(runs.counted("cross_rank_contacts"), runs.world().size() == 2 ? 1 : 2);
  }
}

// As it ships, under the consistent initial friction, whose sweeps cross the ranks.
TEST(Identity, OfAStandingSlope) {
  const TwoRuns runs(testing::shipped_scene(
      "goodman_bray", {"run.duration=0.2", "run.gravity_ramp=0", "output.interval=0.1"}));
  EXPECT_GE(runs.counted("contacts"), 20);
  if (runs.world().size() > 1) {
    EXPECT_GE(runs.counted("cross_rank_contacts"), 1);
  }
}

// The last frame of a stage with scaled masses is of the true ones, ghosts included: where edges have several
// laws, dashpots follow from both masses of a pair.
TEST(Identity, OfASlopeThatSettlesWithScaledMasses) {
  for (const std::string fidelity : {"rigid", "deformable"}) {
    Scene scene =
        testing::scene_of(testing::walked_slope_toml() + "[[stage]]\nkind = \"run\"\nduration = 0.5\n",
                          {"run.fidelity=" + fidelity, "stage.weight.mass_scaling=true",
                           "material.granite.youngs_modulus=40e9", "material.granite.poissons_ratio=0.25"});
    testing::prepare_region(scene);
    const TwoRuns runs(scene);
    if (runs.world().size() > 1) {
      EXPECT_GE(runs.counted("cross_rank_contacts"), 20);
    }
  }
}

// More ranks than blocks: those without work take part in everything all the same.
TEST(Identity, OfThreeBlocksOnAnyNumberOfRanks) {
  std::string toml = "[run]\nduration = 0.5\nfidelity = \"rigid\"\n[material.rock]\ndensity = 2600.0\n"
                     "[joint.default]\nnormal_stiffness = 2e8\n[output]\ninterval = 0.1\n"
                     "[[monitor]]\nblock = \"c\"\n";
  // a and c close in on b, and each comes from the other side of a border wherever it runs.
  toml += testing::block_toml("a", testing::random_polygon(1, 5, 0.6, {-1.4, 0.7}), "velocity = [3, 0, 1]");
  toml += testing::block_toml("floor", testing::rectangle({-6.0, -1.0}, {6.0, 0.0}), "fixed = true");
  toml += testing::block_toml("b", testing::random_polygon(2, 6, 0.6, {0.0, 0.8}), "velocity = [0, 0, -2]");
  toml += testing::block_toml("c", testing::random_polygon(3, 4, 0.6, {1.4, 0.7}), "velocity = [-3, 0, 4]");
  const TwoRuns runs(testing::scene_of(toml));
  const int num_ranks = runs.world().size();
  const auto occupied = static_cast<int>(ranks_with_blocks(runs.together()).size());
  EXPECT_LE(occupied, 3);
  EXPECT_GE(occupied, std::min(num_ranks, 2));
  EXPECT_EQ(occupied<num_ranks, num_ranks> 3);
  EXPECT_GE(runs.counted("contact_steps"), 100);
  EXPECT_GE(runs.counted("refreshes"), 1);
  if (num_ranks > 1) {
    EXPECT_GE(runs.counted("cross_rank_contacts"), 1);
  }
}

// What else steers a run: each setting that takes another way through the step.
TEST(Identity, OfEverySchemeAndSetting) {
  const std::string toml = shaken_wall_toml(8, 8, 0.02);
  for (const std::vector<std::string> &sets : std::vector<std::vector<std::string>>{
           {"run.scheme=newmark-dda"},
           {"run.scheme=central-difference", "run.potential=linear"},
           {"run.scheme=explicit-generalized-alpha", "run.spectral_radius=0.5"},
           {"run.contact_time=start", "run.initial_friction=zero"},
           {"run.contact_time=predictor-end", "output.contacts=false"},
           {"run.gravity_ramp=0.01", "run.contact_damping=0", "output.history_interval=0.005"},
           {"run.time_step=2e-3", "joint.default.normal_stiffness=2e7", "joint.default.cohesion=1e4"}}) {
    SCOPED_TRACE(sets.front());
    const TwoRuns runs(testing::scene_of(toml, sets));
    EXPECT_GE(runs.counted("contacts"), 30);
    if (runs.world().size() > 1) {
      EXPECT_GE(runs.counted("cross_rank_contacts"), 8);
    }
  }
}

// The comparison is not blind: another friction angle is another run.
TEST(Identity, IsNotAnsweredByEverything) {
  const Communicator world = Communicator::world();
  const testing::SharedFolder folder(world);
  const testing::CapturedLog log;
  const std::string toml = shaken_wall_toml(6, 6, 0.02);
  for (const char *angle : {"30", "30.0001"}) {
    const Scene scene = testing::scene_of(toml, {std::string("joint.default.friction_angle_deg=") + angle});
    EXPECT_EQ(run_scene(world, scene, {folder.path(angle), false}), 0);
  }
  world.barrier();
  if (world.is_root()) {
    EXPECT_FALSE(compare_runs(folder.path("30"), folder.path("30.0001")).empty());
  }
}

} // namespace
} // namespace gcpdda::identity_test
