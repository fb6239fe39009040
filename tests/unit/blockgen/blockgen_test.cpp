// Regions cut into blocks: counts that geometry knows, areas that add up, families, slivers, tiles.

#include "blockgen/quality.hpp"
#include "blockgen/region_cutter.hpp"
#include "geometry/holds_point.hpp"
#include "geometry/polygon.hpp"
#include "support/regions.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace gcpdda::blockgen_test {
namespace {

using testing::all_blocks;
using testing::jointed_slope;
using testing::per_degree;
using testing::rectangle_of;
using testing::region_scene;
using testing::same;
using testing::through_going;
using testing::total_area;

/// Coordinates and sums of areas are rounded; straight vertices are left out within 64 ulp of the extent.
constexpr double rounding = 1e-12;

void expect_sound(const std::vector<SceneBlock> &blocks) {
  for (const SceneBlock &block : blocks) {
    ASSERT_GE(block.vertices.size(), 3U);
    EXPECT_GT(signed_area(block.vertices), 0.0);
    EXPECT_TRUE(is_simple(block.vertices));
    EXPECT_TRUE(block.edge_joint.empty() || block.edge_joint.size() == block.vertices.size());
  }
}

std::int64_t num_non_convex(const std::vector<SceneBlock> &blocks) {
  return std::count_if(blocks.begin(), blocks.end(),
                       [](const SceneBlock &b) { return !is_convex(b.vertices); });
}

TEST(RegionCutter, LeavesARegionWithoutJointsWhole) {
  const std::vector<Vec2> outline{{0.1, 0.0}, {9.7, 0.3}, {4.0, 2.0}, {3.0, 7.1}};
  const std::vector<SceneBlock> blocks = all_blocks(region_scene(outline));
  ASSERT_EQ(blocks.size(), 1U);
  EXPECT_EQ(blocks[0].vertices, outline);
  EXPECT_TRUE(blocks[0].edge_joint.empty());
}

// Ten upright and eight level joints make 11 columns and 9 rows, all rectangles.
TEST(RegionCutter, OrthogonalSetsCutTheProductOfTheirNumbers) {
  Scene scene = region_scene(rectangle_of(10.0, 8.0));
  scene.region.joint_sets = {through_going(0.0, 1.0, 1, {0.3, 0.4}), through_going(90.0, 1.0, 2, {0.3, 0.4})};
  const std::vector<SceneBlock> blocks = all_blocks(scene);
  EXPECT_EQ(blocks.size(), 11U * 9U);
  EXPECT_NEAR(total_area(blocks), 80.0, 80.0 * rounding);
  expect_sound(blocks);
  for (const SceneBlock &block : blocks) {
    ASSERT_EQ(block.vertices.size(), 4U);
    ASSERT_EQ(block.edge_joint.size(), 4U);
    for (std::size_t k = 0; k < 4; ++k) {
      const Vec2 from = block.vertices[k];
      const Vec2 to = block.vertices[(k + 1) % 4];
      const bool is_level = std::abs(to.y - from.y) < 1e-12;
      const bool on_outline =
          is_level ? from.y < 1e-12 || from.y > 8.0 - 1e-12 : from.x < 1e-12 || from.x > 10.0 - 1e-12;
      EXPECT_EQ(block.edge_joint[k], on_outline ? -1 : is_level ? 1 : 2);
    }
  }
}

// Joints along the outline are the outline.
TEST(RegionCutter, JointsOnTheOutlineCutNothing) {
  Scene scene = region_scene(rectangle_of(10.0, 8.0));
  scene.region.joint_sets = {through_going(0.0, 1.0, 1), through_going(-90.0, 1.0, 2)};
  const std::vector<SceneBlock> blocks = all_blocks(scene);
  EXPECT_EQ(blocks.size(), 80U);
  for (const SceneBlock &block : blocks) {
    EXPECT_NEAR(signed_area(block.vertices), 1.0, 1e-13);
  }
}

// n lines across a convex region with c crossings inside cut 1 + n + c faces.
TEST(RegionCutter, InclinedSetsObeyEuler) {
  Scene scene = region_scene(rectangle_of(10.0, 8.0));
  scene.region.joint_sets = {through_going(30.0, 0.7, 1, {0.1, 0.1}),
                             through_going(75.0, 1.1, 2, {0.2, 0.3})};
  const std::vector<SceneBlock> blocks = all_blocks(scene);
  std::vector<std::pair<Vec2, Vec2>> lines; // point and direction
  for (const JointSet &set : scene.region.joint_sets) {
    const Vec2 along{std::cos(set.dip.mean), std::sin(set.dip.mean)};
    for (int k = -50; k <= 50; ++k) {
      lines.emplace_back(set.origin + (k * set.spacing.mean) * perp(along), along);
    }
  }
  const auto is_inside = [](Vec2 p) { return p.x > 0.0 && p.x < 10.0 && p.y > 0.0 && p.y < 8.0; };
  std::size_t expected = 1;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    bool meets = false;
    for (int k = -20000; k <= 20000 && !meets; ++k) {
      meets = is_inside(lines[i].first + (k * 1e-3) * lines[i].second);
    }
    expected += meets ? 1 : 0;
    for (std::size_t j = 0; j < i; ++j) {
      const double across = cross(lines[i].second, lines[j].second);
      if (std::abs(across) > 0.1) {
        const double at = cross(lines[j].first - lines[i].first, lines[j].second) / across;
        expected += is_inside(lines[i].first + at * lines[i].second) ? 1 : 0;
      }
    }
  }
  EXPECT_EQ(blocks.size(), expected);
  EXPECT_NEAR(total_area(blocks), 80.0, 80.0 * rounding);
  EXPECT_EQ(num_non_convex(blocks), 0);
}

