// Which law a contact takes where edges belong to joint families, and what it costs where none does.

#include "contact/laws/region_law.hpp"

#include "contact/stiffness_bound.hpp"
#include "gcpdda/io/scene_reader.hpp"
#include "parallel/packing.hpp"
#include "simulation/energy_ledger.hpp"
#include "simulation/simulation.hpp"
#include "support/blocks.hpp"
#include "support/scenes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace gcpdda::region_law_test {
namespace {

using namespace testing;

constexpr std::int32_t smooth = 1;
constexpr std::int32_t rough = 2;
constexpr std::int32_t smooth_and_glued = 3;

/// A default, and families that differ in stiffness too.
JointLaws families() {
  JointLaws joints = one_law(1e6, 0.9);
  joints.laws.resize(4, joints.laws.front());
  joints.laws[smooth].tan_friction = 0.1;
  joints.laws[smooth].normal_stiffness = 2e6;
  joints.laws[rough].tan_friction = 0.7;
  joints.laws[rough].normal_stiffness = 4e6;
  joints.laws[smooth_and_glued].tan_friction = 0.1;
  joints.laws[smooth_and_glued].cohesion = 10.0;
  for (JointLaw &law : joints.laws) {
    law.is_on_edges = true;
  }
  return joints;
}

const std::vector<Vec2> plane = rectangle({-5.0, -1.0}, {5.0, 0.0});

TEST(RegionLaw, OfTwoEdgesIsTheWeakerWhicheverBlockHasIt) {
  const JointLaws joints = families();
  EXPECT_EQ(joints.of_edges(-1, -1, 0), 0);
  EXPECT_EQ(joints.of_edges(rough, -1, 0), rough);
  EXPECT_EQ(joints.of_edges(-1, rough, 0), rough);
  for (const auto &[a, b, weaker] : {std::tuple(smooth, rough, smooth), {smooth, smooth_and_glued, smooth}}) {
    EXPECT_EQ(joints.of_edges(a, b, 0), weaker);
    EXPECT_EQ(joints.of_edges(b, a, 0), weaker);
  }
  JointLaws alike = joints;
  alike.laws[rough] = alike.laws[smooth];
  EXPECT_EQ(alike.of_edges(rough, smooth, 0), smooth) << "the first in the scene";
}

// A brick on its lower face, and then on its right one: each face has a family.
TEST(RegionLaw, OfTheEdgesThatCarryAndItsConstantsHold) {
  const double depth = 1e-3;
  const BlockSystem system = system_of({rectangle({0.0, -depth}, {1.0, 1.0 - depth})}, {plane});
  for (const bool turned : {false, true}) {
    ContactBench bench(with_edges(system, {{smooth, rough, -1, -1}, {}}), families());
    ASSERT_TRUE(bench.candidates.pairs[0].is_mixed);
    EXPECT_EQ(bench.candidates.plain.size(), 1U);
    if (turned) {
      bench.system.trial[0].r = -0.5 * std::numbers::pi;
    }
    bench.evaluate();
    const JointLaw &law = bench.forces.parameters().joints.laws[turned ? rough : smooth];
    EXPECT_EQ(bench.memory().law, turned ? rough : smooth);
    // (2 p_n l d/H)(1 - d/(2l)) = k_n l d (1 - d/2) with l = 1 [method: flush joint on a wider face]; depth
    // and turn are rounded.
    const double normal = law.normal_stiffness * depth * (1.0 - 0.5 * depth);
    EXPECT_NEAR(bench.seen.normal_force, normal, 1e-12 * normal / depth);
    EXPECT_NEAR(bench.seen.cap, law.tan_friction * bench.seen.normal_force, 1e-9);
  }
}

// It rolls over its edge without losing touch.
TEST(RegionLaw, StrengthFollowsTheEdgesAndStiffnessStays) {
  const BlockSystem system = system_of({rectangle({-0.5, -0.5}, {0.5, 0.5})}, {plane});
  const JointLaws joints = families();
  ContactBench bench(with_edges(system, {{smooth, rough, -1, -1}, {}}), joints);
  const auto put = [&](double angle, double sunk) {
    bench.system.trial[0] = {{0.0, 0.5 * (std::abs(std::cos(angle)) + std::abs(std::sin(angle))) - sunk},
                             angle};
    bench.evaluate();
  };
  for (int k = 0; k <= 20; ++k) { // clockwise, on to the right face; on the corner at 10
    put(-0.025 * std::numbers::pi * k, 1e-3);
    ASSERT_EQ(testing::memories(bench.history).size(), 1U);
    EXPECT_EQ(joints.stiffness(bench.memory().law).normal_stiffness, joints.laws[smooth].normal_stiffness)
        << k;
    if (k < 10 || k > 11) { // seen anew after a tenth of half the width, 0.05 m; a step slides by 0.08 m
      EXPECT_EQ(joints.named(bench.memory().law), k < 10 ? smooth : rough) << k;
    }
  }
  EXPECT_NEAR(bench.seen.cap, joints.laws[rough].tan_friction * bench.seen.normal_force, 1e-9);
  put(-0.5 * std::numbers::pi, -1e-3);
  EXPECT_TRUE(testing::memories(bench.history).empty());
  put(-0.5 * std::numbers::pi, 1e-3);
  EXPECT_EQ(bench.memory().law, rough) << "with both of it";
}

// A pillar that has come off the rock along a tunnel's wall, both pressed together by 1 mm: the end of the
// wall at the upper level joint is a region of its own in one place and a part of the wall's in the next one,
// a micrometre away. With the stiffness of the level joint it would change the force by an eighth more than
// the motion does, each time.
TEST(RegionLaw, RegionThatComesOffAnotherKeepsItsStiffness) {
  const std::vector<Vec2> pillar{
      {13.69621116, 10.77211479}, {17.11491135, 9.78970875},  {17.16887967, 9.83112033},
      {17.65632182, 10.46637188}, {17.96273886, 11.20613652}, {18.06724946, 12.0},
      {17.96273208, 12.79386167}, {17.9506511, 12.82302742},  {14.59741705, 13.7574947}};
  const std::vector<Vec2> wall{
      {17.11390501, 9.78999793},  {18.50259689, 9.39094005},  {19.41540203, 12.41483587},
      {17.94965325, 12.8233055},  {17.96193736, 12.79364872}, {18.06641969, 12.0},
      {17.96193058, 11.20635309}, {17.65559148, 10.46679355}, {17.16827937, 9.83172063}};
  ContactBench bench(with_edges(system_of({pillar}, {wall}), {{smooth, -1, -1, -1, -1, -1, -1, smooth, -1},
                                                              {smooth, -1, smooth, -1, -1, -1, -1, -1, -1}}),
                     families());
  const auto force_at = [&](double height, std::size_t num_regions) {
    bench.system.trial[0].u.y = height;
    bench.evaluate();
    EXPECT_EQ(bench.regions.all().size(), num_regions) << height;
    double sum = 0.0;
    for (const RegionForce &region : bench.regions.all()) {
      sum += region.normal_force;
    }
    return sum;
  };
  force_at(0.0, 8);
  force_at(2e-6, 7);
  const double high = force_at(2e-6, 7);
  const double middle = force_at(1e-6, 7);
  const double low = force_at(0.0, 8);
  // The force is linear in the depth, but for faces of 1 m that become shorter by a micrometre.
  EXPECT_NEAR(low - middle, middle - high, 1e-3 * (middle - high));
}

TEST(RegionLaw, ContactThatHasSlidToAnAlikeStiffLawIsOneOfThat) {
  JointLaws joints = families();
  EXPECT_EQ(joints.slid_to(smooth, smooth), smooth);
  const std::int32_t mixed = joints.slid_to(smooth, rough);
  EXPECT_EQ(joints.slid_to(mixed, smooth), smooth);
  EXPECT_EQ(joints.slid_to(mixed, rough), mixed);
  EXPECT_EQ(joints.slid_to(mixed, 0), joints.slid_to(smooth, 0));
  EXPECT_EQ(joints.constants(mixed).half_stiffness, 0.5 * joints.laws[smooth].normal_stiffness);
  EXPECT_EQ(joints.constants(mixed).tan_friction, joints.laws[rough].tan_friction);
  EXPECT_EQ(joints.all_constants().at(static_cast<std::size_t>(mixed)).cohesion, joints.laws[rough].cohesion);
  joints.laws[rough].normal_stiffness = joints.laws[smooth].normal_stiffness;
  EXPECT_EQ(joints.slid_to(smooth, rough), rough);
}

// A block that slides out over the corner of another one is met there first by the upright joint between the
// two, which is rough, and lies on a smooth base from then on. Convex and not, as these are evaluated in two
// ways.
TEST(RegionLaw, BlockThatSlidesOutOverACornerHasTheStrengthOfItsBase) {
  const double sunk = 1e-3;
  const std::vector<Vec2> below = rectangle({-1.0, -1.0}, {0.0, 0.0});
  const std::vector<Vec2> brick = rectangle({-1e-4, -sunk}, {1.0, 1.0});
  const std::vector<Vec2> with_a_notch{{-1e-4, -sunk}, {1.0, -sunk}, {1.0, 1.0}, {0.5, 0.5}, {-1e-4, 1.0}};
  const std::vector<std::int32_t> on_below{-1, rough, smooth, -1};
  for (const std::vector<Vec2> &above : {brick, with_a_notch}) {
    std::vector<std::int32_t> on_above(above.size(), -1);
    on_above.front() = smooth;
    on_above.back() = rough;
    ContactBench bench(with_edges(system_of({below, above}, {}), {on_below, on_above}), families());
    EXPECT_EQ(bench.candidates.plain.size(), above.size() == 4 ? 1U : 0U);
    ContactBench all_rough(
        with_edges(system_of({below, above}, {}),
                   {std::vector<std::int32_t>(4, rough), std::vector<std::int32_t>(above.size(), rough)}),
        families());
    for (int k = 0; k <= 100; ++k) {
      bench.system.trial[1].u.x = -1e-3 * k;
      all_rough.system.trial[1].u.x = -1e-3 * k;
      bench.evaluate();
      all_rough.evaluate();
      const bool is_on_base = k > 10; // ten times as far as it has sunk
      const double friction = families().laws[is_on_base ? smooth : rough].tan_friction;
      // Depths are rounded in coordinates of a metre.
      const double rounding = 1e-15 / sunk * 10.0 * all_rough.seen.normal_force;
      EXPECT_NEAR(bench.seen.normal_force, all_rough.seen.normal_force, rounding) << k;
      if (k == 0 || is_on_base) {
        EXPECT_NEAR(bench.seen.cap, friction * all_rough.seen.normal_force, rounding) << k;
      }
    }
  }
}

TEST(RegionLaw, PairsWhoseEdgesLeadToOneLawAreAsWithoutFamilies) {
  const std::vector<std::vector<Vec2>> bricks{rectangle({0.0, 0.0}, {1.0, 1.0}),
                                              rectangle({0.0, 0.999}, {1.0, 2.0})};
  const std::vector<std::int32_t> all_rough(4, rough);
  const std::vector<std::int32_t> bedded{rough, -1, rough, -1};
  const ContactBench one(with_edges(system_of(bricks, {}), {all_rough, bedded}), families());
  EXPECT_FALSE(one.candidates.pairs[0].is_mixed);
  EXPECT_EQ(one.candidates.pairs[0].law, rough);
  EXPECT_EQ(one.candidates.plain.size(), 1U);
  const ContactBench two(with_edges(system_of(bricks, {}), {bedded, bedded}), families());
  EXPECT_TRUE(two.candidates.pairs[0].is_mixed) << "the upright sides are of the default";
}

TEST(RegionLaw, BoundTakesTheStiffestLawThatTheEdgesCanMeet) {
  JointLaws joints = families();
  EXPECT_EQ(stiffness_bound(joints, 0).normal, 4e6) << "an edge without a law may meet any family";
  EXPECT_EQ(stiffness_bound(joints, 0, std::vector{smooth, smooth}).normal, 2e6) << "the weaker one holds";
  EXPECT_EQ(stiffness_bound(joints, 0, std::vector{smooth, -1}).normal, 4e6);
  for (JointLaw &law : joints.laws) {
    law.is_on_edges = false;
  }
  EXPECT_EQ(stiffness_bound(joints, 0).normal, 1e6) << "nobody has a family";
}

TEST(EdgeJoints, TravelWithTheirRowAndCostNothingElse) {
  const BlockSystem bare = system_of({plane, plane}, {});
  const BlockSystem joined = with_edges(bare, {{}, {smooth, -1, rough, -1}});
  EXPECT_TRUE(bare.edge_joint.empty());
  Bytes bare_message;
  Bytes message;
  for (const std::size_t row : {0U, 1U}) {
    pack_row(bare, row, bare_message);
    pack_row(joined, row, message);
  }
  EXPECT_EQ(message.size(), bare_message.size() + 4 * sizeof(std::int32_t));
  BlockSystem arrived;
  unpack_rows(message, arrived);
  EXPECT_EQ(arrived.edge_joint, joined.edge_joint);
  EXPECT_TRUE(arrived.edge_joints(0).empty());
  ASSERT_EQ(arrived.edge_joints(1).size(), 4U);
  EXPECT_EQ(arrived.edge_joints(1)[2], rough);
  keep_rows(arrived, 1);
  EXPECT_EQ(arrived.edge_joint.size(), 4U);
  append_row(arrived, joined, 1);
  EXPECT_EQ(arrived.edge_joint, joined.edge_joint);
}

/// Largest |residual| of a square that bounces on one face of another one, over its energy at first.
/// @param joints  of the edges of the lower square, from the bottom one on
double bounce_residual(const std::string &joints, std::int32_t expected_law) {
  const std::string toml =
      R"([run]
duration = 0.1
time_step = 1e-4
gravity = [0, 0]
contact_damping = 0.0
fidelity = "rigid"
[material.rock]
density = 2500
[joint.default]
normal_stiffness = 1e8
friction_angle_deg = 0
[joint.soft]
normal_stiffness = 1e7
friction_angle_deg = 0
)" + block_toml("floor", rectangle({-1.0, -1.0}, {2.0, 0.0}), "fixed = true\nedge_joints = " + joints) +
      block_toml("square", rectangle({0.0, 1e-3}, {1.0, 1.001}), "velocity = [0.0, -1.0, 0.0]");
  Simulation simulation(Communicator::self(), scene_of(toml));
  EXPECT_TRUE(simulation.candidates().pairs.at(0).is_mixed);
  EnergyLedger ledger(simulation.state());
  double largest = 0.0;
  bool has_touched = false;
  while (!simulation.finished()) {
    simulation.step();
    if (!simulation.candidates().pairs.empty() && simulation.history().has_plain(0)) {
      EXPECT_EQ(simulation.history().plain[0].law, expected_law);
      has_touched = true;
    }
    largest = std::max(largest, std::abs(ledger.row(simulation.state()).residual));
  }
  EXPECT_TRUE(has_touched);
  EXPECT_GT(simulation.blocks().velocity[0].u.y, 0.9) << "it has bounced";
  return largest / (0.5 * 2500.0);
}

