// A4 and A5: what a rigid system must keep.

#include "problem.hpp"

#include "geometry/polygon.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace gcpdda::testing::conservation_test {
namespace {

// Round-off. The angle is a sum of 1e5 equal terms, whose half ulps of up to 5e-13 rad may all fall on one
// side.
TEST(Conservation, SpinningBlockThousandTurns) {
  constexpr int turns = 1000;
  constexpr int steps_per_turn = 100;
  const double spin = 2.0 * std::numbers::pi;
  Simulation simulation(Communicator::self(),
                        scene_of(head({.duration = turns, .time_step = 1.0 / steps_per_turn, .gravity = {}}) +
                                 block_toml("top", rectangle({-1.0, -0.5}, {1.0, 0.5}),
                                            fmt::format("velocity = [0.0, 0.0, {:.17g}]", spin))));
  double area = 0.0;
  double momentum = 0.0;
  double energy = 0.0;
  const auto kinetic = [&] { // over the inertia
    const RigidDof &v = velocity_of(simulation, 0);
    const BlockProperties &p = simulation.blocks().properties[0];
    return 0.5 * (p.mass / p.inertia * dot(v.u, v.u) + v.r * v.r);
  };
  while (!simulation.finished()) {
    step(simulation);
    area = std::max(area, std::abs(signed_area(current_vertices(simulation.blocks(), 0)) / 2.0 - 1.0));
    momentum = std::max(momentum, std::abs(velocity_of(simulation, 0).r / spin - 1.0));
    energy = std::max(energy, std::abs(2.0 * kinetic() / (spin * spin) - 1.0));
  }
  expect_below("A4 1000 turns: relative change of the area of the vertices", 1e-12, area);
  expect_below("A4 1000 turns: relative change of angular momentum", 1e-12, momentum);
  expect_below("A4 1000 turns: relative change of kinetic energy", 1e-12, energy);
  expect_value("A4 1000 turns: angle", spin * turns, displacement_of(simulation, 0).r, 1e-11);
}

/// A ring of blocks of all shapes that fly at each other, spinning.
std::string implosion(double duration) {
  std::string toml =
      head({.duration = duration, .gravity = {}, .normal_stiffness = 1e8, .friction_deg = 30.0});
  for (int k = 0; k < 25; ++k) {
    const Vec2 centre{1.3 * (k % 5) - 2.6 + 0.03 * (k % 3), 1.3 * (k / 5) - 2.6 - 0.02 * (k % 4)};
    const double spin = 0.4 * ((k * 7) % 11) - 2.0;
    toml += block_toml(
        fmt::format("stone{}", k), random_polygon(static_cast<unsigned>(k + 1), 3 + k % 6, 0.55, centre),
        fmt::format("velocity = [{:.17g}, {:.17g}, {:.17g}]", -0.8 * centre.x - 0.3 * centre.y + 0.5,
                    -0.8 * centre.y + 0.3 * centre.x, spin));
  }
  return toml;
}

struct Momentum {
  Vec2 linear;
  double linear_scale = 0.0; ///< sum of m |v|
  double angular = 0.0;      ///< L* of the last two trial configurations
  double angular_scale = 0.0;
};

Momentum momentum(const Simulation &simulation) {
  Momentum sum;
  const BlockSystem &blocks = simulation.blocks();
  for (std::size_t row = 0; row < blocks.num_owned; ++row) {
    const BlockProperties &p = blocks.properties[row];
    sum.linear += p.mass * blocks.velocity[row].u;
    sum.linear_scale += p.mass * norm(blocks.velocity[row].u);
    const RigidDof increment = blocks.motion[row].increment();
    const RigidDof rate = (1.0 / simulation.plan().time_step) * increment;
    const Vec2 arm = p.centroid + (blocks.trial[row] - increment).u;
    sum.angular += p.mass * cross(arm, rate.u) + p.inertia * rate.r;
    sum.angular_scale += p.mass * norm(arm) * norm(rate.u) + p.inertia * std::abs(rate.r);
  }
  return sum;
}

// Round-off only: forces on a pair are opposite and act at the same points. The difference of two trial
// configurations carries an ulp of x over a step, hence the larger tolerance of L*.
TEST(Conservation, FrictionalCollisionOfManyBlocks) {
  Simulation simulation(Communicator::self(), scene_of(implosion(1.5)));
  step(simulation);
  const Momentum before = momentum(simulation); // its L* is not meant: x*_0 has no partner
  step(simulation);
  step(simulation);
  const Momentum start = momentum(simulation); // the pair (x*_1, x*_2)
  double linear = 0.0;
  double angular = 0.0;
  while (!simulation.finished()) {
    step(simulation);
    const Momentum now = momentum(simulation);
    linear = std::max(linear, norm(now.linear - before.linear) / before.linear_scale);
    angular = std::max(angular, std::abs(now.angular - start.angular) / start.angular_scale);
  }
  ASSERT_FALSE(simulation.fault().has_value());
  ASSERT_GT(simulation.counters().contact_steps, 2 * simulation.step_count()); // it was a collision of many
  const std::string run = fmt::format("A5 25 blocks, {} steps, {} contact steps: ", simulation.step_count(),
                                      simulation.counters().contact_steps);
  expect_below(run + "change of linear momentum", 1e-13, linear);
  expect_below(run + "change of L*", 5e-13, angular);
}

} // namespace
} // namespace gcpdda::testing::conservation_test
