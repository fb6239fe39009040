// In-situ stress: what the scene says of it, and that nothing moves when a run begins under it.

#include "contact/in_situ.hpp"

#include "simulation/simulation.hpp"
#include "support/contact_regions.hpp"
#include "support/regions.hpp"
#include "support/scenes.hpp"
#include "unit/scene_texts.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

namespace gcpdda::in_situ_test {
namespace {

using testing::block_toml;
using testing::rectangle;
using testing::scene_of;

const std::string rock = R"([material.rock]
density = 2600.0
youngs_modulus = 20e9
poissons_ratio = 0.25
)";

/// Rock 20 m by 16 m, 100 m below the surface, in a fixed frame.
struct Rock {
  std::string run = "fidelity = \"rigid\"";
  std::string joints = "[joint.default]\nnormal_stiffness = 5e9\nfriction_angle_deg = 40.0\n";
  std::string cuts = "[[voronoi]]\nsize = 2.0\nirregularity = 0.7\n";
  std::string in_situ = "[in_situ]\nlevel = 100.0\nk0 = 0.7\n";
  std::string stages = "";
  std::string sides = "fixed = [\"bottom\", \"left\", \"right\", \"top\"]\n";

  [[nodiscard]] Scene scene() const {
    Scene scene =
        scene_of("[run]\n" + (stages.empty() ? "duration = 1.0\n" : std::string()) + run + "\n" + rock +
                 joints + "[output]\ninterval = 0.02\n[region]\nmaterial = \"rock\"\n" +
                 "polygon = [[0, 0], [20, 0], [20, 16], [0, 16]]\n" + sides + cuts + in_situ + stages);
    scene.region_blocks = std::make_shared<RegionCutter>(scene, 40);
    return scene;
  }
};

struct Balance {
  double unbalanced = 0.0; ///< largest net force of a block over the largest contact force
  double stretching = 0.0; ///< largest net force on F of a deformable block, over that and the block's size
  double moved = 0.0;      ///< largest displacement, m
  double longest = 0.0;    ///< largest sqrt(area), m
};

Balance balance_of(Simulation &simulation) {
  const BlockSystem &blocks = simulation.blocks();
  Balance balance;
  double largest = 0.0;
  for (const RegionForce &force : testing::regions_of(simulation)) {
    largest = std::max(largest, norm(force.force));
  }
  for (std::size_t row = 0; row < blocks.num_owned; ++row) {
    const double size = std::sqrt(blocks.properties[row].area);
    balance.unbalanced =
        std::max(balance.unbalanced, norm(simulation.blocks().contact[row].force.u) / largest);
    if (blocks.is_deformable(row)) {
      const Mat2 net = blocks.deformation_of(row).contact.force - blocks.deformation_of(row).internal;
      balance.stretching = std::max(balance.stretching, norm(net) / (largest * size));
    }
    balance.moved = std::max(balance.moved, norm(blocks.displacement[row].u));
    balance.longest = std::max(balance.longest, size);
  }
  return balance;
}

struct Case {
  const char *name;
  Rock rock;
};

class InSitu : public ::testing::TestWithParam<Case> {};

// Overlaps of d = sigma/k_n = 3.2e6/5e9 = 0.64 mm lose a force of about d/l of a contact at each of its ends;
// the shortest of the larger contacts are half a metre long, and a block has six of them.
TEST_P(InSitu, NothingMovesWhenTheRunBegins) {
  Rock with = GetParam().rock;
  Simulation simulation(Communicator::self(), with.scene());
  const Balance begin = balance_of(simulation);
  EXPECT_LT(begin.unbalanced, 2e-3);
  EXPECT_LT(begin.stretching, 2e-3);
  for (int step = 0; step < 100; ++step) {
    simulation.step();
  }
  const Balance later = balance_of(simulation);
  EXPECT_LT(later.unbalanced, 3e-3);
  EXPECT_LT(later.moved, 0.02 * 0.64e-3) << "of the overlap";

  if (simulation.scene().run.gravity != Vec2{}) {
    with.in_situ.clear();
    with.sides = Rock{}.sides;
    Simulation without(Communicator::self(), with.scene());
    EXPECT_GT(balance_of(without).unbalanced, 0.99)
        << "no contact bears more than the block beside it weighs";
  }
}

const std::string two_laws = R"([joint.default]
normal_stiffness = 5e9
friction_angle_deg = 40.0
[joint.stiff]
normal_stiffness = 20e9
friction_angle_deg = 40.0
)";
const std::string sets = R"([[joint_set]]
dip_deg = 60
spacing = 2.0
joint = "stiff"
[[joint_set]]
dip_deg = -20
spacing = 1.7
)";

