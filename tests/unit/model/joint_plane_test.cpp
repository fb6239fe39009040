// Traces of planes in the section: apparent dips and spacings against values by hand.

#include "model/joint_plane.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace gcpdda::joint_plane_test {
namespace {

constexpr double degree = std::numbers::pi / 180.0;
constexpr double rounding = 1e-14;

Pole pole(double dip, double dip_direction, double azimuth) {
  return pole_of({dip * degree, (dip_direction - azimuth) * degree, 0.0, 1.0});
}

double apparent(double dip, double dip_direction, double azimuth) {
  return trace_angle(pole(dip, dip_direction, azimuth)) / degree;
}

// tan(apparent dip) = tan(dip) cos(angle between dip direction and section).
TEST(JointPlane, HasTheApparentDipOfTheTables) {
  EXPECT_NEAR(apparent(45, 90, 90), -45.0, 1e-12); // along the section, down to the right
  EXPECT_NEAR(apparent(45, 270, 90), 45.0, 1e-12); // down to the left
  // tan 60 cos 60 = 0.866025, atan: 40.893395 degrees.
  EXPECT_NEAR(apparent(60, 150, 90), -40.893394649, 1e-8);
  EXPECT_NEAR(apparent(60, 30, 90), -40.893394649, 1e-8);
  EXPECT_NEAR(apparent(60, 210, 90), 40.893394649, 1e-8);
  // tan 35 cos 50 = 0.450085, atan: 24.231757 degrees.
  EXPECT_NEAR(apparent(35, 10, 320), -std::atan(std::tan(35 * degree) * std::cos(50 * degree)) / degree,
              1e-12);
  EXPECT_NEAR(apparent(35, 10, 320), -24.2318, 1e-4);
  EXPECT_NEAR(apparent(70, 0, 90), 0.0, 1e-12); // strikes along the section: level
  EXPECT_NEAR(apparent(90, 120, 90), -90.0, 1e-12);
  EXPECT_EQ(apparent(0, 120, 90), 0.0);
}

TEST(JointPlane, LiesFartherApartInAnObliqueSection) {
  EXPECT_NEAR(share_in_section(pole(45, 90, 90)), 1.0, rounding);
  EXPECT_NEAR(share_in_section(pole(0, 17, 90)), 1.0, rounding);
  // An upright plane 60 degrees off: twice as far. A plane that strikes along the section: 1/cos(dip).
  EXPECT_NEAR(share_in_section(pole(90, 150, 90)), 0.5, rounding);
  EXPECT_NEAR(share_in_section(pole(70, 0, 90)), std::cos(70 * degree), rounding);
  EXPECT_NEAR(share_in_section(pole(90, 0, 90)), 0.0, rounding);
}

// Poles about the mean pole have its angle with it, wherever they are turned to, and the right length.
TEST(JointPlane, TurnsPolesAboutTheMeanPole) {
  const JointPlane plane{50.0 * degree, 33.0 * degree, 0.0, 1.0};
  const Pole mean = pole_of(plane);
  for (const double around : {0.0, 1.0, 2.5, 4.0}) {
    const Pole p = pole_near(plane, 0.3, around);
    EXPECT_NEAR(p.x * p.x + p.y * p.y + p.z * p.z, 1.0, rounding);
    EXPECT_NEAR(p.x * mean.x + p.y * mean.y + p.z * mean.z, std::cos(0.3), rounding);
  }
}

} // namespace
} // namespace gcpdda::joint_plane_test
