#include "simulation/time_plan.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace gcpdda {

namespace {

/// Ratios closer than this to a whole number count as whole.
constexpr double whole = 1e-9;

bool is_whole(double ratio) {
  return std::abs(ratio - std::round(ratio)) <= whole * std::max(1.0, ratio);
}

/// Steps of at most `wanted` that fill `stretch`.
double steps_in(double stretch, double wanted) {
  const double ratio = stretch / wanted;
  return std::max(1.0, is_whole(ratio) ? std::round(ratio) : std::ceil(ratio));
}

void plan_checkpoints(double interval, TimePlan &plan, Diagnostics &notes) {
  if (interval <= 0.0) {
    return;
  }
  const double count = interval / plan.time_step;
  plan.steps_per_checkpoint = static_cast<std::int64_t>(std::min(std::max(1.0, std::round(count)), 1e18));
  if (!is_whole(count)) {
    notes.push_back({Severity::info,
                     {},
                     fmt::format("checkpoints are written every {:g} s, not every {:g} s",
                                 static_cast<double>(plan.steps_per_checkpoint) * plan.time_step, interval),
                     "they fall on whole steps",
                     ""});
  }
}

/// Tells of an interval of the histories that shortens the automatic step.
void doubt_history_interval(const RunSettings &run, OutputSettings output, double bound, const TimePlan &plan,
                            Diagnostics &notes) {
  constexpr double tells = 2.0; // times more steps
  constexpr double warns = 10.0;
  if (run.time_step > 0.0 || output.history_interval >= output.interval) {
    return;
  }
  const double asked = output.history_interval;
  output.history_interval = output.interval;
  Diagnostics unsaid;
  const double without = plan_time(run, output, bound, unsaid).time_step;
  const double ratio = without / plan.time_step;
  if (ratio >= tells) {
    notes.push_back(
        {ratio >= warns ? Severity::warning : Severity::info,
         {},
         fmt::format("output.history_interval = {:g} s shortens the time step to {:g} s", asked,
                     plan.time_step),
         fmt::format("every row of a history falls on a step, the run takes {:.0f} times more steps "
                     "than with {:g} s",
                     ratio, without),
         fmt::format("try a longer history_interval, such as {:g}", output.interval)});
  }
}

} // namespace

TimePlan plan_time(const RunSettings &run, const OutputSettings &output, double bound, Diagnostics &notes) {
  // Every output, history row and the end must fall on a whole number of `unit`.
  double unit = std::min(output.interval, output.history_interval);
  constexpr int most_parts = 1000;
  int parts = 1;
  while (parts <= most_parts && !is_whole(run.duration / (unit / parts))) {
    ++parts;
  }
  if (parts > most_parts) {
    notes.push_back({Severity::error,
                     {},
                     fmt::format("run.duration = {:g} s and output.interval = {:g} s have no common step",
                                 run.duration, output.interval),
                     "the last frame must fall on the end of the run exactly",
                     "make the duration a multiple of the interval"});
    return {};
  }
  unit /= parts;

  TimePlan plan;
  plan.duration = run.duration;
  const bool automatic = run.time_step <= 0.0;
  const double wanted = automatic ? std::min(bound, unit) : run.time_step;
  const double count = steps_in(unit, wanted);
  plan.unit = unit;
  plan.steps_per_unit = std::llround(count);
  plan.time_step = unit / count;
  if (!automatic && is_whole(unit / wanted) && wanted <= unit * (1.0 + whole)) {
    plan.time_step = run.time_step;
  } else if (!automatic) {
    notes.push_back(
        {Severity::info,
         {},
         fmt::format("the time step is lowered from {:g} s to {:g} s", run.time_step, plan.time_step),
         "the given one does not divide the output interval",
         ""});
  }
  if (plan.time_step > bound * (1.0 + whole)) {
    notes.push_back(
        {Severity::warning,
         {},
         fmt::format("the time step {:g} s is above the recommended {:g} s", plan.time_step, bound),
         "contacts may gain energy or pass through each other",
         "lower run.time_step or set it to \"auto\""});
  }
  const auto steps = [&](double stretch) {
    return static_cast<std::int64_t>(std::llround(stretch / plan.time_step));
  };
  plan.num_steps = steps(run.duration);
  plan.steps_per_output = steps(output.interval);
  plan.steps_per_history = steps(output.history_interval);
  doubt_history_interval(run, output, bound, plan, notes);
  plan_checkpoints(output.checkpoint_interval, plan, notes);
  return plan;
}

TimePlan plan_with_step(double time_step, double time, bool may_be_longer, RunSettings run,
                        const OutputSettings &output, double bound, const TimePlan &planned) {
  const bool is_given = run.time_step > 0.0;
  const bool fits = planned.time_step >= time_step && is_whole(time / planned.time_step);
  if (is_given || !(planned.time_step > 0.0) || fits || time_step > bound * (1.0 + whole)) {
    return planned;
  }
  run.time_step = time_step;
  if (may_be_longer) {
    run.duration = output.interval * steps_in(run.duration, output.interval);
  }
  Diagnostics unsaid;
  const TimePlan plan = plan_time(run, output, bound, unsaid);
  return plan.time_step == time_step ? plan : planned;
}

std::int64_t step_to_go_on_from(const TimePlan &plan, double time, double time_step, Diagnostics &notes) {
  if (!(plan.time_step > 0.0)) {
    return 0; // a plan with faults of its own
  }
  const double count = time / plan.time_step;
  if (!is_whole(count)) {
    notes.push_back(
        {Severity::error,
         {},
         fmt::format("the checkpoint at t = {} s is between two steps of {} s", time, plan.time_step),
         fmt::format("it was made with steps of {} s", time_step),
         fmt::format("set run.time_step to a whole part of t, for example {}", time / std::ceil(count))});
    return 0;
  }
  if (std::abs(plan.time_step / time_step - 1.0) > whole) {
    notes.push_back({Severity::warning,
                     {},
                     fmt::format("the time step changes from {:g} s to {:g} s", time_step, plan.time_step),
                     "the step across the change is of neither length, and the energies may jump there by "
                     "O(dt^2)",
                     "set run.time_step to the old one for the same results"});
  }
  return std::llround(count);
}

} // namespace gcpdda
