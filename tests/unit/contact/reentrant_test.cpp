// Forces of re-entrant and deformable blocks: gradient of an energy, momentum, continuity, locality.

#include "contact/block_view.hpp"
#include "contact/geometry/overlap_energy.hpp"
#include "support/critical_path.hpp"
#include "support/scenes.hpp"
#include "support/shapes.hpp"
#include "support/thinning.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace gcpdda::reentrant_test {
namespace {

using namespace testing;

constexpr double epsilon = std::numeric_limits<double>::epsilon();
constexpr double degree = std::numbers::pi / 180.0;

/// int t X^T ds on the first block (sign 1) or the second one (-1).
Mat2 gradient_force(const RegionIntegrals &region, const DeformedShape &block, double sign) {
  const auto dyad = about(region, block.centre).dyad;
  const Mat2 t_x{dyad[0], dyad[2], dyad[1], dyad[3]};
  return sign * (t_x * transposed(block.inverse_gradient));
}

/// A block whose reference polygon has its vertices about the origin.
DeformedShape random_block(std::mt19937 &engine, Vec2 centre, double strain, bool convex) {
  const Shape reference =
      convex ? shape_of(random_polygon(static_cast<unsigned>(engine()), 6, 1.0, {}))
             : shape_of(star_polygon(engine, 5 + static_cast<int>(engine() % 6), 0.4, 1.0, {}));
  const Rotation turn = Rotation::of(uniform(engine, 0.0, 6.0));
  const Mat2 stretch{1.0 + uniform(engine, -strain, strain), uniform(engine, -strain, strain),
                     uniform(engine, -strain, strain), 1.0 + uniform(engine, -strain, strain)};
  return deformed(reference, centre, Mat2{turn.c, -turn.s, turn.s, turn.c} * stretch);
}

/// Rigid blocks are seen without a frame.
BlockView view_of(const DeformedShape &block, bool rigid) {
  return rigid ? block.world.view() : block.view();
}

struct Case {
  const char *name;
  bool first_rigid, first_convex, second_rigid, second_convex;
};

const std::vector<Case> cases{{"re-entrant, convex", true, false, true, true},
                              {"convex, re-entrant", true, true, true, false},
                              {"two re-entrant", true, false, true, false},
                              {"two deformed", false, true, false, true},
                              {"deformed, rigid re-entrant", false, true, true, false},
                              {"rigid, deformed re-entrant", true, true, false, false},
                              {"two deformed re-entrant", false, false, false, false}};

// Central differences as in the convex test: truncation h^2 W'''/6 and rounding epsilon W/h, both about
// 1e-10; W''' is larger here, where vertices pass a re-entrant one at a small distance.
TEST(Reentrant, ForceIsTheSlopeOfTheEnergy) {
  std::mt19937 engine(41);
  constexpr double h = 1e-5;
  for (const Case &c : cases) {
    int touching = 0;
    double largest = 0.0;
    for (int trial = 0; trial < 150 / thinning; ++trial) {
      const double angle = uniform(engine, 0.0, 6.0);
      const DeformedShape a = random_block(engine, {}, c.first_rigid ? 0.0 : 0.1, c.first_convex);
      const DeformedShape b =
          random_block(engine, uniform(engine, 0.6, 1.9) * Vec2{std::cos(angle), std::sin(angle)},
                       c.second_rigid ? 0.0 : 0.1, c.second_convex);
      const RegionIntegrals region = contact_of(view_of(a, c.first_rigid), view_of(b, c.second_rigid));
      touching += region.pressure > 0.0 ? 1 : 0;
      const auto slope = [&](Vec2 by, const Mat2 &gradient) {
        const auto energy = [&](double step) {
          const DeformedShape moved_a =
              deformed(a.reference, a.centre + step * by, a.gradient + step * gradient);
          return overlap_energy(view_of(moved_a, c.first_rigid), view_of(b, c.second_rigid));
        };
        return (energy(h) - energy(-h)) / (2.0 * h);
      };
      const Mat2 f = region.pressure > 0.0 ? gradient_force(region, a, 1.0) : Mat2{};
      const auto compare = [&](double expected, double found) {
        largest = std::max(largest, std::abs(expected + found));
      };
      compare(region.force.x, slope({1.0, 0.0}, {}));
      compare(region.force.y, slope({0.0, 1.0}, {}));
      // A rigid block can only turn.
      const Mat2 spin = Mat2{0.0, -1.0, 1.0, 0.0} * a.gradient;
      compare(contract(f, spin), slope({}, spin));
      if (!c.first_rigid) {
        compare(f.xx, slope({}, {1.0, 0.0, 0.0, 0.0}));
        compare(f.xy, slope({}, {0.0, 1.0, 0.0, 0.0}));
        compare(f.yx, slope({}, {0.0, 0.0, 1.0, 0.0}));
        compare(f.yy, slope({}, {0.0, 0.0, 0.0, 1.0}));
      }
    }
    EXPECT_LE(largest, 1e-8) << c.name;
    EXPECT_GT(touching, 60 / thinning) << c.name;
  }
}

// A5, from the other side, about a common point.
TEST(Reentrant, ForcesAreOppositeWhenArgumentsAreSwapped) {
  std::mt19937 engine(42);
  for (const Case &c : cases) {
    for (int trial = 0; trial < 300; ++trial) {
      const DeformedShape a = random_block(engine, {}, c.first_rigid ? 0.0 : 0.1, c.first_convex);
      const DeformedShape b =
          random_block(engine, {uniform(engine, 0.6, 1.9), 0.2}, c.second_rigid ? 0.0 : 0.1, c.second_convex);
      const BlockView first = view_of(a, c.first_rigid);
      const BlockView second = view_of(b, c.second_rigid);
      const RegionIntegrals on_a = contact_of(first, second);
      const RegionIntegrals on_b = contact_of(second, first);
      ASSERT_LE(norm(on_a.force + on_b.force), 1e-14 * on_a.pressure) << c.name;
      const double torques = torque_about(on_a, {}) + torque_about(on_b, {});
      ASSERT_LE(std::abs(torques), 1e-14 * on_a.pressure * (1.0 + norm(on_a.origin))) << c.name;
    }
  }
}

/// A configuration of a moving block along a closed path; phase from 0 to 2 pi.
struct Pose {
  Vec2 centre;
  Mat2 gradient;
};

Pose pose_on_path(double phase, Vec2 start, double radius, double swing, double strain) {
  const Rotation turn = Rotation::of(swing * std::sin(2.0 * phase + 1.0));
  const Mat2 stretch{1.0 + strain * std::sin(phase + 0.3), strain * std::cos(2.0 * phase),
                     0.5 * strain * std::sin(phase), 1.0 - strain * std::cos(phase + 1.1)};
  return {start + radius * Vec2{std::cos(phase), std::sin(phase)},
          Mat2{turn.c, -turn.s, turn.s, turn.c} * stretch};
}

struct PathWork {
  double net = 0.0;
  double total = 0.0;
  [[nodiscard]] double share() const { return std::abs(net) / total; }
};

enum class Field { exact, of_current_distance };

/// Work on a block along the closed path, on its centre and on F. Trapezoid in the force.
PathWork work_on_closed_path(const Shape &moving, const BlockView &still, Vec2 start, double strain,
                             Field field, int steps) {
  PathWork work;
  RegionIntegrals last;
  Pose last_pose;
  Mat2 last_f;
  for (int k = 0; k <= steps; ++k) {
    const Pose pose = pose_on_path(2.0 * std::numbers::pi * k / steps, start, 0.05, 20.0 * degree, strain);
    const DeformedShape block = deformed(moving, pose.centre, pose.gradient);
    // The contrast: the distance to the current boundary, not the one in the reference polygon over J.
    const RegionIntegrals now = contact_of(view_of(block, strain == 0.0 || field != Field::exact), still);
    const Mat2 f = gradient_force(now, block, 1.0);
    if (k > 0) {
      const double increment = 0.5 * (dot(last.force + now.force, pose.centre - last_pose.centre) +
                                      contract(last_f + f, pose.gradient - last_pose.gradient));
      work.net += increment;
      work.total += std::abs(increment);
    }
    last = now;
    last_pose = pose;
    last_f = f;
  }
  return work;
}

// A6, a re-entrant pair: the arm of a cross swings in the corner of an L. The trapezoid's own error falls as
// steps^-2.
TEST(Reentrant, ClosedPathDoesNoNetWork) {
  const Shape cross_shape = shape_of({{-0.2, -1.0},
                                      {0.3, -1.0},
                                      {0.2, -0.2},
                                      {1.0, -0.3},
                                      {1.0, 0.2},
                                      {0.2, 0.2},
                                      {0.2, 1.0},
                                      {-0.2, 1.0},
                                      {-0.3, 0.2},
                                      {-1.0, 0.3},
                                      {-1.0, -0.2},
                                      {-0.2, -0.2}});
  const Shape corner = shape_of({{0.0, 0.0}, {3.0, 0.0}, {3.0, 1.0}, {1.1, 1.0}, {0.9, 3.0}, {0.0, 3.0}});
  for (const Vec2 start : {Vec2{1.3, 1.9}, {1.9, 1.8}, {1.75, 1.1}}) {
    const PathWork coarse =
        work_on_closed_path(cross_shape, corner.view(), start, 0.0, Field::exact, 2000 / thinning);
    const PathWork fine =
        work_on_closed_path(cross_shape, corner.view(), start, 0.0, Field::exact, 20000 / thinning);
    EXPECT_LE(fine.share(), 1e-6);
    EXPECT_LE(std::abs(fine.net), 0.05 * std::abs(coarse.net) + 1e-12) << "the rest is truncation";
  }
}

// The same with 3 % strain along the path; the distance to the current boundary does net work there.
TEST(Reentrant, ClosedPathOfADeformingBlockDoesNoNetWork) {
  const Shape square = shape_of(rectangle({-0.5, -0.5}, {0.5, 0.5}));
  const Shape floor = shape_of(rectangle({-3.0, -2.0}, {3.0, 0.0}));
  const Shape corner = shape_of({{-3, -2}, {3, -2}, {3, 0}, {-0.4, -0.05}, {-0.5, 2}, {-3, 2}});
  const Shape notched =
      shape_of({{-0.5, -0.5}, {-0.2, -0.5}, {0.05, -0.2}, {0.2, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}});
  const Shape tooth = shape_of({{-1.0, -2.0}, {1.0, -2.0}, {0.02, 0.25}});
  for (const auto &[moving, still] : {std::pair(&square, &floor), {&square, &corner}, {&notched, &tooth}}) {
    const auto share = [moving = moving, still = still](Field field, int steps) {
      return work_on_closed_path(*moving, still->view(), {0.0, 0.40}, 0.03, field, steps).share();
    };
    EXPECT_LE(share(Field::exact, 20000 / thinning), 1e-6);
    EXPECT_GE(share(Field::of_current_distance, 2000 / thinning), 3e-3);
    EXPECT_GE(share(Field::of_current_distance, 20000 / thinning), 3e-3) << "it is no truncation";
  }
}

// A deformable block at rest in its reference is the rigid one.
TEST(Reentrant, UndeformedFrameChangesNothing) {
  std::mt19937 engine(43);
  for (int trial = 0; trial < 500 / thinning; ++trial) {
    const bool convex = trial % 2 == 0;
    const DeformedShape a = random_block(engine, {}, 0.0, convex);
    const DeformedShape b = random_block(engine, {uniform(engine, 0.6, 1.9), 0.2}, 0.0, !convex);
    const RegionIntegrals rigid = contact_of(a.world.view(), b.world.view());
    const RegionIntegrals framed = about(contact_of(a.view(), b.view()), rigid.origin);
    ASSERT_NEAR(norm(rigid.force - framed.force), 0.0, 1e-13);
    ASSERT_NEAR(torque_about(rigid, {}), torque_about(framed, {}), 1e-13);
    ASSERT_NEAR(overlap_energy(a.world.view(), b.world.view()), overlap_energy(a.view(), b.view()), 1e-13);
  }
}

// A uniform stretch of the reference by 2: distances there double, so phi = 2 d / 4 in world distances.
TEST(Reentrant, DeformableFieldIsTheReferenceDistanceOverJ) {
  const Shape reference = shape_of(rectangle({-1.0, -1.0}, {1.0, 1.0}));
  const DeformedShape big = deformed(reference, {0.0, -2.0}, {2.0, 0.0, 0.0, 2.0});
  const Shape block = shape_of(rectangle({-0.5, -0.1}, {0.5, 1.0}));
  const Shape point_field = big.world;
  // Only edges of `block` feel the field of `big`: compare piece by piece.
  Overlap framed;
  Overlap plain;
  ASSERT_TRUE(framed.find(block.view(), big.view(), PotentialKind::exact));
  ASSERT_TRUE(plain.find(block.view(), point_field.view(), PotentialKind::exact));
  ASSERT_EQ(framed.pieces().size(), plain.pieces().size());
  for (std::uint32_t i = 0; i < framed.regions()[0].end; ++i) {
    const double factor = i < framed.regions()[0].middle ? 0.125 : 1.0;
    EXPECT_NEAR(framed.pieces()[i].depth_end, factor * plain.pieces()[i].depth_end, 1e-15);
    EXPECT_NEAR(framed.pieces()[i].length, plain.pieces()[i].length, 1e-15);
    EXPECT_NEAR(norm(framed.pieces()[i].begin - plain.pieces()[i].begin), 0.0, 1e-15);
  }
}

std::vector<CriticalPath> critical_paths() {
  const Shape corner = shape_of({{-2, -2}, {2, -2}, {2, 0}, {0, 0}, {0, 2}, {-2, 2}});
  const Shape square = shape_of(rectangle({0.0, 0.0}, {1.0, 1.0}));
  const Shape diamond = moved(square, 45.0 * degree, {}, {});
  const Shape notch = shape_of({{-2, -2}, {2, -2}, {2, 1}, {0, 0}, {-2, 1}});
  const Shape inner = shape_of({{0, 0}, {-1, 1}, {-2, -1}, {2, -1}, {1, 1}}); // re-entrant vertex at 0
  const double slope = std::tan(2.5 * degree);
  const Shape tip = shape_of({{0.0, 0.0}, {slope, 1.0}, {-slope, 1.0}});
  const double r = std::sqrt(0.5);
  return {{"vertex into a re-entrant corner", diamond, corner, {-r, -r}, 0.0},
          {"past a re-entrant corner", moved(diamond, 0.0, {}, {0.02, -0.01}), corner, {-1.0, 0.0}, 1.0},
          {"flush into a corner", square, corner, {-r, -r}, 0.0},
          {"along one face into the other", moved(square, 0.0, {}, {0.0, -0.01}), corner, {-1.0, 0.0}, 0.0},
          {"needle into a corner", moved(tip, -45.0 * degree, {}, {}), corner, {-r, -r}, 1.0},
          {"needle into a notch", tip, notch, {0.0, -1.0}, 2.0},
          {"needle past a notch", moved(tip, 0.0, {}, {0.0, -0.03}), notch, {1.0, 0.0}, 0.0},
          {"re-entrant on convex vertex",
           moved(inner, 180.0 * degree, {}, {}),
           moved(diamond, 180.0 * degree, {}, {}),
           {0.0, -1.0},
           0.0},
          {"re-entrant past convex vertex",
           moved(inner, 180.0 * degree, {}, {0.0, -0.02}),
           moved(diamond, 180.0 * degree, {}, {}),
           {1.0, 0.0},
           1.0},
          {"vertex on vertex",
           moved(corner, 0.0, {}, {-2.0, -2.0}),
           moved(corner, 0.0, {}, {0.0, 2.0}),
           {0.0, 1.0},
           1.0}};
}

// B8, with the bound of the convex test.
TEST(Reentrant, ForceIsContinuousThroughDegenerateConfigurations) {
  for (const CriticalPath &path : critical_paths()) {
    expect_continuous_force(path, 6.0);
  }
}

/// Integrals of all regions, in an order that does not depend on the numbering of the blocks.
std::vector<RegionIntegrals> integrals_by_place(const Shape &a, const Shape &b) {
  Overlap overlap;
  overlap.find(a.view(), b.view(), PotentialKind::exact);
  std::vector<RegionIntegrals> all;
  for (const Region &region : overlap.regions()) {
    all.push_back(overlap.integrate(region));
  }
  std::sort(all.begin(), all.end(),
            [](const RegionIntegrals &p, const RegionIntegrals &q) { return p.pressure < q.pressure; });
  return all;
}

void expect_same_bits(const Shape &a, const Shape &b, const Shape &new_a, const Shape &new_b) {
  const auto before = integrals_by_place(a, b);
  const auto after = integrals_by_place(new_a, new_b);
  ASSERT_EQ(before.size(), after.size());
  for (std::size_t i = 0; i < before.size(); ++i) {
    EXPECT_EQ(before[i].origin, after[i].origin);
    EXPECT_EQ(before[i].force, after[i].force);
    EXPECT_EQ(before[i].dyad, after[i].dyad);
    EXPECT_EQ(before[i].pressure, after[i].pressure);
    EXPECT_EQ(before[i].pressure_moment, after[i].pressure_moment);
  }
}

double distance_to_edge(Vec2 a, Vec2 b, Vec2 x) {
  const double share = std::clamp(dot(x - a, b - a) / dot(b - a, b - a), 0.0, 1.0);
  return norm(x - a - share * (b - a));
}

/// Distance of x from the edges that only one of two polygons has.
double distance_to_difference(const std::vector<Vec2> &a, const std::vector<Vec2> &b, Vec2 x) {
  double nearest = std::numeric_limits<double>::infinity();
  const auto has_edge = [](const std::vector<Vec2> &polygon, Vec2 begin, Vec2 end) {
    const auto at = std::find(polygon.begin(), polygon.end(), begin);
    return at != polygon.end() && (at + 1 == polygon.end() ? polygon.front() : at[1]) == end;
  };
  for (const auto &[one, other] : {std::pair(&a, &b), std::pair(&b, &a)}) {
    for (std::size_t i = 0; i < one->size(); ++i) {
      const Vec2 begin = (*one)[i];
      const Vec2 end = (*one)[(i + 1) % one->size()];
      if (!has_edge(*other, begin, end)) {
        nearest = std::min(nearest, distance_to_edge(begin, end, x));
      }
    }
  }
  return nearest;
}

// A7. A small block at the right side of a star of 16 vertices; the star's left half is cut off or becomes a
// hundred times larger, and the vertices are renumbered.
TEST(Reentrant, CuttingEnlargingAndRenumberingChangeNoBit) {
  std::mt19937 engine(44);
  int same = 0;
  int with_corner = 0;
  for (int trial = 0; trial < 2000 / thinning; ++trial) {
    const std::vector<Vec2> star = star_polygon(engine, 16, 0.6, 1.0, {});
    const Shape a = shape_of(star);
    const Vec2 centre{uniform(engine, 0.7, 1.1), uniform(engine, -0.2, 0.2)};
    const Shape b = shape_of(star_polygon(engine, 7, 0.1, 0.25, centre));
    Overlap overlap;
    overlap.find(a.view(), b.view(), PotentialKind::exact);
    double deepest = 0.0;
    for (const Piece &piece : overlap.pieces()) {
      deepest = std::max({deepest, piece.depth_begin, piece.depth_end});
    }
    std::vector<Vec2> cut;
    std::vector<Vec2> enlarged;
    for (const Vec2 v : star) {
      const bool far = v.x < -0.1;
      enlarged.push_back(far ? 100.0 * v : v);
      if (!far) {
        cut.push_back(v);
      }
    }
    for (std::vector<Vec2> *vertices : {&cut, &enlarged}) {
      // All pieces lie within 0.25 of the centre. A block that has become convex has one region by
      // definition.
      if (!is_simple(*vertices) || is_convex(*vertices) || !(signed_area(*vertices) > 0.0) ||
          !(deepest > 0.0) || distance_to_difference(star, *vertices, centre) < 0.25 + deepest + 1e-6) {
        continue;
      }
      std::rotate(vertices->begin(),
                  vertices->begin() + static_cast<std::ptrdiff_t>(engine() % vertices->size()),
                  vertices->end());
      std::vector<Vec2> turned = b.vertex;
      std::rotate(turned.begin(), turned.begin() + 3, turned.end());
      expect_same_bits(a, b, shape_of(*vertices), shape_of(turned));
      expect_same_bits(b, a, shape_of(turned), shape_of(*vertices));
      same += 1;
      with_corner += overlap.curves().empty() ? 0 : 1;
    }
    ASSERT_FALSE(HasFailure()) << trial;
  }
  EXPECT_GT(same, 1000 / thinning);
  EXPECT_GT(with_corner, 300 / thinning);
}

} // namespace
} // namespace gcpdda::reentrant_test
