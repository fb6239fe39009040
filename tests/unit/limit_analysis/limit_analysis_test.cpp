// Limit analysis of rigid blocks against closed forms.

#include "limit_analysis/limit_analysis.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace gcpdda::limit_analysis_test {
namespace {

constexpr double degree = std::numbers::pi / 180.0;

/// A block of breadth b and height h with the weight 1 on a plane along x that falls by `dip` towards +x.
LimitBlock block_on(double dip, double height) {
  return {{0.0, 0.5 * height}, 1.0, {std::sin(dip), -std::cos(dip)}, 0.0};
}
LimitJoint base_of(double breadth, double phi) {
  LimitJoint joint;
  joint.first = 0;
  joint.begin = {-0.5 * breadth, 0.0};
  joint.end = {0.5 * breadth, 0.0};
  joint.normal = {0.0, 1.0};
  joint.tan_friction = std::tan(phi);
  return joint;
}
double bound(const std::vector<LimitBlock> &blocks, const std::vector<LimitJoint> &joints) {
  return bound_of_factor({blocks, joints, {}}, 0.1, 10.0, 1e-6).value_or(0.0);
}

TEST(LimitAnalysis, BlockOnAPlane) {
  EXPECT_NEAR(bound({block_on(30.0 * degree, 0.5)}, {base_of(2.0, 40.0 * degree)}),
              std::tan(40.0 * degree) / std::tan(30.0 * degree), 3e-6);
  LimitJoint glued = base_of(2.0, 40.0 * degree);
  glued.cohesion = 0.5 * std::sin(30.0 * degree);
  EXPECT_NEAR(bound({block_on(30.0 * degree, 0.5)}, {glued}),
              std::tan(40.0 * degree) / std::tan(30.0 * degree) + 0.5, 3e-6);
}

// Pressure and pull of a bond have one line of strength: the tension that it could bear adds no shear.
TEST(LimitAnalysis, TensionDoesNotHoldABlockThatSlides) {
  LimitJoint glued = base_of(2.0, 40.0 * degree);
  glued.cohesion = 0.5 * std::sin(30.0 * degree);
  glued.tension = 0.9 * glued.cohesion / glued.tan_friction;
  EXPECT_NEAR(bound({block_on(30.0 * degree, 0.5)}, {glued}),
              std::tan(40.0 * degree) / std::tan(30.0 * degree) + 0.5, 3e-6);
}

// Its weight passes outside of its base: no friction holds it, and the strength of a bond does. The bond
// fails where T/2 at the upper end, with lever b, balances W (h/2 sin - b/2 cos).
TEST(LimitAnalysis, BlockThatTopples) {
  const double dip = 25.0 * degree;
  LimitJoint joint = base_of(1.0, 60.0 * degree);
  EXPECT_FALSE(can_hold({{block_on(dip, 3.0)}, {joint}, {}}, 0.1));
  EXPECT_TRUE(can_hold({{block_on(dip, 2.0)}, {joint}, {}}, 1.0)) << "b/h = 0.5 > tan(25)";
  joint.tension = 4.0 * (1.5 * std::sin(dip) - 0.5 * std::cos(dip));
  EXPECT_NEAR(bound({block_on(dip, 3.0)}, {joint}), 2.0, 1e-5);
}

// Two on each other: the upper joint is the weaker one; where it is not weakened the lower one governs.
TEST(LimitAnalysis, WeakerJointGoverns) {
  const double dip = 20.0 * degree;
  LimitBlock upper = block_on(dip, 1.0);
  upper.centroid.y = 1.5;
  LimitJoint between = base_of(1.0, 30.0 * degree);
  between.first = 1;
  between.second = 0;
  between.begin.y = between.end.y = 1.0;
  const LimitJoint base = base_of(3.0, 40.0 * degree);
  EXPECT_NEAR(bound({block_on(dip, 1.0), upper}, {base, between}), std::tan(30.0 * degree) / std::tan(dip),
              3e-6);
  between.is_weakened = false;
  EXPECT_NEAR(bound({block_on(dip, 1.0), upper}, {base, between}), std::tan(40.0 * degree) / std::tan(dip),
              5e-6);
}

// A block of 51,012 N/m that has settled on a plane of 30 degrees, glued by 1.5 of what drives it: the normal
// of its joint is that of the plane but for a part of 3e-18, and its load has a torque of 1e-6 N left.
TEST(LimitAnalysis, RoundingOfASettledStateChangesNothing) {
  const LimitBlock block{{1.0000379906499344, 0.4999779108510925},
                         std::sqrt(2.0),
                         {25505.999995000453, -44177.687897789925},
                         1.6250469343503937e-06};
  LimitJoint joint;
  joint.second = 0;
  joint.begin = {2.8425607541349152e-05, -1.3806146285795485e-05};
  joint.end = {2.0000284260301151, -1.3806146285801889e-05};
  joint.normal = {-3.2017946496843251e-18, -1.0};
  joint.tan_friction = std::tan(5.0 * degree);
  joint.cohesion = 38259.00000808362;
  const double expected = 1.5 + std::tan(5.0 * degree) / std::tan(30.0 * degree);
  EXPECT_NEAR(bound({block}, {joint}), expected, 5e-6);
  EXPECT_TRUE(can_hold({{block}, {joint}, {}}, 0.5));
}

// However the axes lie: parts of unit vectors that are zero in some are rounding in others.
TEST(LimitAnalysis, TurnsChangeNothing) {
  for (int step = 0; step < 24; ++step) {
    const double angle = 15.0 * degree * step;
    const auto turned = [&](Vec2 x) {
      return Vec2{std::cos(angle) * x.x - std::sin(angle) * x.y,
                  std::sin(angle) * x.x + std::cos(angle) * x.y};
    };
    LimitBlock block = block_on(30.0 * degree, 0.5);
    LimitJoint glued = base_of(2.0, 5.0 * degree);
    glued.cohesion = 1.5 * std::sin(30.0 * degree);
    block.centroid = turned(block.centroid);
    block.load = turned(block.load);
    glued.begin = turned(glued.begin);
    glued.end = turned(glued.end);
    glued.normal = turned(glued.normal);
    EXPECT_NEAR(bound({block}, {glued}), 1.5 + std::tan(5.0 * degree) / std::tan(30.0 * degree), 5e-6)
        << 15 * step << " degrees";
  }
}

TEST(LimitAnalysis, SaysWhereNothingFails) {
  EXPECT_FALSE(bound_of_factor({{block_on(0.0, 1.0)}, {base_of(1.0, 30.0 * degree)}, {}}, 0.5, 4.0, 0.01));
  EXPECT_EQ(
      bound_of_factor({{block_on(40.0 * degree, 0.5)}, {base_of(2.0, 20.0 * degree)}, {}}, 0.5, 4.0, 0.01),
      0.5);
}

} // namespace
} // namespace gcpdda::limit_analysis_test
