// The hint of a warning about impacts.

#include "simulation/impact_watch.hpp"
#include "support/scenes.hpp"

#include <gtest/gtest.h>

namespace gcpdda::testing::impact_watch_test {
namespace {

// No block is free to move: there is no frequency that run.safety could refer to.
TEST(ImpactWatch, HintsAtATimeStepWhereNothingLimitsIt) {
  const Simulation simulation(
      Communicator::self(),
      scene_of("[run]\nduration = 1.0\n[material.rock]\ndensity = 2500\n[joint.default]\n"
               "normal_stiffness = 1e9\nfriction_angle_deg = 30\n[output]\ninterval = 0.5\n" +
               block_toml("floor", rectangle({-1.0, -1.0}, {1.0, 0.0}), "fixed = true")));
  ASSERT_EQ(simulation.bound().omega_max, 0.0);
  EXPECT_EQ(warning_of(simulation, {0.0, 0.5, 0.02, 1.0}).hint, "use run.time_step = 0.25 or less");
}

} // namespace
} // namespace gcpdda::testing::impact_watch_test
