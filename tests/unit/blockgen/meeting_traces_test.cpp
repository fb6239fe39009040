// Traces that lie on each other, and traces that end at others.

#include "blockgen/region_cutter.hpp"
#include "support/regions.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

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

Vec2 between(Vec2 a, Vec2 b, double share) {
  return a + share * (b - a);
}

bool cross_inside(const std::vector<Vec2> &a, const std::vector<Vec2> &b) {
  const auto parts = [](const std::vector<Vec2> &line, const std::vector<Vec2> &other) {
    const Vec2 along = line[1] - line[0];
    return cross(along, other[0] - line[0]) * cross(along, other[1] - line[0]) < 0.0;
  };
  return parts(a, b) && parts(b, a);
}

/// Faults from sides of a slanted region to other sides, and from faults to sides, with ends that rounding
/// puts on either side of where they end.
Scene scene_of_faults(std::mt19937 &random, Vec2 origin) {
  Scene scene = scene_with_laws();
  std::vector<Vec2> &outline = scene.region.outline;
  outline = {{0.0, 0.3}, {9.1, -1.7}, {11.3, 7.9}, {1.7, 9.1}};
  for (Vec2 &p : outline) {
    p += origin;
  }
  // Many blocks are expected of this set, which makes tiles small, and none of its joints reaches in.
  JointSet outside = testing::through_going(0.0, 1.0, 1);
  outside.within = {outline[1], outline[1] + Vec2{1.0, -1.0}, outline[1] + Vec2{1.0, -0.5}};
  scene.region.joint_sets = {outside};
  std::uniform_real_distribution<double> share(0.1, 0.9);
  const auto on_side = [&](std::size_t k) {
    return between(outline[k], outline[(k + 1) % 4], share(random));
  };
  std::vector<FaultLine> &faults = scene.region.faults;
  for (std::size_t i = 0; i < 8; ++i) {
    faults.push_back({"", 1, {on_side(i % 4), on_side((i + 1 + i / 4) % 4)}, {}});
  }
  for (std::size_t i = 0; i < 4; ++i) {
    const std::vector<Vec2> &other = faults[i].points;
    faults.push_back({"", 2, {between(other[0], other[1], share(random)), on_side((i + 2) % 4)}, {}});
  }
  return scene;
}

// Each fault that ends at others or at the outline adds a block, and one more at each crossing.
TEST(MeetingTraces, FaultsThatEndAtOthersToWithinRoundingCut) {
  std::mt19937 random(7);
  for (const Vec2 origin : {Vec2{}, Vec2{3.0e5, 5.2e6}}) {
    for (int trial = 0; trial < 40; ++trial) {
      const Scene scene = scene_of_faults(random, origin);
      const std::vector<FaultLine> &faults = scene.region.faults;
      std::size_t expected = 1 + faults.size();
      for (std::size_t i = 0; i < faults.size(); ++i) {
        for (std::size_t k = 0; k < i; ++k) {
          const bool ends_there = i >= 8 && k == i - 8;
          expected += !ends_there && cross_inside(faults[i].points, faults[k].points) ? 1 : 0;
        }
      }
      const std::vector<SceneBlock> blocks = all_blocks(scene);
      EXPECT_EQ(blocks.size(), expected) << "trial " << trial;
      // A vertex may move by 64 roundings of the coordinate (blockgen/tile.cpp) on a boundary of some 200 m.
      const double rounding = 1.5e-14 * (10.0 + origin.y);
      EXPECT_NEAR(testing::total_area(blocks), signed_area(scene.region.outline), 200.0 * rounding);
      const RegionCutter tiled(scene, 1);
      EXPECT_GT(tiled.num_tiles(), 4);
      std::vector<SceneBlock> parts = tiled.make(0, tiled.num_tiles()).blocks;
      const auto is_before = [](const SceneBlock &a, const SceneBlock &b) {
        return std::pair(a.vertices[0].x, a.vertices[0].y) < std::pair(b.vertices[0].x, b.vertices[0].y);
      };
      std::sort(parts.begin(), parts.end(), is_before);
      EXPECT_TRUE(std::equal(parts.begin(), parts.end(), blocks.begin(), blocks.end(), testing::same))
          << "trial " << trial;
    }
  }
}

