// Impedances of viscous sides against closed forms of jointed rock.

#include "blockgen/region_cutter.hpp"
#include "simulation/simulation.hpp"
#include "support/scenes.hpp"

#include <gtest/gtest.h>

#include <fmt/format.h>

#include <cmath>
#include <memory>

namespace gcpdda::testing::side_rock_test {
namespace {

constexpr double density = 2500.0;
constexpr double normal = 1e9;     ///< stiffness of the named law, Pa/m
constexpr double tangential = 4e8; ///< Pa/m
constexpr double youngs_modulus = 3e9;
constexpr double poissons_ratio = 0.25;
constexpr double width = 24.0;

/// Impedances of the bottom of a square of rock.
Impedance of_bottom(const std::string &joint_sets, const std::string &fidelity = "rigid",
                    const std::string &earthquake = "") {
  Scene scene = scene_of(
      fmt::format("[run]\nduration = 1.0\nfidelity = \"{0}\"\n"
                  "[material.rock]\ndensity = {1}\nyoungs_modulus = {2}\npoissons_ratio = {3}\n"
                  "[joint.default]\nnormal_stiffness = 1e8\nfriction_angle_deg = 45.0\n"
                  "[joint.bed]\nnormal_stiffness = {4}\ntangential_ratio = {5}\nfriction_angle_deg = 40.0\n"
                  "[region]\nmaterial = \"rock\"\npolygon = [[0, 0], [{6}, 0], [{6}, {6}], [0, {6}]]\n{7}"
                  "[earthquake]\nviscous = [\"bottom\"]\n{8}[output]\ninterval = 1.0\n",
                  fidelity, density, youngs_modulus, poissons_ratio, normal, tangential / normal, width,
                  joint_sets, earthquake));
  scene.region_blocks = std::make_shared<RegionCutter>(scene);
  const Simulation simulation(Communicator::self(), std::move(scene));
  Impedance sum;
  for (const Dashpot &dashpot : simulation.blocks().dashpot) {
    sum.tangential += dashpot.damping[0] / width;
    sum.normal += dashpot.damping[2] / width;
  }
  return sum;
}

std::string joint_set(double dip_deg, double spacing, const std::string &joint = "bed") {
  return fmt::format("[[joint_set]]\ndip_deg = {}\nspacing = {:.17g}\n{}", dip_deg, spacing,
                     joint.empty() ? "" : "joint = \"" + joint + "\"\n");
}

void expect_moduli(const Impedance &got, double direct, double shear) {
  constexpr double rounding = 1e-9;
  EXPECT_NEAR(got.normal / std::sqrt(density * direct), 1.0, rounding);
  EXPECT_NEAR(got.tangential / std::sqrt(density * shear), 1.0, rounding);
}

TEST(SideRock, OfSlabsHasTheLawOfTheirJoints) {
  expect_moduli(of_bottom(joint_set(0.0, 2.0)), 2.0 * normal, 2.0 * tangential);
  expect_moduli(of_bottom(joint_set(0.0, 2.0, "")), 2.0 * 1e8, 2.0 * 0.5e8);
}

TEST(SideRock, OfAGridShearsAlongBothSets) {
  expect_moduli(of_bottom(joint_set(0.0, 2.0) + joint_set(90.0, 2.0)), 2.0 * normal, tangential);
  // 1/G = 1/(k_t h) + 1/(k_t l) of blocks of the height h and the length l.
  expect_moduli(of_bottom(joint_set(0.0, 2.0) + joint_set(90.0, 6.0)), 2.0 * normal, 1.5 * tangential);
  // Blocks that the outline cuts short do not count: their joints are no closer.
  expect_moduli(of_bottom(joint_set(0.0, 2.5) + joint_set(90.0, 2.5)), 2.5 * normal, 1.25 * tangential);
}

// A strain of compression is one of half its size normal to either set, and of shear along them.
TEST(SideRock, OfObliqueJointsPushesAndShearsThem) {
  const double spacing = std::sqrt(8.0);
  expect_moduli(of_bottom(joint_set(45.0, spacing) + joint_set(135.0, spacing)),
                0.5 * spacing * (normal + tangential), 0.5 * spacing * normal);
}

TEST(SideRock, OfDeformableBlocksIsInSeriesWithTheirJoints) {
  constexpr double factor = youngs_modulus / ((1.0 + poissons_ratio) * (1.0 - 2.0 * poissons_ratio));
  constexpr double direct = (1.0 - poissons_ratio) * factor; // of plane strain
  constexpr double cross = poissons_ratio * factor;
  constexpr double shear = 0.5 * youngs_modulus / (1.0 + poissons_ratio);
  expect_moduli(of_bottom(joint_set(0.0, 2.0), "deformable"), 1.0 / (1.0 / direct + 0.5 / normal),
                1.0 / (1.0 / shear + 0.5 / tangential));
  // In a grid what gives way sideways does so within its joints, too.
  const double determinant = direct * direct - cross * cross;
  const double along = direct / determinant + 0.5 / normal;
  const double across = cross / determinant;
  expect_moduli(of_bottom(joint_set(0.0, 2.0) + joint_set(90.0, 2.0), "deformable"),
                along / (along * along - across * across), 1.0 / (1.0 / shear + 1.0 / tangential));
}

TEST(SideRock, HasTheSpeedsThatTheSceneGives) {
  const Impedance given = of_bottom(joint_set(45.0, 2.0) + joint_set(135.0, 2.0), "rigid",
                                    "p_wave_speed = 3000.0\ns_wave_speed = 1700.0\n");
  EXPECT_NEAR(given.normal, density * 3000.0, 1e-3);
  EXPECT_NEAR(given.tangential, density * 1700.0, 1e-3);
}

} // namespace
} // namespace gcpdda::testing::side_rock_test
