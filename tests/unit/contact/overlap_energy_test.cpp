// Energy of the contact field, and its behaviour along paths: conservation, continuity, degenerate cases.

#include "contact/geometry/overlap_energy.hpp"
#include "support/critical_path.hpp"
#include "support/scenes.hpp"
#include "support/shapes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace gcpdda::overlap_energy_test {
namespace {

using namespace testing;

constexpr double epsilon = std::numeric_limits<double>::epsilon();
constexpr double degree = std::numbers::pi / 180.0;

double energy_of(const Shape &a, const Shape &b) {
  return overlap_energy(a.view(), b.view());
}

// A square sunk flush by d into a wide plane: int y dy over the plane's depth, plus in the square the
// distance to its bottom, cut off by two corners of 45 degrees: d^2/2 l - 2 d^3/6.
TEST(OverlapEnergy, OfAFlushJoint) {
  const double depth = 0.2;
  const Shape square = shape_of(rectangle({0.0, 0.0}, {1.0, 1.0}));
  const Shape plane = shape_of(rectangle({-5.0, -5.0}, {6.0, depth}));
  const double exact = depth * depth - depth * depth * depth / 3.0;
  EXPECT_NEAR(energy_of(square, plane), exact, 10.0 * epsilon);
  EXPECT_NEAR(energy_of(plane, square), exact, 10.0 * epsilon);
  EXPECT_EQ(energy_of(square, moved(square, 0.0, {}, {3.0, 0.0})), 0.0);
}

// Central differences: truncation h^2 W'''/6 with |W'''| of the order of the number of edges, rounding
// epsilon W/h; h = 1e-5 makes both about 1e-10.
TEST(OverlapEnergy, ItsSlopeIsTheForce) {
  std::mt19937 engine(11);
  constexpr double h = 1e-5;
  int touching = 0;
  for (int trial = 0; trial < 500; ++trial) {
    const auto seed = static_cast<unsigned>(engine());
    const double angle = uniform(engine, 0.0, 2.0 * std::numbers::pi);
    const double distance = uniform(engine, 0.8, 1.9);
    const Shape a = shape_of(random_polygon(seed, 3 + static_cast<int>(engine() % 6), 1.0, {}));
    const Shape b = shape_of(random_polygon(seed + 1, 3 + static_cast<int>(engine() % 6), 1.0,
                                            distance * Vec2{std::cos(angle), std::sin(angle)}));
    const RegionIntegrals region = contact_of(a, b);
    touching += region.pressure > 0.0 ? 1 : 0;
    const auto slope = [&](double turn, Vec2 by) {
      return (energy_of(moved(a, h * turn, {}, h * by), b) - energy_of(moved(a, -h * turn, {}, -h * by), b)) /
             (2.0 * h);
    };
    ASSERT_NEAR(slope(0.0, {1.0, 0.0}), -region.force.x, 1e-9) << "trial " << trial;
    ASSERT_NEAR(slope(0.0, {0.0, 1.0}), -region.force.y, 1e-9) << "trial " << trial;
    ASSERT_NEAR(slope(1.0, {}), -torque_about(region, {}), 1e-9) << "trial " << trial;
  }
  EXPECT_GT(touching, 250);
}

struct PathWork {
  double net = 0.0;
  double total = 0.0;
};

/// Work on the first block along a closed path: a corner of 80 degrees circles with radius 0.05 around the
/// corner of another, swinging by 30 degrees, always in contact. Trapezoid in the force.
PathWork work_on_closed_path(PotentialKind potential, int steps) {
  const Shape wedge = shape_of({{0.0, 0.0}, {1.0, 1.2}, {0.0, 2.0}, {-1.0, 1.2}});
  const Shape lower = shape_of({{0.0, 0.12}, {-1.0, -1.0}, {0.0, -2.0}, {1.0, -1.1}});
  PathWork work;
  RegionIntegrals last;
  Vec2 last_offset;
  double last_turn = 0.0;
  for (int k = 0; k <= steps; ++k) {
    const double phase = 2.0 * std::numbers::pi * k / steps;
    const Vec2 offset = 0.05 * Vec2{std::cos(phase), std::sin(phase)};
    const double turn = 30.0 * degree * std::sin(2.0 * phase + 1.0);
    const RegionIntegrals now = contact_of(moved(wedge, turn, {}, offset), lower, potential);
    if (k > 0) {
      // Turning about the moving vertex `offset`, where the torques are taken.
      const double increment =
          0.5 * (dot(last.force + now.force, offset - last_offset) +
                 (torque_about(last, last_offset) + torque_about(now, offset)) * (turn - last_turn));
      work.net += increment;
      work.total += std::abs(increment);
    }
    last = now;
    last_offset = offset;
    last_turn = turn;
  }
  return work;
}

// A6, convex and rigid. The trapezoid's own error falls as steps^-2.
TEST(OverlapEnergy, ClosedPathDoesNoNetWork) {
  const PathWork coarse = work_on_closed_path(PotentialKind::exact, 2000);
  const PathWork fine = work_on_closed_path(PotentialKind::exact, 20000);
  EXPECT_LE(std::abs(fine.net) / fine.total, 1e-6);
  EXPECT_LE(std::abs(fine.net), 0.05 * std::abs(coarse.net) + 1e-12) << "the rest is truncation";
}

// Reading the potential at vertices alone is not conservative: several percent, whatever the steps.
TEST(OverlapEnergy, LinearPotentialDoesNetWork) {
  const PathWork coarse = work_on_closed_path(PotentialKind::linear, 2000);
  const PathWork fine = work_on_closed_path(PotentialKind::linear, 20000);
  EXPECT_GE(std::abs(fine.net) / fine.total, 0.02);
  EXPECT_NEAR(fine.net, coarse.net, 0.01 * std::abs(fine.net)) << "it is no truncation";
}

// B8.
std::vector<CriticalPath> critical_paths() {
  const Shape square = shape_of(rectangle({-0.5, -0.5}, {0.5, 0.5}));
  const Shape below = shape_of(rectangle({-0.5, -1.5}, {0.5, -0.5}));
  const Shape diamond = moved(square, 45.0 * degree, {}, {});
  const double corner = std::sqrt(0.5);
  const Shape tip = shape_of({{0.0, 0.0}, {std::tan(2.5 * degree), 1.0}, {-std::tan(2.5 * degree), 1.0}});
  const Shape other_tip = moved(tip, 180.0 * degree, {}, {});
  const Shape split = shape_of({{-0.5, -0.5},
                                {-0.25, -0.5},
                                {0.0, -0.5},
                                {0.5, -0.5},
                                {0.5, 0.0},
                                {0.5, 0.5},
                                {-0.5, 0.5},
                                {-0.5, 0.25}});
  const Vec2 aside = (1.0 / std::sqrt(5.0)) * Vec2{1.0, 2.0};
  return {
      {"vertex on vertex, head-on", moved(diamond, 0.0, {}, {0.0, 2.0 * corner}), diamond, {0.0, -1.0}, 0.0},
      {"past vertex on vertex",
       moved(diamond, 0.0, {}, {0.0, 2.0 * corner - 0.02}),
       diamond,
       {1.0, 0.0},
       0.0},
      {"vertex on vertex, turning",
       moved(diamond, 0.0, {}, {0.0, 2.0 * corner - 0.02}),
       diamond,
       {1.0, 0.0},
       2.0},
      {"face on face", square, below, {0.0, -1.0}, 0.0},
      {"face on face, turning", moved(square, 0.0, {}, {0.0, -0.01}), below, {0.0, -1.0}, 1.0},
      {"coincident faces side by side", moved(square, 0.0, {}, {1.0, -0.02}), below, {-1.0, 0.0}, 0.0},
      {"corner of coincident faces", moved(square, 0.0, {}, {1.0, 0.0}), below, aside, 0.0},
      {"T junctions", split, below, {0.0, -1.0}, 0.5},
      {"T junctions on both", split, moved(split, 180.0 * degree, {}, {0.0, -1.0}), {0.0, -1.0}, 0.0},
      {"needle tips head-on", tip, other_tip, {0.0, -1.0}, 0.0},
      {"needle tips passing", moved(tip, 0.0, {}, {0.0, -0.05}), other_tip, {1.0, 0.0}, 0.0},
      {"needle into a face", tip, moved(square, 0.0, {}, {0.0, -0.5}), {0.0, -1.0}, 1.0},
      {"needle into a corner", tip, moved(diamond, 0.0, {}, {0.0, -corner}), {0.0, -1.0}, 1.0},
  };
}

TEST(Overlap, ForceIsContinuousThroughDegenerateConfigurations) {
  for (const CriticalPath &path : critical_paths()) {
    // Momentum: the force found from the other side is the opposite one, to 1e-14 of the pressure.
    expect_continuous_force(path, 2.0, [&](const Shape &moving, const RegionIntegrals &region) {
      const RegionIntegrals other = contact_of(path.still, moving);
      ASSERT_LE(norm(region.force + other.force), 1e-14 * region.pressure);
      ASSERT_LE(std::abs(torque_about(region, {}) + torque_about(other, {})), 1e-14 * region.pressure);
    });
  }
}

/// The block with a vertex placed on every edge, up to rounding.
Shape with_collinear_vertices(const Shape &shape, std::mt19937 &engine) {
  std::vector<Vec2> vertices;
  for (std::size_t i = 0; i < shape.vertex.size(); ++i) {
    const Vec2 p = shape.vertex[i];
    const Vec2 q = shape.vertex[(i + 1) % shape.vertex.size()];
    vertices.push_back(p);
    vertices.push_back(p + uniform(engine, 0.1, 0.9) * (q - p));
  }
  return shape_of(vertices);
}

struct PlainAndSplit {
  Shape a, b, split_a, split_b;
};

std::vector<PlainAndSplit> plain_and_split_pairs() {
  std::mt19937 engine(12);
  std::vector<PlainAndSplit> pairs;
  for (int trial = 0; trial < 500; ++trial) {
    const auto seed = static_cast<unsigned>(engine());
    const Vec2 centre{uniform(engine, 0.5, 1.8), uniform(engine, -0.5, 0.5)};
    const Shape a = shape_of(random_polygon(seed, 5, 1.0, {}));
    const Shape b = shape_of(random_polygon(seed + 1, 4, 1.0, centre));
    pairs.push_back({a, b, with_collinear_vertices(a, engine), with_collinear_vertices(b, engine)});
  }
  return pairs;
}

// Lines that coincide with others may cost rounding, no more: a vertex off its edge by one epsilon tilts the
// short lines by up to ten.
constexpr double split_rounding = 100.0 * epsilon;

TEST(Overlap, CollinearVerticesChangeNothing) {
  for (const auto &[a, b, split_a, split_b] : plain_and_split_pairs()) {
    const RegionIntegrals plain = contact_of(a, b);
    const RegionIntegrals with = contact_of(split_a, split_b);
    ASSERT_NEAR(norm(with.force - plain.force), 0.0, split_rounding);
    ASSERT_NEAR(with.pressure, plain.pressure, split_rounding);
    ASSERT_NEAR(torque_about(with, {}), torque_about(plain, {}), 2.0 * split_rounding);
  }
}

TEST(OverlapEnergy, CollinearVerticesChangeNothing) {
  int wrong = 0;
  for (const auto &[a, b, split_a, split_b] : plain_and_split_pairs()) {
    wrong += std::abs(energy_of(split_a, split_b) - energy_of(a, b)) > split_rounding ? 1 : 0;
  }
  EXPECT_EQ(wrong, 0) << "of 500";
}

/// The same outline with `pieces` edges for each.
Shape divided(const Shape &shape, int pieces) {
  std::vector<Vec2> vertices;
  for (std::size_t i = 0; i < shape.vertex.size(); ++i) {
    const Vec2 along = shape.vertex[(i + 1) % shape.vertex.size()] - shape.vertex[i];
    for (int k = 0; k < pieces; ++k) {
      vertices.push_back(shape.vertex[i] + (1.0 * k / pieces) * along);
    }
  }
  return shape_of(vertices);
}

// A cost of n^3 would take a day here.
TEST(LargeOverlap, OfAFaceOfManyEdgesIsThatOfOne) {
  const double depth = 0.2;
  const double exact = depth * depth - depth * depth * depth / 3.0;
  const Shape square = divided(shape_of(rectangle({0.0, 0.0}, {1.0, 1.0})), 5000);
  const Shape plane = divided(shape_of(rectangle({-5.0, -5.0}, {6.0, depth})), 5000);
  EXPECT_NEAR(energy_of(square, plane), exact, 1e-13) << "rounding of the vertices";
  EXPECT_NEAR(energy_of(shape_of(rectangle({0.0, 0.0}, {1.0, 1.0})), plane), exact, 1e-13);
}

// The force comes from the edges inside and knows nothing of cells. Central differences as above.
TEST(LargeOverlap, ItsSlopeIsTheForce) {
  std::mt19937 engine(17);
  constexpr double h = 1e-5;
  int touching = 0;
  for (int trial = 0; trial < 24; ++trial) {
    const bool is_star = trial % 2 == 0;
    const auto outline = [&](int num_vertices, Vec2 centre) {
      return shape_of(is_star ? star_polygon(engine, num_vertices, 0.9, 1.0, centre)
                              : random_polygon(static_cast<unsigned>(engine()), num_vertices, 1.0, centre));
    };
    const Shape a = outline(150, {});
    const Shape b = outline(trial % 3 == 0 ? 5 : 150, uniform(engine, 1.7, 1.9) * Vec2{0.6, 0.8});
    const RegionIntegrals whole = contact_of(a, b);
    touching += whole.pressure > 0.0 ? 1 : 0;
    const auto slope = [&](double turn, Vec2 by) {
      return (energy_of(moved(a, h * turn, {}, h * by), b) - energy_of(moved(a, -h * turn, {}, -h * by), b)) /
             (2.0 * h);
    };
    ASSERT_NEAR(slope(0.0, {1.0, 0.0}), -whole.force.x, 3e-9) << "trial " << trial;
    ASSERT_NEAR(slope(0.0, {0.0, 1.0}), -whole.force.y, 3e-9) << "trial " << trial;
    ASSERT_NEAR(slope(1.0, {}), -torque_about(whole, {}), 3e-9) << "trial " << trial;
  }
  EXPECT_GE(touching, 20);
}

// Two circles of the same edges that overlap by a twentieth of their size: nothing but rounding changes when
// one is moved far away with the other.
TEST(LargeOverlap, OfRoundOutlinesIsTwiceThatOfOneLens) {
  const auto circle = [](Vec2 centre) {
    std::vector<Vec2> vertices;
    constexpr int n = 2000;
    for (int k = 0; k < n; ++k) {
      const double angle = 2.0 * std::numbers::pi * k / n;
      vertices.push_back(centre + Vec2{std::cos(angle), std::sin(angle)});
    }
    return shape_of(vertices);
  };
  // int over the lens of 1 - |x| by Simpson's rule in polar angle about one centre; the lens reaches from
  // r(phi) = 1.95 cos phi - sqrt(1 - 1.95^2 sin^2 phi) to 1.
  const double largest = std::acos(0.975);
  constexpr int steps = 2000;
  double lens = 0.0;
  for (int k = 0; k <= steps; ++k) {
    const double phi = largest * k / steps;
    const double sine = 1.95 * std::sin(phi);
    const double r = 1.95 * std::cos(phi) - std::sqrt(std::max(0.0, 1.0 - sine * sine));
    const double weight = k == 0 || k == steps ? 1.0 : k % 2 == 1 ? 4.0 : 2.0;
    lens += weight * ((1.0 - r * r) / 2.0 - (1.0 - r * r * r) / 3.0);
  }
  lens *= 2.0 * largest / (3.0 * steps);
  // The chords lie up to 1.2e-6 inside the arcs, of a depth of 0.05.
  EXPECT_NEAR(energy_of(circle({}), circle({1.95, 0.0})), 2.0 * lens, 2.0 * lens * 2e-4);
}

} // namespace
} // namespace gcpdda::overlap_energy_test