TEST(RegionCutter, JointsThatEndLeaveBlocksThatAreNotConvex) {
  Scene scene = region_scene(rectangle_of(20.0, 15.0));
  scene.region.joint_sets = {through_going(10.0, 1.0, 1, {0.3, 0.4}),
                             through_going(100.0, 1.0, 2, {0.3, 0.4})};
  for (JointSet &set : scene.region.joint_sets) {
    set.through_going = false;
    set.trace.mean = 3.0;
    set.gap.mean = 1.0;
  }
  const std::vector<SceneBlock> blocks = all_blocks(scene);
  EXPECT_GT(blocks.size(), 50U);
  EXPECT_GT(num_non_convex(blocks), 5);
  EXPECT_NEAR(total_area(blocks), 300.0, 300.0 * rounding);
  expect_sound(blocks);
  // Nothing is left of joints that end within a block: each vertex is a corner.
  for (const SceneBlock &block : blocks) {
    for (std::size_t k = 0; k < block.vertices.size(); ++k) {
      const Vec2 in = block.vertices[(k + 1) % block.vertices.size()] - block.vertices[k];
      const Vec2 out =
          block.vertices[(k + 2) % block.vertices.size()] - block.vertices[(k + 1) % block.vertices.size()];
      EXPECT_GT(std::abs(cross(in, out)), 1e-9 * norm(in) * norm(out));
    }
  }
}

