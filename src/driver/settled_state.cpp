#include "driver/settled_state.hpp"

#include "driver/run_facts.hpp"
#include "driver/safety_search.hpp"
#include "driver/trial_facts.hpp"
#include "simulation/rank_facts.hpp"
#include "simulation/simulation.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <iostream>

namespace gcpdda {

void say(const Communicator &world, const SafetyOptions &options, const std::string &text) {
  if (world.is_root() && !options.quiet) {
    std::cerr << text << std::flush;
  }
}

std::filesystem::path SettledState::directory() const {
  return options_.settled.empty() ? options_.directory / "settled" : options_.settled;
}

ExitCode SettledState::find(const std::function<void()> &prepare) {
  if (options_.settled.empty()) {
    return settle_as_it_can(prepare);
  }
  const ExitCode code = take();
  if (code == exit_code::done) {
    on_root(world_, prepare);
  } else {
    say(world_, options_, message_ + "\n");
  }
  return code;
}

// Blocks that fail on the way have failed at that factor.
ExitCode SettledState::settle_as_it_can(const std::function<void()> &prepare) {
  ExitCode code = settle(1.0, options_.overwrite, prepare);
  note_failure();
  const double from = scene_.reduction.from;
  if ((code == exit_code::done || code == exit_code::undecided) && !has_settled() && from < 1.0) {
    say(world_, options_,
        fmt::format("the blocks {} with their full strength, now with their strengths divided by fos.from = "
                    "{:g}\n",
                    run_.rests_far ? "slide by more than fos.largest_motion while they settle"
                                   : "do not settle",
                    from));
    code = settle(from, true, {});
    note_failure();
  }
  if (code == exit_code::done && !has_settled()) {
    code = exit_code::undecided;
  }
  if (code == exit_code::undecided) {
    message_ = words_on_no_rest(run_, scene_);
    run_.message = message_;
    say(world_, options_, message_ + "\n");
  }
  return code;
}

ExitCode SettledState::settle(double factor, bool overwrite, const std::function<void()> &prepare) {
  RunOptions options{directory(), overwrite, false, {}, options_.quiet};
  options.prepare = prepare;
  const RunOutcome outcome = run_and_tell(world_, settling_scene(scene_, factor), options);
  run_ = trial_of(facts_of(factor, outcome, 0.0, false));
  run_.steps = outcome.summary.steps;
  note_slides(outcome.summary.stages);
  end_time_ = outcome.summary.time;
  num_blocks_ = outcome.summary.blocks;
  message_ = outcome.exit_code == exit_code::numerical_failure ? outcome.summary.message : std::string();
  return outcome.exit_code;
}

/// The state that an earlier search has settled; of no cost to this one.
ExitCode SettledState::take() {
  const Simulation found(world_, settling_scene(scene_, options_.settled_factor), {options_.settled});
  num_blocks_ = found.num_blocks();
  end_time_ = found.time();
  run_.factor = options_.settled_factor;
  run_.verdict = found.finished() ? found.stage().verdict : Verdict::undecided;
  run_.time = found.time();
  run_.steps = found.step_count();
  note_slides(stage_lines(found.scene(), found.stages(), found.stage().results));
  if (has_settled()) {
    return exit_code::done;
  }
  message_ = run_.rests_far
                 ? fmt::format("the blocks of the run in {} slid by {:.2g} of their size while they settled, "
                               "more than fos.largest_motion = {:g}; leave --settled out",
                               options_.settled.string(), slide_, scene_.reduction.largest_motion)
                 : fmt::format("the run in {} has not settled, let it go on (gcpdda restart) or leave "
                               "--settled out",
                               options_.settled.string());
  return exit_code::undecided;
}

// What blocks slide before the search is as far from where they were as what they slide in a trial. Of a
// mechanism it is not known: the slide is that of any block.
void SettledState::note_slides(const std::vector<RunSummary::StageLine> &stages) {
  slides_ = slides_of(stages);
  slide_ = 0.0;
  for (const RunSummary::StageLine &stage : stages) {
    slide_ = std::max(slide_, stage.result.slide);
  }
  if (has_settled() && !watches_mechanism(scene_.reduction) && slide_ >= scene_.reduction.largest_motion) {
    run_.rests_far = true;
    run_.verdict = Verdict::failed;
  }
}

void SettledState::note_failure() {
  if (has_failed()) {
    fails_ = run_.factor;
  }
}

} // namespace gcpdda
