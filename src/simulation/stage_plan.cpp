#include "simulation/stage_plan.hpp"

#include "simulation/stages.hpp"
#include "statics/pseudo_time.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <limits>

namespace gcpdda {

std::int64_t steps_of_weakening(const RunState &run) {
  return std::ssize(run.clock.stage().weakening) * steps_between_verdicts(num_blocks(run.scene));
}

// What cannot be run is told before anything is.
void plan_all_stages(RunState &run) {
  for (const Stage &stage : run.clock.stages) {
    if (run.clock.is_staged && stage.takes_steps()) {
      RunSettings settings = run.scene.run;
      settings.duration = stage.duration;
      Diagnostics found;
      plan_time(settings, run.scene.output, std::numeric_limits<double>::infinity(), found);
      for (Diagnostic &d : found) {
        if (d.severity == Severity::error) { // the one that there is, in the words of a stage
          d.where = stage.where;
          d.what = fmt::format("stage '{}' of {:g} s and output.interval = {:g} s have no common step",
                               stage.name, stage.duration, run.scene.output.interval);
          d.hint = "make its duration or limit a multiple of the interval";
          run.notes.push_back(std::move(d));
        }
      }
    }
  }
}

namespace {

// The limit of the stage comes where the iteration may pause, because a restart may go on from there: after n
// steps it has found n + 1 motions. What it has used up does not count for the damped motion that goes on.
void lengthen_for_statics(RunState &run) {
  constexpr std::int64_t every = statics::IterationRules{}.coarse_every;
  run.clock.plan.lengthen(every - 1 - run.clock.plan.num_steps % every);
  if (run.clock.state.iteration.is_left != 0) {
    run.clock.plan.lengthen(run.clock.state.iteration.evaluations);
  }
}

RunSettings settings_of_stage(const RunState &run) {
  const Stage &stage = run.clock.stage();
  RunSettings settings = run.scene.run;
  settings.duration = stage.takes_steps() ? stage.duration : run.scene.output.interval;
  return settings;
}

/// Notes that have not been given yet.
void note_once(RunState &run, const Diagnostics &notes) {
  for (const Diagnostic &note : notes) {
    if (std::none_of(run.notes.begin(), run.notes.end(),
                     [&](const Diagnostic &given) { return given.what == note.what; })) {
      run.notes.push_back(note);
    }
  }
}

} // namespace

void plan_stage(RunState &run) {
  const Stage &stage = run.clock.stage();
  const RunSettings settings = settings_of_stage(run);
  Diagnostics found;
  run.clock.plan = plan_time(settings, run.scene.output, run.bound.time_step, found);
  const bool steps_dynamically =
      stage.takes_steps() && (stage.solver == Solver::dynamic || run.clock.state.iteration.is_left != 0);
  std::erase_if(
      found, [&](const Diagnostic &note) { return note.severity != Severity::error && !steps_dynamically; });
  note_once(run, found);
  if (run.restored && run.clock.step_count == 0 && !run.clock.state.ended) { // it goes on in the middle
    const RunFacts &facts = run.restored->facts;
    run.clock.plan = plan_with_step(
        facts.time_step, facts.time - run.clock.state.start_time - run.clock.state.iteration.skipped,
        stage.until_verdict, settings, run.scene.output, run.bound.time_step, run.clock.plan);
  }
  if (!stage.takes_steps()) {
    run.clock.plan.duration = 0.0;
    run.clock.plan.num_steps = 0;
  }
  run.clock.plan.lengthen(steps_of_weakening(run));
  if (stage.solver == Solver::statics) {
    lengthen_for_statics(run);
  }
  run.local_damping = stage.local_damping_or(run.scene.run.local_damping);
}

void note_plan(RunState &run) {
  Diagnostics found;
  plan_time(settings_of_stage(run), run.scene.output, run.bound.time_step, found);
  note_once(run, found);
}

} // namespace gcpdda
