#include "simulation/held_blocks.hpp"

#include "dynamics/deformable.hpp"
#include "simulation/stage_runner.hpp"
#include "simulation/static_stage.hpp"
#include "simulation/unbalanced.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace gcpdda {

double held_ratio(const Stage &stage) {
  return (stage.begins_at_rest ? 0.01 : 0.1) * stage.tolerance;
}

double held_force(const RunState &run) {
  const Stage &stage = run.clock.stage();
  const bool holds = run.clock.is_staged && stage.asks_for_rest() && !is_static(run);
  return holds ? held_ratio(stage) * run.clock.state.memory.last.force : 0.0;
}

double held_share(const RunState &run) {
  return most_times * held_ratio(run.clock.stage()) * norm(run.scene.run.gravity);
}

bool is_held_by(const BlockProperties &block, double force, double of_all, double share) {
  return force <= of_all && (share == 0.0 || force <= share * block.heavy_mass());
}

bool is_at_rest(const BlockSystem &blocks, std::size_t row) {
  if (blocks.velocity[row] != RigidDof{} || blocks.acceleration[row] != RigidDof{}) {
    return false;
  }
  return !blocks.is_deformable(row) ||
         (blocks.deformation_of(row).rate == Mat2{} && blocks.deformation_of(row).acceleration == Mat2{});
}

double net_force(const BlockSystem &blocks, std::size_t row) {
  const RigidDof force = blocks.contact[row].force + blocks.anchor_force(row);
  const double turning = blocks.is_deformable(row) ? norm(unbalanced_on_gradient(blocks.deformation_of(row)))
                                                   : std::abs(force.r);
  return std::max(norm(force.u), turning / blocks.properties[row].radius);
}

void hold(BlockSystem &blocks, std::size_t row) {
  blocks.displacement[row] = blocks.trial[row];
  if (blocks.is_deformable(row)) {
    blocks.deformation_of(row).gradient = blocks.deformation_of(row).trial;
  }
  set_to_rest(blocks, row);
}

void hold_at_look(RunState &run) {
  constexpr double held_motion = 1e-6;
  constexpr std::int64_t most = 10; // times as many blocks are there
  const double force = held_force(run);
  if (!(force > 0.0)) {
    return;
  }
  const double motion = held_motion * run.clock.state.memory.last.overlap;
  const double share = held_share(run);
  const auto hardly_moves = [&](std::size_t row) {
    return is_held_by(run.blocks.properties[row], run.looks[row].unbalanced, force, share) &&
           run.looks[row].motion <= motion;
  };
  std::array<std::int64_t, 2> counts{};
  auto &[moving, mobile] = counts;
  for (std::size_t row = 0; row < run.blocks.num_owned; ++row) {
    if (!run.blocks.properties[row].keeps_its_velocity()) {
      ++mobile;
      moving += hardly_moves(row) ? 0 : 1;
    }
  }
  run.communicator.sum(counts);
  const bool few_move = most * moving <= mobile;
  run.contacts.leave_out_resting(few_move);
  if (!few_move) {
    return;
  }
  for (std::size_t row = 0; row < run.blocks.num_owned; ++row) {
    if (!run.blocks.properties[row].keeps_its_velocity() && hardly_moves(row) &&
        !is_at_rest(run.blocks, row)) {
      stop(run, row);
    }
  }
}

void hold_after_statics(RunState &run) {
  const double force = held_force(run);
  const double share = held_share(run);
  for (std::size_t row = 0; row < run.blocks.num_owned; ++row) {
    const BlockProperties &block = run.blocks.properties[row];
    if (!block.keeps_its_velocity() && is_held_by(block, net_force(run.blocks, row), force, share)) {
      set_to_rest(run.blocks, row);
    }
  }
  run.contacts.leave_out_resting(true);
}

} // namespace gcpdda
