#pragma once

// The steps of a run and when its outputs are due.

#include "gcpdda/base/diagnostic.hpp"
#include "gcpdda/model/scene.hpp"

#include <cstdint>

namespace gcpdda {

/// The steps of a run. The step is constant, outputs fall on whole steps, times are counts times the step.
struct TimePlan {
  double time_step = 0.0; ///< s
  double duration = 0.0;  ///< s
  double unit = 0.0;      ///< s, what every output time is a whole number of
  std::int64_t steps_per_unit = 1;
  std::int64_t num_steps = 0;
  std::int64_t steps_per_output = 1;
  std::int64_t steps_per_history = 1;
  std::int64_t steps_per_checkpoint = 0; ///< 0 for none

  [[nodiscard]] double time(std::int64_t step) const {
    // Rounded once: output times come out as written in the scene.
    return step == num_steps ? duration
                             : static_cast<double>(step) * unit / static_cast<double>(steps_per_unit);
  }
  [[nodiscard]] bool output_due(std::int64_t step) const {
    return step % steps_per_output == 0 || step == num_steps;
  }
  [[nodiscard]] bool history_due(std::int64_t step) const {
    return step % steps_per_history == 0 || step == num_steps;
  }
  [[nodiscard]] bool checkpoint_due(std::int64_t step) const {
    return steps_per_checkpoint > 0 && step > 0 && (step % steps_per_checkpoint == 0 || step == num_steps);
  }
  /// Put `more` steps at its end.
  void lengthen(std::int64_t more) {
    if (more > 0) {
      duration = static_cast<double>(num_steps + more) * unit / static_cast<double>(steps_per_unit);
      num_steps += more;
    }
  }
};

/// Choose the step: the scene's, lowered once if it does not divide the output intervals; or the largest that
/// divides them and meets the bound.
///
/// @param bound  largest recommended step (s), infinite where forces move no block
/// @param notes  gets a warning when the scene's step lies above the bound or the interval of the histories
///               makes the automatic one far shorter, an info when it was lowered or when checkpoints fall on
///               other times than asked for, an error when duration and intervals have no common step
TimePlan plan_time(const RunSettings &run, const OutputSettings &output, double bound, Diagnostics &notes);

/// A plan with the step of a run that goes on at a time (s), where the step of `planned` is smaller or none
/// of its steps falls on that time; `planned` where the old step does not divide the intervals or lies above
/// the bound.
/// @param may_be_longer  the duration is a limit, which may end up to an interval later
TimePlan plan_with_step(double time_step, double time, bool may_be_longer, RunSettings run,
                        const OutputSettings &output, double bound, const TimePlan &planned);

/// The step at which a run goes on that has reached `time` (s) with steps of `time_step` (s).
///
/// @param notes  gets a warning where the plan's step is another one, an error where none of its steps falls
/// on
///               that time
std::int64_t step_to_go_on_from(const TimePlan &plan, double time, double time_step, Diagnostics &notes);

} // namespace gcpdda
