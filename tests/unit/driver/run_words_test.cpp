// What a run tells of the laws of its joints, and the values that they have by default.

#include "driver/run_words.hpp"

#include "unit/scene_texts.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

namespace gcpdda::run_words_test {
namespace {

using testing::good;

/// A default law and one of Barton and Bandis, with further keys of both.
std::string scene_with(const std::string &of_default, const std::string &of_rough) {
  return "[run]\nduration = 1.0\n[material.rock]\ndensity = 2600.0\n[joint.default]\nnormal_stiffness = "
         "1e9\n" +
         of_default +
         "[joint.rough]\nmaterials = [\"rock\", \"rock\"]\nlaw = \"barton-bandis\"\njrc = 8\njcs = 50e6\n" +
         of_rough + "[[block]]\nmaterial = \"rock\"\nvertices = [[0, 0], [1, 0], [1, 1]]\n";
}

std::string words_on_rough(const std::string &of_default, const std::string &of_rough) {
  const std::string words = words_on_law(good(scene_with(of_default, of_rough)).joints.laws.at(1));
  return words.substr(words.find("0.5, ") + 5);
}

TEST(WordsOnLaw, NameTheFriction) {
  EXPECT_EQ(
      words_on_law(good(scene_with("friction_angle_deg = 45\ncohesion = 2e4\n", "")).joints.laws.at(0)),
      "joint 'default': normal stiffness 1e+09 Pa/m, tangential ratio 0.5, friction angle 45 deg, cohesion "
      "20000 Pa");
  EXPECT_EQ(
      words_on_rough("", "residual_friction_angle_deg = 28\n"),
      "Barton-Bandis friction with jrc 8, jcs 5e+07 Pa and residual friction angle 28 deg, cohesion 0 Pa");
}

TEST(BartonBandisLaw, HasTheAngleOfTheDefaultLawUnlessGivenOne) {
  const auto expect_angle = [](double degrees, const std::string &of_default, const std::string &of_rough) {
    const JointLaw law = good(scene_with(of_default, of_rough)).joints.laws.at(1);
    EXPECT_NEAR(law.tan_friction, std::tan(degrees * std::acos(-1.0) / 180.0), 1e-12)
        << of_default << of_rough;
    EXPECT_EQ(law.residual_tan_friction, law.tan_friction) << of_default << of_rough;
  };
  const std::string of_bonds = "friction_angle_deg = 45\nresidual_friction_angle_deg = 30\n";
  expect_angle(45.0, "friction_angle_deg = 45\n", "");
  expect_angle(28.0, "friction_angle_deg = 45\n", "residual_friction_angle_deg = 28\n");
  expect_angle(30.0, of_bonds, "");
  expect_angle(0.0, of_bonds, "residual_friction_angle_deg = 0\n");
  expect_angle(33.0, "law = \"barton-bandis\"\njrc = 6\njcs = 1e7\nresidual_friction_angle_deg = 33\n", "");
}

BoltLoad bolt_load(const std::string &name, double tension, bool in_place) {
  BoltLoad load;
  load.last.name = name;
  load.axial = tension;
  load.in_place = in_place;
  return load;
}

// The closing line speaks of what bears something at the end.
TEST(WordsOnSupport, LeaveOutBoltsThatHaveBeenTakenAway) {
  const Scene scene = good(scene_with("", ""));
  RunSummary summary;
  summary.bolts = {bolt_load("old", 5e4, false), bolt_load("new", 2e4, true)};
  EXPECT_EQ(
      words_on_support(summary, scene),
      std::vector<std::string>{"bolts: largest tension 2e+04 N in 'new', largest shear 0 N in 'new'; of 1 "
                               "bolts 0 yielded and 0 broke; 1 has been taken away"});
  summary.bolts.pop_back();
  EXPECT_EQ(words_on_support(summary, scene),
            std::vector<std::string>{"bolts: none is in place; 1 has been taken away"});
  summary.bolts = {bolt_load("new", 2e4, true)};
  EXPECT_EQ(
      words_on_support(summary, scene),
      std::vector<std::string>{"bolts: largest tension 2e+04 N in 'new', largest shear 0 N in 'new'; of 1 "
                               "bolts 0 yielded and 0 broke"});
}

} // namespace
} // namespace gcpdda::run_words_test
