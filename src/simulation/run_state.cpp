#include "simulation/run_state.hpp"

#include <algorithm>
#include <utility>

namespace gcpdda {

RunState::RunState(const Communicator &world, Scene given)
    : communicator(world), scene(std::move(given)), neighbours(world), contacts(contact_parameters(scene)),
      loads(scene), scheme(make_scheme(scene.run.scheme, scene.run.spectral_radius, scene.run.contact_time)) {
  first_reduction = communicator.reductions();
  clock.is_staged = !scene.stages.empty();
  clock.stages = std::move(scene.stages);
  if (!clock.is_staged) {
    clock.stages.resize(1);
    clock.stages.front().duration = scene.run.duration;
  }
}

ContactParameters contact_parameters(const Scene &scene) {
  return {scene.joints, scene.run.contact_damping, scene.run.potential, scene.run.rayleigh.stiffness_damping};
}

void refresh(RunState &run) {
  refresh(run, run.neighbours.remembered(run.blocks));
}

void refresh(RunState &run, ContactMemory memory) {
  const auto scope = run.phases.measure(Phase::refresh);
  run.bolts.share(run.communicator);
  run.digest.reset();
  run.contacts.forget_resting();
  // In pseudo-time no velocity says how far blocks go, and they slide farther than in a step.
  const double least_skin = (run.statics ? 2.0 : 1.0) * run.neighbours.base_skin;
  const std::int64_t left = run.neighbours.refresh(run.blocks, run.contacts.parameters(), run.bolts,
                                                   std::move(memory), least_skin, run.clock.plan.time_step);
  if (run.clock.step_count > 0) {
    run.counters.migrations += left;
    ++run.counters.refreshes;
  }
}

void rebalance_if_uneven(RunState &run) {
  constexpr std::int64_t steps_between_checks = 64;
  if (run.clock.step_count == 0 || run.clock.step_count % steps_between_checks != 0) {
    return;
  }
  const auto scope = run.phases.measure(Phase::refresh);
  if (run.neighbours.rebalance(run.blocks, run.counters.evaluations + run.counters.block_steps)) {
    ++run.counters.rebalances;
  }
}

const ContactDigest &contact_digest(RunState &run) {
  if (!run.digest) {
    run.digest.emplace().find(run.blocks, run.neighbours.candidates, run.neighbours.history, run.contacts);
  }
  return *run.digest;
}

double safe_motion(const RunState &run) {
  return std::min(0.5 * run.neighbours.skin, most_motion_in_step(run));
}

} // namespace gcpdda
