#include "simulation/strain_watch.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace gcpdda::testing::strain_watch_test {
namespace {

Mat2 turned_by(double angle) {
  return {std::cos(angle), -std::sin(angle), std::sin(angle), std::cos(angle)};
}

// Turning on either side of the stretch changes neither of its principal values.
TEST(StrainOf, IsThatOfThePrincipalStretches) {
  for (const double before : {0.0, 0.7, 3.0}) {
    for (const double after : {0.0, -1.2, 2.5}) {
      const Mat2 first = turned_by(before);
      const Mat2 second = turned_by(after);
      EXPECT_NEAR(strain_of(second * first), 0.0, 1e-15);
      EXPECT_NEAR(strain_of(second * Mat2{0.7, 0.0, 0.0, 1.05} * first), 0.3, 1e-15);
      EXPECT_NEAR(strain_of(second * Mat2{1.4, 0.0, 0.0, 0.9} * first), 0.4, 1e-15);
    }
  }
  EXPECT_NEAR(strain_of({-0.2, 0.0, 0.0, 1.0}), 1.2, 1e-15) << "a block that is turned inside out";
}

} // namespace
} // namespace gcpdda::testing::strain_watch_test
