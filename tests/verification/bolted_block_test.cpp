// Bolts: a hung block, blocks on a slope held by cables and dowels, and the cable at the toe of Goodman and
// Bray's slope.

#include "problem.hpp"

#include "simulation/energy_ledger.hpp"
#include "simulation/results.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace gcpdda::testing::bolted_block_test {
namespace {

constexpr double weight = rock_density * earth_gravity; ///< of a unit square, N/m

std::string support_toml(const std::string &keys) {
  return "[support.steel]\n" + keys;
}

std::string bolt_toml(Vec2 from, Vec2 to) {
  return fmt::format("[[bolt]]\nsupport = \"steel\"\nfrom = [{:.17g}, {:.17g}]\nto = [{:.17g}, {:.17g}]\n",
                     from.x, from.y, to.x, to.y);
}

/// A unit square that hangs from a beam by a cable from its centre, and falls into it.
std::string hung_toml(double duration, double stiffness, const std::string &strength,
                      const std::string &fidelity = "rigid") {
  return head({.duration = duration, .fidelity = fidelity, .youngs_modulus = 1e9, .poissons_ratio = 0.25}) +
         block_toml("beam", rectangle({-2.0, 5.0}, {2.0, 6.0}), "fixed = true") +
         block_toml("square", rectangle({-0.5, 0.0}, {0.5, 1.0})) +
         support_toml(
             fmt::format("kind = \"anchored\"\naxial_stiffness = {:.17g}\n{}", stiffness, strength)) +
         bolt_toml({0.0, 0.5}, {0.0, 5.5});
}

// The cable is put in without tension, so the block oscillates about W/k with that amplitude.
TEST(BoltedBlock, HangsOnASpring) {
  const double stiffness = 1e7;
  Simulation simulation(Communicator::self(), scene_of(hung_toml(0.5, stiffness, "")));
  EnergyLedger ledger(simulation.state());
  const double omega = std::sqrt(stiffness / rock_density);
  double deepest = 0.0;
  double worst_residual = 0.0;
  double half_turns = 0.0;
  double last_turn = 0.0;
  double before = 0.0;
  while (!simulation.finished()) {
    step(simulation);
    const double speed = velocity_of(simulation, 1).u.y;
    if (before < 0.0 && speed >= 0.0) {
      last_turn = simulation.time() - simulation.plan().time_step * speed / (speed - before);
      half_turns += half_turns == 0.0 ? 1.0 : 2.0;
    }
    before = speed;
    deepest = std::min(deepest, displacement_of(simulation, 1).u.y);
    if (simulation.step_count() % 20 == 0) {
      const EnergyRow row = ledger.row(simulation.state());
      worst_residual = std::max(worst_residual, std::abs(row.residual));
      EXPECT_EQ(row.support_loss, 0.0);
    }
  }
  const double step_length = omega * simulation.plan().time_step;
  // The leapfrog's frequency is too high by (omega dt)^2/24.
  expect_value("bolts: hung square, half a period, s", std::numbers::pi / omega, last_turn / half_turns,
               step_length * step_length);
  expect_value("bolts: hung square, deepest point, m", -2.0 * weight / stiffness, deepest,
               step_length * step_length);
  // Energies of the trials are off by (omega dt)^2 of what swings, W^2/(2 k).
  expect_below("bolts: hung square, largest energy residual over the energy that swings",
               step_length * step_length, worst_residual / (0.5 * weight * weight / stiffness));
  expect_above("bolts: hung square, frequency the step allows for, over its own", 1.0,
               simulation.bound().omega_max / omega);
  // Seen at every step, and the top of a cosine is flat.
  EXPECT_NEAR(collect_bolts(simulation)[0].largest_axial / (2.0 * weight), 1.0, step_length * step_length);
}

// A capacity of 1.5 W stops the fall after x = T^2/(2 k (T - W)) = 2.25 W/k, of which 0.75 W/k is plastic.
TEST(BoltedBlock, FallsIntoAYieldingCable) {
  const double stiffness = 1e7;
  const double unit = weight / stiffness; // m
  for (const char *fidelity : {"rigid", "deformable"}) {
    Simulation simulation(
        Communicator::self(),
        scene_of(hung_toml(0.2, stiffness, fmt::format("axial_yield = {:.17g}\n", 1.5 * weight), fidelity)));
    EnergyLedger ledger(simulation.state());
    double deepest = 0.0;
    while (!simulation.finished()) {
      step(simulation);
      deepest = std::min(deepest, displacement_of(simulation, 1).u.y);
    }
    const EnergyRow row = ledger.row(simulation.state());
    // W/E = 2.6e-5 m of 5e-3 m is the block's own.
    expect_value(fmt::format("bolts: {} square in a yielding cable, deepest point, m", fidelity),
                 -2.25 * unit, deepest, 0.01);
    expect_value(fmt::format("bolts: {} square in a yielding cable, energy lost in it, J/m", fidelity),
                 1.125 * weight * unit, row.support_loss, 0.01);
    expect_below(
        fmt::format("bolts: {} square in a yielding cable, energy residual over what is lost", fidelity),
        1e-3, std::abs(row.residual) / row.support_loss);
    EXPECT_TRUE(simulation.bolts().links()[0].memory.yielded);
  }
}

// The beam goes within T: the square feels less and less of the cable, m a = -W t/T, and the stress that the
// cable, which holds it below its centroid, puts into it fades as the force does. Stress waves need 3 ms for
// the block.
TEST(BoltedBlock, IsLetGoAsGraduallyAsItsAnchorIsExcavated) {
  constexpr double relax = 0.2;
  constexpr double lasts = 0.1;
  for (const std::string fidelity : {"rigid", "deformable"}) {
    const std::string toml =
        without_duration(head({.fidelity = fidelity, .youngs_modulus = 1e9, .poissons_ratio = 0.25})) +
        block_toml("beam", rectangle({-2.0, 5.0}, {2.0, 6.0}), "fixed = true") +
        block_toml("square", rectangle({-0.5, 0.0}, {0.5, 1.0})) +
        support_toml(
            fmt::format("kind = \"anchored\"\naxial_stiffness = 1e5\npretension = {:.17g}\n", weight)) +
        bolt_toml({0.0, 0.2}, {0.0, 5.5}) +
        fmt::format("[[stage]]\nkind = \"run\"\nduration = 0.2\nlocal_damping = 0.8\n[[stage]]\nkind = "
                    "\"excavate\"\nblocks = "
                    "[\"beam\"]\nrelax = {}\n[[stage]]\nkind = \"run\"\nduration = {}\n",
                    relax, lasts);
    Simulation simulation(Communicator::self(), scene_of(toml));
    while (!simulation.stage_is_over()) {
      step(simulation);
    }
    simulation.end_stage();
    const double height = displacement_of(simulation, 1).u.y;
    const auto stress = [&] { return simulation.blocks().deformation.back().internal.yy; };
    const double held = fidelity == "rigid" ? 0.0 : stress();
    run_stages(simulation, step);
    EXPECT_TRUE(simulation.bolts().empty());
    const std::string what = fmt::format("bolts: {} square, anchor excavated, ", fidelity);
    // The cable is soft: what the square still swings when it is let go changes its pull by less than 1e-3.
    expect_value(what + "velocity, m/s", -earth_gravity * lasts * lasts / (2.0 * relax),
                 velocity_of(simulation, 1).u.y, 1e-3);
    expect_value(what + "way, m", -earth_gravity * std::pow(lasts, 3) / (6.0 * relax),
                 displacement_of(simulation, 1).u.y - height, 1e-3);
    if (fidelity == "deformable") {
      expect_value(what + "stress over that before", 1.0 - lasts / relax, stress() / held, 0.02);
    }
  }
}

constexpr double slope = 40.0 * degree;
constexpr double friction = 30.0 * degree;
/// What friction lacks to hold a unit square on that slope, N/m.
const double missing = weight * (std::sin(slope) - std::cos(slope) * std::tan(friction));

std::vector<Vec2> on_slope(const std::vector<Vec2> &points) {
  return placed(points, slope, {0.0, 0.0});
}

/// The square on the slope, a wall 3 m uphill, and a bolt.
/// @param from, to  along the slope and outwards, from the middle of the square's base
std::string slope_toml(const std::string &support, Vec2 from, Vec2 to) {
  const std::vector<Vec2> ends = on_slope({from, to});
  return head({.duration = 1.0, .friction_deg = friction / degree}) +
         block_toml("ground", on_slope(rectangle({-5.0, -5.0}, {8.0, 0.0})), "fixed = true") +
         block_toml("wall", on_slope(rectangle({3.5, 0.0}, {8.0, 3.0})), "fixed = true") +
         block_toml("square", on_slope(rectangle({-0.5, 0.0}, {0.5, 1.0}))) + support_toml(support) +
         bolt_toml(ends[0], ends[1]);
}

/// A cable through the centre of the square, `lift` above the uphill direction, whose tension is constant:
/// it yields at its pre-tension.
struct Cable {
  double lift = 0.0; ///< rad; negative: into the slope

