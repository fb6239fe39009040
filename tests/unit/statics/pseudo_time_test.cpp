// How the static solver lets loads in.

#include "statics/pseudo_time.hpp"

#include <gtest/gtest.h>

namespace gcpdda::testing::pseudo_time_test {
namespace {

// Every load comes in once and never goes back. Increments are smallest where joints begin to close and where
// the load becomes complete, so that neither makes blocks move faster than in between.
TEST(PseudoTime, LetsLoadsInByIncrementsThatAreSmallAtBothEnds) {
  const statics::PseudoTime iteration(Communicator::self(), {});
  const std::int64_t last = iteration.rules().increments;
  const auto increment = [&](std::int64_t k) {
    return iteration.load_share(k) - iteration.load_share(k - 1);
  };
  EXPECT_EQ(iteration.load_share(0), 0.0);
  EXPECT_EQ(iteration.load_share(last), 1.0);
  EXPECT_EQ(iteration.load_share(10 * last), 1.0);
  for (std::int64_t k = 1; k <= last; ++k) {
    EXPECT_GT(increment(k), 0.0) << k;
  }
  std::int64_t largest = 1;
  while (largest < last && increment(largest + 1) > increment(largest)) {
    ++largest;
  }
  EXPECT_GT(largest, last / 3);
  EXPECT_LT(largest, 2 * last / 3);
  for (std::int64_t k = largest + 1; k <= last; ++k) {
    EXPECT_LT(increment(k), increment(k - 1)) << k;
  }
  for (const std::int64_t end : {std::int64_t{1}, last}) {
    EXPECT_LT(increment(end), 0.1 / static_cast<double>(last)) << "a tenth of an even share";
  }
}

} // namespace
} // namespace gcpdda::testing::pseudo_time_test
