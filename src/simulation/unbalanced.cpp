#include "simulation/unbalanced.hpp"

#include "dynamics/deformable.hpp"
#include "simulation/step_rows.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

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

namespace {

/// The largest force of a contact on each owned row, N/m.
void find_contact_loads(RunState &run, std::vector<double> &loads) {
  loads.assign(run.blocks.num_owned, 0.0);
  const std::vector<CandidatePair> &pairs = run.neighbours.candidates.pairs;
  for_regions(run, 0, pairs.size(), [&](std::uint32_t pair, std::span<const RegionForce> regions) {
    for (const BlockIndex row : {pairs[pair].lower, pairs[pair].higher}) {
      for (const RegionForce &region : regions) {
        if (row.value < loads.size()) {
          loads[row.value] = std::max(loads[row.value], norm(region.force));
        }
      }
    }
  });
}

/// By what owned rows are measured, N/m. Where weight alone shows that a block is at rest, contacts on it are
/// not looked at.
/// @param largest     force anywhere, N/m
/// @param unbalanced  force of each owned row, N/m
std::span<const double> yardsticks(RunState &run, double largest, std::span<const double> unbalanced) {
  std::vector<double> &measures = run.yardsticks;
  measures.assign(run.blocks.num_owned, largest);
  const double tolerance = run.clock.stage().tolerance;
  const auto is_light = [&](std::size_t row) {
    const BlockProperties &block = run.blocks.properties[row];
    return !block.keeps_its_velocity() && most_times * acting_force(run, row) < largest &&
           block.heavy_mass() * norm(run.scene.run.gravity) > 0.0;
  };
  bool asks_contacts = false;
  for (std::size_t row = 0; row < measures.size(); ++row) {
    if (is_light(row)) {
      measures[row] = most_times * acting_force(run, row);
      asks_contacts = asks_contacts || unbalanced[row] > tolerance * measures[row];
    }
  }
  if (asks_contacts) {
    find_contact_loads(run, run.contact_loads);
    for (std::size_t row = 0; row < measures.size(); ++row) {
      if (measures[row] < largest && unbalanced[row] > tolerance * measures[row]) {
        measures[row] = std::min(largest, std::max(measures[row], most_times * run.contact_loads[row]));
      }
    }
  }
  return measures;
}

} // namespace

double measure_looks(RunState &run, double largest) {
  const std::span<const double> measures = yardsticks(run, largest, run.unbalanced_forces);
  double ratio = 0.0;
  for (std::size_t row = 0; row < run.blocks.num_owned && largest > 0.0; ++row) {
    run.looks[row].yardstick = measures[row];
    ratio = std::max(ratio, run.looks[row].unbalanced / measures[row]);
  }
  return run.communicator.max(ratio);
}

double unbalanced_ratio(RunState &run) {
  std::vector<double> &forces = run.unbalanced_forces;
  forces.assign(run.blocks.num_owned, 0.0);
  double acting = run.contacts.sums().largest_force();
  for (std::size_t row = 0; row < forces.size(); ++row) {
    if (!run.blocks.properties[row].keeps_its_velocity()) {
      forces[row] = unbalanced_force(run, row);
      acting = std::max(acting, acting_force(run, row));
    }
  }
  acting = run.communicator.max(acting);
  const std::span<const double> measures = yardsticks(run, acting, forces);
  double ratio = 0.0;
  for (std::size_t row = 0; row < forces.size() && acting > 0.0; ++row) {
    ratio = std::max(ratio, forces[row] / measures[row]);
  }
  return run.communicator.max(ratio);
}

} // namespace gcpdda
