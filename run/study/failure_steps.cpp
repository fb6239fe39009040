// Steps above the bound.

#include "failure_search.hpp"

#include "simulation/energy_ledger.hpp"
#include "support/setting.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace gcpdda::study {

namespace {

using testing::advance;
using testing::block_toml;
using testing::head;
using testing::rectangle;
using testing::rock_density;
using testing::Setting;

Setting wall_setting() {
  return {.duration = 2.0, .normal_stiffness = stiffness(0.8, std::sqrt(0.08)), .friction_deg = 30.0};
}

/// 20 bricks in four rows, gravity rising within the first second of two.
std::string wall(Setting setting) {
  setting.run_keys += "\ngravity_ramp = 1.0";
  return head(setting) + block_toml("ground", rectangle({-1.0, -1.0}, {3.0, 0.0}), "fixed = true") +
         "[[wall]]\nmaterial = \"rock\"\norigin = [0.0, 0.0]\nrows = 4\ncolumns = 5\nblock_size = [0.4, "
         "0.2]\nbond = 0.0\n";
}

Outcome stays(double factor, double recommended) {
  Setting setting = wall_setting();
  setting.time_step = factor * recommended;
  setting.duration = std::ceil(setting.duration / setting.time_step) * setting.time_step;
  return try_scene(wall(setting), [](Simulation &simulation) {
    const EnergyLedger ledger(simulation.state());
    advance(simulation, 1.0);
    double fastest = 0.0;
    while (!simulation.finished()) {
      simulation.step();
      for (const RigidDof &v : simulation.blocks().velocity) {
        fastest = std::max(fastest, norm(v.u));
      }
    }
    const EnergyRow row = simulation.fault() ? EnergyRow{} : ledger.row(simulation.state());
    return judged(fastest < 0.01, fmt::format("fastest {:.1e} m/s after the ramp, residual {:.1e} J/m",
                                              fastest, row.residual));
  });
}

void large_steps(const Options &options, Boundaries &boundaries) {
  double recommended = 0.0;
  try_scene(wall(wall_setting()), [&](Simulation &simulation) {
    recommended = simulation.bound().time_step;
    return Outcome{};
  });
  const Search factors = search(options, 1.0, 64.0, 10, 7);
  boundaries.add("wall of 20 bricks at rest", "step over the recommended one", "1", factors,
                 find_boundary(factors, [&](double factor) { return stays(factor, recommended); }),
                 fmt::format("recommended {:.4g} s = {:g} of the bound; every factor above 1 is warned of",
                             recommended, RunSettings{}.safety));
}

/// 16 deformable squares that fly about in a closed box.
Outcome rattle(double safety, double stiffness_ratio, const std::string &elasticity, double damping,
               int num_steps) {
  constexpr double k = 1e8;
  const double modulus = k / stiffness_ratio;
  std::mt19937 engine(7);
  const auto share = [&] { return static_cast<double>(engine()) / 4294967296.0 - 0.5; };
  std::string blocks = block_toml("low", rectangle({-2.0, -2.0}, {8.0, -0.2}), "fixed = true") +
                       block_toml("high", rectangle({-2.0, 5.0}, {8.0, 7.0}), "fixed = true") +
                       block_toml("left", rectangle({-2.0, -0.2}, {-0.2, 5.0}), "fixed = true") +
                       block_toml("right", rectangle({5.0, -0.2}, {7.0, 5.0}), "fixed = true");
  for (int b = 0; b < 16; ++b) {
    const Vec2 low{1.2 * (b % 4), 1.2 * static_cast<double>(b / 4)};
    const double vx = 4.0 * share();
    const double vy = 4.0 * share();
    blocks += block_toml(fmt::format("b{}", b), rectangle(low, low + Vec2{1.0, 1.0}),
                         fmt::format("velocity = [{:.17g}, {:.17g}, {:.17g}]", vx, vy, 0.5 * share()));
  }
  Setting setting{.duration = 1.0,
                  .gravity = {},
                  .normal_stiffness = k,
                  .damping = damping,
                  .run_keys = fmt::format("safety = {:.17g}\nelasticity = \"{}\"", safety, elasticity),
                  .fidelity = "deformable",
                  .youngs_modulus = modulus,
                  .poissons_ratio = 0.2};
  double step = 0.0;
  try_scene(head(setting) + blocks, [&](Simulation &simulation) {
    step = simulation.bound().time_step;
    return Outcome{};
  });
  setting.duration = num_steps * step;
  return try_scene(head(setting) + blocks, [&](Simulation &simulation) {
    const EnergyLedger ledger(simulation.state());
    const double start = ledger.row(simulation.state()).kinetic;
    double most = 0.0;
    while (!simulation.finished()) {
      for (int k_step = 0; k_step < 50 && !simulation.finished(); ++k_step) {
        simulation.step();
      }
      if (!simulation.fault()) {
        const EnergyRow row = ledger.row(simulation.state());
        most = std::max(most, (row.kinetic + row.strain + row.contact_normal) / start);
      }
    }
    return judged(most < 1.05, fmt::format("energy at most {:.3f} of the first, {} contacts x steps", most,
                                           simulation.counters().contact_steps));
  });
}

void deformable_safety(const Options &options, Boundaries &boundaries) {
  const int steps = options.quick ? 1000 : 10000;
  for (const char *elasticity : {"implicit", "explicit"}) {
    for (const double ratio : {0.1, 1.0, 10.0}) {
      for (const double damping : {0.0, 0.05}) {
        const Search range = search(options, 0.1, 1.0, 7, 4);
        boundaries.add(
            fmt::format("deformable squares in a box, {}, k_n L/E = {:g}, xi = {:g}", elasticity, ratio,
                        damping),
            "safety", "1", range,
            find_boundary(range,
                          [&](double safety) { return rattle(safety, ratio, elasticity, damping, steps); }),
            fmt::format("16 unit squares, frictionless, {} steps; fine: total energy grows by less than 5 %",
                        steps));
      }
    }
  }
}

} // namespace

void failures_of_steps(const Options &options, Boundaries &boundaries) {
  large_steps(options, boundaries);
  deformable_safety(options, boundaries);
}

} // namespace gcpdda::study
