// Faults of scenes as a whole: what is missing, several faults at once, and scenes that are too large.

#include "bad_scene.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace gcpdda::whole_scene_faults_test {
namespace {

using testing::messages;
using testing::scene_text;

TEST(WholeScene, NothingAtAll) {
  const std::vector<std::string> expected{
      "s.toml:1:1: error: 'run' is missing, it is required, write [run]",
      "s.toml:1:1: error: 'material' is missing, it is required, write [material.granite]",
      "s.toml:1:1: error: 'joint' is missing, it is required, write [joint.default]",
      "s.toml:1:1: error: the scene has no blocks, at least one block, wall, pyramid, block file or region "
      "is "
      "required, write [[block]], [[wall]], [[pyramid]], [blocks] or [region]"};
  EXPECT_EQ(messages(""), expected);
}

TEST(WholeScene, TablesOfTheWrongKind) {
  const std::vector<std::string> expected{
      "s.toml:1:1: error: 'run' is an array, it must be a table, write [run]",
      "s.toml:3:1: error: 'block' is a table, it must be a list of tables, write [[block]]",
      "s.toml:5:1: error: 'material' is empty, at least one is needed, write [material.granite]",
      "s.toml:6:1: error: 'default' in [joint] is missing, pairs of materials without a law of their own "
      "take "
      "it, write [joint.default]",
      "s.toml:7:5: error: 'a' in [joint] is an integer, it must be a table, write [joint.default]"};
  EXPECT_EQ(messages("[[run]]\nduration = 1\n[block.a]\nfixed = true\n[material]\n[joint]\na = 1\n"),
            expected);
}

TEST(WholeScene, BlockListOfOtherThings) {
  const std::string text = "block = [1, {material = \"granite\"}]\n[run]\nduration = 2\n[material.granite]\n"
                           "density = 1\n[joint.default]\nnormal_stiffness = 1\n";
  const std::vector<std::string> expected{
      "s.toml:1:10: error: 'block[0]' is an integer, it must be a table, write [[block]]",
      "s.toml:1:13: error: 'vertices' in block 'b1' is missing, it is required, for example vertices = [[0, "
      "0], "
      "[1, 0], [1, 1], [0, 1]]"};
  EXPECT_EQ(messages(text), expected);
}

TEST(WholeScene, AllFaultsAtOnceByPosition) {
  const std::string text = R"([[monitor]]
block = "slidr"
[output]
interval = -1
[[block]]
name = "slider"
material = "chalk"
vertices = [[0, 0], [1, 0], [1, 1], [0, 1]]
colour = "red"
[[block]]
name = "slider"
material = "granite"
vertices = [[0, 0], [1, 1], [1, 0], [0, 1]]
[joint.default]
normal_stiffness = 1e9
friction_angle_deg = 90
[material.granite]
density = inf
[run]
scheme = "newmark-dda"
contact_time = "start"
local_damping = -0.1
)";
  const std::vector<std::string> expected{
      "s.toml:2:9: error: no block is named 'slidr', did you mean 'slider'?",
      "s.toml:4:12: error: 'interval' in [output] is -1, it must be above 0 and at most 1e+12, for example "
      "interval "
      "= 0.02",
      "s.toml:7:12: error: no material is named 'chalk', add a table [material.chalk]",
      "s.toml:9:1: error: unknown key 'colour' in block 'slider', known here: name material vertices "
      "edge_joints velocity fixed "
      "fidelity fixed_points prescribed_velocity velocity_table load",
      "s.toml:11:8: error: two blocks are named 'slider', the first is at line 5, names are unique, and "
      "unnamed "
      "blocks are b<n> from 0 in file order",
      "s.toml:13:12: error: block 'slider' crosses itself, two of its edges meet away from a common vertex, "
      "list the "
      "vertices in order around the block",
      "s.toml:16:22: error: 'friction_angle_deg' in [joint.default] is 90, it must be at least 0 and below "
      "90, for "
      "example friction_angle_deg = 35.0",
      "s.toml:18:11: error: 'density' in [material.granite] is inf, it must be finite, for example density = "
      "2600.0",
      "s.toml:19:1: error: 'duration' in [run] is missing, it is required, for example duration = 2.0",
      "s.toml:21:16: error: 'contact_time' in [run] has no meaning for this scheme, it belongs to "
      "generalized-alpha, leave it out",
      "s.toml:22:17: error: 'local_damping' in [run] is -0.1, it must be at least 0 and below 1, for example "
      "local_damping = 0.0"};
  EXPECT_EQ(messages(text), expected);
}

TEST(WholeScene, MoreThanTenThousandBlocks) {
  const std::string head = scene_text(0, "");
  const std::string block = "[[block]]\nmaterial = \"clay\"\nvertices = [[0, 0], [1, 0], [1, 1]]\n";
  std::string text = head;
  for (int i = 2; i < 10'000; ++i) {
    text += block;
  }
  EXPECT_EQ(messages(text), std::vector<std::string>{});
  text += block;
  EXPECT_EQ(
      messages(text),
      std::vector<std::string>{"s.toml:30012:1: error: 'block' has 10001 entries, a scene file holds at most "
                               "10000, put many blocks into a file and name it in [blocks] file"});
}

TEST(WholeScene, MoreThanTenThousandVertices) {
  std::string vertices = "[0, 0]";
  for (int i = 1; i <= 10'000; ++i) {
    vertices += ", [" + std::to_string(i) + ", " + std::to_string(i) + "]";
  }
  EXPECT_EQ(
      messages(scene_text(17, "vertices = [" + vertices + "]")),
      std::vector<std::string>{"s.toml:17:12: error: 'vertices' in block 'slider' has 10001 points, a block "
                               "has at most 10000, simplify the outline"});
}

TEST(WholeScene, EndlessKeyAndEndlessArray) {
  std::string key = "a";
  for (int i = 0; i < 100'000; ++i) {
    key += ".a";
  }
  EXPECT_EQ(messages("# " + std::string(1000, '.') + "\n[" + key + "]\n").at(0),
            "s.toml:2:403: error: key with more than 200 levels, remove the superfluous dots");
  EXPECT_EQ(messages("a = " + std::string(100'000, '[')).size(), 1U);
}

} // namespace
} // namespace gcpdda::whole_scene_faults_test
