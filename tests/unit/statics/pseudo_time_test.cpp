// How the static solver lets loads in, and its steps.

#include "statics/pseudo_time.hpp"
#include "support/blocks.hpp"
#include "support/touching_pairs.hpp"

#include <gtest/gtest.h>

#include <random>
#include <vector>

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

// Long steps, in which (I + G)^-1 is far from I - G.
TEST(PseudoTime, StepsAreTakenBack) {
  std::mt19937 engine(3);
  const TouchingPair shapes = touching_pair(engine, Touch::face_on_face, 1e-5, 0.3);
  BlockSystem system = strained_blocks(engine, {shapes.lower, shapes.higher}, {false, true}, 1e10, 1e-3);
  statics::PseudoTime iteration(Communicator::self(), {});
  const std::vector<StiffnessBound> stiffness(2, {1e9, 1e9});
  iteration.lay(system, stiffness, true, {});
  const std::vector<RigidDof> trial = system.trial;
  const Mat2 gradient = system.deformation_of(1).trial;
  for (PseudoMotion &motion : pseudo_rows(system)) {
    motion.velocity = {0.3, -0.2, 0.1, -0.15, 0.2, 0.05};
  }
  iteration.move(system);
  EXPECT_GT(norm(system.deformation_of(1).trial - gradient), 0.1);
  iteration.turn_back(system);
  iteration.move(system);
  for (std::size_t row = 0; row < 2; ++row) {
    EXPECT_NEAR(norm(system.trial[row].u - trial[row].u), 0.0, 1e-15);
    EXPECT_NEAR(system.trial[row].r, trial[row].r, 1e-15);
  }
  EXPECT_NEAR(norm(system.deformation_of(1).trial - gradient), 0.0, 1e-15);
  EXPECT_EQ(system.deformation_of(1).gradient, system.deformation_of(1).trial);
}

} // namespace
} // namespace gcpdda::testing::pseudo_time_test
