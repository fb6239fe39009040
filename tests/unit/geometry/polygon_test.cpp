#include "geometry/polygon.hpp"

#include "geometry/aabb.hpp"
#include "geometry/common_area.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <vector>

namespace gcpdda::polygon_test {
namespace {

using Polygon = std::vector<Vec2>;

const Polygon unit_square{{0.0, 0.0}, {1.0, 0.0}, {1.0, 1.0}, {0.0, 1.0}};
const Polygon right_triangle{{0.0, 0.0}, {3.0, 0.0}, {0.0, 2.0}};
const Polygon l_shape{{0.0, 0.0}, {2.0, 0.0}, {2.0, 1.0}, {1.0, 1.0}, {1.0, 3.0}, {0.0, 3.0}};

Polygon regular(int num_vertices, double radius) {
  Polygon polygon;
  for (int i = 0; i < num_vertices; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / num_vertices;
    polygon.push_back({radius * std::cos(angle), radius * std::sin(angle)});
  }
  return polygon;
}

template <class Map> Polygon mapped(Polygon polygon, Map map) {
  std::transform(polygon.begin(), polygon.end(), polygon.begin(), map);
  return polygon;
}

Polygon moved(const Polygon &polygon, Vec2 by) {
  return mapped(polygon, [&](Vec2 p) { return p + by; });
}

Polygon reversed(Polygon polygon) {
  std::reverse(polygon.begin(), polygon.end());
  return polygon;
}

Polygon started_at(Polygon polygon, std::ptrdiff_t first) {
  std::rotate(polygon.begin(), polygon.begin() + first, polygon.end());
  return polygon;
}

void expect_near(const Moments &m, const Moments &exact, double tolerance) {
  EXPECT_NEAR(m.area, exact.area, tolerance);
  EXPECT_NEAR(m.xx, exact.xx, tolerance);
  EXPECT_NEAR(m.yy, exact.yy, tolerance);
  EXPECT_NEAR(m.xy, exact.xy, tolerance);
}

constexpr double rounding = 1e-14;

TEST(Moments, UnitSquare) {
  const Moments m = polygon_moments(unit_square);
  expect_near(m, {1.0, {}, 1.0 / 12, 1.0 / 12, 0.0}, rounding);
  EXPECT_NEAR(m.centroid.x, 0.5, rounding);
  EXPECT_NEAR(m.centroid.y, 0.5, rounding);
}

TEST(Moments, RightTriangle) {
  // About the centroid: b^3 h / 36, b h^3 / 36, -b^2 h^2 / 72.
  const Moments m = polygon_moments(right_triangle);
  expect_near(m, {3.0, {}, 54.0 / 36, 24.0 / 36, -36.0 / 72}, rounding);
  EXPECT_NEAR(m.centroid.x, 1.0, rounding);
  EXPECT_NEAR(m.centroid.y, 2.0 / 3.0, rounding);
}

// Two rectangles, 2 x 1 below and 1 x 2 above, and the parallel axis theorem.
TEST(Moments, ConcaveShapeIsTheSumOfItsRectangles) {
  const double area = 4.0;
  const Vec2 centroid{(2.0 * 1.0 + 2.0 * 0.5) / area, (2.0 * 0.5 + 2.0 * 2.0) / area};
  const Vec2 below = Vec2{1.0, 0.5} - centroid;
  const Vec2 above = Vec2{0.5, 2.0} - centroid;
  const double xx = 8.0 / 12 + 2.0 / 12 + 2.0 * below.x * below.x + 2.0 * above.x * above.x;
  const double yy = 2.0 / 12 + 8.0 / 12 + 2.0 * below.y * below.y + 2.0 * above.y * above.y;
  const double xy = 2.0 * below.x * below.y + 2.0 * above.x * above.y;
  for (std::ptrdiff_t first = 0; first < 6; ++first) {
    const Moments m = polygon_moments(started_at(l_shape, first));
    expect_near(m, {area, {}, xx, yy, xy}, 10 * rounding);
    EXPECT_NEAR(m.centroid.x, centroid.x, rounding);
    EXPECT_NEAR(m.centroid.y, centroid.y, rounding);
  }
}

TEST(Moments, RegularPolygon) {
  for (const int n : {3, 5, 6, 17}) {
    const double radius = 2.5;
    const double turn = 2.0 * std::numbers::pi / n;
    const double area = 0.5 * n * radius * radius * std::sin(turn);
    // Half of the polar moment, by symmetry.
    const double second = area * radius * radius * (2.0 + std::cos(turn)) / 12.0;
    const Moments m = polygon_moments(regular(n, radius));
    expect_near(m, {area, {}, second, second, 0.0}, 1e-12);
    EXPECT_NEAR(norm(m.centroid), 0.0, rounding * 10);
  }
}

// Vertices on a grid of 1/8 m are exact at 1e6 m too: moving must change the centroid alone, and no bit of
// the rest.
TEST(Moments, DistantOriginCostsNoDigits) {
  const Vec2 far{1e6, -2e6};
  for (const Polygon &polygon : {unit_square, right_triangle, l_shape}) {
    const Moments near = polygon_moments(polygon);
    const Moments m = polygon_moments(moved(polygon, far));
    EXPECT_EQ(m.area, near.area);
    EXPECT_EQ(m.xx, near.xx);
    EXPECT_EQ(m.yy, near.yy);
    EXPECT_EQ(m.xy, near.xy);
    EXPECT_NEAR(m.centroid.x, near.centroid.x + far.x, 1e-9);
    EXPECT_NEAR(m.centroid.y, near.centroid.y + far.y, 1e-9);
  }
}

TEST(Moments, TurnWithThePolygon) {
  const Moments m = polygon_moments(l_shape);
  for (const double angle : {0.3, 1.0, 2.0, -2.5}) {
    const Rotation rotation = Rotation::of(angle);
    const Moments turned = polygon_moments(mapped(l_shape, rotation));
    const double c = rotation.c;
    const double s = rotation.s;
    expect_near(turned,
                {m.area,
                 {},
                 c * c * m.xx - 2.0 * c * s * m.xy + s * s * m.yy,
                 s * s * m.xx + 2.0 * c * s * m.xy + c * c * m.yy,
                 c * s * (m.xx - m.yy) + (c * c - s * s) * m.xy},
                1e-13);
    EXPECT_NEAR(norm(turned.centroid - rotation(m.centroid)), 0.0, rounding * 10);
  }
}

TEST(Moments, ClockwiseRingIsAHole) {
  const Moments m = polygon_moments(l_shape);
  const Moments hole = polygon_moments(reversed(l_shape));
  expect_near(hole, {-m.area, {}, -m.xx, -m.yy, -m.xy}, 10 * rounding);
  EXPECT_NEAR(norm(hole.centroid - m.centroid), 0.0, rounding);
}

TEST(Moments, CollinearVertexChangesNothing) {
  Polygon polygon = right_triangle;
  polygon.insert(polygon.begin() + 1, {1.0, 0.0});
  const Moments m = polygon_moments(right_triangle);
  const Moments with = polygon_moments(polygon);
  expect_near(with, m, rounding);
  EXPECT_NEAR(norm(with.centroid - m.centroid), 0.0, rounding);
}

TEST(SignedArea, FollowsTheOrientation) {
  EXPECT_EQ(signed_area(l_shape), 4.0);
  EXPECT_EQ(signed_area(reversed(l_shape)), -4.0);
  EXPECT_EQ(signed_area(moved(l_shape, {1e6, 1e6})), 4.0);
  EXPECT_EQ(signed_area(Polygon{{0.0, 0.0}, {1.0, 1.0}, {2.0, 2.0}}), 0.0);
}

TEST(IsSimple, AcceptsConvexConcaveAndCollinear) {
  for (const Polygon &polygon : {unit_square, right_triangle, l_shape, regular(40, 1.0)}) {
    EXPECT_TRUE(is_simple(polygon));
    EXPECT_TRUE(is_simple(reversed(polygon)));
    EXPECT_TRUE(is_simple(moved(polygon, {1e6, 1e6})));
  }
  EXPECT_TRUE(is_simple(Polygon{{0.0, 0.0}, {0.5, 0.0}, {1.0, 0.0}, {1.0, 1.0}, {0.0, 1.0}}));
}

TEST(IsSimple, RefusesEveryKindOfSelfContact) {
  const Polygon bow_tie{{0.0, 0.0}, {1.0, 1.0}, {1.0, 0.0}, {0.0, 1.0}};
  const Polygon vertex_on_edge{{0.0, 0.0}, {4.0, 0.0}, {4.0, 2.0}, {2.0, 0.0}, {0.0, 2.0}};
  const Polygon pinched{{0.0, 0.0}, {1.0, 1.0}, {2.0, 0.0}, {2.0, 2.0}, {1.0, 1.0}, {0.0, 2.0}};
  const Polygon spike{{0.0, 0.0}, {2.0, 0.0}, {1.0, 0.0}, {1.0, 1.0}};
  const Polygon pentagram = [] {
    const Polygon p = regular(5, 1.0);
    return Polygon{p[0], p[2], p[4], p[1], p[3]};
  }();
  for (const Polygon &polygon : {bow_tie, vertex_on_edge, pinched, spike, pentagram}) {
    for (std::size_t first = 0; first < polygon.size(); ++first) {
      EXPECT_FALSE(is_simple(started_at(polygon, static_cast<std::ptrdiff_t>(first))));
    }
    EXPECT_FALSE(is_simple(reversed(polygon)));
  }
}

TEST(IsConvex, LeftTurnsOnly) {
  EXPECT_TRUE(is_convex(unit_square));
  EXPECT_TRUE(is_convex(regular(100, 3.0)));
  EXPECT_TRUE(is_convex(Polygon{{0.0, 0.0}, {0.5, 0.0}, {1.0, 0.0}, {0.5, 1.0}})) << "a straight vertex";
  EXPECT_FALSE(is_convex(l_shape));
  EXPECT_FALSE(is_convex(reversed(unit_square)));
  for (std::ptrdiff_t first = 0; first < 6; ++first) {
    EXPECT_FALSE(is_convex(started_at(l_shape, first)));
  }
}

TEST(IsConvex, ForgivesADentOfRoundingOnly) {
  const auto dented = [](double depth) { return Polygon{{0.0, 0.0}, {0.5, depth}, {1.0, 0.0}, {0.5, 1.0}}; };
  EXPECT_TRUE(is_convex(dented(1e-13)));
  EXPECT_FALSE(is_convex(dented(1e-6)));
}

TEST(NarrowestWidth, OfKnownShapes) {
  EXPECT_NEAR(narrowest_width(unit_square), 1.0, rounding);
  EXPECT_NEAR(narrowest_width(right_triangle), 6.0 / std::sqrt(13.0), rounding)
      << "the height on the long edge";
  EXPECT_NEAR(narrowest_width(regular(6, 2.0)), 2.0 * std::sqrt(3.0), 1e-13);
  EXPECT_NEAR(narrowest_width(regular(5, 1.0)), 1.0 + std::cos(std::numbers::pi / 5), 1e-13);
}

TEST(NarrowestWidth, DoesNotDependOnPlaceOrDirection) {
  const Polygon plate{{0.0, 0.0}, {10.0, 0.0}, {10.0, 0.25}, {0.0, 0.25}};
  EXPECT_NEAR(narrowest_width(plate), 0.25, rounding);
  EXPECT_NEAR(narrowest_width(reversed(plate)), 0.25, rounding);
  EXPECT_EQ(narrowest_width(moved(plate, {1e6, -1e6})), 0.25);
  EXPECT_NEAR(narrowest_width(mapped(plate, Rotation::of(0.7))), 0.25, 1e-14);
}

// Rounding makes hundreds of tiny corners of vertices in a line: none of them is a side of the hull.
TEST(NarrowestWidth, DoesNotDependOnVerticesInALine) {
  const Polygon corners{{0.0, 0.0}, {10.0, 0.0}, {10.0, 0.25}, {0.0, 0.25}};
  for (const int extra : {20, 100, 500}) {
    Polygon plate;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const Vec2 begin = corners[i];
      const Vec2 along = corners[(i + 1) % corners.size()] - begin;
      for (int k = 0; k <= extra; ++k) {
        plate.push_back(begin + (k / (extra + 1.0)) * along);
      }
    }
    for (const double angle : {0.0, 0.35, 0.7, 1.4, 3.0}) {
      EXPECT_NEAR(narrowest_width(mapped(plate, Rotation::of(angle))), 0.25, 1e-12) << extra << " " << angle;
    }
  }
}

TEST(NarrowestWidth, OfAConcaveShapeIsThatOfItsThinnestPart) {
  EXPECT_NEAR(narrowest_width(l_shape), 1.0, rounding) << "the legs";
  const Polygon thin_leg{{0.0, 0.0}, {3.0, 0.0}, {3.0, 0.2}, {1.0, 0.2}, {1.0, 3.0}, {0.0, 3.0}};
  EXPECT_NEAR(narrowest_width(thin_leg), 0.2, rounding);
  const Polygon prongs{{0.0, 0.0}, {3.0, 0.0}, {3.0, 2.0}, {2.6, 2.0},
                       {2.6, 1.0}, {1.0, 1.0}, {1.0, 2.0}, {0.0, 2.0}};
  EXPECT_NEAR(narrowest_width(prongs), 0.4, rounding);
  // Between two re-entrant vertices, an hourglass.
  const Polygon hourglass{{0.0, 0.0}, {2.0, 0.0}, {1.25, 1.0}, {2.0, 2.0}, {0.0, 2.0}, {0.75, 1.0}};
  EXPECT_NEAR(narrowest_width(hourglass), 0.5, rounding);
  const Polygon arrow{{0.0, 0.0}, {10.0, 0.0}, {10.0, 10.0}, {9.0, 1.0}};
  EXPECT_NEAR(narrowest_width(arrow), 1.0, rounding) << "at its bend";
}

// The size of a dent, of a step or of the gap between two prongs is not a width; from their bottom through
// the interior to the next wall is one.
TEST(NarrowestWidth, OfAConcaveShapeMindsTheInteriorOnly) {
  const Polygon hull{{0.0, 0.0}, {4.0, 0.0}, {4.0, 4.0}, {0.0, 4.0}};
  const Polygon dented{{0.0, 0.0}, {4.0, 0.0}, {4.0, 4.0}, {2.0, 3.9}, {0.0, 4.0}};
  EXPECT_NEAR(narrowest_width(dented), 2.0, rounding);
  const Polygon stepped{{0.0, 0.0}, {4.0, 0.0}, {4.0, 4.0}, {2.0, 4.0}, {2.0, 3.99}, {0.0, 3.99}};
  EXPECT_NEAR(narrowest_width(stepped), 2.0, rounding);
  // The riser leans, so that the way to the edge beyond it is inside: it cuts off a nib of its corner.
  Polygon leaning{{0.0, 0.0}, {4.0, 0.0}, {4.0, 4.0}, {2.0, 4.0}, {2.0001, 3.99}, {0.0, 3.99}};
  EXPECT_NEAR(narrowest_width(leaning), 1.9999, rounding) << "from the step to the wall";
  for (int k = 1; k < 100; ++k) {
    leaning.insert(leaning.begin() + k, Vec2{0.04 * k, 0.0});
  }
  EXPECT_NEAR(narrowest_width(leaning), 1.9999, rounding) << "of many vertices";
  const Polygon slit{{0.0, 0.0},  {4.0, 0.0},  {4.0, 4.0},  {2.01, 4.0},
                     {2.01, 2.5}, {1.99, 2.5}, {1.99, 4.0}, {0.0, 4.0}};
  EXPECT_NEAR(narrowest_width(slit), 1.99, rounding);
  for (std::ptrdiff_t first = 0; first < 8; ++first) {
    EXPECT_EQ(narrowest_width(started_at(slit, first)), narrowest_width(slit));
  }
  EXPECT_NEAR(narrowest_width(mapped(slit, Rotation::of(0.7))), 1.99, 1e-14);
  EXPECT_NEAR(narrowest_width(hull), 4.0, rounding);
}

// The arrow's hull is narrowest across its diagonal, which is none of its own edges; nothing inside is
// thinner.
TEST(NarrowestWidth, OfAConcaveShapeIsAtMostThatOfItsHull) {
  const Polygon wide_arrow{{0.0, 0.0}, {10.0, 0.0}, {10.0, 10.0}, {5.1, 5.0}};
  const Polygon hull{{0.0, 0.0}, {10.0, 0.0}, {10.0, 10.0}};
  EXPECT_LE(narrowest_width(wide_arrow), narrowest_width(hull));
  EXPECT_NEAR(narrowest_width(wide_arrow), 4.9, rounding);
}

TEST(ReentrantVertices, AreTheRightTurns) {
  EXPECT_EQ(reentrant_vertices(unit_square), std::vector<bool>(4, false));
  EXPECT_EQ(
      reentrant_vertices(Polygon{{0.0, 0.0}, {2.0, 0.0}, {2.0, 1.0}, {1.0, 1.0}, {1.0, 2.0}, {0.0, 2.0}}),
      (std::vector<bool>{false, false, false, true, false, false}));
  EXPECT_EQ(reentrant_vertices(Polygon{{0.0, 0.0}, {0.5, 1e-13}, {1.0, 0.0}, {0.5, 1.0}}),
            std::vector<bool>(4, false))
      << "a dent of rounding";
}

TEST(CommonArea, IsThatOfTheIntersection) {
  EXPECT_DOUBLE_EQ(common_area(unit_square, unit_square), 1.0);
  EXPECT_DOUBLE_EQ(common_area(unit_square, moved(unit_square, {0.25, 0.5})), 0.375);
  EXPECT_DOUBLE_EQ(common_area(unit_square, moved(unit_square, {1.0, 0.0})), 0.0);
  EXPECT_DOUBLE_EQ(common_area(unit_square, moved(unit_square, {3.0, 0.5})), 0.0);
  EXPECT_DOUBLE_EQ(common_area(l_shape, l_shape), 4.0);
  EXPECT_DOUBLE_EQ(common_area(l_shape, right_triangle), 31.0 / 12.0);
  EXPECT_DOUBLE_EQ(common_area(right_triangle, l_shape), 31.0 / 12.0);
  EXPECT_DOUBLE_EQ(common_area(l_shape, moved(unit_square, {1.0, 1.0})), 0.0) << "in the notch";
}

TEST(CommonArea, ChangesLittleWithTheVertices) {
  for (const double by : {1e-12, 1e-9, 1e-6, 1e-3}) {
    for (const Vec2 direction : {Vec2{1.0, 0.0}, Vec2{0.0, 1.0}, Vec2{-0.6, 0.8}}) {
      // No more than the perimeter times the shift is lost, and rounding.
      EXPECT_NEAR(common_area(l_shape, moved(l_shape, by * direction)), 4.0, 10.0 * by + 1e-14);
    }
  }
}

TEST(CommonArea, OfRoundPolygonsIsThatOfALens) {
  const Polygon circle = regular(2000, 1.0);
  const double lens = 2.0 * std::acos(0.5) - 0.5 * std::sqrt(3.0); // of unit circles at distance 1
  EXPECT_NEAR(common_area(circle, moved(circle, {1.0, 0.0})), lens, 1e-5) << "chords lie inside the arc";
  EXPECT_NEAR(common_area(moved(circle, {1e6, 1e6}), moved(circle, {1e6 + 1.0, 1e6})),
              common_area(circle, moved(circle, {1.0, 0.0})), 1e-8);
}

/// Prongs of width 1 that point up, 1 apart, on a bar.
Polygon comb(int num_prongs) {
  Polygon polygon{{0.0, -3.0}, {2.0 * num_prongs - 1.0, -3.0}};
  for (int k = num_prongs - 1; k >= 0; --k) {
    const double x = 2.0 * k;
    polygon.insert(polygon.end(), {{x + 1.0, 0.0}, {x + 1.0, 50.0}, {x, 50.0}, {x, 0.0}});
  }
  polygon.erase(polygon.begin() + 2); // the last prong and the first one have no notch beside them
  polygon.pop_back();
  return polygon;
}

Polygon divided(const Polygon &polygon, int pieces) {
  Polygon fine;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    for (int k = 0; k < pieces; ++k) {
      fine.push_back(polygon[i] + (1.0 * k / pieces) * (polygon[(i + 1) % polygon.size()] - polygon[i]));
    }
  }
  return fine;
}

// Looks at all pairs of 20,000 vertices, at each of them again for what is in the way, would take days.
TEST(LargePolygon, IsJudgedAsASmallOne) {
  EXPECT_DOUBLE_EQ(narrowest_width(comb(3)), 1.0);
  EXPECT_TRUE(is_simple(comb(3)));
  Polygon large = comb(5000);
  EXPECT_DOUBLE_EQ(narrowest_width(large), 1.0);
  EXPECT_TRUE(is_simple(large));
  large[10001].x -= 1.5; // through the prong beside it
  EXPECT_FALSE(is_simple(large));
  EXPECT_NEAR(narrowest_width(divided(l_shape, 3000)), narrowest_width(l_shape), 1e-12);
  EXPECT_NEAR(narrowest_width(divided(right_triangle, 7000)), narrowest_width(right_triangle), 1e-12);
  EXPECT_NEAR(narrowest_width(regular(20000, 1.0)), 2.0, 1e-7);
}

} // namespace
} // namespace gcpdda::polygon_test
