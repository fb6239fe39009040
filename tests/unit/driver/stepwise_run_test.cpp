#include "gcpdda/driver/stepwise_run.hpp"

#include "simulation/simulation.hpp"
#include "support/scenes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace gcpdda::stepwise_run_test {
namespace {

constexpr double gravity = 9.81;
constexpr double density = 2600.0;

/// A unit block that settles on a fixed one, and is then let go on.
Scene two_stages() {
  return testing::scene_of(R"(
[run]
fidelity = "rigid"
[material.rock]
density = 2600.0
[joint.default]
normal_stiffness = 1e8
friction_angle_deg = 30.0
[output]
interval = 0.05
[[block]]
name = "floor"
material = "rock"
fixed = true
vertices = [[-1.0, -1.0], [2.0, -1.0], [2.0, 0.0], [-1.0, 0.0]]
[[block]]
name = "block"
material = "rock"
vertices = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]
[[stage]]
kind = "settle"
limit = 20.0
[[stage]]
kind = "run"
duration = 0.1
)");
}

TEST(StepwiseRun, GoesThroughAllStages) {
  StepwiseRun run(Communicator::self(), two_stages());
  EXPECT_EQ(run.num_blocks(), 2);
  bool has_settled = false;
  while (!run.is_finished()) {
    run.step();
    has_settled = has_settled || run.stage() == 1;
  }
  EXPECT_TRUE(has_settled);
  EXPECT_FALSE(run.fault().has_value());
  std::vector<Vec2> vertices;
  const std::vector<FrameRow> blocks = run.blocks(&vertices);
  ASSERT_EQ(blocks.size(), 2U);
  EXPECT_EQ(vertices.size(), 8U);
  // It rests by d = W/(k_n l), and by up to d/l of that more: at its corners the next side is nearer.
  const double sunk = density * gravity / 1e8;
  EXPECT_NEAR(blocks[1].displacement.y, -sunk, sunk * sunk);
  const std::vector<ContactRow> contacts = run.contacts();
  ASSERT_EQ(contacts.size(), 1U);
  // A settled stage is in balance to its tolerance, 1e-5 of the weight or what the scene asks for.
  EXPECT_NEAR(contacts[0].normal_force, density * gravity, 1e-4 * density * gravity);
  EXPECT_LE(std::abs(run.energy().kinetic), 1e-9 * density * gravity * sunk);
}

// Forces on a block that flies are zero: its energies are those of its velocity, to rounding, with any step.
TEST(StepwiseRun, KeepsTheEnergyOfAFlightThroughAnotherStep) {
  for (const std::string fidelity : {"rigid", "deformable"}) {
    StepwiseRun run(Communicator::self(), testing::scene_of("[run]\nfidelity = \"" + fidelity + R"("
gravity = [0.0, 0.0]
time_step = 1e-3
[material.rock]
density = 2600.0
youngs_modulus = 1e9
poissons_ratio = 0.2
[joint.default]
normal_stiffness = 1e8
friction_angle_deg = 30.0
[output]
interval = 0.1
[[block]]
name = "block"
material = "rock"
velocity = [3.0, -1.0, 0.0]
vertices = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]
[[stage]]
kind = "run"
duration = 0.1
[[stage]]
kind = "run"
duration = 0.1
set = {"run.time_step" = 1e-4}
[[stage]]
kind = "run"
duration = 0.1
set = {"run.time_step" = 1e-3}
)"));
    const double kinetic = 0.5 * density * 10.0;
    double residual = 0.0;
    std::vector<double> steps;
    while (!run.is_finished()) {
      run.step();
      residual = std::max(residual, std::abs(run.energy().residual));
      if (steps.empty() || steps.back() != run.time_step()) {
        steps.push_back(run.time_step());
      }
    }
    EXPECT_EQ(steps, (std::vector<double>{1e-3, 1e-4, 1e-3}));
    EXPECT_LE(residual, 1e-9 * kinetic) << fidelity;
  }
}

TEST(StepwiseRun, StepsAsASimulationDoes) {
  const Scene scene = testing::scene_of(testing::falling_pile_toml(12, 0.1));
  StepwiseRun run(Communicator::self(), scene);
  Simulation simulation(Communicator::self(), scene);
  while (!simulation.finished()) {
    simulation.step();
    run.step();
  }
  EXPECT_TRUE(run.is_finished());
  EXPECT_EQ(run.step_count(), simulation.step_count());
  std::size_t compared = 0;
  for (const FrameRow &row : run.blocks()) {
    for (std::size_t k = 0; k < simulation.blocks().num_owned; ++k) {
      if (simulation.blocks().properties[k].id.value == row.block) {
        EXPECT_EQ(row.displacement, simulation.blocks().displacement[k].u);
        ++compared;
      }
    }
  }
  EXPECT_EQ(compared, simulation.blocks().num_owned);
}

} // namespace
} // namespace gcpdda::stepwise_run_test
