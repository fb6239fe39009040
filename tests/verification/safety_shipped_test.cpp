// Factors of safety of the systems with which the thresholds of a trial's verdict were set
// (simulation/stages.hpp), found with the bracket of 1 % and what their scenes say: the tuned half.

#include "safety_limits.hpp"

#include "blockgen/region_cutter.hpp"
#include "support/cut_region.hpp"
#include "support/plane_failure.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

namespace gcpdda::testing::safety_shipped_test {
namespace {

constexpr double default_bracket = 0.01;

TEST(SafetyShipped, InclineAt51Degrees) {
  const double dip = 30.0 * degree;
  const double friction = 51.04 * degree;
  const std::string toml = head({.gravity = {earth_gravity * std::sin(dip), -earth_gravity * std::cos(dip)},
                                 .friction_deg = friction / degree}) +
                           block_toml("plane", rectangle({-2.0, -1.0}, {40.0, 0.0}), "fixed = true") +
                           block_toml("block", rectangle({0.0, 0.0}, {2.0, 1.0}));
  expect_factor(
      {"incline at 30 degrees, friction 51.04 degrees", std::tan(friction) / std::tan(dip), Half::tuned},
      toml);
}

TEST(SafetyShipped, PlaneFailure) {
  for (const double from_cohesion : {0.0, 0.5}) {
    Scene scene = scene_of(plane_failure_toml(from_cohesion));
    scene.reduction.tolerance = default_bracket;
    expect_factor({from_cohesion > 0.0 ? "plane failure with cohesion" : "plane failure",
                   plane_failure_factor(from_cohesion), Half::tuned},
                  scene);
  }
}

// Limit equilibrium; the bound, which can choose the forces between columns, is 12 % higher.
TEST(SafetyShipped, GoodmanBray) {
  KnownLimit limit{"toppling slope of Goodman and Bray", std::tan(40.0 * degree) / 0.785544, Half::tuned};
  limit.bound_tolerance = 0.0;
  expect_factor(limit, shipped_scene("goodman_bray"));
}

TEST(SafetyShipped, DeformableSlope) {
  Scene scene = shipped_scene("deformable_slope", {"run.fidelity=rigid"});
  scene.region_blocks = std::make_shared<RegionCutter>(scene);
  KnownLimit limit{"slope on a bedding plane", std::tan(42.0 * degree) / std::tan(35.0 * degree),
                   Half::tuned};
  limit.bound_tolerance = 0.0;
  expect_factor(limit, scene);
}

// A scene that says nothing of stages or searches, on the way to a rest that friction does not reach at
// first: by local damping alone five of ten trials crept on until their limit.
TEST(SafetyShipped, SceneWithoutStagesHasAVerdict) {
  Scene scene = shipped_scene("jointed_bench");
  prepare_region(scene);
  const SafetyOutcome found = search_quietly(scene);
  EXPECT_EQ(found.exit_code, exit_code::done) << found.message;
  EXPECT_TRUE(found.report.undecided.empty());
  ASSERT_TRUE(found.report.holds && found.report.fails);
  EXPECT_LE(*found.report.fails, (1.0 + default_bracket) * *found.report.holds);
}

} // namespace
} // namespace gcpdda::testing::safety_shipped_test
