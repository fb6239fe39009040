#include "simulation/unbalanced.hpp"

#include "dynamics/deformable.hpp"
#include "simulation/step_rows.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace gcpdda {

namespace {

/// A component of a force before local damping took its share: f (1 - share sign(f) sign(v)).
double undamped(double force, double velocity, double share) {
  const double sign = force * velocity > 0.0 ? 1.0 : force * velocity < 0.0 ? -1.0 : 0.0;
  return force / (1.0 - share * sign);
}

// What local damping of the last evaluation acted against, to a positive factor.
RigidDof damped_motion(const RunState &run, std::size_t row) {
  return run.blocks.is_deformable(row)
             ? next_trial(run.blocks, run.scheme, run.clock.plan.time_step, row).motion -
                   run.blocks.trial[row] + run.blocks.motion[row].increment()
             : run.blocks.velocity[row];
}

} // namespace

double unbalanced_force(const RunState &run, std::size_t row) {
  const RigidDof v = damped_motion(run, row);
  const RigidDof force = run.blocks.contact[row].force + run.blocks.anchor_force(row);
  const double along_x = undamped(force.u.x, v.u.x, run.local_damping);
  const double along_y = undamped(force.u.y, v.u.y, run.local_damping);
  const double turning = run.blocks.is_deformable(row)
                             ? norm(unbalanced_on_gradient(run.blocks.deformation_of(row)))
                             : std::abs(undamped(force.r, v.r, run.local_damping));
  return std::max(norm(Vec2{along_x, along_y}), turning / run.blocks.properties[row].radius);
}

double acting_force(const RunState &run, std::size_t row) {
  const double weight = run.blocks.properties[row].heavy_mass() * norm(run.scene.run.gravity);
  return std::max(weight, norm(applied_forces(run.blocks, row).load.u));
}

double unbalanced_ratio(const RunState &run) {
  std::array<double, 2> largest{0.0, run.contacts.sums().largest_force()};
  auto &[unbalanced, acting] = largest;
  for (std::size_t row = 0; row < run.blocks.num_owned; ++row) {
    if (!run.blocks.properties[row].keeps_its_velocity()) {
      unbalanced = std::max(unbalanced, unbalanced_force(run, row));
      acting = std::max(acting, acting_force(run, row));
    }
  }
  run.communicator.max(largest);
  return acting > 0.0 ? unbalanced / acting : 0.0;
}

} // namespace gcpdda