// The ledger is off by the square of omega dt = 0.02 at most, of the stiffer law.
TEST(EdgeJoints, EachRegionHasTheEnergyOfItsOwnLaw) {
  EXPECT_LT(bounce_residual(R"(["soft", "", "", ""])", 0), 0.02 * 0.02);
  EXPECT_LT(bounce_residual(R"(["", "", "soft", ""])", 1), 0.02 * 0.02);
}

TEST(EdgeJoints, TurnRoundWithAnOutlineGivenClockwise) {
  const std::string head = rock_toml(1.0, 0.1, "a") + "[joint.s]\ncohesion = 1\n[joint.r]\ncohesion = 2\n";
  const Scene scene =
      scene_of(head + block_toml("a", {{0, 0}, {1, 0}, {1, 1}}, "edge_joints = [\"s\", \"r\", \"\"]") +
               block_toml("b", {{0, 0}, {1, 1}, {1, 0}}, "edge_joints = [\"\", \"r\", \"s\"]"));
  EXPECT_EQ(scene.blocks[0].edge_joint, (std::vector<std::int32_t>{1, 2, -1}));
  EXPECT_EQ(scene.blocks[1].vertices, scene.blocks[0].vertices);
  EXPECT_EQ(scene.blocks[1].edge_joint, scene.blocks[0].edge_joint);
}

} // namespace
} // namespace gcpdda::region_law_test
