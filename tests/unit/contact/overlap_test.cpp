// The contact integral of two convex blocks against independent ways to the same number.

#include "geometry/polygon.hpp"
#include "model/stiffness.hpp"
#include "support/scenes.hpp"
#include "support/shapes.hpp"
#include "support/thinning.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <numbers>

namespace gcpdda::overlap_test {
namespace {

using namespace testing;

constexpr double epsilon = std::numeric_limits<double>::epsilon();
constexpr double degree = std::numbers::pi / 180.0;

using Long = long double;
struct LongVec {
  Long x = 0.0L;
  Long y = 0.0L;
};

/// Integrals about a given point, k_n/2 = 1, forces on the first block.
struct Reference {
  LongVec force;
  Long dyad[4]{};
  Long pressure = 0.0L;
  LongVec moment;
};

/// Distance to the nearest point of the boundary, negative outside: nearest point of every segment, no lines.
Long boundary_distance(const Shape &block, LongVec x) {
  Long nearest = std::numeric_limits<Long>::infinity();
  bool inside = true;
  const std::size_t n = block.vertex.size();
  for (std::size_t j = 0; j < n; ++j) {
    const Vec2 a = block.vertex[j];
    const Vec2 b = block.vertex[(j + 1) % n];
    const LongVec ab{Long(b.x) - a.x, Long(b.y) - a.y};
    const LongVec ax{x.x - a.x, x.y - a.y};
    const Long square = ab.x * ab.x + ab.y * ab.y;
    const Long share = std::clamp((ab.x * ax.x + ab.y * ax.y) / square, 0.0L, 1.0L);
    nearest = std::min(nearest, std::hypot(ax.x - share * ab.x, ax.y - share * ab.y));
    inside = inside && ab.x * ax.y - ab.y * ax.x >= 0.0L;
  }
  return inside ? nearest : -nearest;
}

// The distance along an edge is linear between the points where two edge lines of the other block are equally
// far or one is met. Cut the edge at ALL of them, in long double; two Gauss points a part are then exact.
void add_edges(const Shape &own, const Shape &other, Long sign, Vec2 about, Reference &sum) {
  const std::size_t n = other.vertex.size();
  for (std::size_t e = 0; e < own.vertex.size(); ++e) {
    const Vec2 a = own.vertex[e];
    const Vec2 b = own.vertex[(e + 1) % own.vertex.size()];
    const Long length = std::hypot(Long(b.x) - a.x, Long(b.y) - a.y);
    const LongVec t{(Long(b.x) - a.x) / length, (Long(b.y) - a.y) / length};
    std::vector<Long> alpha(n);
    std::vector<Long> beta(n);
    std::vector<Long> cuts{0.0L, length};
    for (std::size_t j = 0; j < n; ++j) {
      const Vec2 p = other.vertex[j];
      const Vec2 q = other.vertex[(j + 1) % n];
      const Long size = std::hypot(Long(q.x) - p.x, Long(q.y) - p.y);
      const LongVec normal{(Long(q.y) - p.y) / size, (Long(p.x) - q.x) / size};
      alpha[j] = normal.x * (Long(p.x) - a.x) + normal.y * (Long(p.y) - a.y);
      beta[j] = -(normal.x * t.x + normal.y * t.y);
      cuts.push_back(-alpha[j] / beta[j]);
      for (std::size_t k = 0; k < j; ++k) {
        cuts.push_back((alpha[j] - alpha[k]) / (beta[k] - beta[j]));
      }
    }
    std::erase_if(cuts, [&](Long s) { return !(s >= 0.0L && s <= length); });
    std::sort(cuts.begin(), cuts.end());
    for (std::size_t c = 0; c + 1 < cuts.size(); ++c) {
      for (const Long gauss : {-0.5L / std::sqrt(3.0L), 0.5L / std::sqrt(3.0L)}) {
        const Long width = cuts[c + 1] - cuts[c];
        const Long s = 0.5L * (cuts[c] + cuts[c + 1]) + gauss * width;
        const LongVec x{a.x + s * t.x, a.y + s * t.y};
        const Long d = 0.5L * width * std::max(0.0L, boundary_distance(other, x));
        const LongVec arm{x.x - about.x, x.y - about.y};
        const LongVec f{-sign * d * t.y, sign * d * t.x}; // inward normal of the edge's own block
        sum.force = {sum.force.x + f.x, sum.force.y + f.y};
        sum.dyad[0] += arm.x * f.x;
        sum.dyad[1] += arm.x * f.y;
        sum.dyad[2] += arm.y * f.x;
        sum.dyad[3] += arm.y * f.y;
        sum.pressure += d;
        sum.moment = {sum.moment.x + d * arm.x, sum.moment.y + d * arm.y};
      }
    }
  }
}

Reference reference_contact(const Shape &first, const Shape &second, Vec2 about) {
  Reference sum;
  add_edges(first, second, 1.0L, about, sum);
  add_edges(second, first, -1.0L, about, sum);
  return sum;
}

/// Random pair of convex polygons of sizes near 1, overlapping or not.
std::pair<Shape, Shape> random_pair(std::mt19937 &engine) {
  const int m = 3 + static_cast<int>(engine() % 7);
  const int n = 3 + static_cast<int>(engine() % 7);
  const double angle = uniform(engine, 0.0, 2.0 * std::numbers::pi);
  const double distance = uniform(engine, 0.3, 2.1);
  const auto seed = static_cast<unsigned>(engine());
  return {shape_of(random_polygon(seed, m, 1.0, {})),
          shape_of(random_polygon(seed + 1, n, uniform(engine, 0.3, 1.5),
                                  distance * Vec2{std::cos(angle), std::sin(angle)}))};
}

/// Largest difference of all integrals from the reference, over what rounding may do: lengths and depths near
/// 1 are known to a few epsilon, so integrals of at most a perimeter to a few tens of them.
double error_in_epsilon(const Shape &first, const Shape &second) {
  const RegionIntegrals region = contact_of(first, second);
  const Reference exact = reference_contact(first, second, region.origin);
  Long error = std::abs(region.pressure - exact.pressure);
  error = std::max(error, std::hypot(region.force.x - exact.force.x, region.force.y - exact.force.y));
  error = std::max(error, std::hypot(region.pressure_moment.x - exact.moment.x,
                                     region.pressure_moment.y - exact.moment.y));
  for (std::size_t i = 0; i < 4; ++i) {
    error = std::max(error, std::abs(region.dyad[i] - exact.dyad[i]));
  }
  return static_cast<double>(error) / epsilon;
}

TEST(Overlap, AgreesWithCuttingEdgesAtAllCrossings) {
  std::mt19937 engine(1);
  int touching = 0;
  for (int trial = 0; trial < 3000 / thinning; ++trial) {
    const auto [a, b] = random_pair(engine);
    touching += contact_of(a, b).pressure > 0.0 ? 1 : 0;
    ASSERT_LE(error_in_epsilon(a, b), 100.0) << "trial " << trial;
  }
  EXPECT_GT(touching, 1500 / thinning);
}

// Regular polygons in symmetric position: many lines cross in one point, vertices meet vertices and edges.
TEST(Overlap, AgreesInSymmetricPositions) {
  for (int m = 3; m <= 12; ++m) {
    for (int n = 3; n <= 12; ++n) {
      const auto regular = [](int count, double first) {
        std::vector<Vec2> polygon;
        for (int k = 0; k < count; ++k) {
          const double angle = first + 2.0 * std::numbers::pi * k / count;
          polygon.push_back({std::cos(angle), std::sin(angle)});
        }
        return polygon;
      };
      const Shape a = shape_of(regular(m, 0.0));
      for (const double distance : {0.0, 0.5, 1.0, 1.5, 1.9}) {
        for (const double turn : {0.0, std::numbers::pi, std::numbers::pi / n}) {
          const Shape b = shape_of(placed(regular(n, turn), 0.0, {distance, 0.0}));
          ASSERT_LE(error_in_epsilon(a, b), 100.0) << m << " " << n << " " << distance << " " << turn;
        }
      }
    }
  }
}

// A5: the force found from the other side is the opposite one, about a common point too.
TEST(Overlap, ForcesAreOppositeWhenArgumentsAreSwapped) {
  std::mt19937 engine(2);
  for (int trial = 0; trial < 2000; ++trial) {
    const auto [a, b] = random_pair(engine);
    const RegionIntegrals on_a = contact_of(a, b);
    const RegionIntegrals on_b = contact_of(b, a);
    // 1e-14 of the total pressure and its moment: about 45 roundings of the sum.
    ASSERT_LE(norm(on_a.force + on_b.force), 1e-14 * on_a.pressure);
    const double torques = torque_about(on_a, {}) + torque_about(on_b, {});
    ASSERT_LE(std::abs(torques), 1e-14 * on_a.pressure * (1.0 + norm(on_a.origin)));
  }
}

// B1 for k_n/2 = 1: 2 l d (1 - d/(2 l)) on a wider face, 2 l d (1 - d/l) between equal faces.
TEST(Overlap, FlushJointMatchesItsFormula) {
  const Shape block = shape_of(rectangle({0.0, 0.0}, {1.5, 2.0}));
  for (const double depth : {1e-9, 1e-4, 0.1, 0.5}) {
    const Shape wide = shape_of(rectangle({-4.0, depth - 3.0}, {5.0, depth}));
    const Shape equal = shape_of(rectangle({0.0, depth - 3.0}, {1.5, depth}));
    // The difference of coordinates near 3 knows the depth to a few epsilon, absolute.
    const double tolerance = 20.0 * epsilon;
    EXPECT_NEAR(contact_of(block, wide).force.y, 2.0 * 1.5 * depth * (1.0 - depth / 3.0), tolerance);
    EXPECT_NEAR(contact_of(block, equal).force.y, 2.0 * 1.5 * depth * (1.0 - depth / 1.5), tolerance);
    EXPECT_NEAR(contact_of(block, wide).force.x, 0.0, tolerance);
    EXPECT_NEAR(torque_about(contact_of(block, wide), {0.75, 1.0}), 0.0, 2.0 * tolerance);
  }
}

// A right-angled corner of a block that rocks, k_n = 2: from almost flush on one face to almost on the other.
TEST(Overlap, OfARightAngledCornerIsWhatItsSinkingSays) {
  const Shape plane = shape_of(rectangle({-10.0, -4.0}, {10.0, 0.0}));
  for (const double tilt : {1.0, 10.0, 30.0, 45.0, 70.0, 89.0}) {
    const Vec2 along{std::cos(tilt * degree), std::sin(tilt * degree)};
    for (const double depth : {1e-4, 3e-3}) {
      const Vec2 tip{0.0, -depth};
      const Shape block = shape_of({tip, tip + along, tip + along + perp(along), tip + perp(along)});
      const double load = contact_of(block, plane).force.y;
      // The cut edges are rounded by an epsilon of the block's size.
      EXPECT_NEAR(corner_sinking(load, 2.0, tilt * degree), depth, 200.0 * epsilon) << tilt << " degrees";
    }
  }
}

// B2 for p_n/H = 1.
TEST(Overlap, WedgeMatchesItsFormula) {
  const Shape plane = shape_of(rectangle({-20.0, -20.0}, {20.0, 0.0}));
  for (const double half_angle : {2.5 * degree, 20.0 * degree, 45.0 * degree, 80.0 * degree}) {
    for (const double depth : {1e-6, 1e-3, 0.2}) {
      const double reach = 2.0 * std::tan(half_angle);
      const Shape wedge = shape_of({{0.0, -depth}, {reach, 2.0 - depth}, {-reach, 2.0 - depth}});
      const double exact = depth * depth * std::tan(half_angle) * (1.0 + std::sin(half_angle));
      // Depth and faces are known to a few epsilon; the force is of second order in the depth.
      EXPECT_NEAR(contact_of(wedge, plane).force.y, exact, 20.0 * epsilon * (depth + exact) * (1.0 + reach));
    }
  }
}

TEST(Overlap, TouchingWithoutOverlapGivesNoForce) {
  const Shape square = shape_of(rectangle({0.0, 0.0}, {1.0, 1.0}));
  for (const Vec2 by : {Vec2{1.0, 0.0}, {1.0, 0.5}, {1.0, 1.0}, {0.0, -1.0}, {-1.0, 1.0}, {0.25, 1.0}}) {
    const RegionIntegrals region = contact_of(square, moved(square, 0.0, {}, by));
    EXPECT_EQ(region.pressure, 0.0);
    EXPECT_EQ(region.force, Vec2{});
  }
  const Shape diamond = shape_of({{1.0, 0.5}, {1.5, 0.0}, {2.0, 0.5}, {1.5, 1.0}});
  EXPECT_EQ(contact_of(square, diamond).pressure, 0.0);
}

// A7. The vertices that region edges do not use are dropped, or replaced by two a hundred times farther away.
struct RegionEdges {
  std::size_t first = 0; ///< first edge of the chain that the region needs
  std::size_t count = 0;
  double deepest = 0.0; ///< largest depth of the other block's edges in this one
};

RegionEdges needed_edges(const Shape &own, const Shape &other) {
  Overlap overlap;
  overlap.find(own.view(), other.view(), PotentialKind::exact);
  const std::size_t n = own.vertex.size();
  std::vector<bool> needed(n, false);
  RegionEdges chain;
  for (std::size_t i = 0; i < overlap.pieces().size(); ++i) {
    const Piece &piece = overlap.pieces()[i];
    for (std::size_t e = 0; e < n; ++e) {
      if (i < overlap.regions().front().middle) {
        needed[e] = needed[e] || piece.normal == own.normal[e];
        continue;
      }
      chain.deepest = std::max({chain.deepest, piece.depth_begin, piece.depth_end});
      for (const auto &[x, depth] :
           {std::pair(piece.begin, piece.depth_begin), {piece.end(), piece.depth_end}}) {
        // Active at an end of a piece, up to rounding: counted as needed.
        needed[e] = needed[e] || dot(own.normal[e], own.vertex[e] - x) <= depth + 1e-12;
      }
    }
  }
  // Smallest chain of edges with all needed ones: everything but the longest gap.
  std::size_t longest = 0;
  for (std::size_t start = 0; start < n; ++start) {
    std::size_t gap = 0;
    while (gap < n && !needed[(start + gap) % n]) {
      ++gap;
    }
    if (gap > longest) {
      longest = gap;
      chain.first = (start + gap) % n;
    }
  }
  chain.count = n - longest;
  return chain;
}

/// The chain and then other vertices; empty if those would not make a convex block that keeps away from
/// `other`.
std::vector<Vec2> with_far_part(const Shape &own, const RegionEdges &chain, const std::vector<Vec2> &far,
                                const Shape &other) {
  std::vector<Vec2> vertices;
  for (std::size_t k = 0; k <= chain.count; ++k) {
    vertices.push_back(own.vertex[(chain.first + k) % own.vertex.size()]);
  }
  vertices.insert(vertices.end(), far.begin(), far.end());
  if (vertices.size() < 3 || !is_convex(vertices) || !is_simple(vertices) || !(signed_area(vertices) > 0.0)) {
    return {};
  }
  const Shape shape = shape_of(vertices);
  Overlap overlap;
  overlap.find(other.view(), own.view(), PotentialKind::exact);
  for (std::size_t e = chain.count; e < vertices.size(); ++e) {
    for (const Piece &piece : overlap.pieces()) {
      for (const Vec2 x : {piece.begin, piece.end()}) {
        if (dot(shape.normal[e], shape.vertex[e] - x) < chain.deepest + 1e-6) {
          return {};
        }
      }
    }
  }
  return vertices;
}

void expect_same_bits(const RegionIntegrals &a, const RegionIntegrals &b) {
  EXPECT_EQ(a.origin, b.origin);
  EXPECT_EQ(a.force, b.force);
  EXPECT_EQ(a.dyad, b.dyad);
  EXPECT_EQ(a.pressure, b.pressure);
  EXPECT_EQ(a.pressure_moment, b.pressure_moment);
}

TEST(Locality, CuttingEnlargingAndRenumberingChangeNoBit) {
  std::mt19937 engine(3);
  int cut = 0;
  int enlarged = 0;
  for (int trial = 0; trial < 6000 / thinning; ++trial) {
    const auto seed = static_cast<unsigned>(engine());
    const double angle = uniform(engine, 0.0, 2.0 * std::numbers::pi);
    const double distance = uniform(engine, 1.6, 1.95);
    const Shape a = shape_of(random_polygon(seed, 8 + static_cast<int>(engine() % 8), 1.0, {}));
    const Shape b = shape_of(random_polygon(seed + 1, 3 + static_cast<int>(engine() % 10), 1.0,
                                            distance * Vec2{std::cos(angle), std::sin(angle)}));
    if (!(contact_of(a, b).pressure > 0.0)) {
      continue;
    }
    const RegionEdges chain = needed_edges(a, b);
    const std::size_t n = a.vertex.size();
    const std::size_t last = (chain.first + chain.count) % n;
    // Beyond the chain the boundary turns by 0.05 and runs a hundred sizes far.
    const Vec2 out = perp(a.normal[(last + n - 1) % n]);
    const Vec2 in = perp(a.normal[chain.first]);
    const Vec2 far_end = a.vertex[last] + 100.0 * Rotation::of(0.05)(out);
    const Vec2 far_begin = a.vertex[chain.first] - 100.0 * Rotation::of(-0.05)(in);
    for (const auto &far : {std::vector<Vec2>{}, std::vector<Vec2>{far_end, far_begin}}) {
      std::vector<Vec2> vertices = with_far_part(a, chain, far, b);
      if (vertices.empty()) {
        continue;
      }
      (far.empty() ? cut : enlarged) += 1;
      std::rotate(vertices.begin(),
                  vertices.begin() + static_cast<std::ptrdiff_t>(engine() % vertices.size()), vertices.end());
      expect_same_bits(contact_of(a, b), contact_of(shape_of(vertices), b));
      expect_same_bits(contact_of(b, a), contact_of(b, shape_of(vertices)));
    }
    std::vector<Vec2> turned = b.vertex;
    std::rotate(turned.begin(), turned.begin() + 1, turned.end());
    expect_same_bits(contact_of(a, b), contact_of(a, shape_of(turned)));
    ASSERT_FALSE(HasFailure()) << "trial " << trial;
  }
  EXPECT_GT(cut, 300 / thinning);
  EXPECT_GT(enlarged, 100 / thinning);
}

} // namespace
} // namespace gcpdda::overlap_test
