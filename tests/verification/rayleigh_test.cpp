// Rayleigh damping: the ratio alpha/(4 pi f) + beta pi f of a joint's normal and shear spring, and of a
// block's own elasticity.

#include "problem.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <vector>

namespace gcpdda::testing::rayleigh_test {
namespace {

constexpr double stiffness = 1e9; ///< Pa/m
constexpr double ratio = 0.04;    ///< the least one

/// What oscillates, and how fast.
struct Oscillator {
  std::string name;
  std::string toml; ///< without [run]
  double frequency; ///< Hz
  std::function<double(const Simulation &)> at;
};

Setting setting_of(const Oscillator &oscillator) {
  const double period = 1.0 / oscillator.frequency;
  return {.duration = 6.0 * period,
          .time_step = period / 400.0,
          .gravity = {},
          .normal_stiffness = stiffness,
          .friction_deg = 60.0,
          .damping = 0.0,
          .run_keys = "plane = \"stress\"\n",
          .fidelity = oscillator.name == "rock" ? "deformable" : "rigid",
          .youngs_modulus = 1e9};
}

std::string toml_of(const Oscillator &oscillator, const Setting &setting) {
  std::string toml = head(setting);
  toml.erase(toml.find("contact_damping"),
             toml.find('\n', toml.find("contact_damping")) + 1 - toml.find("contact_damping"));
  return toml + oscillator.toml;
}

/// To the end of the stage: ln(A_1/A_n) = pi (n - 1) xi/sqrt(1 - xi^2) from the ways between turning points,
/// wherever it comes to rest.
double ratio_of(Simulation &simulation, const Oscillator &oscillator) {
  std::vector<double> turns;
  double before = oscillator.at(simulation);
  double last = before;
  while (!simulation.stage_is_over()) {
    step(simulation);
    const double now = oscillator.at(simulation);
    if ((last - before) * (now - last) < 0.0) { // the vertex of the parabola
      const double bend = now - 2.0 * last + before;
      turns.push_back(last - 0.125 * (now - before) * (now - before) / bend);
    }
    before = last;
    last = now;
  }
  const std::size_t n = turns.size();
  EXPECT_GE(n, 8U);
  const double decrement =
      std::log(std::abs((turns[1] - turns[0]) / (turns[n - 1] - turns[n - 2]))) / static_cast<double>(n - 2);
  return decrement / std::hypot(std::numbers::pi, decrement);
}

std::string rayleigh_toml(double least, double frequency) {
  return fmt::format("{{ ratio = {}, frequency = {:.17g} }}", least, frequency);
}

std::vector<Oscillator> oscillators() {
  // 2 m wide, 0.5 m high and pressed on the floor by a load, 0.1 mm deep, with some speed.
  constexpr double width = 2.0;
  constexpr double depth = 1e-4;
  constexpr double mass = rock_density * width * 0.5;
  const std::string floor = block_toml("floor", rectangle({-5.0, -1.0}, {5.0, 0.0}), "fixed = true");
  const auto block = [&](const std::string &velocity, double height_of_load) {
    return floor +
           block_toml(
               "block", rectangle({-0.5 * width, -depth}, {0.5 * width, 0.5 - depth}),
               fmt::format("velocity = {}\n[[block.load]]\npoint = [0.0, {}]\nforce = [0.0, {:.17g}]\n",
                           velocity, height_of_load, -stiffness * width * depth));
  };
  const double normal = std::sqrt(stiffness * width / mass);
  std::vector<Oscillator> all;
  all.push_back({"joint", block("[0.0, 1e-3, 0.0]", 0.2), normal / (2.0 * std::numbers::pi),
                 [](const Simulation &s) { return displacement_of(s, 1).u.y; }});
  // Two loads pull a free square of 1 m apart: it swings about the strain F/E.
  const double force = 1e3;
  const double rock = std::sqrt(12.0 * 1e9 / rock_density);
  all.push_back({"rock",
                 block_toml("square", rectangle({0.0, 0.0}, {1.0, 1.0}),
                            fmt::format("[[block.load]]\npoint = [1.0, 0.5]\nforce = [{0}, 0.0]\n"
                                        "[[block.load]]\npoint = [0.0, 0.5]\nforce = [-{0}, 0.0]\n",
                                        force)),
                 rock / (2.0 * std::numbers::pi), [](const Simulation &s) {
                   return s.blocks().deformation_of(row_of(s, 0)).gradient.xx - 1.0;
                 }});
  return all;
}

// At a frequency at which mass and stiffness damp alike, and where either of them does most of it. Time steps
// of 1/400 period: dashpots taken at t_n, and what generalized-alpha takes itself of the rock's swing, is
// (omega dt)^2 and less.
TEST(Rayleigh, RatioFollowsItsCurve) {
  for (const Oscillator &oscillator : oscillators()) {
    for (const double least_at : {0.25, 1.0, 4.0}) { // times the frequency
      Setting setting = setting_of(oscillator);
      setting.run_keys += "rayleigh = " + rayleigh_toml(ratio, least_at * oscillator.frequency) + "\n";
      Simulation simulation(Communicator::self(), scene_of(toml_of(oscillator, setting)));
      expect_value(
          fmt::format("Rayleigh damping, {}, least at {} of its frequency: ratio", oscillator.name, least_at),
          0.5 * ratio * (least_at + 1.0 / least_at), ratio_of(simulation, oscillator), 5e-3);
    }
  }
}

// A stage brings its own: strong damping first, then little.
TEST(Rayleigh, RatioIsThatOfTheStage) {
  constexpr double later = 0.01;
  constexpr double least_at = 2.0;
  for (const Oscillator &oscillator : oscillators()) {
    Setting setting = setting_of(oscillator);
    setting.run_keys += "rayleigh = " + rayleigh_toml(ratio, oscillator.frequency) + "\n";
    const std::string stage =
        fmt::format("[[stage]]\nkind = \"run\"\nduration = {:.17g}\n", setting.duration);
    Simulation simulation(Communicator::self(),
                          scene_of(without_duration(toml_of(oscillator, setting)) + stage + stage +
                                   "set = { \"run.rayleigh\" = " +
                                   rayleigh_toml(later, least_at * oscillator.frequency) + " }\n"));
    expect_value(fmt::format("Rayleigh damping, {}, first stage: ratio", oscillator.name), ratio,
                 ratio_of(simulation, oscillator), 5e-3);
    simulation.end_stage();
    simulation.begin_next_stage();
    expect_value(fmt::format("Rayleigh damping, {}, second stage: ratio", oscillator.name),
                 0.5 * later * (least_at + 1.0 / least_at), ratio_of(simulation, oscillator), 5e-3);
  }
}

} // namespace
} // namespace gcpdda::testing::rayleigh_test