TEST(RegionCutter, EveryEdgeKnowsItsFamily) {
  const Scene scene = jointed_slope();
  const std::vector<SceneBlock> blocks = all_blocks(scene);
  const std::vector<Vec2> &tunnel = scene.region.openings[0].outline;
  const auto lies_on = [](const std::vector<Vec2> &outline, Vec2 p) {
    for (std::size_t k = 0; k < outline.size(); ++k) {
      const Vec2 edge = outline[(k + 1) % outline.size()] - outline[k];
      const double at = dot(p - outline[k], edge) / dot(edge, edge);
      if (at > -1e-9 && at < 1.0 + 1e-9 && std::abs(cross(edge, p - outline[k])) < 1e-9 * norm(edge)) {
        return true;
      }
    }
    return false;
  };
  std::map<std::int32_t, int> seen;
  for (const SceneBlock &block : blocks) {
    for (std::size_t k = 0; k < block.vertices.size() && !block.fixed; ++k) {
      const Vec2 from = block.vertices[k];
      const Vec2 to = block.vertices[(k + 1) % block.vertices.size()];
      const std::int32_t joint = block.edge_joint.empty() ? -1 : block.edge_joint[k];
      ++seen[joint];
      const bool on_outline =
          lies_on(scene.region.outline, 0.5 * (from + to)) || lies_on(tunnel, 0.5 * (from + to));
      EXPECT_EQ(joint == -1, on_outline);
      // Five deviations of Fisher's distribution are 10 degrees; the other set is not turned.
      const double dip = std::fmod(std::atan2(to.y - from.y, to.x - from.x) / per_degree + 360.0, 180.0);
      if (joint == 1) {
        EXPECT_NEAR(dip, 20.0, 12.0);
      } else if (joint == 2) {
        EXPECT_NEAR(dip, 105.0, 1e-3 / std::max(1e-3, norm(to - from)));
      }
    }
  }
  EXPECT_GT(seen[1], 100);
  EXPECT_GT(seen[2], 100);
}

// The layout of the tiles is no part of the answer, and where a share of them ends even less.
TEST(RegionCutter, TilesDoNotShow) {
  const Scene scene = jointed_slope();
  std::vector<SceneBlock> whole = all_blocks(scene);
  EXPECT_GT(whole.size(), 300U);
  EXPECT_NEAR(total_area(whole), signed_area(scene.region.outline),
              signed_area(scene.region.outline) * rounding);
  const RegionCutter cutter(scene, 40);
  EXPECT_GE(cutter.num_tiles(), 9);
  CutReport together;
  const std::vector<SceneBlock> tiled = cutter.make(0, cutter.num_tiles(), together).blocks;
  std::vector<SceneBlock> one_by_one;
  CutReport apart;
  for (std::int64_t tile = 0; tile < cutter.num_tiles(); ++tile) {
    for (SceneBlock &block : cutter.make(tile, tile + 1, apart).blocks) {
      one_by_one.push_back(std::move(block));
    }
  }
  EXPECT_TRUE(std::equal(tiled.begin(), tiled.end(), one_by_one.begin(), one_by_one.end(), same));
  EXPECT_EQ(together.merged_slivers, apart.merged_slivers);
  EXPECT_GT(together.merged_slivers, 0);
  const auto by_first_vertex = [](const SceneBlock &a, const SceneBlock &b) {
    return std::pair(a.vertices[0].x, a.vertices[0].y) < std::pair(b.vertices[0].x, b.vertices[0].y);
  };
  std::sort(whole.begin(), whole.end(), by_first_vertex);
  std::sort(one_by_one.begin(), one_by_one.end(), by_first_vertex);
  ASSERT_EQ(whole.size(), one_by_one.size());
  for (std::size_t k = 0; k < whole.size(); ++k) {
    EXPECT_TRUE(same(whole[k], one_by_one[k])) << k;
  }
}

// Beds across the whole region: a tile sees its blocks whole, and the joint that ends them, only when it sees
// everything.
TEST(RegionCutter, BlocksLongerThanManyTilesAreCutOnce) {
  Scene scene = region_scene(rectangle_of(100.0, 10.0));
  scene.region.joint_sets = {through_going(0.0, 0.5, 1, {0.0, 0.25})};
  scene.region.faults = {{"end", 2, {{90.0, -1.0}, {90.0, 11.0}}, {}}};
  const RegionCutter cutter(scene, 1);
  EXPECT_GE(cutter.num_tiles(), 10);
  const std::vector<SceneBlock> blocks = cutter.make(0, cutter.num_tiles()).blocks;
  EXPECT_EQ(blocks.size(), 2U * 21U);
  EXPECT_NEAR(total_area(blocks), 1000.0, 1000.0 * rounding);
}

