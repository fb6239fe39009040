// B5: a wedge of blocks on a slope that must stand, and slide where friction is too low.

#include "problem.hpp"

#include "simulation/energy_ledger.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace gcpdda::testing::block_systems_test {
namespace {

double max_speed(const Simulation &simulation) {
  double fastest = 0.0;
  for (std::size_t row = 0; row < simulation.blocks().num_owned; ++row) {
    const RigidDof &v = simulation.blocks().velocity[row];
    fastest = std::max(fastest, norm(v.u) + simulation.blocks().properties[row].radius * std::abs(v.r));
  }
  return fastest;
}

double max_difference(const std::vector<RigidDof> &a, const std::vector<RigidDof> &b) {
  double largest = 0.0;
  for (std::size_t row = 0; row < a.size(); ++row) {
    largest = std::max(largest, norm((a[row] - b[row]).u) + std::abs((a[row] - b[row]).r));
  }
  return largest;
}

// Round-off: after 20 s the last slow modes have died out.
TEST(BlockSystems, WedgeOnASlopeStays) {
  Simulation simulation(Communicator::self(), shipped_scene("stacked_wedge", {"run.duration=24.0"}));
  ASSERT_EQ(simulation.blocks().num_owned, 32U);
  run_until(simulation, 20.0);
  const std::vector<RigidDof> rest = simulation.blocks().displacement;
  expect_below("B5 wedge of 32 blocks, xi = 0.3: settlement after 20 s, m", 0.02,
               max_difference(rest, std::vector<RigidDof>(rest.size())));
  expect_below("B5 wedge of 32 blocks, xi = 0.3: speed after 20 s, m/s", 1e-10, max_speed(simulation));
  run(simulation);
  expect_below("B5 wedge of 32 blocks, xi = 0.3: motion from 20 to 24 s, m", 1e-11,
               max_difference(simulation.blocks().displacement, rest));
}

/// Largest speed from now until `time`.
double peak_speed(Simulation &simulation, double time) {
  double peak = 0.0;
  while (simulation.time() < time && !simulation.finished()) {
    step(simulation);
    peak = std::max(peak, max_speed(simulation));
  }
  return peak;
}

// The default xi = 0.05 hardly damps the wedge's slow swaying, but no joint slides any more and the swaying
// dies out. Flush joints that are loaded at once settle in a way that round-off decides: hence a wide limit.
TEST(BlockSystems, WedgeOnASlopeSettlesWithLittleDamping) {
  Simulation simulation(Communicator::self(),
                        shipped_scene("stacked_wedge", {"run.contact_damping=0.05", "run.duration=16.0"}));
  const EnergyLedger ledger(simulation.state());
  run_until(simulation, 5.0);
  const double early_speed = peak_speed(simulation, 8.0);
  const double early_work = ledger.row(simulation.state()).friction_loss;
  run_until(simulation, 13.0);
  const double late_speed = peak_speed(simulation, 16.0);
  const double late_work = ledger.row(simulation.state()).friction_loss;
  EXPECT_FALSE(simulation.fault().has_value());
  expect_below("B5 wedge of 32 blocks, xi = 0.05: peak speed from 13 to 16 s over that from 5 to 8 s", 0.8,
               late_speed / early_speed);
  expect_below("B5 wedge of 32 blocks, xi = 0.05: work of friction from 8 to 16 s over that until 8 s", 1e-6,
               std::abs(late_work / early_work - 1.0));
}

TEST(BlockSystems, WedgeOnASlopeSlidesWhenFrictionIsTooLow) {
  Simulation simulation(
      Communicator::self(),
      shipped_scene("stacked_wedge", {"joint.default.friction_angle_deg=24.0", "run.duration=3.0"}));
  run(simulation);
  const std::vector<RigidDof> &moved = simulation.blocks().displacement; // the ground too
  // The whole wedge as one block: s = g (sin 26.5 - tan 24 cos 26.5) t^2/2 = 2.12 m; its rows also shear.
  expect_above("B5 wedge of 32 blocks at friction 24 degrees: motion in 3 s, m", 2.0,
               max_difference(moved, std::vector<RigidDof>(moved.size())));
}

} // namespace
} // namespace gcpdda::testing::block_systems_test
