// Ends of faults that miss a line by little.

#include "simulation/short_traces.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

namespace gcpdda::testing::short_traces_test {
namespace {

RockRegion square(double size) {
  RockRegion region;
  region.outline = {{0.0, 0.0}, {size, 0.0}, {size, size}, {0.0, size}};
  return region;
}

void add_fault(RockRegion &region, std::vector<Vec2> points) {
  region.faults.push_back({"fault", -1, std::move(points), {}});
}

// Two lines of 7.07 m at a right angle; half the diagonal rounded to 2.5 instead of 2.5004 ends 0.3 mm short.
TEST(ShortTraces, AreToldWithTheirGap) {
  RockRegion region = square(10.0);
  add_fault(region, {{0.0, 0.0}, {10.0, 10.0}});
  add_fault(region, {{0.0, 5.0}, {2.5, 2.5004}});
  const std::vector<ShortTrace> found = short_traces(region);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].end, (Vec2{2.5, 2.5004}));
  EXPECT_NEAR(found[0].gap, 0.0004 / std::sqrt(2.0), 1e-12);
}

// Ends of a map with a piece of millimetres at the end of the trace are seen as well.
TEST(ShortTraces, OfMapsBeforeAnOutline) {
  RockRegion region = square(10.0);
  region.maps.push_back({"map.csv", "", -1, {{{1.0, 1.0}, {1.0, 9.994}, {1.0, 9.999}}}, {}, {}});
  const std::vector<ShortTrace> found = short_traces(region);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_NEAR(found[0].gap, 1e-3, 1e-12);
}

TEST(ShortTraces, ALoopThatDoesNotClose) {
  RockRegion region = square(10.0);
  add_fault(region, {{1.0, 1.0}, {4.0, 1.0}, {4.0, 4.0}, {1.0, 1.001}});
  EXPECT_EQ(short_traces(region).size(), 2U);
}

// Ends on a line or a bit from it, beyond it, in the rock, at an end of another trace, or outside the region.
TEST(ShortTraces, AreNoneWhereNothingIsMissed) {
  RockRegion region = square(10.0);
  add_fault(region, {{0.0, 0.0}, {10.0, 10.0}});
  add_fault(region, {{0.0, 5.0}, {2.5, 2.5}});
  add_fault(region, {{0.0, 6.0}, {3.0, std::nextafter(3.0, 4.0)}});
  add_fault(region, {{0.0, 8.0}, {4.001, 3.999}});
  add_fault(region, {{0.0, 9.0}, {4.0, 9.0}});
  add_fault(region, {{4.0, 9.0}, {5.0, 8.0}});
  add_fault(region, {{8.0, 1.0}, {10.001, 1.0}});
  EXPECT_TRUE(short_traces(region).empty());
}

} // namespace
} // namespace gcpdda::testing::short_traces_test
