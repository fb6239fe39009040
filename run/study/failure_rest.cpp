// Blocks at rest: mass ratios, stiffness, tall piles, many steps.

#include "failure_search.hpp"

#include "simulation/energy_ledger.hpp"
#include "support/setting.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

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

std::string column(int num_blocks) {
  std::string toml = ground();
  for (int k = 0; k < num_blocks; ++k) {
    toml += block_toml(fmt::format("b{}", k), rectangle({0.0, 1.0 * k}, {1.0, k + 1.0}));
  }
  return toml;
}

/// Depth of a flush unit joint that carries `force`: k_n d (1 - share d) = force.
double depth_under(double force, double stiffness, double share) {
  return (1.0 - std::sqrt(1.0 - 4.0 * share * force / stiffness)) / (2.0 * share);
}

/// How far the first joint of unit squares 1, 2 over the ground 0 is from carrying its weight, and the
/// speeds.
struct Unrest {
  double depth = 0.0; ///< largest relative error of the depth of the two joints
  double speed = 0.0;
};

Unrest unrest(const Simulation &simulation, double lower_depth, double upper_depth) {
  const double lower = -displacement_of(simulation, 1).u.y;
  const double upper = -displacement_of(simulation, 2).u.y - lower;
  return {std::max(std::abs(lower / lower_depth - 1.0), std::abs(upper / upper_depth - 1.0)),
          std::max(norm(velocity_of(simulation, 1).u), norm(velocity_of(simulation, 2).u))};
}

/// Largest unrest between two times.
Unrest largest_unrest(Simulation &simulation, double until, double lower_depth, double upper_depth) {
  Unrest largest;
  while (!simulation.finished() && simulation.time() < until) {
    simulation.step();
    const Unrest now = unrest(simulation, lower_depth, upper_depth);
    largest = {std::max(largest.depth, now.depth), std::max(largest.speed, now.speed)};
  }
  return largest;
}

void mass_ratio(const Options &options, Boundaries &boundaries, bool heavy_above, double friction_deg) {
  const double k = stiffness(2.0, 1.0);
  constexpr double ramp = 1.0;
  const auto trial = [&](double ratio) {
    const std::string toml = head({.duration = 3.0,
                                   .normal_stiffness = k,
                                   .friction_deg = friction_deg,
                                   .run_keys = "gravity_ramp = 1.0"}) +
                             column(2) +
                             fmt::format("[material.light]\ndensity = {}\n", rock_density / ratio);
    const std::string light = heavy_above ? "b0" : "b1";
    const double weight = rock_density * earth_gravity;
    const double upper = depth_under(heavy_above ? weight : weight / ratio, k, 1.0);
    const double lower = depth_under(weight * (1.0 + 1.0 / ratio), k, 0.5);
    return try_scene(toml,
                     [&](Simulation &simulation) {
                       const EnergyLedger ledger(simulation.state());
                       advance(simulation, ramp);
                       const Unrest early = largest_unrest(simulation, 1.3, lower, upper);
                       Unrest late = largest_unrest(simulation, 1.6, lower, upper);
                       // What is about to move is given the time to show how.
                       while (!simulation.finished() && late.speed > 2.0 * early.speed &&
                              late.speed <= 100.0 * early.speed) {
                         late = largest_unrest(simulation, simulation.time() + 0.1, lower, upper);
                       }
                       const EnergyRow energy = ledger.row(simulation.state());
                       const std::string text = fmt::format(
                           "depths off by {:.1e} of the closed form, speed {:.1e} m/s after {:.1e}, {} steps",
                           late.depth, late.speed, early.speed, simulation.step_count());
                       const bool is_kept = std::abs(energy.residual) < 1e-3 * energy.kinetic;
                       if (late.speed > 100.0 * early.speed && is_kept) {
                         return Outcome{Ending::physical,
                                        fmt::format("the light block is squeezed out, {}, energy residual "
                                                    "{:.1e} of the kinetic",
                                                    text, energy.residual / energy.kinetic)};
                       }
                       return judged(late.depth < 0.01 && late.speed <= 2.0 * early.speed, text);
                     },
                     {fmt::format("block.{}.material=\"light\"", light)});
  };
  const Search range = search(options, 1.0, options.quick ? 1e3 : 1e6, 4, 4);
  boundaries.add(
      heavy_above ? "heavy block on a light one" : "light block on a heavy one", "density ratio", "1", range,
      find_boundary(range, trial),
      fmt::format("unit squares, friction {:g} deg, k_n = {:.4g} Pa/m, gravity ramp 1 s", friction_deg, k));
}

