// B1, B2 and C3: blocks at rest on their joints.

#include "problem.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

namespace gcpdda::testing::rest_test {
namespace {

constexpr double weight = rock_density * earth_gravity; ///< of a unit square, N/m

std::string floor_toml() {
  return block_toml("floor", rectangle({-4.0, -2.0}, {5.0, 0.0}), "fixed = true");
}

// Soft on purpose: the depth is 2.5 % of the block, so that the correction (1 - d/2L) counts. Round-off once
// the oscillation has been damped out.
TEST(Rest, OverlapOfASquareOnAPlane) {
  for (const double k_n : {1e6, 1e9}) {
    Simulation simulation(Communicator::self(),
                          scene_of(head({.duration = 40.0, .normal_stiffness = k_n, .damping = 0.3}) +
                                   floor_toml() + block_toml("square", rectangle({0.0, 0.0}, {1.0, 1.0}))));
    run(simulation);
    // k_n L d (1 - d/(2L)) = m g
    expect_value(fmt::format("B1 k_n={:g}: overlap at rest, m", k_n),
                 1.0 - std::sqrt(1.0 - 2.0 * weight / k_n), -displacement_of(simulation, 1).u.y, 1e-10);
  }
}

// omega^2 = (k_n L/m)(1 - d/L) for small amplitudes: the leading term up to O(d/L).
TEST(Rest, PeriodOfASquareOnAPlane) {
  for (const double k_n : {1e7, 1e9}) {
    const double depth = 1.0 - std::sqrt(1.0 - 2.0 * weight / k_n);
    const double period = 2.0 * std::numbers::pi * std::sqrt(rock_density / k_n);
    constexpr int num_periods = 20;
    constexpr int steps_per_period = 1000;
    Simulation simulation(Communicator::self(),
                          scene_of(head({.duration = 1.1 * num_periods * period,
                                         .time_step = period / steps_per_period,
                                         .normal_stiffness = k_n,
                                         .damping = 0.0}) +
                                   floor_toml() +
                                   block_toml("square", rectangle({0.0, -depth}, {1.0, 1.0 - depth}),
                                              fmt::format("velocity = [0.0, {:.17g}, 0.0]",
                                                          1e-3 * depth * std::sqrt(k_n / rock_density)))));
    // The square starts upwards through its rest position; the 20th return in that direction ends 20 periods.
    int returns = 0;
    double end = 0.0;
    while (returns < num_periods && !simulation.finished()) {
      const double before = displacement_of(simulation, 1).u.y;
      const double time = simulation.time();
      step(simulation);
      const double after = displacement_of(simulation, 1).u.y;
      if (before < 0.0 && after >= 0.0) {
        ++returns;
        end = time + simulation.plan().time_step * before / (before - after);
      }
    }
    ASSERT_EQ(returns, num_periods);
    const double measured = end / num_periods;
    expect_value(fmt::format("B1 k_n={:g}, d/L={:.1e}: period, s", k_n, depth), period, measured,
                 1.0 * depth);
    // Truncation: the leapfrog's period is short by W^2/24 = 1.6e-6, the amplitude adds 1e-6 d/L.
    expect_value(fmt::format("B1 k_n={:g}: period with the depth's share, s", k_n),
                 period / std::sqrt(1.0 - depth), measured, 3e-6);
  }
}

// p_n h^2 tan t (1 + sin t)/H with p_n/H = k_n/2: an exact integral. The depth is a difference of coordinates
// of 1 m, good to 1e-16 m of 1e-3 m.
TEST(Rest, SymmetricWedgeOnAPlane) {
  constexpr double k_n = 1e9;
  constexpr double depth = 0.001;
  for (const double half_angle : {2.5, 15.0, 30.0, 45.0, 60.0}) {
    const double half_width = std::tan(half_angle * degree);
    Simulation simulation(
        Communicator::self(),
        scene_of(
            head({.gravity = {}, .normal_stiffness = k_n}) +
            block_toml("floor", rectangle({-9.0, -4.0}, {9.0, 0.0}), "fixed = true") +
            block_toml("wedge", {{0.0, -depth}, {half_width, 1.0 - depth}, {-half_width, 1.0 - depth}})));
    const RigidDof force = simulation.blocks().contact[row_of(simulation, 1)].force;
    expect_value(fmt::format("B2 wedge of half-angle {} degrees, 1 mm deep: force, N/m", half_angle),
                 0.5 * k_n * depth * depth * half_width * (1.0 + std::sin(half_angle * degree)), force.u.y,
                 1e-12);
    EXPECT_LE(std::abs(force.u.x) + std::abs(force.r), 1e-12 * force.u.y);
  }
}

/// Largest relative error of the overlap of a column's joints. Equal faces: k_n L d (1 - d/L) = weight above;
/// the floor is wider: (1 - d/(2L)).
double column_error(int num_blocks, double k_n) {
  std::string toml = head({.duration = 60.0,
                           .normal_stiffness = k_n,
                           .friction_deg = 30.0,
                           .damping = 0.3,
                           .run_keys = "gravity_ramp = 2.0"}) +
                     floor_toml();
  for (int k = 0; k < num_blocks; ++k) {
    toml += block_toml(fmt::format("b{}", k), rectangle({0.0, k + 0.0}, {1.0, k + 1.0}));
  }
  Simulation simulation(Communicator::self(), scene_of(toml));
  run(simulation);
  double worst = 0.0;
  for (int joint = 0; joint < num_blocks; ++joint) {
    const double closure = (num_blocks - joint) * weight / k_n;
    const double expected = joint == 0 ? 1.0 - std::sqrt(1.0 - 2.0 * closure)
                                       : 2.0 * closure / (1.0 + std::sqrt(1.0 - 4.0 * closure));
    const double below = joint == 0 ? 0.0 : displacement_of(simulation, joint).u.y;
    const double overlap = below - displacement_of(simulation, joint + 1).u.y;
    worst = std::max(worst, std::abs(overlap / expected - 1.0));
  }
  return worst;
}

// Damping of slow modes by joints is weak, hence the ramp of gravity and the long run; then round-off. Joints
// turn like springs k_n L^3/12, so a column buckles under its own weight above m g/L = 7.84 (k_n
// L^4/12)/height^3: the soft column stands at 10 % of that, the high one at 4 %.
TEST(Rest, JointsOfAColumn) {
  expect_below("C3 column of 5 blocks, k_n = 5e7: largest relative error of a joint's overlap", 1e-9,
               column_error(5, 5e7));
  expect_below("C3 column of 10 blocks, k_n = 1e9: largest relative error of a joint's overlap", 1e-9,
               column_error(10, 1e9));
}

// Block i of n carries (n - i - 1/2) weights on average and its lower joint n - i; without Poisson's effect,
// so that the joints stay straight. What is left out is strain and closure over the size, 1e-5 each.
TEST(Rest, ShorteningOfADeformableColumn) {
  constexpr int num_blocks = 5;
  constexpr double k_n = 2e10;
  for (const double ratio : {0.2, 1.0, 5.0}) { // k_n L/E
    const double youngs_modulus = k_n / ratio;
    std::string toml = head({.duration = 1.5,
                             .normal_stiffness = k_n,
                             .friction_deg = 30.0,
                             .run_keys = "local_damping = 0.5",
                             .fidelity = "deformable",
                             .youngs_modulus = youngs_modulus}) +
                       floor_toml();
    for (int k = 0; k < num_blocks; ++k) {
      toml += block_toml(fmt::format("b{}", k), rectangle({0.0, k + 0.0}, {1.0, k + 1.0}));
    }
    Simulation simulation(Communicator::self(), scene_of(toml));
    run(simulation);
    const BlockSystem &blocks = simulation.blocks();
    const std::size_t top = row_of(simulation, num_blocks);
    const double got =
        -displacement_of(simulation, num_blocks).u.y - 0.5 * (blocks.deformation_of(top).gradient.yy - 1.0);
    const double joints = 0.5 * num_blocks * (num_blocks + 1) * weight / k_n;
    const double hooke = 0.5 * num_blocks * num_blocks * weight / youngs_modulus;
    expect_value(
        fmt::format("C3 column of {} deformable blocks, k_n L/E = {}: shortening, m", num_blocks, ratio),
        joints + hooke, got, 2e-5);
  }
}

} // namespace
} // namespace gcpdda::testing::rest_test