  [[nodiscard]] double needed() const {
    return missing / (std::cos(lift) - std::sin(lift) * std::tan(friction));
  }
  [[nodiscard]] std::string toml(double tension) const {
    const Vec2 line{std::cos(lift), std::sin(lift)};
    const Vec2 centre{0.0, 0.5};
    const double to_face = 0.499 / std::max(std::abs(line.x), std::abs(line.y));
    return slope_toml(fmt::format("kind = \"anchored\"\naxial_stiffness = 1e5\naxial_yield = {0:.17g}\n"
                                  "pretension = {0:.17g}\n",
                                  tension),
                      centre - to_face * line, centre + 4.0 * line);
  }
};

Vec2 downhill() {
  return {-std::cos(slope), -std::sin(slope)};
}

// Limit equilibrium: T (cos(lift) - sin(lift) tan(phi)) = W (sin(slope) - cos(slope) tan(phi)). At right
// angles to the plane, along it, and at phi to it, where the least force is needed.
TEST(BoltedBlock, OnASlopeNeedsTheForceOfLimitEquilibrium) {
  for (const double lift : {-90.0 * degree, 0.0, -30.0 * degree}) {
    const Cable cable{lift};
    const std::string what = fmt::format("bolts: cable at {:g} degrees to the slope", lift / degree);
    for (const double share : {0.5, 0.98, 1.02}) {
      // A strength that is just enough stops no motion: let none begin.
      const bool is_static = share != 0.5;
      Simulation simulation(Communicator::self(),
                            scene_of(cable.toml(share * cable.needed()),
                                     {fmt::format("run.local_damping={}", is_static ? 0.8 : 0.0)}));
      ASSERT_EQ(simulation.bolts().links().size(), 1U);
      run_until(simulation, 0.2);
      const double early = dot(velocity_of(simulation, 2).u, downhill());
      run_until(simulation, 0.4);
      const double late = dot(velocity_of(simulation, 2).u, downhill());
      if (!is_static) {
        // A cable at right angles has turned by 0.08 m in 4.5 m when the block has slid so far.
        expect_value(what + ", half the force needed, acceleration, m/s2", 0.5 * missing / rock_density,
                     (late - early) / 0.2, 0.04);
        continue;
      }
      run_until(simulation, 0.5);
      const double before = dot(displacement_of(simulation, 2).u, downhill());
      run_until(simulation, 1.0);
      const double slid = dot(displacement_of(simulation, 2).u, downhill()) - before;
      share < 1.0 ? expect_above(what + ", 2 % too weak, slides within half a second, m", 1e-4, slid)
                  : expect_below(what + ", 2 % too strong, slides within half a second, m", 1e-9, slid);
    }
  }
}

// A dowel across the joint, soft along its axis so that it has no tension, bears what friction lacks by its
// shear; one 2 % too weak lets the block go.
TEST(BoltedBlock, IsHeldByADowel) {
  for (const double share : {0.98, 1.02, 5.0}) {
    const std::string toml =
        slope_toml(fmt::format("kind = \"grouted\"\naxial_stiffness = 1e3\nshear_stiffness = 1e7\n"
                               "active_length = 0.2\nshear_yield = {:.17g}\n",
                               share * missing),
                   {0.0, 0.9}, {0.0, -2.0});
    Simulation simulation(Communicator::self(), scene_of(toml, {"run.local_damping=0.8"}));
    run(simulation);
    const double speed = norm(velocity_of(simulation, 2).u);
    const LinkMemory &memory = simulation.bolts().links().at(0).memory;
    if (share < 1.0) {
      expect_above("bolts: dowel 2 % too weak, speed, m/s", 1e-3, speed);
    } else {
      expect_below(fmt::format("bolts: dowel of {:g} times the force needed, speed, m/s", share), 1e-4,
                   speed);
      // Friction helps as far as the block came to rest on its cap.
      expect_above(fmt::format("bolts: dowel of {:g} times the force needed, its shear over that", share),
                   1.0, std::abs(memory.shear) / missing);
    }
  }
}

/// A unit square below a fixed beam of 0.5 m and more fixed rock, held by a bar with a plate that reaches 2.5
/// m above it and is grouted with `bond`, N/m. The rock above the beam is excavated.
std::string cut_bar_toml(double bond) {
  return head({.fidelity = "rigid", .youngs_modulus = 1e9, .poissons_ratio = 0.25}) +
         block_toml("beam", rectangle({-2.0, 1.0}, {2.0, 1.5}), "fixed = true") +
         block_toml("above", rectangle({-2.0, 1.5}, {2.0, 5.0}), "fixed = true") +
         block_toml("square", rectangle({-0.5, 0.0}, {0.5, 1.0})) +
         support_toml(fmt::format("kind = \"grouted\"\naxial_stiffness = 1e9\nactive_length = 0.4\n"
                                  "plate = true\nbond_strength = {:.17g}\n",
                                  bond)) +
         bolt_toml({0.0, 0.2}, {0.0, 3.5}) +
         "[[stage]]\nkind = \"settle\"\nlimit = 10.0\n[[stage]]\nkind = \"excavate\"\n"
         "blocks = [\"above\"]\n[[stage]]\nkind = \"run\"\nduration = 0.2\n";
}

// The l = 0.5 m of grout that are left bear half the weight, W = 2 b l, and less as the bar is drawn out by
// x: m x'' = W - b (l - x), so x = l (cosh(w t) - 1) with w^2 = b/m = g/(2 l).
TEST(BoltedBlock, DrawsItsBarOutOfTheRockThatAnExcavationLeaves) {
  Simulation simulation(Communicator::self(), scene_of(without_duration(cut_bar_toml(weight))));
  run_stages(simulation);
  ASSERT_EQ(simulation.bolts().links().size(), 1U);
  EXPECT_NEAR(simulation.bolts().links()[0].grout[1], 0.5, 1e-12);
  const double omega = std::sqrt(earth_gravity / (2.0 * 0.5));
  const double drawn = 0.5 * (std::cosh(omega * 0.2) - 1.0);
  // The bar had been stretched by W/k = 2.6e-5 m, and comes to a slip within a step of 1e-4 s.
  EXPECT_NEAR(-displacement_of(simulation, 2).u.y, drawn, 1e-3 * drawn + 2.0 * weight / 1e9);
  EXPECT_NEAR(simulation.bolts().links()[0].memory.axial, weight * (0.5 - drawn), 2e-3 * weight);
}

// 2 % more than the weight holds, on what is left of the grout; 2 % less does not.
TEST(BoltedBlock, NeedsTheGroutOfTheRockThatIsLeft) {
  for (const double share : {0.98, 1.02}) {
    Simulation simulation(Communicator::self(),
                          scene_of(without_duration(cut_bar_toml(share * weight / 0.5))));
    run_stages(simulation);
    const double fallen = -displacement_of(simulation, 2).u.y;
    if (share < 1.0) {
      EXPECT_GT(fallen, 1e-3);
    } else {
      EXPECT_LT(fallen, 1e-4);
    }
  }
}

} // namespace
} // namespace gcpdda::testing::bolted_block_test
