// What is said of [[liner]] and of [support.NAME] of kind liner.

#include "unit/scene_texts.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace gcpdda::liner_scene_test {
namespace {

using namespace testing;

const std::string head = R"([material.rock]
density = 2600
[joint.default]
normal_stiffness = 1e9
[region]
polygon = [[-20, -20], [20, -20], [20, 20], [-20, 20]]
material = "rock"
[[opening]]
name = "tunnel"
shape = "d"
centre = [0, 0]
width = 6
height = 6
[support.bar]
kind = "grouted"
axial_stiffness = 1e8
active_length = 0.3
)";

TEST(LinerScene, ReadsTypesAndLiners) {
  const Scene scene = good("[run]\n" + head + R"([support.shotcrete]
kind = "liner"
thickness = 0.1
youngs_modulus = 15e9
poissons_ratio = 0.25
compressive_strength = 25e6
tensile_strength = 2e6
residual_tensile_strength = 1e6
shear_strength = 3e6
adhesion = 0.5e6
bond_width = 0.05
[support.plain]
kind = "liner"
thickness = 0.3
youngs_modulus = 30e9
[[liner]]
name = "ring"
support = "plain"
opening = "tunnel"
active = false
[[liner]]
support = "shotcrete"
opening = "tunnel"
from_angle_deg = 0
to_angle_deg = 180
[[liner]]
support = "shotcrete"
points = [[-20, 20], [0, 20], [20, 20]]
[[stage]]
kind = "run"
duration = 1
[[stage]]
kind = "run"
duration = 1
set = { "liner.ring.active" = true, "liner.liner1.active" = false, "support.plain.youngs_modulus" = 1e10 }
)");
  ASSERT_EQ(scene.supports.size(), 3U);
  const SupportType &shotcrete = scene.supports[1];
  EXPECT_EQ(shotcrete.kind, SupportType::Kind::liner);
  EXPECT_EQ(shotcrete.thickness, 0.1);
  EXPECT_EQ(shotcrete.youngs_modulus, 15e9);
  EXPECT_EQ(shotcrete.poissons_ratio, 0.25);
  EXPECT_EQ(shotcrete.compressive_strength, 25e6);
  EXPECT_EQ(shotcrete.tensile_strength, 2e6);
  EXPECT_EQ(shotcrete.residual_tensile_strength, 1e6);
  EXPECT_EQ(shotcrete.shear_strength, 3e6);
  EXPECT_EQ(shotcrete.adhesion, 0.5e6);
  EXPECT_EQ(shotcrete.bond_width, 0.05);
  const SupportType &plain = scene.supports[2];
  EXPECT_EQ(plain.poissons_ratio, 0.2);
  EXPECT_EQ(plain.tensile_strength, std::numeric_limits<double>::infinity());
  EXPECT_EQ(plain.adhesion, std::numeric_limits<double>::infinity());
  EXPECT_EQ(plain.bond_width, 0.03);
  ASSERT_EQ(scene.liners.size(), 3U);
  EXPECT_TRUE(scene.bolts.empty());
  const Liner &ring = scene.liners[0];
  EXPECT_EQ(ring.name, "ring");
  EXPECT_EQ(ring.support, 2);
  EXPECT_TRUE(ring.is_closed);
  EXPECT_FALSE(ring.active);
  EXPECT_EQ(ring.path, scene.region.openings[0].outline);
  const Liner &arch = scene.liners[1];
  EXPECT_EQ(arch.name, "liner1");
  EXPECT_FALSE(arch.is_closed);
  EXPECT_TRUE(arch.has_rock_on_right);
  EXPECT_LT(arch.path.size(), ring.path.size() + 1); // without the floor
  const Liner &face = scene.liners[2];
  EXPECT_FALSE(face.has_rock_on_right);
  EXPECT_EQ(face.path.size(), 3U);
  EXPECT_TRUE(scene.stages[1].after->liners[0].active);
  EXPECT_FALSE(scene.stages[1].after->liners[1].active);
  EXPECT_EQ(scene.stages[1].after->supports[2].youngs_modulus, 1e10);
}

TEST(LinerScene, FaultsAreToldAllAtOnce) {
  const std::string text = head + R"([support.a]
kind = "liner"
axial_stiffness = 1e8
plate = true
residual_tensile_strength = 1e6
bond_width = 0.1
[support.b]
kind = "liner"
thickness = 0.1
youngs_modulus = 1e10
tensile_strength = 1e6
residual_tensile_strength = 2e6
[support.c]
kind = "anchored"
axial_stiffness = 1e8
thickness = 0.1
[[bolt]]
support = "b"
from = [0, 0]
to = [0, 5]
[[liner]]
name = "x"
support = "bar"
opening = "tunnel"
[[liner]]
name = "x"
support = "b"
points = [[0, 0], [1, 0]]
from_angle_deg = 10
[[liner]]
support = "b"
[[liner]]
support = "b"
opening = "tunel"
points = [[0, 0], [1, 0]]
[[liner]]
support = "b"
points = [[0, 0], [0, 0]]
[[liner]]
support = "b"
opening = "tunnel"
from_angle_deg = 10
[[liner]]
support = "b"
opening = "tunel"
from_angle_deg = 10
to_angle_deg = 5
[[monitor]]
name = "liners"
point = [9, 9]
[run]
duration = 1
)";
  std::vector<std::string> places;
  for (const std::string &message : messages(read_scene(text, "s.toml", {}))) {
    places.push_back(message.substr(0, message.find(',')));
  }
  EXPECT_EQ(
      places,
      (std::vector<std::string>{
          "s.toml:18:1: error: 'thickness' in [support.a] is missing",
          "s.toml:18:1: error: 'youngs_modulus' in [support.a] is missing",
          "s.toml:20:19: error: 'axial_stiffness' in [support.a] has no meaning",
          "s.toml:21:9: error: 'plate' in [support.a] has no meaning",
          "s.toml:22:29: error: 'residual_tensile_strength' in [support.a] has no meaning without "
          "'tensile_strength'",
          "s.toml:23:14: error: 'bond_width' in [support.a] has no meaning without 'adhesion'",
          "s.toml:29:29: error: 'residual_tensile_strength' in [support.b] is 2e+06 Pa",
          "s.toml:33:13: error: 'thickness' in [support.c] has no meaning",
          "s.toml:35:11: error: 'b' is a support of liners",
          "s.toml:40:11: error: 'bar' is a support of bolts", "s.toml:42:1: error: two liners are named 'x'",
          "s.toml:46:18: error: 'from_angle_deg' in liner 'x' has no meaning",
          "s.toml:47:1: error: liner 'liner2' gives neither opening nor points",
          "s.toml:52:10: error: liner 'liner3' gives both opening and points",
          "s.toml:55:10: error: 'points' in liner 'liner4' has the same point twice in a row",
          "s.toml:59:18: error: liner 'liner5' gives one angle",
          "s.toml:62:11: error: no opening is named 'tunel'",
          "s.toml:64:16: error: liner 'liner6' has no arc to stand on",
          "s.toml:66:8: error: a point named 'liners' cannot be monitored"}));
}

} // namespace
} // namespace gcpdda::liner_scene_test
