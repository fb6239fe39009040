// Rigid, deformable or auto: error against cost over k_n L/E, and what an unused feature costs.

#include "study.hpp"

#include "support/setting.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <map>

namespace gcpdda::study {

using namespace testing;

namespace {

constexpr double joint_stiffness = 1e9; // k_n, Pa/m: given, the modulus varies

/// Settling under a load, without gravity: soft blocks take longer.
Setting loaded(const std::string &fidelity, double youngs_modulus) {
  const double duration = 3.0 * std::max(1.0, std::sqrt(0.1 * joint_stiffness / youngs_modulus));
  Setting setting;
  setting.duration = duration;
  setting.interval = duration;
  setting.gravity = {};
  setting.normal_stiffness = joint_stiffness;
  setting.damping = 0.1;
  setting.fidelity = fidelity;
  setting.youngs_modulus = youngs_modulus;
  setting.run_keys = "plane = \"stress\"\nlocal_damping = 0.4\n";
  return setting;
}

struct Settlement {
  double value = 0.0; ///< m
  double predicted_error = 0.0;
  std::int64_t num_deformable = 0;
  Cost cost;
};

template <class Measure> Settlement settle(const std::string &toml, Measure &&measure) {
  Simulation simulation(Communicator::self(), scene_of(toml));
  Settlement settlement;
  settlement.cost = advance(simulation, simulation.plan().duration);
  settlement.value = simulation.fault() ? std::nan("") : measure(simulation);
  const FidelityReport &report = simulation.fidelity();
  settlement.predicted_error = report.worst_rigid;
  settlement.num_deformable = report.num_deformable;
  return settlement;
}

std::string loads(const std::vector<Vec2> &points, Vec2 force) {
  std::string text;
  for (const Vec2 point : points) {
    text += fmt::format("[[block.load]]\npoint = [{:.17g}, {:.17g}]\nforce = [{:.17g}, {:.17g}]\n", point.x,
                        point.y, force.x, force.y);
  }
  return text;
}

/// Shortening of a bar of unit squares under a dead load at its free end; exact: P n (1/E + 1/(k_n L)).
Settlement shorten_bar(const std::string &fidelity, double youngs_modulus) {
  constexpr int num_blocks = 8;
  const double load = 1e-6 * std::min(youngs_modulus, joint_stiffness);
  std::string toml = head(loaded(fidelity, youngs_modulus)) +
                     block_toml("abutment", rectangle({-2.0, -1.0}, {0.0, 2.0}), "fixed = true");
  for (int i = 0; i < num_blocks; ++i) {
    const std::string end = loads({{num_blocks, 0.25}, {num_blocks, 0.75}}, {-0.5 * load, 0.0});
    toml += block_toml(fmt::format("bar{}", i), rectangle({1.0 * i, 0.0}, {i + 1.0, 1.0}),
                       i + 1 < num_blocks ? "" : end);
  }
  Settlement settlement = settle(toml, [&](const Simulation &simulation) {
    const BlockSystem &blocks = simulation.blocks();
    const std::size_t last = row_of(simulation, num_blocks);
    const double strain = blocks.is_deformable(last) ? blocks.deformation_of(last).gradient.xx - 1.0 : 0.0;
    return -displacement_of(simulation, num_blocks).u.x - 0.5 * strain;
  });
  settlement.value /= load * num_blocks * (1.0 / youngs_modulus + 1.0 / joint_stiffness);
  return settlement;
}

/// How far a loaded rigid beam sinks onto a wall of bricks.
Settlement load_wall(const std::string &fidelity, double youngs_modulus) {
  constexpr double width = 4.0;
  constexpr double height = 2.0;
  const double load = 1e-6 * std::min(youngs_modulus, joint_stiffness);
  const std::string toml =
      head(loaded(fidelity, youngs_modulus)) +
      block_toml("ground", rectangle({-2.0, -2.0}, {width + 2.0, 0.0}), "fixed = true") +
      block_toml("beam", rectangle({0.0, height}, {width, height + 1.0}),
                 "fidelity = \"rigid\"\n" +
                     loads({{1.0, height + 1.0}, {3.0, height + 1.0}}, {0.0, -0.5 * width * load})) +
      fmt::format(
          "[[wall]]\nname = \"wall\"\nmaterial = \"rock\"\norigin = [0.0, 0.0]\nrows = 4\ncolumns = 4\n"
          "block_size = [{:.17g}, {:.17g}]\n",
          width / 4.0, height / 4.0);
  return settle(toml, [](const Simulation &simulation) { return -displacement_of(simulation, 1).u.y; });
}

/// Errors of rigid and auto against the closed form (bar) or against all blocks deformable (wall).
void chart_fidelity(const Options &options) {
  Table table(options.folder / "fidelity.csv", {"problem", "k_n_L_over_E", "fidelity", "deformable_blocks",
                                                "error", "predicted_error", "cpu_s", "evaluations", "steps"});
  std::vector<double> ratios{1e-4, 1e-2, 1.0, 1e2};
  if (!options.quick) {
    ratios = {1e-4, 1e-3, 3e-3, 9e-3, 1.1e-2, 3e-2, 0.1, 1.0, 10.0, 100.0};
  }
  double worst = 1.0;
  int choices = 0;
  int right = 0;
  const std::map<std::string, Settlement (*)(const std::string &, double)> problems{{"bar", shorten_bar},
                                                                                    {"wall", load_wall}};
  for (const auto &[name, compute] : problems) {
    const double size = name == "bar" ? 1.0 : std::sqrt(0.5);
    for (const double ratio : ratios) {
      const double youngs_modulus = joint_stiffness * size / ratio;
      const double predicted = ratio / (1.0 + ratio);
      const double truth = name == "bar" ? 1.0 : compute("deformable", youngs_modulus).value;
      for (const char *fidelity : {"rigid", "deformable", "auto"}) {
        const Settlement got = compute(fidelity, youngs_modulus);
        const double error = std::abs(got.value / truth - 1.0);
        table.add({name, ratio, std::string(fidelity), got.num_deformable, error,
                   got.num_deformable > 0 ? 0.0 : predicted, got.cost.cpu, got.cost.evaluations,
                   got.cost.steps});
        if (fidelity == std::string("rigid")) {
          worst = std::max({worst, error / predicted, predicted / error});
        } else if (fidelity == std::string("auto")) {
          ++choices;
          right += (got.num_deformable == 0) == (predicted <= 0.01) ? 1 : 0;
        }
      }
    }
  }
  std::cout << fmt::format(
      "auto takes rigid blocks exactly where the predicted error is below accepted_error: {} of {}\n"
      "predicted error of rigid blocks against the measured one: within a factor of {:.2f}\n",
      right, choices, worst);
}

/// A pyramid that settles, and more in its scene.
std::string pyramid(double friction_deg, const std::string &more, const std::string &fidelity = "rigid") {
  Setting setting;
  setting.duration = 0.2;
  setting.interval = 0.2;
  setting.time_step = 1e-4;
  setting.normal_stiffness = stiffness(10.0, 1.0);
  setting.friction_deg = friction_deg;
  setting.youngs_modulus = 1e3 * setting.normal_stiffness;
  setting.fidelity = fidelity;
  return head(setting) + block_toml("ground", rectangle({-5.0, -2.0}, {15.0, 0.0}), "fixed = true") +
         "[[pyramid]]\nname = \"pyramid\"\nmaterial = \"rock\"\norigin = [0.0, 0.0]\nrows = 10\n"
         "block_size = [1.0, 1.0]\n" +
         more;
}

std::string far_blocks(int count, const std::string &keys) {
  std::string text;
  for (int i = 0; i < count; ++i) {
    text += block_toml(fmt::format("far{}", i), rectangle({100.0 + 3.0 * i, 50.0}, {101.0 + 3.0 * i, 51.0}),
                       keys);
  }
  return text;
}

/// Stepping with a feature that is present but unused, paired with stepping without it.
void price_unused(const Options &options) {
  struct Pair {
    std::string feature;
    std::string without;
    std::string with;
  };
  std::string monitors;
  for (int row = 0; row < 10; ++row) {
    monitors += fmt::format("[[monitor]]\nblock = \"pyramid.{}.0\"\n", row);
  }
  const std::string plain = pyramid(31.0, "");
  const std::vector<Pair> pairs{
      {"friction 31 degrees instead of 0", pyramid(0.0, ""), plain},
      {"100 fixed bodies far away", plain, pyramid(31.0, far_blocks(100, "fixed = true"))},
      {"fidelity auto instead of rigid", plain, pyramid(31.0, "", "auto")},
      {"one deformable block far away", plain, pyramid(31.0, far_blocks(1, "fidelity = \"deformable\""))},
      {"100 mobile blocks far away", plain, pyramid(31.0, far_blocks(100, ""))},
      {"10 monitored blocks", plain, pyramid(31.0, monitors)},
      {"the same scene again", plain, plain},
  };
  Table table(options.folder / "unused.csv",
              {"feature", "cpu_ratio", "evaluations_ratio", "contact_steps_ratio"});
  const int repeats = options.quick ? 1 : 9;
  for (const auto &[feature, without, with] : pairs) {
    std::vector<double> ratios;
    Cost base;
    Cost more;
    for (int k = 0; k < repeats; ++k) {
      Simulation first(Communicator::self(), scene_of(without));
      Simulation second(Communicator::self(), scene_of(with));
      base = advance(first, 0.2);
      more = advance(second, 0.2);
      ratios.push_back(more.cpu / base.cpu);
    }
    const auto ratio = [](std::int64_t a, std::int64_t b) {
      return static_cast<double>(a) / static_cast<double>(b);
    };
    table.add({feature, median(ratios), ratio(more.evaluations, base.evaluations),
               ratio(more.contact_steps, base.contact_steps)});
    std::cout << fmt::format("{:40} CPU x {:.3f}, evaluations x {:.3f}, contacts x {:.3f}\n", feature,
                             median(ratios), ratio(more.evaluations, base.evaluations),
                             ratio(more.contact_steps, base.contact_steps))
              << std::flush;
  }
}

} // namespace

void fidelity(const Options &options) {
  chart_fidelity(options);
  price_unused(options);
}

} // namespace gcpdda::study
