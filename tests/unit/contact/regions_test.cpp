// Regions of contacts with re-entrant blocks: which pieces share a spring.

#include "support/scenes.hpp"
#include "support/shapes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace gcpdda::regions_test {
namespace {

using namespace testing;

const std::vector<Vec2> l_shape{{0, 0}, {4, 0}, {4, 1}, {1, 1}, {1, 4}, {0, 4}};
const std::vector<Vec2> u_shape{{0, 0}, {3, 0}, {3, 2}, {2, 2}, {2, 1}, {1, 1}, {1, 2}, {0, 2}};
const std::vector<Vec2> v_notch{{0, -3}, {6, -3}, {6, 2}, {5, 2}, {3, 0}, {1, 2}, {0, 2}};

std::vector<RegionFaces> faces_of(const Shape &first, const Shape &second) {
  Overlap overlap;
  overlap.find(first.view(), second.view(), PotentialKind::exact);
  std::vector<RegionFaces> faces;
  for (const Region &region : overlap.regions()) {
    faces.push_back(region.faces);
  }
  return faces;
}

/// What must hold of any list of regions.
void expect_sound(const Shape &first, const Shape &second) {
  Overlap overlap;
  const bool found = overlap.find(first.view(), second.view(), PotentialKind::exact);
  EXPECT_EQ(found, !overlap.regions().empty());
  std::uint32_t next = 0;
  for (const Region &region : overlap.regions()) {
    EXPECT_EQ(region.begin, next);
    EXPECT_LE(region.begin, region.middle);
    EXPECT_LE(region.middle, region.end);
    next = region.end;
    double pressure = 0.0;
    for (std::uint32_t i = region.begin; i < region.end; ++i) {
      const Piece &piece = overlap.pieces()[i];
      const Shape &own = i < region.middle ? first : second;
      EXPECT_EQ(piece.normal, own.normal.at(static_cast<std::size_t>(piece.edge)));
      pressure += piece.length * (piece.depth_begin + piece.depth_end);
    }
    EXPECT_GT(pressure, 0.0);
  }
  EXPECT_EQ(next, overlap.pieces().size());
  EXPECT_TRUE(std::is_sorted(overlap.regions().begin(), overlap.regions().end(),
                             [](const Region &a, const Region &b) { return a.faces < b.faces; }));
}

TEST(Regions, WedgeInANotchHasOneOnEachFace) {
  const Shape notch = shape_of(v_notch);
  // Blunter than the notch's 90 degrees: it rests on the notch's edges; sharper: at its bottom.
  for (const double half : {1.0, 0.9}) {
    const Shape wedge = shape_of({{3.0, -0.01}, {3.0 + 2.0 * half, 1.99}, {3.0 - 2.0 * half, 1.99}});
    EXPECT_EQ(faces_of(wedge, notch).size(), 2U);
    EXPECT_EQ(faces_of(notch, wedge).size(), 2U);
    expect_sound(wedge, notch);
    expect_sound(notch, wedge);
  }
  // Sunk by the same depth on both faces the two carry the same, and only sideways forces cancel.
  const Shape wedge = shape_of({{3.0, -0.01}, {5.0, 1.99}, {1.0, 1.99}});
  Overlap overlap;
  ASSERT_TRUE(overlap.find(wedge.view(), notch.view(), PotentialKind::exact));
  const RegionIntegrals left = overlap.integrate(overlap.regions()[0]);
  const RegionIntegrals right = overlap.integrate(overlap.regions()[1]);
  EXPECT_NEAR(left.force.x + right.force.x, 0.0, 1e-15);
  EXPECT_NEAR(left.force.y, right.force.y, 1e-15);
  EXPECT_GT(std::abs(left.force.x), 0.9 * left.force.y) << "each presses along its face's normal";
}

// The notch is the block's only re-entrant vertex, so both faces are ends of one stretch; and the wedge has a
// re-entrant vertex far away, so its own outline, which runs through the tip, would connect them.
TEST(Regions, AreCutAtTheOtherBlocksOnlyReentrantVertexToo) {
  const Shape wedge = shape_of({{3.0, -0.01}, {5.0, 1.99}, {3.0, 1.5}, {1.0, 1.99}});
  EXPECT_EQ(faces_of(wedge, shape_of(v_notch)).size(), 2U);
  EXPECT_EQ(faces_of(shape_of(v_notch), wedge).size(), 2U);
}

TEST(Regions, BarOverTheProngsOfAUHasTwo) {
  const Shape bar = shape_of(rectangle({-1.0, 1.99}, {4.0, 3.0}));
  const std::vector<RegionFaces> faces = faces_of(shape_of(u_shape), bar);
  ASSERT_EQ(faces.size(), 2U);
  EXPECT_EQ(faces[0], (RegionFaces{0, 0}));
  EXPECT_EQ(faces[1], (RegionFaces{0, 0})) << "both on the outer stretch, through vertex 0";
  expect_sound(shape_of(u_shape), bar);
  expect_sound(bar, shape_of(u_shape));
}

TEST(Regions, BarOnAFlatFaceHasOne) {
  const Shape bar = shape_of(rectangle({1.5, 0.98}, {3.5, 2.0}));
  EXPECT_EQ(faces_of(shape_of(l_shape), bar).size(), 1U);
  EXPECT_EQ(faces_of(bar, shape_of(l_shape)).size(), 1U);
  // Over the whole leg, its end too.
  EXPECT_EQ(faces_of(shape_of(l_shape), shape_of(rectangle({1.5, 0.98}, {5.0, 2.0}))).size(), 1U);
  // Pushed into the corner it rests on both faces.
  EXPECT_EQ(faces_of(shape_of(l_shape), shape_of(rectangle({0.99, 0.98}, {3.5, 2.0}))).size(), 2U);
  // Split by vertices on the face it is still one.
  const Shape split = shape_of({{0, 0}, {4, 0}, {4, 1}, {3, 1}, {2.5, 1}, {2, 1}, {1, 1}, {1, 4}, {0, 4}});
  EXPECT_EQ(faces_of(split, bar).size(), 1U);
}

TEST(Regions, AreNumberedByTheStretchesFromVertexZero) {
  // Into the slot of the U: its bottom is a stretch of its own, number 1 counted from vertex 0.
  const Shape tip = shape_of({{1.5, 0.98}, {1.9, 3.0}, {1.1, 3.0}});
  EXPECT_EQ(faces_of(shape_of(u_shape), tip), (std::vector<RegionFaces>{{1, 0}}));
  EXPECT_EQ(faces_of(tip, shape_of(u_shape)), (std::vector<RegionFaces>{{0, 1}}));
  // Counted from another vertex 0 it is number 0: from the bottom's own first vertex.
  std::vector<Vec2> turned = u_shape;
  std::rotate(turned.begin(), turned.begin() + 4, turned.end());
  EXPECT_EQ(faces_of(shape_of(turned), tip), (std::vector<RegionFaces>{{0, 0}}));
  // A plug as wide as the slot, sunk on three faces: walls and bottom.
  const Shape plug = shape_of(rectangle({0.99, 0.99}, {2.01, 3.0}));
  const std::vector<RegionFaces> faces = faces_of(shape_of(u_shape), plug);
  EXPECT_EQ(faces, (std::vector<RegionFaces>{{0, 0}, {0, 0}, {1, 0}}));
}

TEST(Regions, OfTwoReentrantBlocksNameBothStretches) {
  // Two L's with their corners turned to each other, each leg's end on the other's inner face.
  const Shape other = shape_of(placed(l_shape, std::numbers::pi, {4.99, 4.99}));
  EXPECT_EQ(faces_of(shape_of(l_shape), other).size(), 2U);
  // Two U's hooked into each other: a prong of the second on the bottom of the first's slot.
  const std::vector<Vec2> wide{{0, 0}, {3, 0}, {3, 2}, {2.1, 2}, {2.1, 1}, {0.9, 1}, {0.9, 2}, {0, 2}};
  const Shape hook = shape_of(placed(wide, std::numbers::pi, {4.05, 2.99}));
  EXPECT_EQ(faces_of(shape_of(wide), hook), (std::vector<RegionFaces>{{0, 1}, {1, 0}}));
}

TEST(Regions, TouchingWithoutDepthHasNone) {
  const Shape bar = shape_of(rectangle({1.5, 1.0}, {3.5, 2.0}));
  EXPECT_TRUE(faces_of(shape_of(l_shape), bar).empty());
  EXPECT_TRUE(faces_of(shape_of(l_shape), shape_of(rectangle({1.0, 1.0}, {2.0, 2.0}))).empty());
}

TEST(Regions, OfRandomPairsAreSoundAndLoseNothing) {
  std::mt19937 engine(31);
  int several = 0;
  for (int trial = 0; trial < 1000; ++trial) {
    const Shape a = shape_of(star_polygon(engine, 9, 0.4, 1.0, {}));
    const Shape b = shape_of(star_polygon(engine, 8, 0.4, 1.0, {uniform(engine, 0.8, 1.9), 0.3}));
    expect_sound(a, b);
    several += faces_of(a, b).size() > 1 ? 1 : 0;
    // The other way round the same regions come out: as many, with the faces exchanged.
    ASSERT_EQ(contact_of(a, b).pressure > 0.0, contact_of(b, a).pressure > 0.0);
    ASSERT_FALSE(HasFailure()) << trial;
  }
  EXPECT_GT(several, 100);
}

} // namespace
} // namespace gcpdda::regions_test
