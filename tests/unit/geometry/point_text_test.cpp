#include "geometry/point_text.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace gcpdda::point_text_test {
namespace {

TEST(PointText, IsShortNearTheOrigin) {
  EXPECT_EQ(point_text({0.0, -2.5}), "[0, -2.5]");
  EXPECT_EQ(point_text({1.23456789, 999.9994}), "[1.23457, 999.999]");
  EXPECT_EQ(point_text({1.23456789, 1e-7}, 9), "[1.23456789, 1e-07]");
}

// {:g} would write [450015, 4.99999e+06] here.
TEST(PointText, HasMillimetresInMapCoordinates) {
  EXPECT_EQ(point_text({450015.25, 4999990.0}), "[450015.25, 4999990]");
  EXPECT_EQ(point_text({-1234.56789, 5000004.9994}), "[-1234.568, 5000004.999]");
  EXPECT_EQ(point_text({449999.9999, 1e6}, 9), "[450000, 1000000]");
  EXPECT_EQ(point_text({123456.789, 1234567.8912}, 9), "[123456.789, 1234567.891]");
}

TEST(PointText, KnowsNoNumbers) {
  EXPECT_EQ(coordinate_text(std::numeric_limits<double>::infinity()), "inf");
}

} // namespace
} // namespace gcpdda::point_text_test
