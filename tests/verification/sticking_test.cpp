// B6: a block that sticks to a plane swings on its stick spring for ever.

#include "problem.hpp"

#include "simulation/energy_ledger.hpp"
#include "support/memories.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

namespace gcpdda::testing::sticking_test {
namespace {

// No damping, no slip: swaying couples with rocking and bouncing, nothing is lost. The first tenth of the run
// shows every phase of that; later none may stand out. (Springs that follow v dt instead of the trial
// configurations gained a factor of 250 to 900.)
TEST(Sticking, EnergyOfATangentialOscillationIsBounded) {
  constexpr double k_n = 1e9;
  constexpr double dt = 2e-4;
  constexpr int num_steps = 100000;
  const double weight = rock_density * earth_gravity;
  const double depth = 1.0 - std::sqrt(1.0 - 2.0 * weight / k_n);
  // A contact that moves at t = 0 starts on its cap otherwise.
  Simulation simulation(Communicator::self(),
                        scene_of(head({.duration = num_steps * dt,
                                       .time_step = dt,
                                       .normal_stiffness = k_n,
                                       .friction_deg = 35.0,
                                       .damping = 0.0,
                                       .run_keys = "initial_friction = \"zero\""}) +
                                 block_toml("plane", rectangle({-3.0, -2.0}, {4.0, 0.0}), "fixed = true") +
                                 block_toml("square", rectangle({0.0, -depth}, {1.0, 1.0 - depth}),
                                            "velocity = [1e-3, 0.0, 0.0]")));
  EnergyLedger ledger(simulation.state());
  const double supplied = 0.5 * rock_density * 1e-6;
  double first = 0.0;
  double later = 0.0;
  double lost = 0.0;
  while (!simulation.finished()) {
    step(simulation);
    if (simulation.step_count() % 20 == 0) {
      const EnergyRow row = ledger.row(simulation.state());
      (simulation.step_count() <= num_steps / 10 ? first : later) =
          std::max(simulation.step_count() <= num_steps / 10 ? first : later, std::abs(row.residual));
      lost = row.friction_loss;
    }
  }
  ASSERT_FALSE(simulation.fault().has_value());
  expect_below("B6 distance slid in 100000 steps, m", 0.0, memories(simulation.history())[0].slip);
  // Round-off of the sum of the work of 1e5 steps.
  expect_below("B6 energy lost in friction over the energy supplied", 1e-8, std::abs(lost) / supplied);
  expect_below("B6 energy error over the energy supplied, steps 0 to 10000", 0.05, first / supplied);
  expect_below("B6 energy error of steps 10000 to 100000 over that of the first 10000", 1.02, later / first);
}

/// What a square does that was kicked along its plane, over the energy of the kick.
struct Swinging {
  double friction_loss = 0.0;
  double kinetic_first = 0.0; ///< largest in the first tenth of the run
  double kinetic_later = 0.0;
};

// A point load where it stands presses the square to its plane without straining it.
Swinging swing_deformable(double youngs_modulus) {
  constexpr double k_n = 1e9;
  constexpr double dt = 1e-4;
  constexpr int num_steps = 100000;
  constexpr double speed = 1e-3;
  constexpr double depth = 3e-5;
  constexpr double load = k_n * depth * (1.0 - 0.5 * depth);
  Simulation simulation(
      Communicator::self(),
      scene_of(head({.duration = num_steps * dt,
                     .time_step = dt,
                     .gravity = {},
                     .normal_stiffness = k_n,
                     .friction_deg = 35.0,
                     .damping = 0.0,
                     .run_keys = "initial_friction = \"zero\"\nelasticity = \"explicit\"",
                     .fidelity = "deformable",
                     .youngs_modulus = youngs_modulus,
                     .poissons_ratio = 0.2}) +
               block_toml("plane", rectangle({-3.0, -2.0}, {4.0, 0.0}), "fixed = true") +
               block_toml("square", rectangle({0.0, -depth}, {1.0, 1.0 - depth}),
                          fmt::format("velocity = [{}, 0.0, 0.0]\n[[block.load]]\npoint = [0.5, {}]\n"
                                      "force = [0.0, {}]",
                                      speed, -depth, -load))));
  EnergyLedger ledger(simulation.state());
  const double supplied = 0.5 * rock_density * speed * speed;
  Swinging result;
  while (!simulation.finished()) {
    step(simulation);
    if (simulation.step_count() % 20 == 0) {
      const EnergyRow row = ledger.row(simulation.state());
      double &largest =
          simulation.step_count() <= num_steps / 10 ? result.kinetic_first : result.kinetic_later;
      largest = std::max(largest, row.kinetic / supplied);
      result.friction_loss = row.friction_loss / supplied;
    }
  }
  EXPECT_FALSE(simulation.fault().has_value());
  expect_below("B6 distance slid in 100000 steps, deformable, m", 0.0,
               memories(simulation.history())[0].slip);
  return result;
}

// Strain swings with the joint. The loss is what the skew part of the tangent leaves
// (tests/unit/contact/tangent_test.cpp), of the order of the strain of the stick spring, 2e-6. (Friction at
// the centre of pressure leaves 1.4e-4.)
TEST(Sticking, EnergyOfADeformableBlockIsBounded) {
  for (const double youngs_modulus : {1e9, 3e9}) {
    const Swinging swinging = swing_deformable(youngs_modulus);
    const std::string block = fmt::format("B6 square of E = {:.0e} Pa: ", youngs_modulus);
    expect_below(block + "energy lost in friction over the energy supplied", 1e-5,
                 std::abs(swinging.friction_loss));
    expect_below(block + "kinetic energy of steps 10000 to 100000 over that of the first 10000", 1.02,
                 swinging.kinetic_later / swinging.kinetic_first);
  }
}

} // namespace
} // namespace gcpdda::testing::sticking_test
