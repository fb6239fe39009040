#include "gcpdda/dynamics/integrate.hpp"

#include <cmath>

namespace gcpdda {

namespace {

bool is_finite(const RigidDof &a) {
  return std::isfinite(a.u.x) && std::isfinite(a.u.y) && std::isfinite(a.r);
}

} // namespace

void predict(BlockSystem &system, const Scheme &scheme, double time_step) {
  const double by_velocity = scheme.trial_velocity * time_step;
  const double by_acceleration = scheme.trial_acceleration * time_step * time_step;
  for (std::size_t i = 0; i < system.num_owned; ++i) {
    system.trial_previous[i] = system.trial[i];
    system.trial[i] = system.displacement[i] +
                      (by_velocity * system.velocity[i] + by_acceleration * system.acceleration[i]);
  }
  pose(system, 0, system.num_owned);
}

std::optional<std::size_t> solve_and_update(BlockSystem &system, std::span<const RigidDof> forces,
                                            const Scheme &scheme, double time_step) {
  std::optional<std::size_t> broken;
  for (std::size_t i = 0; i < system.num_owned; ++i) {
    const RigidDof a = system.acceleration[i];
    const RigidDof a_new =
        (1.0 / (1.0 - scheme.alpha_m)) * (accelerate(system.properties[i], forces[i]) - scheme.alpha_m * a);
    const RigidDof d_new =
        system.displacement[i] + (time_step * system.velocity[i] +
                                  time_step * time_step * ((0.5 - scheme.beta) * a + scheme.beta * a_new));
    const RigidDof v_new = system.velocity[i] + time_step * ((1.0 - scheme.gamma) * a + scheme.gamma * a_new);
    if (!is_finite(a_new) || !is_finite(v_new) || !is_finite(d_new)) {
      broken = broken.value_or(i);
      continue;
    }
    system.acceleration[i] = a_new;
    system.displacement[i] = d_new;
    system.velocity[i] = v_new;
  }
  return broken;
}

} // namespace gcpdda
