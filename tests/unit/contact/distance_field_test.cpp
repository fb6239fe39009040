// Depths along edges inside a block with re-entrant vertices, against the distance to every edge of it.

#include "support/scenes.hpp"
#include "support/shapes.hpp"
#include "support/thinning.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace gcpdda::distance_field_test {
namespace {

using namespace testing;

constexpr double degree = std::numbers::pi / 180.0;
using Long = long double;

/// Sizes are near 1 and coordinates up to 3: a depth is known to some ten epsilon, next to a needle's tip of
/// 5 degrees, where lines cross flat, to twenty times that.
constexpr double rounding = 4e-14;

Long distance_to_edge(const Shape &block, std::size_t e, Vec2 x) {
  const Vec2 a = block.vertex[e];
  const Vec2 b = block.vertex[(e + 1) % block.vertex.size()];
  const Long dx = Long(b.x) - a.x;
  const Long dy = Long(b.y) - a.y;
  const Long share =
      std::clamp(((Long(x.x) - a.x) * dx + (Long(x.y) - a.y) * dy) / (dx * dx + dy * dy), 0.0L, 1.0L);
  return std::hypot(x.x - a.x - share * dx, x.y - a.y - share * dy);
}

/// Distance to the boundary, negative outside; the side by crossings of a ray.
double brute_depth(const Shape &block, Vec2 x) {
  Long nearest = std::numeric_limits<Long>::infinity();
  bool inside = false;
  for (std::size_t e = 0; e < block.vertex.size(); ++e) {
    const Vec2 a = block.vertex[e];
    const Vec2 b = block.vertex[(e + 1) % block.vertex.size()];
    nearest = std::min(nearest, distance_to_edge(block, e, x));
    if ((a.y > x.y) != (b.y > x.y) && x.x < a.x + (Long(b.x) - a.x) * (Long(x.y) - a.y) / (Long(b.y) - a.y)) {
      inside = !inside;
    }
  }
  return static_cast<double>(inside ? nearest : -nearest);
}

double depth_at(const Overlap &overlap, const Piece &piece, double s) {
  if (piece.curve < 0) {
    return piece.depth_begin + (piece.depth_end - piece.depth_begin) * s / piece.length;
  }
  const DepthCurve &curve = overlap.curves()[static_cast<std::size_t>(piece.curve)];
  return curve.scale * std::hypot(curve.q, s - curve.foot);
}

struct Errors {
  double depth = 0.0;  ///< on pieces
  double missed = 0.0; ///< depth where there is no piece
  double face = 0.0;   ///< how much farther the named face is than the nearest edge
  double floor = 0.0;  ///< how far depth_floor() lies above the depth or below zero
  double joint = 0.0;  ///< pieces on one place beyond the first
  int curves = 0;
};

/// All edges of `own` in the field of `other`; the pieces of the first block are looked at.
Errors errors_of(const Shape &own, const Shape &other, int samples) {
  Errors errors;
  Overlap overlap;
  overlap.find(own.view(), other.view(), PotentialKind::exact);
  std::vector<Piece> pieces;
  for (const Region &region : overlap.regions()) {
    const auto of_region = overlap.pieces().subspan(region.begin, region.middle - region.begin);
    pieces.insert(pieces.end(), of_region.begin(), of_region.end());
  }
  for (const Piece &piece : pieces) {
    errors.curves += piece.curve >= 0 ? 1 : 0;
    const auto floor = overlap.depth_floor(piece);
    for (int k = 0; k <= 8; ++k) {
      const double share = k / 8.0;
      const double s = share * piece.length;
      const Vec2 x = piece.begin + s * perp(piece.normal);
      const double depth = depth_at(overlap, piece, s);
      errors.depth = std::max(errors.depth, std::abs(depth - std::max(0.0, brute_depth(other, x))));
      const auto face = static_cast<std::size_t>(piece.face);
      errors.face = std::max(errors.face, static_cast<double>(distance_to_edge(other, face, x)) - depth);
      const double low = floor[0] + share * (floor[1] - floor[0]);
      errors.floor = std::max({errors.floor, low - depth, -low});
    }
    const double ends = depth_at(overlap, piece, piece.length) - piece.depth_end;
    errors.depth =
        std::max({errors.depth, std::abs(ends), std::abs(depth_at(overlap, piece, 0.0) - piece.depth_begin)});
  }
  for (std::size_t e = 0; e < own.vertex.size(); ++e) {
    for (int k = 0; k < samples; ++k) {
      const double s = own.length[e] * (k + 0.5) / samples;
      const Vec2 x = own.vertex[e] + s * perp(own.normal[e]);
      bool covered = false;
      double within = 0.0;
      for (const Piece &piece : pieces) {
        const double along = dot(x - piece.begin, perp(piece.normal));
        if (static_cast<std::size_t>(piece.edge) == e) {
          covered = covered || (along >= -rounding && along <= piece.length + rounding);
          within += along > rounding && along < piece.length - rounding ? 1.0 : 0.0;
        }
      }
      const double depth = brute_depth(other, x);
      errors.missed = std::max(errors.missed, covered ? 0.0 : depth);
      errors.joint = std::max(errors.joint, within - 1.0);
    }
  }
  return errors;
}

void expect_exact(const Shape &own, const Shape &other, const std::string &what) {
  const Errors errors = errors_of(own, other, 16);
  EXPECT_LE(errors.depth, rounding) << what;
  EXPECT_LE(errors.missed, rounding) << what;
  EXPECT_LE(errors.face, rounding) << what;
  EXPECT_LE(errors.floor, rounding) << what;
  EXPECT_EQ(errors.joint, 0.0) << what << ": no two pieces on one place";
}

TEST(DistanceField, AgreesWithTheDistanceToEveryEdge) {
  std::mt19937 engine(21);
  int curves = 0;
  for (int trial = 0; trial < 1500 / thinning; ++trial) {
    const Shape field = shape_of(
        star_polygon(engine, 4 + static_cast<int>(engine() % 12), uniform(engine, 0.1, 0.9), 1.0, {}));
    const Vec2 centre{uniform(engine, -1.0, 1.0), uniform(engine, -1.0, 1.0)};
    const Shape own = shape_of(star_polygon(engine, 3 + static_cast<int>(engine() % 8), 0.2, 1.0, centre));
    expect_exact(own, field, "trial " + std::to_string(trial));
    curves += errors_of(own, field, 0).curves;
    ASSERT_FALSE(HasFailure());
  }
  EXPECT_GT(curves, 1000 / thinning) << "parts nearest to a re-entrant vertex";
}

// Lattice shapes: vertices on vertices, vertices on edges, coincident and collinear edges, edges through
// several vertices, edges on the bisector of two faces.
TEST(DistanceField, AgreesInDegeneratePositions) {
  const std::vector<std::vector<Vec2>> fields{
      {{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}},
      {{0, 0}, {3, 0}, {3, 2}, {2, 2}, {2, 1}, {1, 1}, {1, 2}, {0, 2}},
      {{0, 0}, {1, 0}, {2, 0}, {2, 0.5}, {2, 1}, {1, 1}, {1, 1.5}, {1, 2}, {0, 2}, {0, 1}},
      {{0, 0}, {2, 0}, {2, 2}, {1, 1}, {0, 2}},
      {{1, 0}, {2, 0}, {2, 1}, {3, 1}, {3, 2}, {2, 2}, {2, 3}, {1, 3}, {1, 2}, {0, 2}, {0, 1}, {1, 1}}};
  const std::vector<std::vector<Vec2>> owns{
      {{0, 0}, {1, 0}, {1, 1}, {0, 1}},
      {{0, 0}, {1, 0}, {0, 1}},
      {{0, 0}, {2, -1}, {2, 1}},
      {{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}},
      {{0, 0}, {0.5, 0}, {1, 0}, {1, 0.25}, {1, 1}, {0.5, 0.5}, {0, 1}}};
  for (std::size_t f = 0; f < fields.size(); ++f) {
    for (std::size_t o = 0; o < owns.size(); ++o) {
      for (int ix = -4; ix <= 8; ix += thinning > 1 ? 3 : 1) {
        for (int iy = -4; iy <= 6; iy += thinning > 1 ? 3 : 1) {
          for (const double turn : {0.0, 90.0, 45.0, 180.0}) {
            const std::vector<Vec2> own = placed(owns[o], turn * degree, {0.5 * ix, 0.5 * iy});
            const std::string what = std::to_string(f) + " " + std::to_string(o) + " at " +
                                     std::to_string(ix) + " " + std::to_string(iy) + " turned " +
                                     std::to_string(turn);
            expect_exact(shape_of(own), shape_of(fields[f]), what);
            // The same, off the lattice by rounding only.
            const Vec2 off{0.3, -0.7};
            expect_exact(shape_of(placed(own, 0.4, off)), shape_of(placed(fields[f], 0.4, off)), what);
            ASSERT_FALSE(HasFailure());
          }
        }
      }
    }
  }
}

// Needles of 5 degrees: as field, as own edges, tip to tip and tip into a re-entrant corner.
TEST(DistanceField, AgreesAtNeedleTips) {
  const double slope = std::tan(2.5 * degree);
  const std::vector<Vec2> needles{{-1.0, -1.0}, {1.0, -1.0}, {1.0, 1.0},    {1.0 - 2.0 * slope, 0.0},
                                  {0.0, 0.0},   {0.0, 1.0},  {-slope, 0.0}, {-1.0, 0.0}};
  const std::vector<Vec2> needle{{0.0, 0.0}, {slope, 1.0}, {-slope, 1.0}};
  std::mt19937 engine(22);
  for (const Vec2 tip : {Vec2{1.0, 1.0}, {0.0, 1.0}, {0.0, 0.0}, {-slope, 0.0}, {1.0 - 2.0 * slope, 0.0}}) {
    for (int k = 0; k < 400; ++k) {
      const double turn = k < 72 ? 5.0 * k * degree : uniform(engine, 0.0, 2.0 * std::numbers::pi);
      const double off = k % 3 == 0 ? 0.0 : 1e-3;
      const Vec2 at = tip + off * Vec2{uniform(engine, -1.0, 1.0), uniform(engine, -1.0, 1.0)};
      expect_exact(shape_of(placed(needle, turn, at)), shape_of(needles), "needle " + std::to_string(k));
      ASSERT_FALSE(HasFailure());
    }
  }
}

/// Integrals over the pieces with the brute depth: three Gauss points on 64 parts of each piece. Of a smooth
/// depth the truncation is below 1e-14; a piece with a kink inside, a missed break point, shows.
RegionIntegrals by_quadrature(const Shape &first, const Shape &second, Vec2 origin) {
  Overlap overlap;
  overlap.find(first.view(), second.view(), PotentialKind::exact);
  RegionIntegrals sum;
  sum.origin = origin;
  for (const Region &region : overlap.regions()) {
    for (std::uint32_t i = region.begin; i < region.end; ++i) {
      const Piece &piece = overlap.pieces()[i];
      const Shape &other = i < region.middle ? second : first;
      const Vec2 direction = i < region.middle ? -piece.normal : piece.normal;
      const double h = piece.length / 64.0;
      for (int k = 0; k < 64 * 3; ++k) {
        const int gauss = k % 3 - 1;
        const double s = (k / 3 + 0.5 + 0.5 * gauss * std::sqrt(0.6)) * h;
        const Vec2 x = piece.begin + s * perp(piece.normal);
        const double d = (gauss == 0 ? 8.0 : 5.0) / 18.0 * h * std::max(0.0, brute_depth(other, x));
        sum.pressure += d;
        sum.force += d * direction;
        sum.pressure_moment += d * (x - origin);
        sum.dyad[0] += d * (x - origin).x * direction.x;
        sum.dyad[1] += d * (x - origin).x * direction.y;
        sum.dyad[2] += d * (x - origin).y * direction.x;
        sum.dyad[3] += d * (x - origin).y * direction.y;
      }
    }
  }
  return sum;
}

TEST(DistanceField, IntegralsAgreeWithFineQuadrature) {
  std::mt19937 engine(23);
  int touching = 0;
  for (int trial = 0; trial < 200 / thinning; ++trial) {
    const Shape a = shape_of(star_polygon(engine, 10, 0.4, 1.0, {}));
    const Shape b = shape_of(star_polygon(engine, 9, 0.3, 1.0, {uniform(engine, 0.3, 1.5), 0.2}));
    const RegionIntegrals exact = contact_of(a, b);
    const RegionIntegrals fine = by_quadrature(a, b, exact.origin);
    touching += exact.pressure > 0.0 ? 1 : 0;
    // Lengths and depths near 1 are known to some epsilon, the sum of some twenty pieces to 1e-13.
    ASSERT_NEAR(exact.pressure, fine.pressure, 1e-13) << trial;
    ASSERT_NEAR(norm(exact.force - fine.force), 0.0, 1e-13) << trial;
    ASSERT_NEAR(norm(exact.pressure_moment - fine.pressure_moment), 0.0, 1e-13) << trial;
    for (std::size_t i = 0; i < 4; ++i) {
      ASSERT_NEAR(exact.dyad[i], fine.dyad[i], 1e-13) << trial;
    }
  }
  EXPECT_GT(touching, 150 / thinning);
}

// A convex block walked by the general algorithm gives what the lower envelope gives.
TEST(DistanceField, OfAConvexBlockIsItsLowerEnvelope) {
  std::mt19937 engine(24);
  for (int trial = 0; trial < 1000 / thinning; ++trial) {
    const Shape a = shape_of(random_polygon(static_cast<unsigned>(engine()), 6, 1.0, {}));
    const Shape b =
        shape_of(random_polygon(static_cast<unsigned>(engine()), 5, 1.0, {uniform(engine, 0.2, 1.9), 0.1}));
    BlockView general = a.view();
    general.is_convex = false;
    const RegionIntegrals envelope = contact_of(a, b);
    const RegionIntegrals field = about(contact_of(general, b.view()), envelope.origin);
    ASSERT_NEAR(envelope.pressure, field.pressure, 1e-14);
    ASSERT_NEAR(norm(envelope.force - field.force), 0.0, 1e-14);
    ASSERT_NEAR(torque_about(envelope, {}), torque_about(field, {}), 1e-14);
  }
}

} // namespace
} // namespace gcpdda::distance_field_test