// A fault from rock through the re-entrant corner of an outline or an opening passes it by rounding on either
// side: through the toe of a slope, and two through the corners of a roof that meet above it.
TEST(MeetingTraces, FaultsThroughCornersToWithinRoundingCut) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> slope(0.2, 2.5);
  std::uniform_real_distribution<double> reach(0.3, 1.2);
  const double left = 4.1;
  const double right = 6.7;
  const double low = 3.3;
  const double high = 5.9;
  for (const Vec2 origin : {Vec2{}, Vec2{3.0e5, 5.2e6}}) {
    const auto moved = [&](std::vector<Vec2> outline) {
      for (Vec2 &p : outline) {
        p += origin;
      }
      return outline;
    };
    const auto through = [&](Vec2 corner, Vec2 along, double beyond) {
      return std::vector<Vec2>{origin + corner - reach(random) * along, origin + corner + beyond * along};
    };
    for (int trial = 0; trial < 60; ++trial) {
      const double rise = slope(random);
      Scene scene = scene_with_laws();
      scene.region.outline =
          moved({{0.0, 0.0}, {10.0, 0.0}, {10.0, 10.0}, {left, 10.0}, {left, low}, {0.0, low}});
      scene.region.faults = {{"", 1, through({left, low}, {1.0, rise}, 10.0), {}}};
      EXPECT_EQ(all_blocks(scene).size(), 2U) << "toe, trial " << trial;
      scene.region.outline = moved(rectangle_of(10.0, 10.0));
      Opening opening;
      opening.outline = moved({{left, low}, {right, low}, {right, high}, {left, high}});
      scene.region.openings = {opening};
      const double half = 0.5 * (right - left);
      scene.region.faults = {{"", 1, through({left, high}, {1.0, rise}, half + 0.01), {}},
                             {"", 1, through({right, high}, {-1.0, rise}, half + 0.01), {}}};
      const std::vector<SceneBlock> blocks = all_blocks(scene);
      EXPECT_TRUE(std::any_of(blocks.begin(), blocks.end(),
                              [&](const SceneBlock &block) {
                                return std::abs(signed_area(block.vertices) - half * half * rise) < 1e-6;
                              }))
          << "roof, trial " << trial;
    }
  }
}

// Walls of an opening lie on joints up to rounding, 3 x 0.8 against 2.4: no block has a spike along them,
// whose corner would have no angle at all.
TEST(MeetingTraces, WallsOnJointsLeaveNoSpikes) {
  const auto sharpest = [](const std::vector<SceneBlock> &blocks) {
    double angle = std::numbers::pi;
    for (const SceneBlock &block : blocks) {
      const std::size_t n = block.vertices.size();
      for (std::size_t k = 0; k < n; ++k) {
        const Vec2 there = block.vertices[(k + 1) % n] - block.vertices[k];
        const Vec2 back = block.vertices[(k + n - 1) % n] - block.vertices[k];
        angle = std::min(angle, std::abs(std::atan2(cross(there, back), dot(there, back))));
      }
    }
    return angle;
  };
  for (const double size : {0.1, 0.2, 0.3, 0.4, 0.6, 0.7, 0.8, 0.9}) {
    for (const int half : {3, 5, 6, 7}) {
      Scene scene = scene_with_laws();
      const double far = 10.0 * size;
      scene.region.outline = {{-far, -far}, {far, -far}, {far, far}, {-far, far}};
      const double wall = std::stod(fmt::format("{:.6g}", half * size)); // as one writes it
      Opening opening;
      opening.outline = {{-wall, -wall}, {wall, -wall}, {wall, wall}, {-wall, wall}};
      scene.region.openings = {opening};
      scene.region.min_width = 0.02 * size;
      scene.region.joint_sets = {testing::through_going(0.0, size, 1), testing::through_going(90.0, size, 1)};
      EXPECT_GT(sharpest(all_blocks(scene)), 1.0) << "joint sets, " << half << " x " << size;
      scene.region.joint_sets.clear();
      BrickPattern bricks;
      bricks.size = {size, size};
      bricks.bond = 0.5;
      bricks.joint = 1;
      scene.region.bricks = {bricks};
      EXPECT_GT(sharpest(all_blocks(scene)), 1.0) << "bricks, " << half << " x " << size;
    }
  }
}

// A set that is kept to a layer ends at the outline of the layer.
TEST(MeetingTraces, ASetWithinALayerCutsTheWholeLayer) {
  Scene scene = scene_with_laws();
  const std::vector<Vec2> layer{{-1.0, 2.3}, {11.0, 4.1}, {11.0, 7.7}, {-1.0, 5.9}};
  scene.region.layers = {{-1, 1, layer, {}}};
  const auto num_in_layer = [&] {
    const std::vector<SceneBlock> blocks = all_blocks(scene);
    return std::count_if(blocks.begin(), blocks.end(), [](const SceneBlock &b) { return b.material == 1; });
  };
  for (const double dip : {51.37, 63.7, 77.4, 95.21}) {
    scene.region.joint_sets = {testing::through_going(dip, 0.7, 1)};
    const auto through = num_in_layer();
    scene.region.joint_sets[0].within = layer;
    EXPECT_EQ(num_in_layer(), through) << dip;
  }
}

} // namespace
} // namespace gcpdda::meeting_traces_test