/// A unit square at its depth, `steps` steps, force on it against its weight.
Outcome rest_at(double k, double offset, int steps) {
  const double weight = rock_density * earth_gravity;
  const double depth = depth_under(weight, k, 0.5);
  const double duration = steps * 0.1 * std::sqrt(rock_density / k);
  const std::string toml =
      head({.duration = duration, .normal_stiffness = k}) +
      block_toml("ground", rectangle({offset - 10.0, offset - 2.0}, {offset + 11.0, offset}),
                 "fixed = true") +
      block_toml("b", rectangle({offset, offset - depth}, {offset + 1.0, offset + 1.0 - depth}));
  return try_scene(toml, [&](Simulation &simulation) {
    double largest = 0.0;
    double turn = 0.0;
    while (!simulation.finished()) {
      simulation.step();
      largest = std::max(largest, std::abs(displacement_of(simulation, 1).u.y) / depth);
      turn = std::max(turn, std::abs(displacement_of(simulation, 1).r) / depth);
    }
    const double rounding = 30.0 * std::numeric_limits<double>::epsilon() * (1.0 + offset);
    return judged(depth * std::max(largest, turn) < std::max(0.01 * depth, rounding),
                  fmt::format("motion {:.1e}, turn {:.1e} of the depth {:.1e} m in {} steps", largest, turn,
                              depth, simulation.step_count()));
  });
}

void joint_stiffness(const Options &options, Boundaries &boundaries) {
  const double rule = stiffness(1.0, 1.0);
  const auto ramped = [&](double share) {
    const double k = share * rule;
    return try_scene(head({.duration = 1.5, .normal_stiffness = k, .run_keys = "gravity_ramp = 1.0"}) +
                         column(1),
                     [&](Simulation &simulation) {
                       advance(simulation, 1.5);
                       const double depth = depth_under(rock_density * earth_gravity, k, 0.5);
                       const double error = std::abs(-displacement_of(simulation, 1).u.y / depth - 1.0);
                       return judged(error < 0.5, fmt::format("depth {:.3g} m, off by {:.1e}, {} steps",
                                                              depth, error, simulation.step_count()));
                     });
  };
  const Search soft = search(options, 1.0, 1e-6);
  boundaries.add(
      "soft joint under a block", "k_n over the rule's", "1", soft, find_boundary(soft, ramped),
      fmt::format("unit square, rule k_n = {:.4g} Pa/m, gravity ramp 1 s; statically too deep from "
                  "{:.3g} on",
                  rule, rock_density * earth_gravity / 0.375 / rule));
  const Search stiff = search(options, 1.0, options.quick ? 1e4 : 1e6, 4);
  boundaries.add("stiff joint under a block", "k_n over the rule's", "1", stiff, find_boundary(stiff, ramped),
                 "as the soft one; the cost grows with its square root");
  for (const double offset : {0.0, 1000.0}) {
    const Search extreme = search(options, 1.0, 1e20 / rule, 14, 8);
    boundaries.add(
        fmt::format("stiff joint, rounding, {:g} m from the origin", offset), "k_n over the rule's", "1",
        extreme, find_boundary(extreme, [&](double share) { return rest_at(share * rule, offset, 10000); }),
        "unit square started at its depth; fine: moves and turns by less than 1 % of the depth or 30 ulp "
        "of its place");
  }
}