INSTANTIATE_TEST_SUITE_P(
    Unit, InSitu,
    ::testing::Values(
        Case{"Rigid", {}}, Case{"Deformable", {.run = "fidelity = \"deformable\""}},
        Case{"TwoLaws", {.joints = two_laws, .cuts = sets}},
        Case{"TwoLawsDeformable", {.run = "fidelity = \"deformable\"", .joints = two_laws, .cuts = sets}},
        Case{"MoreAcross", {.in_situ = "[in_situ]\nlevel = 100.0\nk0 = 1.5\n"}},
        Case{"SurfaceLoad", {.in_situ = "[in_situ]\nvertical_stress = 2e6\nlevel = 16.0\n"}},
        Case{"RotatedAxes",
             {.run = "fidelity = \"deformable\"\ngravity = [0, 0]",
              .in_situ = "[in_situ]\nprincipal_stresses = [3.2e6, 2e6]\nprincipal_angle_deg = 30.0\n"}},
        Case{"StressOnTop", {.sides = "fixed = [\"bottom\", \"left\", \"right\"]\nstress = [\"top\"]\n"}},
        Case{"StressAllAround",
             {.run = "fidelity = \"deformable\"\ngravity = [0, 0]",
              .in_situ = "[in_situ]\nprincipal_stresses = [3.2e6, 2e6]\nprincipal_angle_deg = 30.0\n",
              .sides = "stress = [\"bottom\", \"left\", \"right\", \"top\"]\n"}},
        Case{"Bonded",
             {.joints = "[joint.default]\nnormal_stiffness = 5e9\nfriction_angle_deg = 40.0\ncohesion = 1e6\n"
                        "tension = 1e5\n"}}),
    [](const auto &param) { return param.param.name; });

TEST(InSituStress, IsThatOfTheBlocks) {
  Rock rock_mass;
  rock_mass.run = "fidelity = \"deformable\"";
  Simulation simulation(Communicator::self(), rock_mass.scene());
  const BlockSystem &blocks = simulation.blocks();
  for (std::size_t row = 0; row < blocks.num_owned; ++row) {
    const double vertical = 2600.0 * 9.81 * (100.0 - blocks.centroid(row).y);
    const BlockProperties &block = blocks.properties[row];
    const auto by_contacts = contact_digest(simulation.state()).mean_stress(blocks, row);
    const Mat2 own = (1.0 / block.area) * blocks.deformation_of(row).internal;
    EXPECT_NEAR(own.yy, -vertical, 1e-9 * vertical);
    EXPECT_NEAR(own.xx, -0.7 * vertical, 1e-9 * vertical);
    EXPECT_NEAR(own.xy, 0.0, 1e-9 * vertical);
    // What the ends of its joints lack: about d/l of each.
    const double lacking = 8.0 * (vertical / 5e9) / std::sqrt(block.area) * vertical;
    EXPECT_NEAR(by_contacts[1], -vertical, lacking);
    EXPECT_NEAR(by_contacts[0], -0.7 * vertical, lacking);
    EXPECT_NEAR(by_contacts[2], 0.0, lacking);
  }
}

