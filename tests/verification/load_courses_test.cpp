// Loads and stress that change with time, through the whole Simulation: their motion, their energy, and what
// they leave behind where they come slowly and where they come at once.

#include "problem.hpp"

#include "simulation/energy_ledger.hpp"
#include "support/contact_regions.hpp"
#include "support/regions.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace gcpdda::testing::load_courses_test {
namespace {

std::string load_toml(Vec2 point, Vec2 force, const std::string &course) {
  return fmt::format("[[block.load]]\npoint = [{:.17g}, {:.17g}]\nforce = [{:.17g}, {:.17g}]\n{}\n", point.x,
                     point.y, force.x, force.y, course);
}

Setting free_setting(const std::string &fidelity, double duration, double time_step) {
  return {.duration = duration,
          .time_step = time_step,
          .gravity = {},
          .fidelity = fidelity,
          .youngs_modulus = 1e9,
          .poissons_ratio = 0.25};
}

constexpr Vec2 force{3e4, -7e4};
constexpr double side = 2.0;
constexpr double mass = side * side * rock_density;

Simulation pushed_square(const Setting &setting, const std::string &course) {
  return Simulation(Communicator::self(),
                    scene_of(head(setting) + block_toml("square", rectangle({1.0, 1.0}, {3.0, 3.0}),
                                                        load_toml({2.0, 2.0}, force, course))));
}

// m x'' = f s(t/T), s = 3 z^2 - 2 z^3: at T x = (1/4 - 1/10) f T^2/m and v = f T/(2 m). A load taken at the
// wrong time of a step would be off by dt/T; so the error is one of dt^2. Where nothing but the load acts,
// the leapfrog's kinetic energy is the work by the trapezoid to round-off.
TEST(LoadCourse, ARampMovesAFreeBlockAsItsIntegralSays) {
  for (const std::string fidelity : {"rigid", "deformable"}) {
    std::vector<double> way_errors;
    for (const double dt : {2e-2, 1e-2}) {
      Simulation simulation = pushed_square(free_setting(fidelity, 1.0, dt), "ramp = 1.0");
      const EnergyLedger ledger(simulation.state());
      double residual = 0.0;
      while (!simulation.finished()) {
        step(simulation);
        residual = std::max(residual, std::abs(ledger.row(simulation.state()).residual));
      }
      const Vec2 way = (0.15 / mass) * force;
      const Vec2 speed = (0.5 / mass) * force;
      const std::string what = fmt::format("ramp on a free block, {}, dt = {}: ", fidelity, dt);
      way_errors.push_back(norm(displacement_of(simulation, 0).u - way) / norm(way));
      expect_below(what + "error of the way", 2.0 * dt * dt, way_errors.back());
      expect_below(what + "error of the speed", 2.0 * dt * dt,
                   norm(velocity_of(simulation, 0).u - speed) / norm(speed));
      expect_below(what + "largest residual over the kinetic energy", 1e-12,
                   residual / (0.5 * mass * dot(speed, speed)));
    }
    expect_value("ramp on a free block, " + fidelity + ": error of the way of dt over that of dt/2", 4.0,
                 way_errors[0] / way_errors[1], 0.1);
  }
}

// m x'' = f sin(w t): x = f/(m w) (t - sin(w t)/w). A table with rows h apart is a sine smaller by
// (w h)^2/12 = 2.1e-5 in the mean, and the leapfrog is off by (w dt)^2/12 = 1.3e-5 of its motion.
TEST(LoadCourse, AHarmonicTableMovesAFreeBlockAsItsIntegralSays) {
  constexpr double w = 2.0 * std::numbers::pi;
  constexpr double h = 1.0 / 400.0;
  constexpr double dt = 1.0 / 500.0;
  std::string table;
  for (int k = 0; k <= 800; ++k) {
    table += fmt::format("{}[{:.17g}, {:.17g}]", k > 0 ? ", " : "", h * k, std::sin(w * h * k));
  }
  for (const std::string fidelity : {"rigid", "deformable"}) {
    Simulation simulation = pushed_square(free_setting(fidelity, 2.0, dt), "table = [" + table + "]");
    EnergyLedger ledger(simulation.state());
    double error = 0.0;
    double residual = 0.0;
    double most = 0.0;
    while (!simulation.finished()) {
      step(simulation);
      const double t = simulation.time();
      const Vec2 expected = ((t - std::sin(w * t) / w) / (mass * w)) * force;
      error = std::max(error, norm(displacement_of(simulation, 0).u - expected));
      const EnergyRow row = ledger.row(simulation.state());
      residual = std::max(residual, std::abs(row.residual));
      most = std::max(most, row.boundary_work);
    }
    const double end = 2.0 / (mass * w) * norm(force);
    const std::string what = "harmonic load on a free block, " + fidelity + ": ";
    expect_below(what + "error over the way at the end", 5e-5, error / end);
    expect_below(what + "residual over the largest work", 1e-11, residual / most);
  }
}

/// A block 2 m wide and 1 m high, pushed along its base by 0.85 of what makes it slip, then left alone: where
/// it stands in the end, and what friction took, by the stretch of its spring under the load.
struct Pushed {
  double farthest = 0.0;
  double left = 0.0;
  double friction_loss = 0.0;
};
Pushed push(const std::string &fidelity, const std::string &course) {
  const Setting setting{.duration = 2.0,
                        .friction_deg = 30.0,
                        // Friction lets a deformable block swing up by itself with less.
                        .damping = fidelity == "deformable" ? 0.3 : 0.05,
                        .fidelity = fidelity,
                        .youngs_modulus = 20e9,
                        .poissons_ratio = 0.25};
  const double weight = 2.0 * rock_density * earth_gravity;
  const double push = 0.85 * weight * std::tan(30.0 * degree);
  Simulation simulation(Communicator::self(),
                        scene_of(head(setting) +
                                 block_toml("floor", rectangle({-9.0, -2.0}, {9.0, 0.0}), "fixed = true") +
                                 block_toml("block", rectangle({-1.0, 0.0}, {1.0, 1.0}),
                                            load_toml({1.0, 0.0}, {push, 0.0}, course))));
  const EnergyLedger ledger(simulation.state());
  const double stretch = push / (0.5 * 1e9 * 2.0); // k_t = 0.5 k_n a metre
  Pushed pushed;
  while (!simulation.finished()) {
    step(simulation);
    pushed.farthest = std::max(pushed.farthest, displacement_of(simulation, 1).u.x / stretch);
  }
  pushed.left = displacement_of(simulation, 1).u.x / stretch;
  pushed.friction_loss = ledger.row(simulation.state()).friction_loss / (0.5 * push * stretch);
  return pushed;
}

// At once the spring would swing to 1.85 of the load (1.37 with a dashpot of 0.3), beyond 1/0.85 of it: it
// slips, for good. Over half a second, 30 of its periods, it does not: the way is the stretch and the tilt
// under a load that acts at the base, and back.
TEST(LoadCourse, ASuddenLoadMakesAJointSlipForGoodAndARampDoesNot) {
  for (const std::string fidelity : {"rigid", "deformable"}) {
    const std::string what = "block pushed by 0.85 of its friction, " + fidelity + ", ";
    const Pushed slow = push(fidelity, "table = [[0, 0], [0.1, 0], [0.6, 1], [1.0, 1], [1.5, 0]]");
    expect_value(what + "slowly: farthest way over the stretch", 1.0, slow.farthest, 0.02);
    expect_below(what + "slowly: way left over the stretch", 1e-3, std::abs(slow.left));
    expect_below(what + "slowly: friction loss over the stretch's energy", 1e-5, slow.friction_loss);
    const Pushed sudden = push(fidelity, "table = [[0, 0], [0.1, 0], [0.1001, 1], [1.0, 1], [1.5, 0]]");
    expect_above(what + "at once: way left over the stretch", 0.05, sudden.left);
    expect_above(what + "at once: friction loss over the stretch's energy", 0.05, sudden.friction_loss);
  }
}

// A load that has not come yet is waited for; one that a stage has taken away, or whose block has gone, is
// not.
TEST(LoadCourse, NoVerdictFallsBeforeTheLoadHasCome) {
  const std::string late = load_toml({0.5, 0.5}, {0.0, -1e3}, "table = [[0, 0], [1.0, 0], [1.1, 1]]");
  const auto settled_after = [&](const std::string &change, const std::string &solver) {
    const std::string settle =
        fmt::format("[[stage]]\nkind = \"settle\"\nlimit = 5.0\nsolver = \"{}\"\n", solver);
    Simulation simulation(Communicator::self(),
                          scene_of(without_duration(head({.friction_deg = 30.0, .interval = 0.1})) +
                                   block_toml("floor", rectangle({-9.0, -2.0}, {9.0, 0.0}), "fixed = true") +
                                   block_toml("stone", rectangle({0.0, 0.0}, {1.0, 1.0}), late) +
                                   block_toml("other", rectangle({3.0, 0.0}, {4.0, 1.0})) + change + settle));
    run_stages(simulation, step);
    EXPECT_EQ(simulation.stage_results().back().verdict, Verdict::settled);
    return simulation.time();
  };
  const std::string run = "[[stage]]\nkind = \"run\"\nduration = 0.1\n";
  const std::string unload = "[[stage]]\nkind = \"change\"\nset = { \"block.stone.load\" = [] }\n";
  const std::string excavate = "[[stage]]\nkind = \"excavate\"\nblocks = [\"stone\"]\n";
  for (const char *solver : {"dynamic", "static"}) {
    EXPECT_GE(settled_after("", solver), 1.1) << solver;
    EXPECT_LT(settled_after(run + unload, solver), 1.0) << solver;
    EXPECT_LT(settled_after(run + excavate, solver), 1.0) << solver;
  }
}

/// What acts on block 0 in the load's evaluation of the step just taken.
void expect_load(const Simulation &simulation, Vec2 expected, Vec2 scale) {
  const Vec2 got = applied_forces(simulation.blocks(), 0).load.u;
  EXPECT_LE(norm(got - expected), 1e-14 * norm(scale)) << "at " << simulation.time();
}

// Loads that a stage replaces within 1 s, and that a second one replaces before it is over; a load with a
// table of its own comes in by it times the rise. Round-off.
TEST(LoadCourse, AStageReplacesLoadsWithinItsRamp) {
  const Vec2 f0{1e4, 0.0};
  const Vec2 f1{0.0, 3e4};
  const Vec2 f2{-2e4, 1e4};
  const auto listed = [](Vec2 f, const std::string &course) {
    return fmt::format("set = {{ \"block.square.load\" = [ {{ point = [2, 2], force = [{}, {}]{} }} ] }}\n",
                       f.x, f.y, course);
  };
  const std::string run = "[[stage]]\nkind = \"run\"\nduration = 0.5\n";
  Simulation simulation(
      Communicator::self(),
      scene_of(without_duration(head(free_setting("rigid", 0.5, 0.01))) +
               block_toml("square", rectangle({1.0, 1.0}, {3.0, 3.0}), load_toml({2.0, 2.0}, f0, "")) + run +
               "[[stage]]\nkind = \"change\"\nramp = 1.0\n" + listed(f1, ", table = [[0, 1], [1, 2]]") + run +
               "[[stage]]\nkind = \"run\"\nduration = 1.0\nramp = 0.8\n" + listed(f2, "")));
  const auto rise = [](double z) { return z <= 0.0 ? 0.0 : z >= 1.0 ? 1.0 : z * z * (3.0 - 2.0 * z); };
  std::int64_t looked_at = 0;
  while (!simulation.finished()) {
    if (simulation.stage_is_over()) {
      simulation.end_stage();
      simulation.begin_next_stage();
      continue;
    }
    const double t = simulation.time() + simulation.scheme().load_time * simulation.plan().time_step;
    simulation.step();
    const double s1 = rise(t - 0.5);
    const double s2 = rise((t - 1.0) / 0.8);
    const double table = 1.0 + std::clamp(t - 0.5, 0.0, 1.0);
    expect_load(simulation, (1.0 - s2) * ((1.0 - s1) * f0 + (s1 * table) * f1) + s2 * f2, f1);
    ++looked_at;
  }
  EXPECT_GE(looked_at, 199);
}

} // namespace
} // namespace gcpdda::testing::load_courses_test
