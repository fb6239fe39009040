#include "simulation/evaluation.hpp"

namespace gcpdda {

void evaluate_group(RunState &run, const PairGroup &group) {
  const auto scope = run.phases.measure(Phase::forces);
  run.contacts.evaluate_group(run.blocks, run.neighbours.candidates, run.neighbours.history, group);
}

void progress_messages(RunState &run) {
  const auto scope = run.phases.measure(Phase::ghosts);
  run.neighbours.ghosts.progress();
}

void receive_ghosts(RunState &run) {
  const auto scope = run.phases.measure(Phase::ghosts);
  run.neighbours.ghosts.finish(run.blocks);
}

namespace {

void take_report(RunState &run, const ForceReport &report) {
  run.force_report = report;
  run.digest.reset();
  if (report.fault) {
    keep_first(run.local_fault, *report.fault);
  }
}

void evaluate_bolts(RunState &run) {
  if (!run.bolts.empty()) {
    run.bolts.evaluate(run.blocks);
  }
}

} // namespace

void evaluate_border(RunState &run) {
  const auto scope = run.phases.measure(Phase::forces);
  take_report(run,
              run.contacts.evaluate_border(run.blocks, run.neighbours.candidates, run.neighbours.history));
  evaluate_bolts(run);
  run.bolts.note_largest();
}

void evaluate_all(RunState &run) {
  take_report(run, run.contacts.evaluate(run.blocks, run.neighbours.candidates, run.neighbours.history));
  evaluate_bolts(run);
}

void evaluate_still(RunState &run) {
  forget_increments(run.blocks);
  evaluate_all(run);
}

void sum_forces(RunState &run) {
  const auto scope = run.phases.measure(Phase::forces);
  run.contact_count = run.contacts.finish_sums(run.blocks, run.neighbours.candidates);
  run.contacts.add_opening_works(run.neighbours.candidates, run.blocks);
  run.bolts.add_forces(run.blocks, run.contacts.sums().of_blocks());
}

} // namespace gcpdda
