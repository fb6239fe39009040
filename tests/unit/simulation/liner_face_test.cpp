// Which blocks a liner finds along its path, and the elements between them.

#include "simulation/bolts.hpp"
#include "simulation/liner_face.hpp"
#include "support/blocks.hpp"
#include "support/setting.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace gcpdda::testing::liner_face_test {
namespace {

constexpr double thickness = 0.1;

Liner liner_on(std::vector<Vec2> path, bool is_closed = false) {
  Liner liner;
  liner.path = std::move(path);
  liner.is_closed = is_closed;
  return liner;
}

LinerElements lay(const Liner &liner, const std::vector<std::vector<Vec2>> &blocks,
                  double depth = thickness) {
  const LinerPath path = path_of(liner, depth, true);
  std::vector<FaceHit> hits(path.stations.size());
  for (std::size_t k = 0; k < blocks.size(); ++k) {
    meet(path, blocks[k], static_cast<std::int64_t>(k), hits);
  }
  return elements_of(3, path, depth, hits);
}

/// A roof of unit squares, the rock above y = 0; the path goes to the left so that the rock is on its right.
const Liner roof = liner_on({{3.0, 0.0}, {0.0, 0.0}});
std::vector<std::vector<Vec2>> squares() {
  return {rectangle({0.0, 0.0}, {1.0, 1.0}), rectangle({1.0, 0.0}, {2.0, 1.0}),
          rectangle({2.0, 0.0}, {3.0, 1.0})};
}

TEST(LinerFace, HasAnElementFromMiddleToMiddle) {
  const LinerElements elements = lay(roof, squares());
  EXPECT_EQ(elements.num_stretches, 3);
  EXPECT_EQ(elements.num_gaps, 0);
  ASSERT_EQ(elements.links.size(), 2U);
  const BoltLink &first = elements.links[0];
  EXPECT_EQ(first.liner, 3);
  EXPECT_EQ(first.bolt, -1);
  EXPECT_FALSE(first.head_first); // along the path block 2 comes before block 1
  EXPECT_EQ(first.end[0].block, 1);
  EXPECT_EQ(first.end[1].block, 2);
  // Stations are 1/80 m apart and even on a block.
  EXPECT_NEAR(norm(first.end[0].point - Vec2{1.5, 0.0}), 0.0, 1e-12);
  EXPECT_NEAR(norm(first.end[1].point - Vec2{2.5, 0.0}), 0.0, 1e-12);
  EXPECT_EQ(first.end[0].along, (Vec2{1.0, 0.0}));
  EXPECT_NEAR(first.length, 1.0, 1e-12);
}

// 2 % of 3 m is less than the thickness: a block may have moved by 0.1 m, and the node is on its face.
TEST(LinerFace, FollowsBlocksThatHaveMoved) {
  auto blocks = squares();
  blocks[1] = rectangle({1.0, -0.05}, {2.0, 0.95});
  LinerElements elements = lay(roof, blocks);
  ASSERT_EQ(elements.links.size(), 2U);
  EXPECT_NEAR(norm(elements.links[0].end[0].point - Vec2{1.5, -0.05}), 0.0, 1e-12);
  blocks[1] = rectangle({1.0, 0.15}, {2.0, 1.15});
  elements = lay(roof, blocks);
  EXPECT_TRUE(elements.links.empty());
  EXPECT_EQ(elements.num_gaps, 1);
  blocks[1] = rectangle({1.0, -0.15}, {2.0, 0.85}); // the ray begins inside it
  elements = lay(roof, blocks);
  EXPECT_EQ(elements.num_gaps, 1);
}

TEST(LinerFace, BridgesSliversAndCracks) {
  auto blocks = squares();
  blocks[1] = rectangle({1.0, 0.0}, {1.04, 1.0});
  blocks[2] = rectangle({1.1, 0.0}, {3.0, 1.0}); // a crack of 6 cm
  LinerElements elements = lay(roof, blocks);
  ASSERT_EQ(elements.links.size(), 1U);
  EXPECT_EQ(elements.links[0].end[0].block, 0);
  EXPECT_EQ(elements.links[0].end[1].block, 2);
  EXPECT_EQ(elements.num_gaps, 0);
  blocks[2] = rectangle({1.2, 0.0}, {3.0, 1.0}); // wider than the liner is thick
  elements = lay(roof, blocks);
  EXPECT_TRUE(elements.links.empty());
  EXPECT_EQ(elements.num_gaps, 1);
}

// Edges of 1 cm are shorter than the spacing of the stations on the long edges: 1/8 of 0.2 m. The sliver of
// 5 cm, a quarter of the thickness, is skipped on either kind of edge.
TEST(LinerFace, MeasuresSliversOnADigitisedProfile) {
  auto blocks = squares();
  blocks[0] = rectangle({0.0, 0.0}, {1.45, 1.0});
  blocks[1] = rectangle({1.45, 0.0}, {1.5, 1.0});
  blocks[2] = rectangle({1.5, 0.0}, {3.0, 1.0});
  std::vector<Vec2> digitised{{3.0, 0.0}};
  for (int k = 0; k <= 40; ++k) {
    digitised.push_back({1.7 - 0.01 * k, 0.0});
  }
  digitised.push_back({0.0, 0.0});
  for (const Liner &liner : {roof, liner_on(digitised)}) {
    const LinerElements elements = lay(liner, blocks, 0.2);
    EXPECT_EQ(elements.num_stretches, 2);
    ASSERT_EQ(elements.links.size(), 1U);
    EXPECT_EQ(elements.links[0].end[0].block, 0);
    EXPECT_EQ(elements.links[0].end[1].block, 2);
  }
}

/// Wedges around a circle of radius 2 that a polygon of as many sides stands for.
std::vector<std::vector<Vec2>> wedges(int count) {
  std::vector<std::vector<Vec2>> blocks;
  const auto at = [&](double radius, int k) {
    const double angle = 2.0 * std::numbers::pi * k / count;
    return Vec2{radius * std::cos(angle), radius * std::sin(angle)};
  };
  for (int k = 0; k < count; ++k) {
    blocks.push_back({at(2.0, k), at(4.0, k), at(4.0, k + 1), at(2.0, k + 1)});
  }
  return blocks;
}

TEST(LinerFace, ClosesAroundAnOpening) {
  const int count = 12;
  std::vector<Vec2> outline;
  for (const auto &wedge : wedges(count)) {
    outline.push_back(wedge.front());
  }
  const LinerElements elements = lay(liner_on(outline, true), wedges(count));
  ASSERT_EQ(elements.links.size(), 12U);
  const double apothem = 2.0 * std::cos(std::numbers::pi / count);
  for (const BoltLink &link : elements.links) {
    EXPECT_NEAR(link.length, 2.0 * apothem * std::sin(std::numbers::pi / count), 1e-12);
    EXPECT_NEAR(norm(link.end[0].point), apothem, 1e-12);
  }
  // Every block has two elements.
  for (std::int64_t block = 0; block < count; ++block) {
    EXPECT_EQ(std::count_if(elements.links.begin(), elements.links.end(),
                            [&](const BoltLink &link) {
                              return link.end[0].block == block || link.end[1].block == block;
                            }),
              2);
  }
  // One gone: the ring is open there.
  auto torn = wedges(count);
  torn[4] = rectangle({50.0, 0.0}, {51.0, 1.0});
  const LinerElements open = lay(liner_on(outline, true), torn);
  EXPECT_EQ(open.links.size(), 10U);
  EXPECT_EQ(open.num_gaps, 1);
}

// The path begins in a gap of 0.16 m. In half of it nothing is near, in the other half a block stands out
// beyond the reach of the stations.
TEST(LinerFace, AGapAtTheBeginningOfAClosedLinerIsOneGap) {
  const std::vector<Vec2> outline{{2.04, 0.0}, {4.0, 0.0}, {4.0, -4.0}, {0.0, -4.0}, {0.0, 0.0}};
  const std::vector<std::vector<Vec2>> blocks{
      rectangle({-1.0, 0.0}, {1.92, 1.0}), rectangle({2.08, 0.0}, {5.0, 1.0}),
      rectangle({4.0, -5.0}, {5.0, 0.0}),  rectangle({-1.0, -5.0}, {4.0, -4.0}),
      rectangle({-1.0, -4.0}, {0.0, 0.0}), rectangle({1.92, -0.15}, {2.0, 1.0})};
  const LinerPath path = path_of(liner_on(outline, true), thickness, false);
  std::vector<FaceHit> hits(path.stations.size());
  for (std::size_t k = 0; k < blocks.size(); ++k) {
    meet(path, blocks[k], static_cast<std::int64_t>(k), hits);
  }
  EXPECT_EQ(hits.front().block, FaceHit::nothing);
  EXPECT_EQ(hits.back().block, FaceHit::nothing);
  EXPECT_TRUE(
      std::any_of(hits.begin(), hits.end(), [](const FaceHit &hit) { return hit.block == FaceHit::inside; }));
  const LinerElements elements = elements_of(3, path, thickness, hits);
  EXPECT_EQ(elements.num_stretches, 5);
  EXPECT_EQ(elements.num_gaps, 1);
  EXPECT_EQ(elements.links.size(), 4U);
}

TEST(LinerFace, AnArcIsThePartOfAnOutline) {
  const std::vector<Vec2> square = rectangle({-2.0, 0.0}, {2.0, 4.0});
  const std::vector<Vec2> arch = arc_of(square, 0.0, std::numbers::pi); // right wall, roof, left wall
  ASSERT_EQ(arch.size(), 4U);
  EXPECT_EQ(arch[0], (Vec2{2.0, 0.0}));
  EXPECT_EQ(arch[1], (Vec2{2.0, 4.0}));
  EXPECT_EQ(arch[2], (Vec2{-2.0, 4.0}));
  EXPECT_EQ(arch[3], (Vec2{-2.0, 0.0}));
}

std::string face_toml(const std::string &points, const std::string &more = "") {
  std::string toml = head({.duration = 0.01});
  for (int k = 0; k < 3; ++k) {
    toml += block_toml(std::string("b") + static_cast<char>('0' + k),
                       rectangle({1.0 * k, 0.0}, {1.0 + k, 1.0}), "fixed = true");
  }
  return toml + block_toml("free", rectangle({20.0, 0.0}, {21.0, 1.0})) + more +
         "[support.layer]\nkind = \"liner\"\nthickness = 0.1\nyoungs_modulus = 2e10\n"
         "[[liner]]\nname = \"face\"\nsupport = \"layer\"\npoints = " +
         points + "\n";
}

/// What is said of the liner of such a scene, and the number of its elements.
std::pair<std::string, std::size_t> said_of(const std::string &toml) {
  const Simulation simulation(Communicator::self(), scene_of(toml));
  std::string said;
  for (const Diagnostic &note : simulation.notes()) {
    said += note.what + ";";
  }
  return {said, simulation.bolts().links().size()};
}

TEST(LinerFace, FindsTheSideOfTheRock) {
  using Said = std::pair<std::string, std::size_t>;
  EXPECT_EQ(said_of(face_toml("[[0, 0], [3, 0]]")), Said("", 2));
  EXPECT_EQ(said_of(face_toml("[[3, 0], [0, 0]]")), Said("", 2));
  EXPECT_EQ(said_of(face_toml("[[0, 1], [3, 1]]")), Said("", 2));
  EXPECT_EQ(said_of(face_toml("[[0, 5], [3, 5]]")), Said("liner 'face' touches no block;", 0));
  EXPECT_EQ(said_of(face_toml("[[1.2, 0], [1.8, 0]]")), Said("liner 'face' touches only one block;", 0));
  EXPECT_EQ(said_of(face_toml("[[0, 0.5], [3, 0.5]]")), Said("liner 'face' lies inside the rock;", 0));
  // Above the path first, then below it.
  EXPECT_EQ(said_of(face_toml("[[0, 0], [6, 0]]",
                              block_toml("below", rectangle({3.0, -1.0}, {6.0, 0.0}), "fixed = true"))),
            Said("liner 'face' has blocks on both sides;", 0));
}

// Whichever way the path was given, and whichever block has the lower id; at right angles to the left of it
// is the void.
TEST(LinerLines, RunWithTheRockOnTheirRight) {
  for (const char *points : {"[[0, 0], [3, 0]]", "[[3, 0], [0, 0]]"}) {
    std::string toml = face_toml(points);
    for (std::size_t at = toml.find("fixed = true"); at != std::string::npos;
         at = toml.find("fixed = true")) {
      toml.erase(at, 12);
    }
    const Simulation simulation(Communicator::self(), scene_of(toml));
    const std::vector<LinerLine> lines =
        simulation.bolts().liner_lines(Communicator::self(), simulation.blocks());
    ASSERT_EQ(lines.size(), 2U) << points;
    EXPECT_NEAR(norm(lines[0].points[0] - Vec2{2.5, 0.0}), 0.0, 1e-12);
    EXPECT_NEAR(norm(lines[0].points[1] - Vec2{1.5, 0.0}), 0.0, 1e-12);
    EXPECT_EQ(lines[1].points[0], lines[0].points[1]);
  }
}

} // namespace
} // namespace gcpdda::testing::liner_face_test
