// Joints through a corner of the region, which rounding takes to either side of it.

#include "blockgen/necks.hpp"
#include "geometry/polygon.hpp"
#include "support/regions.hpp"
#include "support/scenes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace gcpdda::necks_test {
namespace {

using blockgen::NeckCut;
using blockgen::PlaneFace;
using testing::all_blocks;
using testing::per_degree;
using testing::region_scene;
using testing::through_going;

void expect_simple(const std::vector<SceneBlock> &blocks) {
  for (const SceneBlock &block : blocks) {
    EXPECT_TRUE(is_simple(block.vertices));
  }
}

// Two triangles that meet on the upper edge of a rectangle are one ring with a neck there. The rectangle gets
// the vertex.
TEST(Necks, AreCutOnBothSidesOfTheEdge) {
  const blockgen::Ring bow{{0.0, 0.0}, {2.0, 0.0}, {2.0, 1.0}, {1.0, 0.0}, {0.0, 1.0}};
  std::vector<NeckCut> cuts;
  std::vector<PlaneFace> faces;
  for (const blockgen::Ring &part : blockgen::without_necks(bow, 1e-12, cuts)) {
    EXPECT_NEAR(signed_area(part), 0.5, 1e-15);
    faces.push_back({part, {}});
  }
  ASSERT_EQ(faces.size(), 2U);
  ASSERT_EQ(cuts.size(), 1U);
  EXPECT_EQ(cuts[0].vertex, (Vec2{1.0, 0.0}));
  faces.push_back({{{0.0, -1.0}, {2.0, -1.0}, {2.0, 0.0}, {0.0, 0.0}}, {}});
  blockgen::share_vertices(cuts, faces);
  EXPECT_EQ(faces[0].outer.size(), 3U);
  EXPECT_EQ(faces[1].outer.size(), 3U);
  EXPECT_EQ(faces[2].outer, (blockgen::Ring{{0.0, -1.0}, {2.0, -1.0}, {2.0, 0.0}, {1.0, 0.0}, {0.0, 0.0}}));
}

/// How often the outlines of blocks come to the origin, at most: with a vertex or with an edge through it.
int most_visits_to_origin(const std::vector<SceneBlock> &blocks) {
  int most = 0;
  for (const SceneBlock &block : blocks) {
    const std::size_t n = block.vertices.size();
    int visits = 0;
    for (std::size_t k = 0; k < n; ++k) {
      const Vec2 from = block.vertices[k];
      const Vec2 along = block.vertices[(k + 1) % n] - from;
      const double at = dot(-from, along) / dot(along, along);
      const bool passes = at > 1e-6 && at < 1.0 - 1e-6 && std::abs(cross(along, from)) < 1e-12 * norm(along);
      visits += passes || norm(from) < 1e-12 ? 1 : 0;
    }
    most = std::max(most, visits);
  }
  return most;
}

// A joint through a re-entrant corner, as bedding through the toe of a slope, ends both blocks there: which
// side rounding takes it to is not seen.
TEST(Necks, JointsThroughACornerLeaveNoNeck) {
  for (int dip = 5; dip < 60; dip += 6) {
    SCOPED_TRACE(dip);
    const double face = 72.0 * per_degree;
    const Vec2 crest{10.0 / std::tan(face), 10.0};
    Scene scene = region_scene({{-9.0, -8.0}, {20.0, -8.0}, {20.0, 10.0}, crest, {0.0, 0.0}, {-9.0, 0.0}});
    scene.region.joint_sets = {through_going(dip, 0.84, 1), through_going(85.0, 1.1, 2, {0.3, 0.2})};
    const std::vector<SceneBlock> blocks = all_blocks(scene);
    expect_simple(blocks);
    EXPECT_EQ(most_visits_to_origin(blocks), 1) << "a block that touches itself";
  }
}

// A flat joint through the toe leaves wedges below the floor that become part of the rock on its other side,
// and nothing is left of the joint between them. With these seeds rounding takes it beside the toe.
TEST(Necks, SliversAtACornerLeaveNoSlit) {
  for (const int seed : {1, 2, 3}) {
    SCOPED_TRACE(seed);
    const std::vector<SceneBlock> blocks = all_blocks(testing::scene_of(R"(
[run]
duration = 1.0
fidelity = "rigid"
[material.rock]
density = 2600.0
[joint.default]
normal_stiffness = 1e9
[region]
material = "rock"
min_width = 0.194
[region.slope]
toe_length = 14.6
crest_length = 26.2
depth = 10.2
[[region.slope.bench]]
height = 14.55
face_angle_deg = 52.9
width = 6.6
[[region.slope.bench]]
height = 14.55
face_angle_deg = 55.6
[[joint_set]]
name = "flat"
dip_deg = 2.9
spacing = 1.62
spacing_scatter = {kind = "lognormal", deviation = 0.324}
seed = )" + std::to_string(seed) + R"(
[[joint_set]]
name = "steep"
dip_deg = 69.3
dip_scatter = {kind = "normal", deviation_deg = 3.0}
spacing = 1.61
trace_length = 12.04
gap = 0.85
seed = 1048
)"));
    expect_simple(blocks);
    EXPECT_EQ(most_visits_to_origin(blocks), 1) << "a block with a slit";
  }
}

} // namespace
} // namespace gcpdda::necks_test