class Slivers : public ::testing::Test {
protected:
  Slivers() : scene_(region_scene(rectangle_of(4.0, 4.0))) {
    scene_.region.faults = {{"a", 1, {{-1.0, 2.0}, {5.0, 2.0}}, {}},
                            {"b", 2, {{-1.0, 2.001}, {5.0, 2.001}}, {}}};
    scene_.region.joint_sets = {through_going(90.0, 1.0, 0, {0.5, 0.0})};
    scene_.region.min_width = 0.01;
  }
  Scene scene_;
};

// Of its two long edges, equal but for rounding, one goes: the strip joins the block behind it.
TEST_F(Slivers, AreMergedWithTheNeighbourOfTheLongestEdge) {
  const RegionCutter cutter(scene_);
  CutReport report;
  const std::vector<SceneBlock> blocks = cutter.make(0, 1, report).blocks;
  EXPECT_EQ(blocks.size(), 2U * 5U);
  EXPECT_EQ(report.merged_slivers, 5);
  EXPECT_TRUE(report.kept_slivers.empty());
  EXPECT_NEAR(total_area(blocks), 16.0, 16.0 * rounding);
  expect_sound(blocks);
}

TEST_F(Slivers, AreRefusedByNameOfPlace) {
  scene_.region.slivers = SliverRule::refuse;
  const BlockSource::Made made = RegionCutter(scene_).make(0, 1);
  ASSERT_EQ(made.faults.size(), 5U);
  EXPECT_EQ(made.faults[0].what, "the block at [0, 2] is a sliver");
}

TEST_F(Slivers, StayWhereTheSceneKeepsThem) {
  scene_.region.slivers = SliverRule::keep;
  EXPECT_EQ(all_blocks(scene_).size(), 3U * 5U);
}

TEST_F(Slivers, DoNotLeaveTheirRock) {
  scene_.region.layers = {{0, 1, {{-1.0, 2.0}, {5.0, 2.0}, {5.0, 2.001}, {-1.0, 2.001}}, {}}};
  const RegionCutter cutter(scene_);
  CutReport report;
  const std::vector<SceneBlock> blocks = cutter.make(0, 1, report).blocks;
  EXPECT_EQ(report.kept_slivers.size(), 1U); // the five are one strip in the end
  EXPECT_EQ(blocks.size(), 2U * 5U + 1U);
}

TEST(RegionCutter, ABlockAroundOthersIsCutIntoBlocksWithoutHoles) {
  Scene scene = region_scene(rectangle_of(6.0, 6.0));
  scene.region.faults = {{"a", 1, {{2.0, 2.0}, {4.0, 2.0}, {4.0, 4.0}, {2.0, 4.0}, {2.0, 2.0}}, {}},
                         {"b", 2, {{2.0, 3.0}, {4.0, 3.0}}, {}}};
  const RegionCutter cutter(scene);
  CutReport report;
  const std::vector<SceneBlock> blocks = cutter.make(0, 1, report).blocks;
  EXPECT_EQ(report.cut_rings, 1);
  EXPECT_EQ(blocks.size(), 4U);
  EXPECT_NEAR(total_area(blocks), 36.0, 36.0 * rounding);
  expect_sound(blocks);
  for (const SceneBlock &block : blocks) {
    for (const SceneBlock &other : blocks) {
      EXPECT_TRUE(&block == &other ||
                  !holds_point(block.vertices, polygon_moments(other.vertices).centroid) ||
                  !is_convex(other.vertices));
    }
  }
}

TEST(RegionCutter, OpeningsAreNamedOrLeftOut) {
  Scene scene = jointed_slope();
  const double tunnel = signed_area(scene.region.openings[0].outline);
  double inside = 0.0;
  std::size_t num_inside = 0;
  const std::vector<SceneBlock> named = all_blocks(scene);
  for (const SceneBlock &block : named) {
    inside += block.opening == 0 ? signed_area(block.vertices) : 0.0;
    num_inside += block.opening == 0 ? 1 : 0;
  }
  EXPECT_NEAR(inside, tunnel, 1000.0 * rounding);
  EXPECT_GT(num_inside, 3U);
  scene.region.openings[0].excavated = true;
  const RegionCutter cutter(scene);
  CutReport report;
  const std::vector<SceneBlock> left = cutter.make(0, cutter.num_tiles(), report).blocks;
  EXPECT_EQ(left.size() + num_inside, named.size());
  EXPECT_NEAR(report.excavated_area.value(), tunnel, 1000.0 * rounding);
}

