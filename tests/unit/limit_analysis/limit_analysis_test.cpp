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
  return bound_of_factor(blocks, joints, 0.1, 10.0, 1e-6).value_or(0.0);
}

TEST(LimitAnalysis, BlockOnAPlane) {
  EXPECT_NEAR(bound({block_on(30.0 * degree, 0.5)}, {base_of(2.0, 40.0 * degree)}),
              std::tan(40.0 * degree) / std::tan(30.0 * degree), 3e-6);
  LimitJoint glued = base_of(2.0, 40.0 * degree);
  glued.cohesion = 0.5 * std::sin(30.0 * degree);
  EXPECT_NEAR(bound({block_on(30.0 * degree, 0.5)}, {glued}),
              std::tan(40.0 * degree) / std::tan(30.0 * degree) + 0.5, 3e-6);
}

// Its weight passes outside of its base: no friction holds it, and the strength of a bond does. The bond
// fails where T/2 at the upper end, with lever b, balances W (h/2 sin - b/2 cos).
TEST(LimitAnalysis, BlockThatTopples) {
  const double dip = 25.0 * degree;
  LimitJoint joint = base_of(1.0, 60.0 * degree);
  EXPECT_FALSE(can_hold({block_on(dip, 3.0)}, {joint}, 0.1));
  EXPECT_TRUE(can_hold({block_on(dip, 2.0)}, {joint}, 1.0)) << "b/h = 0.5 > tan(25)";
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

TEST(LimitAnalysis, SaysWhereNothingFails) {
  EXPECT_FALSE(bound_of_factor({block_on(0.0, 1.0)}, {base_of(1.0, 30.0 * degree)}, 0.5, 4.0, 0.01));
  EXPECT_EQ(bound_of_factor({block_on(40.0 * degree, 0.5)}, {base_of(2.0, 20.0 * degree)}, 0.5, 4.0, 0.01),
            0.5);
}

} // namespace
} // namespace gcpdda::limit_analysis_test