TEST(InSituStress, LeavesMassAreaAndFreeEdges) {
  const std::string toml =
      "[run]\nduration = 1.0\nfidelity = \"rigid\"\n" + rock +
      "[joint.default]\nnormal_stiffness = 1e8\n[in_situ]\nlevel = 1.0\nk0 = 0.0\nvertical_stress = 1e5\n" +
      block_toml("floor", rectangle({-1.0, -1.0}, {2.0, 0.0}), "fixed = true") +
      block_toml("block", rectangle({0.0, 0.0}, {1.0, 1.0}));
  Simulation simulation(Communicator::self(), scene_of(toml));
  const BlockSystem &blocks = simulation.blocks();
  const BlockProperties &block = blocks.properties[0];
  EXPECT_EQ(block.area, 1.0);
  EXPECT_EQ(block.mass, 2600.0);
  EXPECT_EQ(block.centroid, (Vec2{0.5, 0.5}));
  const std::vector<Vec2> vertices = current_vertices(blocks, 0);
  const double down = (1e5 + 2600.0 * 9.81) / 1e8; // all of it: the floor is fixed
  EXPECT_NEAR(vertices[0].y, -down, 1e-15);
  EXPECT_NEAR(vertices[1].y, -down, 1e-15);
  EXPECT_EQ(vertices[2].y, 1.0);
  EXPECT_NEAR(vertices[0].x, 0.0, 1e-15);
  bool told = false;
  for (const Diagnostic &note : simulation.notes()) {
    told = told || note.what == "an edge of block 'block' that touches nothing would have to bear 1e+05 Pa";
  }
  EXPECT_TRUE(told) << "the load on its top";
}

TEST(InSituStress, TellsOfJointsTooWeakForIt) {
  Rock weak;
  weak.joints = "[joint.default]\nnormal_stiffness = 5e9\nfriction_angle_deg = 2.0\n";
  Simulation simulation(Communicator::self(), weak.scene());
  ASSERT_FALSE(simulation.notes().empty());
  EXPECT_TRUE(simulation.notes().back().what.starts_with("joints are too weak for the in-situ shear"));
}

TEST(InSituStress, ThatWouldPullIsAFault) {
  Rock above;
  above.in_situ = "[in_situ]\nlevel = 10.0\n";
  EXPECT_THROW(Simulation(Communicator::self(), above.scene()), SceneError);
}

// Stiffness by the overlap that is allowed: that of the deepest in-situ stress.
TEST(InSituStress, IsWhatAnAllowedOverlapIsOf) {
  Rock by_overlap;
  by_overlap.joints = "[joint.default]\nallowed_overlap = 1e-3\nfriction_angle_deg = 40.0\n";
  by_overlap.cuts = "[[bricks]]\nblock_size = [2.0, 2.0]\nbond = 0.0\n";
  Simulation simulation(Communicator::self(), by_overlap.scene());
  EXPECT_NEAR(simulation.scene().joints.laws[0].normal_stiffness, 2600.0 * 9.81 * 100.0 / (1e-3 * 2.0), 1.0);
}

// A block held between two rollers by 1 MPa falls as if it were alone; between fixed sides it sticks.
TEST(Rollers, HoldTheirNormalAlone) {
  const std::string text = "[run]\nduration = 0.2\nfidelity = \"rigid\"\n" + rock +
                           "[joint.default]\nnormal_stiffness = 1e9\nfriction_angle_deg = 35.0\n"
                           "[in_situ]\nprincipal_stresses = [1e6, 0.0]\n[region]\nmaterial = \"rock\"\n"
                           "polygon = [[0, 0], [1, 0], [1, 2], [0, 2]]\nfixed_thickness = 3.0\n";
  for (const char *hold : {"roller", "fixed"}) {
    Scene scene = scene_of(text + hold + " = [\"left\", \"right\"]\n");
    scene.region_blocks = std::make_shared<RegionCutter>(scene, 40);
    Simulation simulation(Communicator::self(), scene);
    const bool rolls = hold == std::string("roller");
    EXPECT_EQ(simulation.blocks().num_fixed, 2U);
    const double pressed = testing::regions_of(simulation)[0].normal_force;
    EXPECT_NEAR(pressed, 2.0 * 1e6, 2.0 * 1e6 * 1e-3) << "d/l of its ends";
    while (!simulation.finished()) {
      simulation.step();
    }
    const RigidDof moved = simulation.blocks().displacement[0];
    EXPECT_NEAR(moved.u.y, rolls ? -0.5 * 9.81 * 0.04 : 0.0, rolls ? 1e-12 : 1e-4);
    EXPECT_NEAR(moved.u.x, 0.0, 1e-12);
    EXPECT_NEAR(moved.r, 0.0, 1e-12);
  }
}

struct BadInSitu {
  const char *name;
  std::string text;
  std::string expected; ///< behind "s.toml:"
  std::string run = "";
};

class BadInSituTable : public ::testing::TestWithParam<BadInSitu> {};

