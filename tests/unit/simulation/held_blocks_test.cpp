// Settle stages with the dynamic step hold blocks at rest: what that changes, and what it saves.

#include "simulation/energy_ledger.hpp"
#include "simulation/held_blocks.hpp"
#include "support/contact_regions.hpp"
#include "support/incline.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

namespace gcpdda::testing::held_blocks_test {
namespace {

struct Course {
  std::vector<RigidDof> places; ///< by row
  std::vector<double> forces;   ///< normal ones, by region
  std::int64_t evaluations = 0; ///< of pairs in the last stage
  std::int64_t most_held = 0;   ///< rows, at one step
  std::int64_t held_at_end = 0;
  EnergyRow energies;
};

std::int64_t num_held(const BlockSystem &blocks) {
  std::int64_t held = 0;
  for (std::size_t row = 0; row < blocks.num_owned; ++row) {
    held += is_at_rest(blocks, row) ? 1 : 0;
  }
  return held;
}

/// The first steps of the last stage.
Course course_of(const std::string &toml, int steps) {
  Simulation simulation(Communicator::self(), scene_of(toml));
  while (simulation.stage().index < 2) {
    simulation.end_stage();
    simulation.stage_is_over() ? simulation.begin_next_stage() : simulation.step();
  }
  Course course;
  const EnergyLedger ledger(simulation.state());
  const std::int64_t before = simulation.counters().evaluations;
  for (int k = 0; k < steps; ++k) {
    simulation.step();
    course.held_at_end = num_held(simulation.blocks());
    course.most_held = std::max(course.most_held, course.held_at_end);
  }
  course.energies = ledger.row(simulation.state());
  course.evaluations = simulation.counters().evaluations - before;
  course.places = simulation.blocks().displacement;
  for (const auto &region : regions_of(simulation)) {
    course.forces.push_back(region.normal_force);
  }
  return course;
}

Course course_of(const std::string &fidelity, const std::string &tolerance, int steps) {
  const std::string stage = "local_damping = 0.1\ntolerance = " + tolerance + "\n";
  return course_of(falling_block_toml(fidelity, 10, 12, "interval = 10\n", stage), steps);
}

// Up to the impact forces may differ by a millionth of the largest and places by a millionth of a block, that
// is what is asked of them; here they differ by what a wall that is at rest to 1e-10 swings. With a tolerance
// of 1e-30 no block is held.
TEST(HeldBlocks, AreWhereTheyWouldBe) {
  for (const std::string fidelity : {"rigid", "deformable"}) {
    const Course held = course_of(fidelity, "1e-5", 400);
    const Course free = course_of(fidelity, "1e-30", 400);
    EXPECT_EQ(free.most_held, 0);
    EXPECT_EQ(held.held_at_end, std::ssize(held.places) - 2) << "all but the one that falls and the floor";
    EXPECT_LT(4 * held.evaluations, free.evaluations);
    ASSERT_EQ(held.forces.size(), free.forces.size());
    const double largest = *std::max_element(free.forces.begin(), free.forces.end());
    for (std::size_t k = 0; k < held.forces.size(); ++k) {
      EXPECT_NEAR(held.forces[k], free.forces[k], 1e-6 * largest);
    }
    for (std::size_t row = 0; row < held.places.size(); ++row) {
      EXPECT_LT(norm(held.places[row].u - free.places[row].u), 1e-6) << row;
    }
  }
}

// The impact wakes them in the step in which it comes to them, and they come to rest as if they had not been
// held: what follows an impact differs by as much after any change of the last digits.
TEST(HeldBlocks, WakeWhereForcesReachThem) {
  for (const std::string fidelity : {"rigid", "deformable"}) {
    const Course held = course_of(fidelity, "1e-5", 800);
    EXPECT_EQ(held.most_held, std::ssize(held.places) - 2);
    EXPECT_EQ(held.held_at_end, 0) << fidelity;
    // Of the energy that the block brings along.
    const Course free = course_of(fidelity, "1e-30", 800);
    EXPECT_NEAR(held.energies.residual, free.energies.residual, 1e-3 * -free.energies.gravity) << fidelity;
  }
}

// A run stage is dynamics, whether it ends by a verdict or not.
TEST(HeldBlocks, AreNotInARunStage) {
  std::string toml = falling_block_toml("rigid", 10, 12, "interval = 10\n", "local_damping = 0.1\n");
  const std::string settle = "kind = \"settle\"\nlimit = 40.0\nsolver = \"dynamic\"\n";
  toml.replace(toml.find(settle), settle.size(), "kind = \"run\"\nlimit = 40.0\n");
  EXPECT_EQ(course_of(toml, 400).most_held, 0);
}

} // namespace
} // namespace gcpdda::testing::held_blocks_test
