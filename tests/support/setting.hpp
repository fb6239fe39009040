#pragma once

// What test problems and studies share: the head of a one-rock scene, and looks at a run in memory.

#include "scenes.hpp"
#include "simulation/simulation.hpp"

#include <numbers>
#include <string>
#include <vector>

namespace gcpdda::testing {

constexpr double degree = std::numbers::pi / 180.0;
constexpr double earth_gravity = 9.81; ///< m/s2
constexpr double rock_density = 2600.0;

/// The head of a scene with one rock and one contact law.
struct Setting {
  double duration = 1.0;
  double time_step = 0.0; ///< 0: automatic. Otherwise the duration is a whole number of steps
  Vec2 gravity{0.0, -earth_gravity};
  double normal_stiffness = 1e9;
  double friction_deg = 0.0;
  double damping = 0.05;
  std::string run_keys{}; ///< more lines of [run]
  std::string fidelity = "rigid";
  double youngs_modulus = 0.0; ///< Pa; 0: none given
  double poissons_ratio = 0.0;
  double interval = 0.0; ///< s, of outputs; 0: the duration if the step is given, else a hundredth of it
};
std::string head(const Setting &setting);

/// Row of a block.
std::size_t row_of(const Simulation &simulation, int block);
/// x_n - x_0 of a block.
const RigidDof &displacement_of(const Simulation &simulation, int block);
const RigidDof &velocity_of(const Simulation &simulation, int block);

/// Step to a time that is a whole number of steps, or to the next step after it; stops at a fault.
void advance(Simulation &simulation, double time);

/// All stages, as a run goes through them, by steps of one's own kind.
void run_stages(
    Simulation &simulation, void (*step)(Simulation &) = [](Simulation &s) { s.step(); });
/// A scene whose stages say how long they last.
std::string without_duration(std::string toml);

/// Slope of the least-squares line through (log x, log y).
double log_slope(const std::vector<double> &x, const std::vector<double> &y);

} // namespace gcpdda::testing