TEST(RegionCutter, LayersGiveMaterials) {
  Scene scene = region_scene(rectangle_of(10.0, 9.0));
  scene.region.joint_sets = {through_going(90.0, 2.0, 1, {1.0, 0.0})};
  scene.region.layers = {{2, 1, {{-1.0, 3.0}, {11.0, 3.0}, {11.0, 5.0}, {-1.0, 5.0}}, {}}};
  const std::vector<SceneBlock> blocks = all_blocks(scene);
  EXPECT_EQ(blocks.size(), 3U * 6U);
  double clay = 0.0;
  for (const SceneBlock &block : blocks) {
    clay += block.material == 1 ? signed_area(block.vertices) : 0.0;
  }
  EXPECT_NEAR(clay, 20.0, 90.0 * rounding);
}

TEST(RegionCutter, FixedBlocksLieAlongTheSides) {
  Scene scene = region_scene({{0.0, 0.0}, {9.0, 0.0}, {9.0, 7.0}, {5.0, 7.0}, {3.0, 4.0}, {0.0, 4.0}});
  scene.region.fixed = {true, true, true, false};
  const std::vector<SceneBlock> blocks = all_blocks(scene);
  ASSERT_EQ(blocks.size(), 4U);
  const std::vector<std::vector<Vec2>> expected{{{-1.0, -1.0}, {10.0, -1.0}, {10.0, 0.0}, {-1.0, 0.0}},
                                                {{-1.0, 0.0}, {0.0, 0.0}, {0.0, 4.0}, {-1.0, 4.0}},
                                                {{9.0, 0.0}, {10.0, 0.0}, {10.0, 7.0}, {9.0, 7.0}}};
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_TRUE(blocks[k + 1].fixed);
    EXPECT_EQ(blocks[k + 1].vertices, expected[k]);
  }
}

TEST(RegionCutter, FixedBlocksHoldASingleVertex) {
  Scene scene = region_scene({{0.0, 0.0}, {10.0, -2.0}, {9.0, 6.0}});
  scene.region.fixed = {true, true, true, true};
  const std::vector<SceneBlock> blocks = all_blocks(scene);
  ASSERT_EQ(blocks.size(), 5U);
  const std::vector<std::vector<Vec2>> expected{{{9.0, -3.0}, {11.0, -3.0}, {11.0, -2.0}, {9.0, -2.0}},
                                                {{-1.0, -1.0}, {0.0, -1.0}, {0.0, 1.0}, {-1.0, 1.0}},
                                                {{10.0, -2.0}, {11.0, -2.0}, {11.0, -1.0}, {10.0, -1.0}},
                                                {{8.0, 6.0}, {10.0, 6.0}, {10.0, 7.0}, {8.0, 7.0}}};
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_EQ(blocks[k + 1].vertices, expected[k]);
  }
}

// Far from the origin nothing is lost but the digits of the coordinates.
TEST(RegionCutter, AFarRegionKeepsItsVertices) {
  const std::vector<Vec2> outline{
      {512345.1, 4e6 + 0.7}, {512365.3, 4e6 + 0.7}, {512365.3, 4e6 + 15.9}, {512345.1, 4e6 + 15.9}};
  Scene scene = region_scene(outline);
  scene.region.joint_sets = {through_going(33.0, 1.0, 1, outline[0]),
                             through_going(121.0, 1.0, 2, outline[0])};
  scene.region.min_width = 1e-3;
  const std::vector<SceneBlock> blocks = all_blocks(scene);
  EXPECT_GT(blocks.size(), 250U);
  // Coordinates of 4e6 m are rounded by 5e-10 m; 600 m of joints.
  EXPECT_NEAR(total_area(blocks), signed_area(outline), 600.0 * 1e-9);
  expect_sound(blocks);
  std::size_t corners = 0;
  for (const SceneBlock &block : blocks) {
    for (const Vec2 p : block.vertices) {
      corners += static_cast<std::size_t>(std::count(outline.begin(), outline.end(), p));
    }
  }
  EXPECT_GE(corners, 4U);
}

