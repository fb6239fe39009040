// The stiffness of joints that follows from the modulus of the rock mass.

#include "unit/scene_texts.hpp"

#include <gtest/gtest.h>

namespace gcpdda::joint_stiffness_test {
namespace {

using testing::good;

const std::string head = R"([run]
duration = 2
[material.rock]
density = 2600
youngs_modulus = 40e9
[material.shale]
density = 2600
youngs_modulus = 20e9
[joint.default]
friction_angle_deg = 35
)";

const std::string tail = R"([region]
polygon = [[0, 0], [0, 10], [20, 10], [20, 0]]
material = "rock"
)";

std::vector<std::string> faults(const std::string &joints) {
  return testing::messages(read_scene(head + joints + tail, "s.toml", {}));
}

// Joints and intact rock are springs in series: 1/E_m = 1/E_i + 1/(k_n s). By hand for 10 and 40 GPa at
// 0.5 m: 10 40/(0.5 (40 - 10)) = 26.667 GPa/m.
TEST(JointStiffness, OfJointsInSeriesWithRock) {
  const Scene scene = good(head + "rock_mass_modulus = 10e9\nintact_modulus = 40e9\nspacing = 0.5\n" + tail);
  const double k = scene.joints.laws[0].normal_stiffness;
  EXPECT_NEAR(k, 80e9 / 3.0, 1e-5);
  EXPECT_NEAR(1.0 / (1.0 / 40e9 + 1.0 / (k * 0.5)), 10e9, 1e-5);
}

// The modulus of intact rock is that of the law's own materials; a law takes what it does not give from
// default, and a stiffness of its own replaces all.
TEST(JointStiffness, OfFurtherLawsTakesTheMaterialsAndDefault) {
  const Scene scene = good(head + R"(rock_mass_modulus = 10e9
intact_modulus = 40e9
spacing = 0.5
[joint.wide]
spacing = 1.0
[joint.own]
normal_stiffness = 3e9
[joint.plain]
friction_angle_deg = 20
)" + tail);
  EXPECT_NEAR(scene.joints.laws[1].normal_stiffness, 40e9 / 3.0, 1e-5);
  EXPECT_EQ(scene.joints.laws[2].normal_stiffness, 3e9);
  EXPECT_EQ(scene.joints.laws[2].rock_mass_modulus, 0.0);
  EXPECT_EQ(scene.joints.laws[3].normal_stiffness, scene.joints.laws[0].normal_stiffness);
  const Scene pair = good(head + R"(normal_stiffness = 1e9
[joint.shale]
materials = ["shale", "shale"]
rock_mass_modulus = 10e9
spacing = 1.0
)" + tail);
  EXPECT_NEAR(pair.joints.laws[1].normal_stiffness, 20e9, 1e-5);
  EXPECT_EQ(pair.joints.laws[1].intact_modulus, 20e9);
}

TEST(JointStiffness, NeedsOneModulusOfIntactRock) {
  const auto said = faults("rock_mass_modulus = 10e9\nspacing = 0.5\n");
  ASSERT_EQ(said.size(), 1U) << ::testing::PrintToString(said);
  EXPECT_NE(
      said[0].find("'intact_modulus' in [joint.default] is missing, the Young's moduli of its materials "
                   "differ, for example intact_modulus = 40e9"),
      std::string::npos)
      << said[0];
}

// Whatever the keys allow by themselves, the stiffness is one that could have been given.
TEST(JointStiffness, IsWithinTheRangeOfItsKey) {
  for (const char *values : {"rock_mass_modulus = 39.9999999999e9\nintact_modulus = 40e9\nspacing = 1e-9\n",
                             "rock_mass_modulus = 1e-320\nintact_modulus = 40e9\nspacing = 1e9\n"}) {
    const auto said = faults(values);
    ASSERT_EQ(said.size(), 1U) << ::testing::PrintToString(said);
    EXPECT_NE(said[0].find("[joint.default] would have a normal stiffness of "), std::string::npos)
        << said[0];
  }
}

// A stage that sets the modulus changes the stiffness.
TEST(JointStiffness, FollowsWhatAStageSets) {
  std::string staged = head.substr(0, head.find("duration")) + head.substr(head.find("[material"));
  staged += "rock_mass_modulus = 10e9\nintact_modulus = 40e9\nspacing = 0.5\n" + tail;
  staged += "[[stage]]\nkind = \"run\"\nduration = 1\n[[stage]]\nkind = \"run\"\nduration = 1\n"
            "set = { \"joint.default.rock_mass_modulus\" = 20e9 }\n";
  const Scene scene = good(staged);
  ASSERT_TRUE(scene.stages.at(1).after);
  EXPECT_NEAR(scene.stages[1].after->joints.laws[0].normal_stiffness, 80e9, 1e-4);
}

} // namespace
} // namespace gcpdda::joint_stiffness_test
