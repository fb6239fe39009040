// Growth of small motions of blocks that stick to each other under shear: theory against runs, friction at
// the grip against friction at the centre of pressure.

#include "sheared_column.hpp"
#include "study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <string>
#include <vector>

namespace gcpdda::study {

namespace {

constexpr double tan_friction = 1.7320508075688772; // 60 degrees
struct Variant {
  ActsAt acts_at;
  const char *name;
};
constexpr std::array<Variant, 2> variants{
    {{ActsAt::grip, "grip"}, {ActsAt::centre_of_pressure, "centre of pressure"}}};

std::vector<double> from_to(double first, double last, int count) {
  std::vector<double> values;
  for (int i = 0; i < count; ++i) {
    values.push_back(first + (last - first) * i / (count - 1));
  }
  return values;
}

struct Grid {
  std::vector<double> angles;
  std::vector<double> uses;
  std::vector<double> log_softness;
  std::vector<double> damping;
};

/// visit(problem, use) for all of a grid.
template <class Visit> void for_all(const Grid &grid, Visit &&visit) {
  for (const double angle : grid.angles) {
    for (const double damping : grid.damping) {
      for (const double log_softness : grid.log_softness) {
        for (const double use : grid.uses) {
          visit(ColumnProblem{angle, std::pow(10.0, log_softness), use * tan_friction, damping}, use);
        }
      }
    }
  }
}

/// For tables that are read by eye too.
double rounded(double value) {
  return std::stod(fmt::format("{:.4g}", value));
}

void map(const Grid &grid, const std::filesystem::path &folder) {
  Table table(folder / "flutter_map.csv", {"joint_angle_deg", "damping_ratio", "k_n L/E", "use",
                                           "growth_grip_over_omega", "growth_centre_over_omega"});
  std::array<double, variants.size()> worst{};
  std::array<int, variants.size()> growing{};
  int count = 0;
  for_all(grid, [&](const ColumnProblem &problem, double use) {
    std::array<double, variants.size()> growth{};
    for (std::size_t k = 0; k < variants.size(); ++k) {
      growth[k] = ShearedColumn(problem, variants[k].acts_at).growth() / ShearedColumn::joint_frequency();
      worst[k] = std::max(worst[k], growth[k]);
      growing[k] += growth[k] > 0.0 ? 1 : 0;
    }
    table.add({problem.joint_angle_deg, problem.damping_ratio, rounded(problem.softness), rounded(use),
               rounded(growth[0]), rounded(growth[1])});
    ++count;
  });
  for (std::size_t k = 0; k < variants.size(); ++k) {
    std::cout << fmt::format("friction at the {}: {} of {} states grow, at most by {:.3g} omega\n",
                             variants[k].name, growing[k], count, worst[k]);
  }
}

void runs(const Grid &grid, int num_steps, const std::filesystem::path &folder) {
  Table table(folder / "flutter_runs.csv", {"acts_at", "joint_angle_deg", "damping_ratio", "k_n L/E", "use",
                                            "theory_over_omega", "measured_over_omega"});
  constexpr double noticed = 0.02; // growth over omega from which runs are compared in percent
  const double omega = ShearedColumn::joint_frequency();
  for (const Variant &variant : variants) {
    double worst = 0.0;
    double largest = 0.0;
    double among_resting = 0.0;
    unsigned seed = 0;
    for_all(grid, [&](const ColumnProblem &problem, double use) {
      ShearedColumn column(problem, variant.acts_at);
      const double theory = column.growth() / omega;
      const double measured = column.measured_growth(++seed, num_steps) / omega;
      table.add({std::string(variant.name), problem.joint_angle_deg, problem.damping_ratio,
                 rounded(problem.softness), rounded(use), rounded(theory), rounded(measured)});
      worst = std::max(worst, theory > noticed ? std::abs(measured / theory - 1.0) : 0.0);
      largest = std::max(largest, measured);
      among_resting = std::max(among_resting, theory == 0.0 ? measured : 0.0);
    });
    std::cout << fmt::format("friction at the {}: runs grow by at most {:.3g} omega, by {:.1e} where theory "
                             "has no growth; above {} omega within {:.1f} % of theory\n",
                             variant.name, largest, among_resting, noticed, 100.0 * worst);
  }
}

} // namespace

void flutter(const Options &options) {
  const bool quick = options.quick;
  map({.angles = {0.0, 30.0, 45.0, 60.0},
       .uses = from_to(-0.95, 0.95, quick ? 9 : 21),
       .log_softness = from_to(-3.0, 3.0, quick ? 7 : 25),
       .damping = {0.0, 0.05, 0.2}},
      options.folder);
  runs({.angles = {0.0, 30.0, 45.0, 60.0},
        .uses = from_to(-0.95, 0.95, quick ? 3 : 5),
        .log_softness = from_to(-1.0, 2.0, quick ? 3 : 5),
        .damping = {0.0, 0.05}},
       quick ? 2500 : 12000, options.folder);
}

} // namespace gcpdda::study
