#include "setting.hpp"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

namespace gcpdda::testing {

std::string head(const Setting &s) {
  return fmt::format(R"([run]
duration = {:.17g}
time_step = {}
gravity = [{:.17g}, {:.17g}]
fidelity = "{}"
contact_damping = {:.17g}
{}
[material.rock]
density = {:.17g}
{}
[joint.default]
normal_stiffness = {:.17g}
friction_angle_deg = {:.17g}
[output]
interval = {:.17g}
)",
                     s.duration, s.time_step > 0.0 ? fmt::format("{:.17g}", s.time_step) : "\"auto\"",
                     s.gravity.x, s.gravity.y, s.fidelity, s.damping, s.run_keys, rock_density,
                     s.youngs_modulus > 0.0
                         ? fmt::format("youngs_modulus = {:.17g}\npoissons_ratio = {:.17g}", s.youngs_modulus,
                                       s.poissons_ratio)
                         : "",
                     s.normal_stiffness, s.friction_deg,
                     s.interval > 0.0    ? s.interval
                     : s.time_step > 0.0 ? s.duration
                                         : s.duration / 100.0);
}

std::size_t row_of(const Simulation &simulation, int block) {
  const BlockSystem &blocks = simulation.blocks();
  for (std::size_t row = 0; row < blocks.num_rows(); ++row) {
    if (blocks.properties[row].id.value == block) {
      return row;
    }
  }
  throw std::runtime_error(fmt::format("no block {}", block));
}

const RigidDof &displacement_of(const Simulation &simulation, int block) {
  return simulation.blocks().displacement[row_of(simulation, block)];
}

const RigidDof &velocity_of(const Simulation &simulation, int block) {
  return simulation.blocks().velocity[row_of(simulation, block)];
}

void advance(Simulation &simulation, double time) {
  const double almost = time - 1e-6 * simulation.plan().time_step;
  while (!simulation.finished() && simulation.time() < almost) {
    simulation.step();
  }
}

double log_slope(const std::vector<double> &x, const std::vector<double> &y) {
  double sx = 0.0;
  double sy = 0.0;
  double sxx = 0.0;
  double sxy = 0.0;
  const auto n = static_cast<double>(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double u = std::log(x[i]);
    const double v = std::log(y[i]);
    sx += u;
    sy += v;
    sxx += u * u;
    sxy += u * v;
  }
  return (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

void run_stages(Simulation &simulation, void (*step)(Simulation &)) {
  while (true) {
    simulation.end_stage();
    if (simulation.finished()) {
      return;
    }
    if (simulation.stage_is_over()) {
      simulation.begin_next_stage();
    } else {
      step(simulation);
    }
  }
}

std::string without_duration(std::string toml) {
  const std::size_t begin = toml.find("duration = ");
  return toml.erase(begin, toml.find('\n', begin) - begin);
}

} // namespace gcpdda::testing
