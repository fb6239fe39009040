// B10: a block that slides down a wedge which itself slides on a smooth floor.
//
// The wedge (mass M, slope al, falling to the right) goes to the left with A, the block (m) down the slope
// with a against the wedge. N between the two, friction mu N. Newton's law of the wedge along the floor, and
// of the block across and along the slope (classical, e.g. Landau and Lifshitz, Mechanics, for mu = 0):
//     M A = N (sin(al) - mu cos(al)),  N = m (g cos(al) - A sin(al)),  m (a - A cos(al)) = m g sin(al) - mu N
//     A = m g cos(al) (sin(al) - mu cos(al))/(M + m sin(al) (sin(al) - mu cos(al)))
// Nothing pushes the two sideways: M A = m (a cos(al) - A), to rounding.
//
// The wedge's weight acts at a third of its base and tilts it by 2 M g/(k_n base^2), up to 1.5e-5: al is the
// slope that this leaves. Truncation: rigid, the load that goes from one side of the wedge to the other turns
// it meanwhile, by less than that; deformable, its weight strains the wedge, and so its slope, by 4e4 Pa/E.

#include "problem.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace gcpdda::testing::movable_wedge_test {
namespace {

constexpr double drawn_slope = 30.0 * degree;
constexpr double wedge_base = 6.0; ///< m
constexpr double block_size = 0.8; ///< m, along the slope; its height is half of it
constexpr double from = 0.4;       ///< s: dashpots have taken what the start shakes
constexpr double until = 0.8;      ///< s
const double wedge_height = wedge_base * std::tan(drawn_slope);
const double wedge_mass = rock_density * 0.5 * wedge_base * wedge_height;

struct Pair {
  double mu = 0.0;
  double thickness = 0.4;        ///< of the block, m
  double normal_stiffness = 1e9; ///< Pa/m
  double youngs_modulus = 0.0;   ///< 0: rigid

  [[nodiscard]] double mass() const { return rock_density * block_size * thickness; }
  [[nodiscard]] double wedge_acceleration(double slope) const {
    const double s = std::sin(slope);
    const double pull = s - mu * std::cos(slope);
    return mass() * earth_gravity * std::cos(slope) * pull / (wedge_mass + mass() * s * pull);
  }
  [[nodiscard]] double block_acceleration(double slope) const { ///< a
    const double big_a = wedge_acceleration(slope);
    return earth_gravity * std::sin(slope) + big_a * std::cos(slope) -
           mu * (earth_gravity * std::cos(slope) - big_a * std::sin(slope));
  }

  [[nodiscard]] std::string toml() const {
    std::string toml = head({.duration = until,
                             .normal_stiffness = normal_stiffness,
                             .friction_deg = std::atan(mu) / degree,
                             .damping = 0.3,
                             .fidelity = youngs_modulus > 0.0 ? "deformable" : "rigid",
                             .youngs_modulus = youngs_modulus,
                             .poissons_ratio = 0.25});
    toml += fmt::format("[material.floor]\ndensity = {}\n[joint.smooth]\nmaterials = [\"rock\", \"floor\"]\n"
                        "friction_angle_deg = 0.0\n",
                        rock_density);
    const double sunk = (wedge_mass + mass()) * earth_gravity / (normal_stiffness * wedge_base);
    const double depth = mass() * earth_gravity * std::cos(drawn_slope) / (normal_stiffness * block_size);
    toml += block_toml("wedge", {{0.0, -sunk}, {wedge_base, -sunk}, {0.0, wedge_height - sunk}});
    // Its upper corner lies a fifth of the slope from the top.
    toml += block_toml(
        "block",
        placed(
            {{0.0, -depth}, {block_size, -depth}, {block_size, thickness - depth}, {0.0, thickness - depth}},
            -drawn_slope, {0.2 * wedge_base, 0.8 * wedge_height - sunk}));
    std::string floor = block_toml("floor", rectangle({-20.0, -3.0}, {20.0, 0.0}), "fixed = true");
    return toml + floor.replace(floor.find("\"rock\""), 6, "\"floor\"");
  }
};

/// @return what the momenta along the floor leave, over that of the block
double check_accelerations(const Pair &pair, double tolerance) {
  Simulation simulation(Communicator::self(), scene_of(pair.toml()));
  run_until(simulation, from);
  const double since = simulation.time();
  const Vec2 wedge = velocity_of(simulation, 0).u;
  const Vec2 block = velocity_of(simulation, 1).u;
  run(simulation);
  const double during = simulation.time() - since;
  const Vec2 of_wedge = (1.0 / during) * (velocity_of(simulation, 0).u - wedge);
  const Vec2 of_block = (1.0 / during) * (velocity_of(simulation, 1).u - block);
  const double slope = drawn_slope - displacement_of(simulation, 0).r;
  const std::string name = fmt::format(
      "B10 block on a wedge, mu = {}, m/M = {:.3g}, k_n = {:g} Pa/m, {}: ", pair.mu, pair.mass() / wedge_mass,
      pair.normal_stiffness,
      pair.youngs_modulus > 0.0 ? fmt::format("deformable, E = {:g} Pa", pair.youngs_modulus) : "rigid");
  expect_value(name + "acceleration of the wedge, m/s2", pair.wedge_acceleration(slope), -of_wedge.x,
               tolerance);
  const double along = dot(of_block - of_wedge, {std::cos(slope), -std::sin(slope)});
  expect_value(name + "of the block against it, m/s2", pair.block_acceleration(slope), along, tolerance);
  const double of_block_alone = pair.mass() * velocity_of(simulation, 1).u.x;
  return std::abs(wedge_mass * velocity_of(simulation, 0).u.x / of_block_alone + 1.0);
}

TEST(MovableWedge, BothAccelerateAsMomentumHasIt) {
  double unbalanced = 0.0;
  for (const double mu : {0.0, 0.3}) {
    for (const double stiff : {0.0, 1.0, 30.0}) { // E/k_n, m; 0: rigid
      for (const Pair &drawn : {Pair{mu, 0.4, 1e9}, Pair{mu, 1.2, 1e9}, Pair{mu, 1.2, 1e10}}) {
        Pair pair = drawn;
        pair.youngs_modulus = stiff * pair.normal_stiffness;
        const double overlaps = 5e-6 * (1e9 / pair.normal_stiffness);
        const double strain = stiff > 0.0 ? 1e5 / pair.youngs_modulus : 0.0;
        unbalanced = std::max(unbalanced, check_accelerations(pair, overlaps + strain));
      }
    }
  }
  expect_below("B10 blocks on a wedge: sum of the momenta over that of the block", 1e-12, unbalanced);
}

} // namespace
} // namespace gcpdda::testing::movable_wedge_test
