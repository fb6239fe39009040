// What a scene takes is judged from numbers, before anything is made.

#include "blockgen/region_cutter.hpp"
#include "simulation/scene_size.hpp"
#include "support/scenes.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <string>

namespace gcpdda::scene_size_test {
namespace {

const std::string head = R"([run]
duration = 1.0
[material.rock]
density = 2600.0
[joint.default]
normal_stiffness = 1e9
)";

Scene wall_scene(const std::string &rows, const std::string &columns) {
  return testing::scene_of(
      head + "[[wall]]\nmaterial = \"rock\"\norigin = [0, 0]\nblock_size = [1, 1]\nrows = " + rows +
      "\ncolumns = " + columns + "\n");
}

Scene region_scene(const std::string &polygon, const std::string &joint_sets) {
  Scene scene =
      testing::scene_of(head + "[region]\nmaterial = \"rock\"\npolygon = " + polygon + "\n" + joint_sets);
  scene.region_blocks = std::make_shared<RegionCutter>(scene);
  return scene;
}

std::string set_of(const std::string &dip, const std::string &spacing) {
  return "[[joint_set]]\ndip_deg = " + dip + "\nspacing = " + spacing + "\n";
}

TEST(SceneSize, OfAWallIsThatOfItsBricks) {
  const SizeEstimate small = estimate_size(wall_scene("100", "100"));
  const SizeEstimate large = estimate_size(wall_scene("100000", "10000"));
  EXPECT_EQ(large.blocks, 1e9 + 5e4) << "every second row has a brick more";
  EXPECT_NEAR(large.bytes / small.bytes, large.blocks / small.blocks, 1e-6 * 1e5);
  EXPECT_GT(large.bytes, 4e11) << "no block is held in 400 bytes: its vertices and state alone are more";
}

TEST(SceneSize, ThatMemoryCannotHoldIsRefusedWithNumbers) {
  const SizeEstimate size{1e9, 9e11, 15000.0};
  const Diagnostics refused = judge_size(size, {4, 64e9});
  ASSERT_EQ(refused.size(), 1U);
  EXPECT_EQ(to_string(refused[0]),
            "error: about 1e+09 blocks need at least 900 GB of memory, 4 ranks can have 64 "
            "GB here, use fewer or larger blocks, or more machines");
  const Diagnostics nearly = judge_size({1e6, 9e8, 15.0}, {1, 1e9});
  ASSERT_EQ(nearly.size(), 1U);
  EXPECT_EQ(nearly[0].severity, Severity::warning);
  EXPECT_TRUE(judge_size({1e6, 9e8, 15.0}, {1, 64e9}).empty());
  EXPECT_TRUE(has_errors(judge_size({1e6, 9e8, 15.0}, {100, 64e9}, 100.0))) << "a hundred members at a time";
}

TEST(SceneSize, ThatTakesLongIsSaidBefore) {
  const Diagnostics found = judge_size({1e7, 9e9, 600.0}, {2, 64e9});
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(
      to_string(found[0]),
      "warning: it takes about 5 min on 2 ranks to make the blocks and find their contacts, there are about "
      "1e+07 blocks, wait, use more ranks, or use larger spacings and blocks");
  EXPECT_TRUE(judge_size({1e7, 9e9, 600.0}, {64, 64e9}).empty()) << "ten seconds";
}

// One wrong coordinate: by its area alone the region would have few blocks.
TEST(SceneSize, OfARegionCountsItsReachAcrossTheJoints) {
  const std::string needle = "[[0, 0], [1e6, 14], [21, 19], [-0.5, 0.9]]";
  const double across = 1e6 * 0.8660254037844386; // of joints that dip 120 degrees
  EXPECT_NEAR(estimate_size(region_scene(needle, set_of("120", "2.0"))).blocks, across / 2.0, 0.01 * across);
  const double square =
      estimate_size(region_scene("[[0,0],[20,0],[20,20],[0,20]]", set_of("30", "0.1"))).blocks;
  EXPECT_NEAR(square, 274.0, 0.3 * 274.0) << "cut into 274";
}

// Noding looks at all pairs of long joints at an angle, and at none of parallel ones along an axis.
TEST(SceneSize, OfManyLongJointsAtAnAngleIsMuch) {
  const std::string square = "[[0,0],[20,0],[20,20],[0,20]]";
  const auto seconds = [&](const char *dip, const char *spacing) {
    return estimate_size(region_scene(square, set_of(dip, spacing))).seconds;
  };
  EXPECT_LT(seconds("30", "0.1"), 1.0);
  EXPECT_GT(seconds("30", "0.001"), 600.0);
  EXPECT_GT(seconds("30", "0.001"), 100.0 * seconds("90", "0.001"));
}

} // namespace
} // namespace gcpdda::scene_size_test
