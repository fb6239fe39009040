// Traces that nearly coincide, or nearly cross in one point, leave neither dust nor spikes.

#include "blockgen/dust_faces.hpp"
#include "geometry/polygon.hpp"
#include "support/regions.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

namespace gcpdda::dust_faces_test {
namespace {

using testing::all_blocks;
using testing::rectangle_of;
using testing::region_scene;
using testing::same;
using testing::total_area;

constexpr double hair = 1e-4; // m, by which traces miss each other
constexpr double min_width = 0.04;

/// A region of 20 x 10 m cut by the lines of one map, of the law "one".
Scene mapped(std::vector<std::vector<Vec2>> lines) {
  Scene scene = region_scene(rectangle_of(20.0, 10.0));
  JointMap map;
  map.lines = std::move(lines);
  map.joint = 1;
  scene.region.maps = {map};
  scene.region.min_width = min_width;
  scene.region.min_area = min_width * min_width;
  return scene;
}

/// Traces through the middle, each off by a part of a hair.
std::vector<std::vector<Vec2>> star(int count) {
  std::vector<std::vector<Vec2>> lines;
  for (int k = 0; k < count; ++k) {
    const double angle = k * std::numbers::pi / count + 0.01;
    const Vec2 along{std::cos(angle), std::sin(angle)};
    const Vec2 middle = Vec2{10.0, 5.0} + (0.5 * hair * std::sin(7.0 * k)) * Vec2{-along.y, along.x};
    lines.push_back({middle - 15.0 * along, middle + 15.0 * along});
  }
  return lines;
}

/// Each line of a grid drawn three times.
std::vector<std::vector<Vec2>> grid_drawn_thrice() {
  std::vector<std::vector<Vec2>> lines;
  double seed = 1.0;
  const auto off = [&] { return hair * std::sin(13.0 * seed++); };
  for (int copy = 0; copy < 3; ++copy) {
    for (const double y : {2.5, 5.0, 7.5}) {
      lines.push_back({{-1.0, y + off()}, {21.0, y + 0.3 + off()}});
    }
    for (const double x : {4.0, 8.0, 12.0, 16.0}) {
      lines.push_back({{x + off(), -1.0}, {x + 1.0 + off(), 11.0}});
    }
  }
  return lines;
}

double narrowest_of(const std::vector<SceneBlock> &blocks) {
  double narrowest = std::numeric_limits<double>::infinity();
  for (const SceneBlock &block : blocks) {
    EXPECT_TRUE(is_simple(block.vertices));
    narrowest = std::min(narrowest, narrowest_width(block.vertices));
  }
  return narrowest;
}

/// Edges inside of the region without the law of the map.
int edges_without_law(const std::vector<SceneBlock> &blocks) {
  int count = 0;
  for (const SceneBlock &block : blocks) {
    for (std::size_t k = 0; k < block.vertices.size(); ++k) {
      const Vec2 middle = 0.5 * (block.vertices[k] + block.vertices[(k + 1) % block.vertices.size()]);
      const bool is_inside = std::min({middle.x, middle.y, 20.0 - middle.x, 10.0 - middle.y}) > 1e-9;
      count += is_inside && (block.edge_joint.empty() || block.edge_joint[k] != 1) ? 1 : 0;
    }
  }
  return count;
}

TEST(DustFaces, OfTracesThroughNearlyOnePointShrinkToIt) {
  const std::vector<SceneBlock> blocks = all_blocks(mapped(star(12)));
  EXPECT_EQ(blocks.size(), 24U);
  EXPECT_NEAR(total_area(blocks), 200.0, 1e-10);
  EXPECT_GE(narrowest_of(blocks), min_width);
  EXPECT_EQ(edges_without_law(blocks), 0);
  for (const SceneBlock &block : blocks) {
    EXPECT_TRUE(is_convex(block.vertices));
    EXPECT_LE(block.vertices.size(), 4U);
  }
}

TEST(DustFaces, OfTracesDrawnThriceLeaveNoSpikes) {
  const std::vector<SceneBlock> blocks = all_blocks(mapped(grid_drawn_thrice()));
  EXPECT_EQ(blocks.size(), 20U);
  EXPECT_NEAR(total_area(blocks), 200.0, 1e-10);
  EXPECT_GE(narrowest_of(blocks), min_width);
  EXPECT_EQ(edges_without_law(blocks), 0);
}

// Whatever is seen around a tile: with joint sets that make the tiles small.
TEST(DustFaces, ShrinkAlikeInTiles) {
  for (const auto &lines : {star(12), grid_drawn_thrice()}) {
    Scene scene = mapped(lines);
    scene.region.joint_sets = {testing::through_going(20.0, 1.0, 2), testing::through_going(110.0, 1.0, 2)};
    const std::vector<SceneBlock> whole = all_blocks(scene);
    EXPECT_NEAR(total_area(whole), 200.0, 1e-10);
    const RegionCutter cutter(scene, 4);
    ASSERT_GT(cutter.num_tiles(), 20);
    const std::vector<SceneBlock> parts = cutter.make(0, cutter.num_tiles()).blocks;
    ASSERT_EQ(parts.size(), whole.size());
    for (const SceneBlock &block : whole) {
      EXPECT_TRUE(
          std::any_of(parts.begin(), parts.end(), [&](const SceneBlock &part) { return same(block, part); }));
    }
  }
}

// A triangle of 2 cm, above the tenth of min_width, becomes part of a neighbour.
TEST(DustFaces, LeaveLargerSliversToBeMerged) {
  const std::vector<SceneBlock> blocks = all_blocks(
      mapped({{{-1.0, 5.0}, {21.0, 5.0}}, {{10.0, -1.0}, {10.0, 11.0}}, {{4.02, -1.0}, {16.02, 11.0}}}));
  EXPECT_EQ(blocks.size(), 6U);
  EXPECT_NEAR(total_area(blocks), 200.0, 1e-10);
}

constexpr blockgen::SliverSizes wide_slivers{10.0, 0.0}; // dust is within 1 m

enum Face : std::size_t { below, strip, right_strip, rightmost, above, top, a, b, c, d, x };

/// Strips of rock with triangles of dust on their borders. Each triangle shrinks to its tip.
/// - c and d stand side by side on the strip `above`, from which a corner hangs down between them: that strip
///   holds the tip of one of them, but the line between both would cross the corner.
/// - a and b do the same to the strip below, with a corner of c between them that goes out of their way where
///   c shrinks.
/// - x shares a face with d alone.
std::vector<blockgen::RockFace> heaps_in_a_row() {
  const std::vector<std::vector<Vec2>> rings{
      {{-5, -5}, {5, -5}, {5, 0}, {4, 0}, {2.7, 0}, {0.9, 0}, {0.3, 0}, {-0.3, 0}, {-0.9, 0}, {-5, 0}},
      {{-5, 0},
       {-0.9, 0},
       {-0.6, 0.4},
       {-0.3, 0},
       {0.3, 0},
       {0.6, 0.4},
       {0.9, 0},
       {2.7, 0},
       {2.7, 0.5},
       {0.75, 0.5},
       {0, 0.35},
       {-0.5, 0.5},
       {-5, 0.5}},
      {{2.7, 0}, {4, 0}, {4, 0.1}, {3.8, 0.25}, {4, 0.4}, {4, 0.5}, {3.3, 0.5}, {2.7, 0.5}},
      {{4, 0}, {5, 0}, {5, 0.5}, {4, 0.5}, {4, 0.4}, {4, 0.1}},
      {{-5, 0.5},
       {-0.5, 0.5},
       {0, 0.35},
       {0.25, 0.95},
       {0.75, 0.5},
       {2.7, 0.5},
       {3, 0.9},
       {3.3, 0.5},
       {4, 0.5},
       {5, 0.5},
       {5, 2},
       {1.7, 0.8},
       {-5, 2}},
      {{-5, 2}, {1.7, 0.8}, {5, 2}, {5, 5}, {-5, 5}},
      {{-0.9, 0}, {-0.3, 0}, {-0.6, 0.4}},
      {{0.3, 0}, {0.9, 0}, {0.6, 0.4}},
      {{0, 0.35}, {0.75, 0.5}, {0.25, 0.95}},
      {{2.7, 0.5}, {3.3, 0.5}, {3, 0.9}},
      {{3.8, 0.25}, {4, 0.1}, {4, 0.4}}};
  std::vector<blockgen::RockFace> faces;
  for (const std::vector<Vec2> &ring : rings) {
    blockgen::RockFace face;
    face.shape.outer = ring;
    face.area = signed_area(ring);
    face.box = bounding_box(ring);
    face.is_sliver = blockgen::is_sliver(face, wide_slivers);
    faces.push_back(std::move(face));
  }
  return faces;
}

// That c and d stay leaves a and b with a corner between them.
TEST(DustFaces, ShrinkTogetherWithoutCrossingAFace) {
  std::vector<blockgen::RockFace> faces = heaps_in_a_row();
  blockgen::MovedEdges moved;
  shrink_dust(wide_slivers, faces, moved);
  EXPECT_EQ(faces.size(), 10U) << "x shrinks";
  double area = 0.0;
  for (const blockgen::RockFace &face : faces) {
    EXPECT_TRUE(is_simple(face.shape.outer)) << face.corner().x << ", " << face.corner().y;
    EXPECT_GT(signed_area(face.shape.outer), 0.0);
    area += signed_area(face.shape.outer);
  }
  EXPECT_NEAR(area, 100.0, 1e-12);
}

// Where more of x may lie beyond what is seen, d is doubtful, and with it c, a and b, one after the other.
TEST(DustFaces, AreDoubtfulAsFarAsTheUnknownReaches) {
  std::vector<blockgen::RockFace> faces = heaps_in_a_row();
  faces[rightmost].is_certain = false;
  blockgen::MovedEdges moved;
  shrink_dust(wide_slivers, faces, moved);
  EXPECT_FALSE(faces[below].is_certain) << "it depends on a and b";
  EXPECT_TRUE(faces[top].is_certain) << "it has no vertex of dust";
}

// Without c between them nothing depends on d.
TEST(DustFaces, AreCertainWhereEveryOutcomeIsTheSame) {
  std::vector<blockgen::RockFace> faces = heaps_in_a_row();
  faces[rightmost].is_certain = false;
  faces[strip].shape.outer[10] = {0, 0.5}; // the corner between a and b lies higher
  faces[above].shape.outer[2] = {0, 0.5};
  faces[c].shape.outer[0] = {0, 0.5};
  blockgen::MovedEdges moved;
  shrink_dust(wide_slivers, faces, moved);
  EXPECT_TRUE(faces[below].is_certain);
  EXPECT_TRUE(is_simple(faces[below].shape.outer));
}

} // namespace
} // namespace gcpdda::dust_faces_test
