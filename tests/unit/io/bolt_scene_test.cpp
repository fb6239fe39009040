// What is said of [support.NAME], [[bolt]] and [[bolt_pattern]].

#include "unit/scene_texts.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace gcpdda::bolt_scene_test {
namespace {

using namespace testing;

const std::string tunnel_scene = R"([run]
duration = 2.0
[material.rock]
density = 2600
[joint.default]
normal_stiffness = 1e9
[region]
polygon = [[-20, -20], [20, -20], [20, 20], [-20, 20]]
material = "rock"
[[joint_set]]
dip_deg = 30
spacing = 2
[[opening]]
name = "tunnel"
shape = "d"
centre = [0, 0]
width = 6
height = 6
)";

/// The same without a duration: stages say how long they last.
std::string staged_scene() {
  std::string text = tunnel_scene;
  return text.erase(text.find("duration"), std::string("duration = 2.0\n").size());
}

TEST(BoltScene, ReadsTypesBoltsAndPatterns) {
  const Scene scene = good(staged_scene() + R"([support.strand]
kind = "anchored"
axial_rigidity = 2e8
pretension = 1e5
[support.rockbolt]
kind = "grouted"
axial_stiffness = 1e8
axial_yield = 2e5
shear_stiffness = 2e7
shear_yield = 1e5
active_length = 0.3
rupture_strain = 0.1
bond_strength = 3e5
plate = true
spacing = 1.5
[[bolt_pattern]]
name = "roof"
support = "rockbolt"
opening = "tunnel"
length = 4
count = 5
active = false
[[bolt]]
support = "strand"
from = [-3, 0]
to = [-12, 0]
[[stage]]
kind = "run"
duration = 1
[[stage]]
kind = "run"
duration = 1
set = { "bolt_pattern.roof.active" = true, "bolt.bolt0.active" = false, "support.strand.axial_yield" = 3e5 }
)");
  ASSERT_EQ(scene.supports.size(), 2U);
  EXPECT_EQ(scene.supports[0].kind, SupportType::Kind::anchored);
  EXPECT_EQ(scene.supports[0].axial_yield, std::numeric_limits<double>::infinity());
  EXPECT_EQ(scene.supports[0].spacing, 1.0);
  EXPECT_EQ(scene.supports[1].shear_yield, 1e5);
  EXPECT_TRUE(scene.supports[1].plate);
  ASSERT_EQ(scene.bolts.size(), 6U);
  EXPECT_EQ(scene.bolts[0].name, "bolt0");
  EXPECT_EQ(scene.bolts[0].support, 0);
  EXPECT_TRUE(scene.bolts[0].active);
  EXPECT_EQ(scene.bolts[3].name, "roof.2");
  EXPECT_EQ(scene.bolts[3].support, 1);
  EXPECT_FALSE(scene.bolts[3].active);
  // The third of five stands on the crown.
  EXPECT_NEAR(scene.bolts[3].from.x, 0.0, 1e-9);
  EXPECT_NEAR(scene.bolts[3].to.x, 0.0, 1e-9);
  EXPECT_NEAR(scene.bolts[3].to.y - scene.bolts[3].from.y, 4.0, 1e-9);
  EXPECT_FALSE(scene.stages[1].after->bolts[0].active);
  EXPECT_TRUE(scene.stages[1].after->bolts[3].active);
  EXPECT_EQ(scene.stages[1].after->supports[0].axial_yield, 3e5);
}

TEST(BoltScene, FaultsAreToldAllAtOnce) {
  const std::string text = tunnel_scene + R"([support.strand]
kind = "anchored"
axial_stiffness = 1e8
axial_rigidity = 2e8
axial_yield = 1e5
pretension = 2e5
plate = true
[support.rockbolt]
kind = "grouted"
shear_yield = 1e5
plate = true
[[bolt]]
name = "a"
support = "rokbolt"
from = [0, 0]
to = [0, 5]
[[bolt]]
name = "b"
support = "strand"
from = [0, 5]
to = [0, 5]
[[bolt]]
name = "b"
support = "strand"
from = [0, 3]
to = [0, 5]
[[bolt_pattern]]
support = "strand"
opening = "tunel"
length = 4
from_angle_deg = 180
[[monitor]]
name = "bolts"
point = [9, 9]
)";
  std::vector<std::string> places;
  for (const std::string &message : messages(read_scene(text, "s.toml", {}))) {
    places.push_back(message.substr(0, message.find(',')));
  }
  EXPECT_EQ(places,
            (std::vector<std::string>{
                "s.toml:22:18: error: [support.strand] gives both axial_stiffness and axial_rigidity",
                "s.toml:24:14: error: 'pretension' in [support.strand] is 200000 N",
                "s.toml:25:9: error: 'plate' in [support.strand] has no meaning",
                "s.toml:26:1: error: [support.rockbolt] gives neither axial_stiffness nor axial_rigidity",
                "s.toml:26:1: error: 'active_length' in [support.rockbolt] is missing",
                "s.toml:28:15: error: 'shear_yield' in [support.rockbolt] has no meaning without "
                "'shear_stiffness'",
                "s.toml:29:9: error: 'plate' in [support.rockbolt] has no meaning without 'bond_strength'",
                "s.toml:32:11: error: no support is named 'rokbolt'",
                "s.toml:39:6: error: bolt 'b' has no length", "s.toml:40:1: error: two bolts are named 'b'",
                "s.toml:45:1: error: bolt_pattern 'bolt_pattern0' gives neither count nor spacing",
                "s.toml:47:11: error: no opening is named 'tunel'",
                "s.toml:49:18: error: bolt_pattern 'bolt_pattern0' has no arc to stand on",
                "s.toml:51:8: error: a point named 'bolts' cannot be monitored"}));
}

TEST(BoltScene, AStageCannotChangeTheKindOfABolt) {
  const SceneReading reading = read_scene(
      staged_scene() + "[support.a]\nkind = \"anchored\"\naxial_stiffness = 1e8\n[[stage]]\nkind = "
                       "\"run\"\nduration = 1\n[[stage]]\nkind = \"run\"\nduration = 1\nset = { "
                       "\"support.a.kind\" = \"grouted\" }\n",
      "s.toml", {});
  ASSERT_EQ(reading.diagnostics.size(), 1U);
  EXPECT_EQ(reading.diagnostics[0].what, "a stage cannot set 'support.a.kind'");
}

} // namespace
} // namespace gcpdda::bolt_scene_test
