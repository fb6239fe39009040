// Traces that lie on each other, and traces that end at others.

#include "blockgen/region_cutter.hpp"
#include "support/regions.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace gcpdda::meeting_traces_test {
namespace {

using testing::all_blocks;
using testing::rectangle_of;
using testing::region_scene;

/// Law "one" is weaker than law "two".
Scene scene_with_laws() {
  Scene scene = region_scene(rectangle_of(10.0, 10.0));
  scene.joints.laws[1].tan_friction = 0.1;
  return scene;
}

/// Laws of the edges within the region, once for each.
std::vector<std::int32_t> laws_within(const std::vector<SceneBlock> &blocks) {
  std::vector<std::int32_t> laws;
  for (const SceneBlock &block : blocks) {
    for (std::size_t k = 0; k < block.vertices.size(); ++k) {
      const Vec2 middle = 0.5 * (block.vertices[k] + block.vertices[(k + 1) % block.vertices.size()]);
      if (middle.x > 0.1 && middle.x < 9.9 && middle.y > 0.1 && middle.y < 9.9) {
        laws.push_back(block.edge_joint.empty() ? -1 : block.edge_joint[k]);
      }
    }
  }
  std::sort(laws.begin(), laws.end());
  laws.erase(std::unique(laws.begin(), laws.end()), laws.end());
  return laws;
}

using Laws = std::vector<std::int32_t>;

TEST(MeetingTraces, ANamedLawHoldsOnOutlinesThatNameNone) {
  const std::vector<Vec2> upper{{-1.0, 4.0}, {11.0, 7.0}, {11.0, 11.0}, {-1.0, 11.0}};
  Scene scene = scene_with_laws();
  scene.region.faults = {{"seam", 1, {{-1.0, 4.0}, {11.0, 7.0}}, {}}};
  scene.region.layers = {{-1, 1, upper, {}}};
  EXPECT_EQ(laws_within(all_blocks(scene)), Laws{1});
  scene.region.layers.clear();
  Opening opening;
  opening.outline = upper;
  scene.region.openings = {opening};
  EXPECT_EQ(laws_within(all_blocks(scene)), Laws{1});
}

TEST(MeetingTraces, OfNamedLawsTheWeakerHoldsInAnyOrder) {
  Scene scene = scene_with_laws();
  const std::vector<Vec2> line{{-1.0, 4.0}, {11.0, 7.0}};
  scene.region.faults = {{"a", 1, line, {}}, {"b", 2, line, {}}};
  EXPECT_EQ(laws_within(all_blocks(scene)), Laws{1});
  scene.region.faults = {{"b", 2, line, {}}, {"a", 1, line, {}}};
  EXPECT_EQ(laws_within(all_blocks(scene)), Laws{1});
}

} // namespace
} // namespace gcpdda::meeting_traces_test
