#include "simulation/simulation.hpp"

#include "simulation/evaluation.hpp"
#include "simulation/stage_runner.hpp"
#include "simulation/static_stage.hpp"

#include <utility>

namespace gcpdda {

Simulation::Simulation(const Communicator &communicator, Scene scene, const Beginning &beginning)
    : run_(communicator, std::move(scene)), rows_(run_) {
  start(run_, beginning);
}

void Simulation::step() {
  if (is_static(run_)) {
    prepare_statics(run_);
  }
  if (is_static(run_)) { // it has not been left
    static_step(run_);
    return;
  }
  rebalance_if_uneven(run_);
  if (run_.neighbours.stale) { // some block may use up half the skin in this step; all ranks agree
    refresh(run_);
  }
  weaken_further(run_);
  rows_.begin();
  rows_.send_border_trials();
  for (const PairGroup &group : run_.neighbours.candidates.groups) { // blocks stay in the cache
    rows_.predict_to(group.rows_read);
    evaluate_group(run_, group);
    progress_messages(run_);
    rows_.advance_to(group.rows_finished);
  }
  receive_ghosts(run_);
  evaluate_border(run_);
  sum_forces(run_);
  rows_.advance_remaining();
  ++run_.clock.step_count;
  rows_.prescribe_motion();
  judge_stage(run_);
  report_step(run_, rows_.report());
}

} // namespace gcpdda