/// What a column of unit squares does in one and a half of its slowest periods.
Outcome stand(int num_blocks, bool ramp, double friction_deg) {
  const double k = stiffness(1.0, 1.0);
  const double period = 4.0 * num_blocks * std::sqrt(rock_density / k);
  const double duration = ramp ? 3.0 * period : 1.5 * period;
  const std::string toml =
      head({.duration = duration,
            .normal_stiffness = k,
            .friction_deg = friction_deg,
            .run_keys = fmt::format("gravity_ramp = {:.17g}", ramp ? 2.0 * period : 0.0)}) +
      column(num_blocks);
  return try_scene(toml, [&](Simulation &simulation) {
    const EnergyLedger ledger(simulation.state());
    double gap = 0.0;
    double sideways = 0.0;
    while (!simulation.finished()) {
      simulation.step();
      for (int b = 2; b <= num_blocks; ++b) {
        const RigidDof &upper = displacement_of(simulation, b);
        gap = std::max(gap, upper.u.y - displacement_of(simulation, b - 1).u.y);
        sideways = std::max(sideways, std::abs(upper.u.x));
      }
    }
    const double weight = num_blocks * rock_density * earth_gravity;
    const double fall = simulation.counters().max_overlap * num_blocks; // at most, of the centroid
    const double residual =
        simulation.fault() ? 0.0 : ledger.row(simulation.state()).residual / (weight * fall);
    const std::string text =
        fmt::format("joints open by {:.1e} m, blocks aside by {:.1e} m, largest overlap {:.3g} m, "
                    "energy residual {:.1e}, {} steps",
                    gap, sideways, simulation.counters().max_overlap, residual, simulation.step_count());
    if (std::abs(residual) > 0.02) {
      return judged(false, text);
    }
    if (sideways > 0.1) {
      return Outcome{Ending::physical, "buckles, " + text};
    }
    return gap > 0.01 ? Outcome{Ending::physical, "blocks jump off, " + text} : Outcome{Ending::fine, text};
  });
}

void tall_piles(const Options &options, Boundaries &boundaries) {
  for (const bool ramp : {false, true}) {
    for (const double friction : {0.0, 30.0}) {
      Search range = search(options, 2.0, 200.0, 8, 8);
      range.whole = true;
      const auto trial = [&](double n) { return stand(static_cast<int>(n), ramp, friction); };
      boundaries.add(
          fmt::format("column of soft blocks, {}, friction {:g} deg",
                      ramp ? "gravity ramp" : "sudden gravity", friction),
          "number of blocks", "1", range, find_boundary(range, trial),
          fmt::format("unit squares, k_n = {:.4g} Pa/m for a height of one block", stiffness(1.0, 1.0)));
    }
  }
}

void many_steps(const Options &options, Boundaries &boundaries) {
  constexpr double slope = 15.0 * testing::degree;
  constexpr double settled = 40.0;
  const double k = stiffness(2.0, std::sqrt(2.0));
  const double steps = options.quick ? 5e3 : 1e6;
  const auto turned = [&](Vec2 low, Vec2 high) { return testing::placed(rectangle(low, high), -slope, {}); };
  const auto scene = [&](double duration) {
    return head({.duration = duration,
                 .normal_stiffness = k,
                 .friction_deg = 30.0,
                 .run_keys = "gravity_ramp = 5.0"}) +
           block_toml("ground", turned({-3.0, -2.0}, {5.0, 0.0}), "fixed = true") +
           block_toml("b0", turned({0.0, 0.0}, {2.0, 1.0})) +
           block_toml("b1", turned({0.0, 1.0}, {2.0, 2.0}));
  };
  double step = 0.0;
  try_scene(scene(settled), [&](Simulation &simulation) {
    step = simulation.bound().time_step;
    return Outcome{};
  });
  const auto trial = [&](double count) {
    return try_scene(scene(settled + step * count), [&](Simulation &simulation) {
      advance(simulation, settled);
      const RigidDof start = displacement_of(simulation, 2);
      const double speed = norm(velocity_of(simulation, 2).u);
      double largest = 0.0;
      while (!simulation.finished()) {
        simulation.step();
        const RigidDof moved = displacement_of(simulation, 2) - start;
        largest = std::max({largest, norm(moved.u), std::abs(moved.r)});
      }
      return judged(largest < 1e-11,
                    fmt::format("moved {:.1e} m from a speed of {:.1e} m/s in {} steps, then {:.1e} m/s",
                                largest, speed, simulation.step_count(), norm(velocity_of(simulation, 2).u)));
    });
  };
  const Search range{steps, steps, 1, 0, false};
  boundaries.add("two blocks at rest on 15 degrees, friction 30", "steps", "1", range,
                 find_boundary(range, trial),
                 fmt::format("2 m by 1 m, k_n = {:.4g} Pa/m, motion after {:g} s of settling", k, settled));
}

} // namespace

void failures_at_rest(const Options &options, Boundaries &boundaries) {
  mass_ratio(options, boundaries, true, 30.0);
  mass_ratio(options, boundaries, true, 0.0);
  mass_ratio(options, boundaries, false, 30.0);
  joint_stiffness(options, boundaries);
  tall_piles(options, boundaries);
  many_steps(options, boundaries);
}

} // namespace gcpdda::study