TEST_P(BadInSituTable, IsRefusedWithReasonAndHint) {
  const std::string text = GetParam().text + "\n[run]\nduration = 1.0\n" + GetParam().run +
                           "[material.rock]\ndensity = 2600\n[material.clay]\ndensity = 2000\n"
                           "[joint.default]\nnormal_stiffness = 1e9\n" +
                           block_toml("b", rectangle({0.0, 0.0}, {1.0, 1.0}));
  const std::vector<std::string> found = testing::messages(read_scene(text, "s.toml", {}));
  ASSERT_EQ(found.size(), 1U) << (found.empty() ? "" : found[1]);
  EXPECT_EQ(found[0], "s.toml:" + GetParam().expected);
}

INSTANTIATE_TEST_SUITE_P(
    Unit, BadInSituTable,
    ::testing::Values(
        BadInSitu{
            "Nothing", "[in_situ]\nk0 = 0.5",
            "1:1: error: [in_situ] gives no stress, it needs vertical_stress, principal_stresses or level, "
            "for example level = 100.0"},
        BadInSitu{"Both", "[in_situ]\nvertical_stress = 1e6\nprincipal_stresses = [1e6, 2e6]",
                  "3:22: error: [in_situ] gives vertical_stress and principal_stresses, each says all of the "
                  "stress at the level, leave one of them out"},
        BadInSitu{
            "Densities", "[in_situ]\nlevel = 10",
            "1:1: error: 'density' in [in_situ] is missing, the materials have different ones, that of the "
            "rock above, for example density = 2600"},
        BadInSitu{
            "AngleOfNothing", "[in_situ]\nvertical_stress = 1e6\nprincipal_angle_deg = 3",
            "3:23: error: 'principal_angle_deg' in [in_situ] has no meaning, it turns principal_stresses, "
            "leave it out"},
        BadInSitu{
            "DensityWithoutLevel", "[in_situ]\nvertical_stress = 1e6\ndensity = 2600",
            "3:11: error: 'density' in [in_situ] has no meaning, the stress grows with depth only below a "
            "level, leave it out"},
        BadInSitu{
            "Weightless", "[in_situ]\nlevel = 10\ndensity = 2600",
            "2:9: error: 'level' in [in_situ] has no meaning, without gravity there is no weight to bear, "
            "leave it out",
            "gravity = [0, 0]\n"},
        BadInSitu{
            "RollerAndFixed",
            "[region]\nmaterial = \"rock\"\npolygon = [[5, 0], [6, 0], [6, 1]]\n"
            "fixed = [\"left\"]\nroller = [\"left\"]",
            "5:11: error: the left side of [region] is fixed and a roller, a fixed side holds along itself "
            "too, leave it out of 'fixed' or of 'roller'"},
        BadInSitu{"StressOnAFixedSide",
                  "[in_situ]\nvertical_stress = 1e6\n[region]\nmaterial = \"rock\"\npolygon = [[5, 0], [6, "
                  "0], [6, 1]]\n"
                  "fixed = [\"top\"]\nstress = [\"top\"]",
                  "7:11: error: the top side of [region] is fixed and under stress, what holds it bears "
                  "whatever acts on "
                  "it, leave it out of 'fixed' or of 'stress'"},
        BadInSitu{
            "StressFromNowhere",
            "[region]\nmaterial = \"rock\"\npolygon = [[5, 0], [6, 0], [6, 1]]\nstress = [\"top\"]",
            "4:11: error: no stress acts on the top side of [region], the one of [in_situ] does, which is "
            "missing, for example [in_situ] with level = 100.0"},
        BadInSitu{
            "Ramp", "[in_situ]\nlevel = 10\ndensity = 2600",
            "6:16: error: 'gravity_ramp' in [run] has no meaning beside 'level' in [in_situ], the rock is in "
            "equilibrium under its whole weight, leave one of them out",
            "gravity_ramp = 0.5\n"},
        BadInSitu{
            "Negative", "[in_situ]\nvertical_stress = -1e6",
            "2:19: error: 'vertical_stress' in [in_situ] is -1000000, it must be at least 0 and at most "
            "1e+15, for example vertical_stress = 2.6e6"}),
    [](const auto &param) { return param.param.name; });

} // namespace
} // namespace gcpdda::in_situ_test
