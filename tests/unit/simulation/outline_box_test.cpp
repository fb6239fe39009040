// A box without the outline holds the outline, also of a block that has been strained.

#include "simulation/bolt_pieces.hpp"
#include "simulation/outline_box.hpp"
#include "support/blocks.hpp"
#include "support/scenes.hpp"

#include <gtest/gtest.h>

namespace gcpdda::testing::outline_box_test {
namespace {

constexpr double far = 4e6; // m, as of a national grid

BlockSystem two_blocks() {
  BlockSystem system =
      system_of({rectangle({far, far}, {far + 3.0, far + 1.0}), rectangle({0.0, 0.0}, {2.0, 2.0})}, {},
                1000.0, [](std::size_t row) { return row == 1; });
  system.displacement[0].r = 0.7;
  system.deformation[system.deformation_begin[1]].gradient = {1.0, 4.0, 0.0, 1.0}; // far beyond its circle
  return system;
}

TEST(OutlineBox, HoldsTheOutline) {
  const BlockSystem system = two_blocks();
  for (std::size_t row = 0; row < system.num_owned; ++row) {
    const Aabb box = box_around(system, row);
    for (const Vec2 vertex : current_vertices(system, row)) {
      EXPECT_TRUE(box.holds(vertex)) << row;
    }
    EXPECT_LT(box.extent().x, 2.0 * 5.0 * system.properties[row].radius) << row;
  }
}

// A bolt beside the circle of the block before it was sheared.
TEST(OutlineBox, BoltsFindABlockThatHasBeenSheared) {
  const BlockSystem system = two_blocks();
  Scene scene;
  scene.bolts.resize(2);
  scene.bolts[0].from = {4.5, 1.8};
  scene.bolts[0].to = {4.7, 1.9};
  scene.bolts[1].from = {50.0, 1.8};
  scene.bolts[1].to = {51.0, 1.8};
  const std::vector<std::int64_t> which{0, 1};
  std::vector<BoltPiece> pieces;
  append_pieces(scene, which, system, 1, pieces);
  ASSERT_EQ(pieces.size(), 1U);
  EXPECT_EQ(pieces[0].bolt, 0);
  EXPECT_EQ(pieces[0].begin, 0.0);
  EXPECT_EQ(pieces[0].end, 1.0);
}

} // namespace
} // namespace gcpdda::testing::outline_box_test
