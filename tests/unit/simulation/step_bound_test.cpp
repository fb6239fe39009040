// The step that the program takes by itself for scenes with a single block.

#include "simulation/energy_ledger.hpp"
#include "simulation/simulation.hpp"
#include "support/scenes.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

namespace gcpdda::testing::step_bound_test {
namespace {

/// A bar 1 m long that hangs by a fixed point in the middle of its upper end and begins to swing.
std::string bar_on_a_point(const std::string &fidelity) {
  return fmt::format("[run]\nduration = 2.0\nfidelity = \"{}\"\n[material.rock]\ndensity = 2500\n"
                     "youngs_modulus = 1e9\npoissons_ratio = 0.2\n[joint.default]\nnormal_stiffness = 1e9\n"
                     "friction_angle_deg = 30\n[output]\ninterval = 0.5\n",
                     fidelity) +
         block_toml("bar", {{0.43, -0.90}, {0.52, -0.85}, {0.04, 0.02}, {-0.04, -0.02}},
                    "fixed_points = [[0, 0]]");
}

/// A fixed block too far away to be touched.
std::string far_block() {
  return block_toml("far", rectangle({-5.0, -5.0}, {5.0, -4.0}), "fixed = true");
}

class SingleBlock : public ::testing::TestWithParam<const char *> {};

TEST_P(SingleBlock, HasTheStepThatItHasBesideAFixedBlock) {
  const std::string toml = bar_on_a_point(GetParam());
  const Simulation alone(Communicator::self(), scene_of(toml));
  const Simulation beside(Communicator::self(), scene_of(toml + far_block()));
  EXPECT_GT(alone.bound().omega_max, 0.0);
  EXPECT_EQ(alone.bound().omega_max, beside.bound().omega_max);
  EXPECT_EQ(alone.bound().block, 0);
  EXPECT_EQ(alone.plan().time_step, beside.plan().time_step);
  EXPECT_LE(alone.plan().time_step, alone.bound().time_step);
}

// A fixed point gives way by the weight over its stiffness, which is 1e-8 m here.
TEST_P(SingleBlock, SwingsAboutItsFixedPointAndKeepsItsEnergy) {
  Simulation simulation(Communicator::self(), scene_of(bar_on_a_point(GetParam())));
  const EnergyLedger ledger(simulation.state());
  double most_kinetic = 0.0;
  while (!simulation.finished()) {
    simulation.step();
    if (simulation.step_count() % 100 == 0) {
      const EnergyRow row = ledger.row(simulation.state());
      most_kinetic = std::max(most_kinetic, row.kinetic);
      ASSERT_LE(std::abs(row.residual), 0.01);
      ASSERT_GE(row.strain, 0.0);
    }
  }
  EXPECT_GT(most_kinetic, 100.0);
}

INSTANTIATE_TEST_SUITE_P(StepBound, SingleBlock, ::testing::Values("rigid", "deformable"),
                         [](const auto &fidelity) { return fidelity.param; });

} // namespace
} // namespace gcpdda::testing::step_bound_test
