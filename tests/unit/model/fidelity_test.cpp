#include "model/fidelity.hpp"

#include "geometry/holds_point.hpp"
#include "support/scenes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace gcpdda::fidelity_test {
namespace {

using testing::placed;
using testing::rectangle;

constexpr double area = 4.0; // L = 2 m
constexpr double joint = 1e9;
constexpr double infinite = std::numeric_limits<double>::infinity();

/// E for which k_n L/(E + k_n L) is this share.
double modulus_of(double share) {
  return joint * std::sqrt(area) * (1.0 / share - 1.0);
}

Material rock(double youngs_modulus) {
  return {"rock", 2600.0, youngs_modulus, 0.25};
}

BlockKind kind_of(const SceneBlock &block, double youngs_modulus, const RunSettings &run) {
  return choose_fidelity(block, area, rock(youngs_modulus), joint, run).kind;
}

SceneBlock block_with(Fidelity fidelity) {
  SceneBlock block;
  block.fidelity = fidelity;
  return block;
}

RunSettings run_with(Fidelity fidelity, double accepted_error = 0.01) {
  RunSettings run;
  run.fidelity = fidelity;
  run.accepted_error = accepted_error;
  return run;
}

// 1/E_eff = 1/E + 1/(k_n L): a rigid block leaves 1/E out. A few operations: some epsilon.
TEST(Fidelity, LeavesOutTheShareOfTheBlocksOwnCompliance) {
  for (const double youngs_modulus : {1e7, 2e9, 4e10}) {
    for (const double block_area : {0.25, 1.0, 9.0}) {
      const double of_block = 1.0 / youngs_modulus;
      const double of_joint = 1.0 / (joint * std::sqrt(block_area));
      const double got = choose_fidelity({}, block_area, rock(youngs_modulus), joint, {}).rigid_error;
      EXPECT_NEAR(got, of_block / (of_block + of_joint), 1e-15);
    }
  }
}

TEST(Fidelity, IsRigidUpToTheAcceptedError) {
  for (const double accepted : {0.001, 0.01, 0.3}) {
    const RunSettings run = run_with(Fidelity::automatic, accepted);
    EXPECT_EQ(kind_of({}, modulus_of(accepted * (1.0 - 1e-9)), run), BlockKind::rigid) << accepted;
    EXPECT_EQ(kind_of({}, modulus_of(accepted * (1.0 + 1e-9)), run), BlockKind::deformable) << accepted;
  }
  // "Does not exceed": 1/2 is exact in binary.
  EXPECT_EQ(kind_of({}, modulus_of(0.5), run_with(Fidelity::automatic, 0.5)), BlockKind::rigid);
  EXPECT_EQ(kind_of({}, modulus_of(0.5), run_with(Fidelity::automatic, std::nextafter(0.5, 0.0))),
            BlockKind::deformable);
}

TEST(Fidelity, OfTheRunIsTakenWhateverTheError) {
  for (const double share : {1e-6, 0.9}) {
    EXPECT_EQ(kind_of({}, modulus_of(share), run_with(Fidelity::rigid)), BlockKind::rigid) << share;
    EXPECT_EQ(kind_of({}, modulus_of(share), run_with(Fidelity::deformable)), BlockKind::deformable) << share;
  }
}

TEST(Fidelity, OfTheBlockGoesBeforeThatOfTheRun) {
  for (const Fidelity of_run : {Fidelity::automatic, Fidelity::rigid, Fidelity::deformable}) {
    for (const double share : {1e-6, 0.9}) {
      const RunSettings run = run_with(of_run);
      EXPECT_EQ(kind_of(block_with(Fidelity::rigid), modulus_of(share), run), BlockKind::rigid);
      EXPECT_EQ(kind_of(block_with(Fidelity::deformable), modulus_of(share), run), BlockKind::deformable);
    }
  }
  // "auto" of a block is as the run says.
  EXPECT_EQ(kind_of(block_with(Fidelity::automatic), modulus_of(0.9), run_with(Fidelity::rigid)),
            BlockKind::rigid);
}

TEST(Fidelity, FixedAndDrivenBlocksNeverDeform) {
  SceneBlock fixed = block_with(Fidelity::deformable);
  fixed.fixed = true;
  EXPECT_EQ(kind_of(fixed, modulus_of(0.9), run_with(Fidelity::deformable)), BlockKind::fixed);
  fixed.fidelity = Fidelity::rigid;
  EXPECT_EQ(kind_of(fixed, modulus_of(0.9), run_with(Fidelity::rigid)), BlockKind::fixed);
  SceneBlock driven = block_with(Fidelity::deformable);
  driven.driven = true;
  EXPECT_EQ(kind_of(driven, modulus_of(0.9), run_with(Fidelity::deformable)), BlockKind::rigid);
  driven.fidelity = Fidelity::automatic;
  EXPECT_EQ(kind_of(driven, modulus_of(0.9), run_with(Fidelity::automatic)), BlockKind::rigid);
}

// Without a modulus nothing is known of the block's compliance: "auto" takes it as rigid, however strict.
TEST(Fidelity, WithoutAModulusIsRigid) {
  const FidelityChoice choice =
      choose_fidelity({}, area, rock(0.0), joint, run_with(Fidelity::automatic, 1e-12));
  EXPECT_EQ(choice.kind, BlockKind::rigid);
  EXPECT_EQ(choice.rigid_error, 0.0);
}

TEST(Fidelity, WithoutContactNothingIsLeftOut) {
  const FidelityChoice choice =
      choose_fidelity({}, area, rock(1e6), 0.0, run_with(Fidelity::automatic, 1e-12));
  EXPECT_EQ(choice.rigid_error, 0.0);
  EXPECT_EQ(choice.kind, BlockKind::rigid);
}

/// 3 m x 2 m with a notch of 1 m x 1 m cut in from above.
const std::vector<Vec2> notched{{0.0, 0.0}, {3.0, 0.0}, {3.0, 2.0}, {2.0, 2.0},
                                {2.0, 1.0}, {1.0, 1.0}, {1.0, 2.0}, {0.0, 2.0}};
// The header's 1e-9 of the polygon's size, here 3 m; points at half and at twice that distance.
constexpr double near = 3e-9;

struct Case {
  Vec2 point;
  bool held;
  const char *what;
};
const std::vector<Case> cases{
    {{0.5, 0.5}, true, "inside"},
    {{0.5, 1.5}, true, "inside the left horn"},
    {{2.5, 1.5}, true, "inside the right horn"},
    {{0.5, 1.0}, true, "level with the bottom of the notch: its ray passes along an edge"},
    {{1.5, 1.5}, false, "in the notch"},
    {{1.5, 2.0}, false, "in the mouth of the notch"},
    {{1.5, 1.0}, true, "on the bottom of the notch"},
    {{1.5, 1.0 - 0.5 * near}, true, "just below the bottom of the notch"},
    {{1.5, 1.0 + 0.5 * near}, true, "on the bottom but for rounding"},
    {{1.5, 1.0 + 2.0 * near}, false, "just above the bottom of the notch"},
    {{1.5, 0.0}, true, "on an edge"},
    {{3.0, 1.3}, true, "on the right edge"},
    {{3.0 + 2.0 * near, 1.3}, false, "just right of it"},
    {{3.0 + 0.5 * near, 1.3}, true, "on it but for rounding"},
    {{0.0, 0.0}, true, "on a vertex"},
    {{3.0, 2.0}, true, "on the highest vertex"},
    {{1.0, 1.0}, true, "on a re-entrant vertex"},
    {{-1.0, 0.0}, false, "left of an edge, on its line"},
    {{4.0, 1.0}, false, "right, level with re-entrant vertices"},
    {{-1.0, 1.0}, false, "left, level with re-entrant vertices: its ray crosses the whole block"},
    {{-1.0, 2.0}, false, "left, level with the four highest vertices"},
    {{1.5, -1.0}, false, "below"},
    {{1.5, 9.0}, false, "above the notch"},
};

TEST(HoldsPoint, OfANonConvexPolygon) {
  for (const Case &c : cases) {
    EXPECT_EQ(holds_point(notched, c.point), c.held) << c.what;
  }
}

// Turned, no edge is level any more; moved, coordinates carry an ulp of 1e6 m, 1.2e-10 m, far below `near`.
TEST(HoldsPoint, WhereverThePolygonLies) {
  for (const double angle : {0.0, 0.3, 0.5 * std::numbers::pi, 2.7}) {
    for (const Vec2 offset : {Vec2{}, Vec2{1e6, -1e6}}) {
      const std::vector<Vec2> polygon = placed(notched, angle, offset);
      for (const Case &c : cases) {
        EXPECT_EQ(holds_point(polygon, placed({c.point}, angle, offset)[0]), c.held)
            << c.what << ", angle " << angle << ", at " << offset.x;
      }
    }
  }
}

// The tolerance goes with the polygon's size.
TEST(HoldsPoint, HasARelativeTolerance) {
  for (const double scale : {1e-3, 1.0, 1e3}) {
    const std::vector<Vec2> square = rectangle({0.0, 0.0}, {scale, scale});
    EXPECT_TRUE(holds_point(square, {0.5 * scale, -0.5e-9 * scale})) << scale;
    EXPECT_FALSE(holds_point(square, {0.5 * scale, -2e-9 * scale})) << scale;
  }
}

TEST(DistanceToBoundary, IsThatOfTheNearestEdgeOrVertex) {
  const std::vector<Vec2> square = rectangle({0.0, 0.0}, {1.0, 1.0});
  EXPECT_EQ(distance_to_boundary(square, {0.5, -2.0}), 2.0) << "below an edge";
  EXPECT_EQ(distance_to_boundary(square, {4.0, 5.0}), 5.0) << "beyond a vertex";
  EXPECT_EQ(distance_to_boundary(square, {0.75, 0.5}), 0.25) << "inside";
}

TEST(HoldsPoint, NoPolygonHoldsAPointThatIsNone) {
  EXPECT_FALSE(holds_point(notched, {infinite, 0.5}));
  EXPECT_FALSE(holds_point(notched, {std::numeric_limits<double>::quiet_NaN(), 0.5}));
}

} // namespace
} // namespace gcpdda::fidelity_test
