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
  for (std::int64_t k = 2; k <= last / 2; ++k) {
    EXPECT_GT(increment(k), increment(k - 1)) << k;
    EXPECT_GT(increment(last + 1 - k), increment(last + 2 - k)) << last - k;
  }
}

} // namespace
} // namespace gcpdda::testing::pseudo_time_test