TEST(RegionCutter, VoronoiCellsHaveTheirMeanArea) {
  Scene scene = region_scene(rectangle_of(20.0, 20.0));
  VoronoiCells cells;
  cells.size = 1.0;
  cells.joint = 1;
  scene.region.voronoi = {cells};
  std::vector<SceneBlock> blocks = all_blocks(scene);
  EXPECT_NEAR(total_area(blocks), 400.0, 400.0 * rounding);
  EXPECT_EQ(num_non_convex(blocks), 0);
  // One cell for each of 400 sites and those of sites outside that reach in: at most a rim of 84.
  EXPECT_GE(blocks.size(), 400U);
  EXPECT_LE(blocks.size(), 484U);
  const RegionCutter tiled(scene, 50);
  EXPECT_GE(tiled.num_tiles(), 9);
  EXPECT_EQ(tiled.make(0, tiled.num_tiles()).blocks.size(), blocks.size());
  cells.seed = 1;
  scene.region.voronoi = {cells};
  EXPECT_NE(all_blocks(scene)[0].vertices, blocks[0].vertices);
}

TEST(RegionCutter, BricksAreBonded) {
  Scene scene = region_scene(rectangle_of(4.0, 1.0));
  BrickPattern bricks;
  bricks.size = {1.0, 0.25};
  bricks.bond = 0.5;
  scene.region.bricks = {bricks};
  // Two rows of four bricks and two of three with halves at both ends.
  const std::vector<SceneBlock> blocks = all_blocks(scene);
  EXPECT_EQ(blocks.size(), 2U * 4U + 2U * 5U);
  for (const SceneBlock &block : blocks) {
    EXPECT_EQ(block.vertices.size(), 4U);
  }
}

TEST(RegionCutter, ExpectsAboutAsManyBlocksAsItCuts) {
  for (const double dip : {0.0, 30.0, 70.0}) {
    Scene scene = region_scene(rectangle_of(30.0, 20.0));
    scene.region.joint_sets = {through_going(dip, 0.7, 1, {0.3, 0.4}),
                               through_going(dip + 65.0, 1.1, 2, {0.3, 0.4})};
    const auto cut = static_cast<double>(all_blocks(scene).size());
    EXPECT_NEAR(expected_blocks(scene.region), cut, 0.1 * cut);
  }
}

TEST(BlockQuality, KnowsWhatIsPoor) {
  SceneBlock needle;
  needle.vertices = {{0.0, 0.0}, {10.0, 0.0}, {10.0, 1.0}};
  SceneBlock square;
  square.vertices = {{0.0, 0.0}, {1.0, 0.0}, {1.0, 1.0}, {0.0, 1.0}};
  SceneBlock strip;
  strip.vertices = {{0.0, 0.0}, {100.0, 0.0}, {100.0, 0.5}, {0.0, 0.5}};
  BlockQuality quality;
  quality.add(7, needle);
  quality.add(8, square);
  quality.add(9, strip);
  EXPECT_NEAR(sharpest_corner(needle.vertices), std::atan(0.1) / per_degree, 1e-12);
  EXPECT_NEAR(mean_width(5.0, needle.vertices), 5.0 / std::sqrt(101.0), 1e-14);
  EXPECT_EQ(quality.num_blocks, 3);
  EXPECT_EQ(quality.num_needles, 1);
  EXPECT_EQ(quality.num_slivers, 1);
  EXPECT_EQ(quality.sharpest[0].id, 7);
  EXPECT_EQ(quality.narrowest[0].id, 9);
  EXPECT_EQ(quality.area.value(), 56.0);
  EXPECT_EQ(quality.areas.counts()[static_cast<std::size_t>(0 - PowerHistogram::lowest)],
            1); // [1, 2): the square
}

} // namespace
} // namespace gcpdda::blockgen_test
