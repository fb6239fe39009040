// Deep overlaps, fast blocks, spinning blocks.

#include "failure_search.hpp"

#include "simulation/energy_ledger.hpp"
#include "support/setting.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace gcpdda::study {

namespace {

using testing::advance;
using testing::block_toml;
using testing::displacement_of;
using testing::earth_gravity;
using testing::head;
using testing::rectangle;
using testing::rock_density;
using testing::velocity_of;

void deep_overlap(const Options &options, Boundaries &boundaries) {
  const double k = stiffness(1.0, 1.0);
  const auto trial = [&](double share) {
    const std::string load =
        fmt::format("[[block.load]]\npoint = [0.5, 0.5]\nforce = [0.0, {:.17g}]", -share * k);
    return try_scene(head({.duration = 0.5, .gravity = {}, .normal_stiffness = k, .damping = 0.0}) +
                         ground() + block_toml("b", rectangle({0.0, 0.0}, {1.0, 1.0}), load),
                     [&](Simulation &simulation) {
                       advance(simulation, 0.5);
                       return Outcome{Ending::fine, fmt::format("largest overlap {:.4f} of the width",
                                                                simulation.counters().max_overlap)};
                     });
  };
  const Search loads = search(options, 0.02, 2.0, 6, 8);
  boundaries.add("block pressed into the ground by a sudden load", "load over k_n L", "1", loads,
                 find_boundary(loads, trial),
                 "unit square, no damping; energy says 1/4 - 1/24 = 0.2083 at half the width");
  for (const bool onto_block : {false, true}) {
    const double low = onto_block ? 1.0 : 0.0;
    const std::string blocks =
        ground() +
        block_toml("idle", rectangle({0.0, low - 1.0 + (onto_block ? 0.0 : 3.0)},
                                     {1.0, low + (onto_block ? 0.0 : 3.0)})) +
        block_toml("ram", rectangle({0.0, low}, {1.0, low + 1.0}), "prescribed_velocity = [0.0, -1.0, 0.0]");
    const auto pressed = [&](double depth) {
      return try_scene(
          head({.duration = depth, .gravity = {}, .normal_stiffness = k}) + blocks,
          [&](Simulation &simulation) {
            advance(simulation, depth);
            const double overlap = simulation.counters().max_overlap;
            return judged(onto_block || depth < 0.5,
                          fmt::format("the ram has moved {:.3g} m, overlap seen {:.4f} m", depth, overlap));
          });
    };
    const Search depths = search(options, 0.1, 1.5, 5, 12);
    boundaries.add(onto_block ? "ram pressed onto a block on the ground"
                              : "ram pressed into the fixed ground",
                   "motion over width", "1", depths, find_boundary(depths, pressed),
                   "unit squares, 1 m/s; the force of a joint reverses at an overlap of 0.5");
  }
}

/// A square shot at a wall of its own thickness, or at its like; the phase of the hit within a step varies.
Outcome shot(double speed, bool at_its_like, double share) {
  constexpr double size = 0.1;
  constexpr double distance = 1.0;
  const auto square = [&](double x) { return rectangle({x - size, -0.5 * size}, {x, 0.5 * size}); };
  const double duration = 3.0 * distance / speed;
  std::string toml =
      head({.duration = duration, .gravity = {}, .normal_stiffness = stiffness(1.0, size), .damping = 0.0}) +
      block_toml("bullet", square(-distance * share), fmt::format("velocity = [{:.17g}, 0.0, 0.0]", speed));
  toml += at_its_like ? block_toml("like", square(distance * share + size),
                                   fmt::format("velocity = [{:.17g}, 0.0, 0.0]", -speed))
                      : block_toml("wall", rectangle({0.0, -2.0}, {size, 2.0}), "fixed = true");
  return try_scene(toml, [&](Simulation &simulation) {
    advance(simulation, duration);
    const double back = velocity_of(simulation, 0).u.x / speed;
    return judged(back < 0.0 && std::abs(back * back - 1.0) < 0.1,
                  fmt::format("leaves at {:.3f} of its speed, moves {:.2g} of its size in a step", back,
                              speed * simulation.plan().time_step / size));
  });
}

void tunnelling(const Options &options, Boundaries &boundaries) {
  for (const bool at_its_like : {false, true}) {
    const auto trial = [&](double speed) {
      Outcome last;
      for (const double share : {1.0, 0.987, 0.971, 0.953, 0.932, 0.911, 0.887, 0.863}) {
        last = shot(speed, at_its_like, share);
        if (last.ending == Ending::silent) {
          break;
        }
      }
      return last;
    };
    const Search speeds{1.0, 1e4, options.quick ? 5 : 13, options.quick ? 2 : 7, false};
    const double k = stiffness(1.0, 0.1);
    const double mass = (at_its_like ? 0.5 : 1.0) * rock_density * 0.01;
    boundaries.add(
        at_its_like ? "square shot at its like" : "square shot at a wall as thin as itself", "speed of each",
        "m/s", speeds, find_boundary(speeds, trial),
        fmt::format("squares of 0.1 m, k_n = {:.4g} Pa/m, no damping, 8 phases; half the width is reached "
                    "about from {:.3g} m/s on",
                    k,
                    std::sqrt(2.0 * k * 0.1 * 0.0025 * (at_its_like ? 1.0 / 3.0 : 5.0 / 12.0) / mass) /
                        (at_its_like ? 2.0 : 1.0)));
  }
}

/// What a square in flight meets, in a step that is not far below the time it takes.
enum class Target { wall, like, shifted_like };

/// A square that moves by `share` of its size in a step: does any phase of the hit let it through?
Outcome leap(double share, Target target, int num_phases) {
  constexpr double size = 0.1;
  constexpr double step = 1e-4;
  constexpr double gap = 0.3;
  const double speed = share * size / step;
  const auto square = [&](double x, double y) { return rectangle({x, y}, {x + size, y + size}); };
  for (int phase = 0; phase < num_phases; ++phase) {
    const double start = gap + 2.0 * share * size * phase / num_phases;
    const double other = target == Target::wall ? 0.0 : -speed;
    const std::string toml =
        head({.duration = 60 * step,
              .time_step = step,
              .gravity = {},
              .normal_stiffness = stiffness(1.0, size),
              .damping = 0.0}) +
        block_toml("bullet", square(-start - size, 0.0),
                   fmt::format("velocity = [{:.17g}, 0.0, 0.0]", speed)) +
        (target == Target::wall ? block_toml("wall", rectangle({0.0, -2.0}, {size, 2.0}), "fixed = true")
                                : block_toml("like", square(0.0, target == Target::like ? 0.0 : 0.3 * size),
                                             fmt::format("velocity = [{:.17g}, 0.0, 0.0]", other)));
    const Outcome outcome = try_scene(toml, [&](Simulation &simulation) {
      while (!simulation.finished()) {
        simulation.step();
      }
      const double ahead = displacement_of(simulation, 0).u.x - displacement_of(simulation, 1).u.x - start;
      return judged(
          ahead < size,
          fmt::format("passes through at {:.3g} m/s in phase {} of {}, step {:g} of the recommended", speed,
                      phase, num_phases, step / simulation.bound().time_step));
    });
    if (outcome.ending == Ending::silent || outcome.ending == Ending::warned ||
        outcome.text.starts_with("too fast")) {
      return outcome;
    }
  }
  return {Ending::fine, "every phase bounces or stops"};
}

void tunnelling_in_large_steps(const Options &options, Boundaries &boundaries) {
  struct Case {
    Target target;
    const char *name;
  };
  for (const Case &c : {Case{Target::wall, "a thin wall"}, Case{Target::like, "its like"},
                        Case{Target::shifted_like, "its like, shifted by 0.3 of its size"}}) {
    const Search shares{0.1, 1.2, options.quick ? 5 : 20, options.quick ? 1 : 5, false};
    const int num_phases = options.quick ? 20 : 60;
    boundaries.add(fmt::format("fast square through {}", c.name), "motion of each in a step over size", "1",
                   shares,
                   find_boundary(shares, [&](double share) { return leap(share, c.target, num_phases); }),
                   fmt::format("squares of 0.1 m, {} phases of the hit", num_phases));
  }
}

/// A spinning unit square in free flight for 20 turns, or as many as 1e4 steps are; a far neighbour sets dt.
Outcome spin(double rate, bool deformable, const std::string &elasticity) {
  const double k = stiffness(1.0, 1.0);
  const double duration = std::min(20.0 * 2.0 * std::numbers::pi / rate, 1.0);
  const std::string toml =
      head({.duration = duration,
            .gravity = {},
            .normal_stiffness = k,
            .damping = 0.0,
            .run_keys = fmt::format("elasticity = \"{}\"", elasticity),
            .fidelity = deformable ? "deformable" : "rigid",
            .youngs_modulus = 1e9,
            .poissons_ratio = 0.2}) +
      ground() +
      block_toml("b", rectangle({0.0, 3.0}, {1.0, 4.0}), fmt::format("velocity = [0.0, 0.0, {:.17g}]", rate));
  return try_scene(toml, [&](Simulation &simulation) {
    const EnergyLedger ledger(simulation.state());
    const double start = ledger.row(simulation.state()).kinetic;
    double largest = 0.0;
    for (int part = 1; part <= 50; ++part) {
      advance(simulation, duration * part / 50);
      const double lost = ledger.row(simulation.state()).residual / start;
      largest = std::abs(lost) > std::abs(largest) ? lost : largest;
    }
    const double stretch =
        deformable ? determinant(simulation.blocks().deformation_of(0).gradient) - 1.0 : 0.0;
    return judged(std::abs(largest) < 0.02,
                  fmt::format("energy off by {:.1e}, area by {:.1e}, turns {:.2g} rad in a step, {} steps",
                              largest, stretch, rate * simulation.plan().time_step, simulation.step_count()));
  });
}

/// A square that spins and falls 1 cm onto the ground, friction 30 degrees.
Outcome land(double rate, bool deformable) {
  const std::string toml =
      head({.duration = 1.0,
            .normal_stiffness = stiffness(1.0, 1.0),
            .friction_deg = 30.0,
            .fidelity = deformable ? "deformable" : "rigid",
            .youngs_modulus = 1e9,
            .poissons_ratio = 0.2}) +
      ground() +
      block_toml("b", rectangle({0.0, 0.5}, {1.0, 1.5}), fmt::format("velocity = [0.0, 0.0, {:.17g}]", rate));
  return try_scene(toml, [&](Simulation &simulation) {
    const EnergyLedger ledger(simulation.state());
    const EnergyRow first = ledger.row(simulation.state());
    const double available = first.kinetic + rock_density * earth_gravity * 0.5;
    double largest = 0.0;
    for (int part = 1; part <= 50 && !simulation.fault(); ++part) {
      advance(simulation, part * 0.02);
      const double lost = simulation.fault() ? 0.0 : ledger.row(simulation.state()).residual / available;
      largest = std::abs(lost) > std::abs(largest) ? lost : largest;
    }
    return judged(std::abs(largest) < 0.05, fmt::format("energy off by {:.1e}, largest overlap {:.2g} m",
                                                        largest, simulation.counters().max_overlap));
  });
}

void spinning(const Options &options, Boundaries &boundaries) {
  const Search rates = search(options, 1.0, 1e6, 13, 6);
  const std::string held = "unit square, E = 1 GPa where deformable, default step";
  boundaries.add("rigid square spinning in flight", "angular velocity", "rad/s", rates,
                 find_boundary(rates, [](double rate) { return spin(rate, false, "implicit"); }), held);
  for (const char *elasticity : {"implicit", "explicit"}) {
    boundaries.add(fmt::format("deformable square spinning in flight, {} elasticity", elasticity),
                   "angular velocity", "rad/s", rates,
                   find_boundary(rates, [&](double rate) { return spin(rate, true, elasticity); }),
                   fmt::format("{}; centrifugal strain rho w^2 L^2/(12 E) is 1 at {:.0f} rad/s", held,
                               std::sqrt(12e9 / rock_density)));
  }
  for (const bool deformable : {false, true}) {
    boundaries.add(fmt::format("spinning {} square landing", deformable ? "deformable" : "rigid"),
                   "angular velocity", "rad/s", rates,
                   find_boundary(rates, [&](double rate) { return land(rate, deformable); }), held);
  }
}

} // namespace

void failures_in_motion(const Options &options, Boundaries &boundaries) {
  deep_overlap(options, boundaries);
  tunnelling(options, boundaries);
  tunnelling_in_large_steps(options, boundaries);
  spinning(options, boundaries);
}

} // namespace gcpdda::study
