#include "simulation/time_plan.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace gcpdda::time_plan_test {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

struct Planned {
  TimePlan plan;
  Diagnostics notes;

  [[nodiscard]] int count(Severity severity) const {
    int count = 0;
    for (const Diagnostic &note : notes) {
      count += note.severity == severity ? 1 : 0;
    }
    return count;
  }
};

/// time_step 0 is "auto".
Planned plan(double duration, double interval, double time_step, double bound,
             double history_interval = 0.0) {
  RunSettings run;
  run.duration = duration;
  run.time_step = time_step;
  OutputSettings output;
  output.interval = interval;
  output.history_interval = history_interval > 0.0 ? history_interval : interval;
  Planned result;
  result.plan = plan_time(run, output, bound, result.notes);
  return result;
}

TEST(TimePlan, GivenStepIsUsedAsGiven) {
  for (const double step : {1e-3, 0.1 / 3.0, 0.1, 0.1 * (1.0 + 1e-12) / 7.0}) {
    const Planned p = plan(2.0, 0.1, step, 1.0);
    EXPECT_EQ(p.plan.time_step, step);
    EXPECT_TRUE(p.notes.empty());
    EXPECT_EQ(p.plan.steps_per_output, std::llround(0.1 / step));
    EXPECT_EQ(p.plan.num_steps, 20 * p.plan.steps_per_output);
  }
}

TEST(TimePlan, GivenStepThatDoesNotDivideIsLoweredOnce) {
  const Planned p = plan(2.0, 0.1, 0.03, 1.0);
  EXPECT_EQ(p.plan.time_step, 0.1 / 4.0);
  EXPECT_EQ(p.plan.steps_per_output, 4);
  ASSERT_EQ(p.count(Severity::info), 1);
  EXPECT_NE(p.notes[0].what.find("0.03"), std::string::npos);
  EXPECT_NE(p.notes[0].what.find("0.025"), std::string::npos);
  // Longer than the interval: one step an interval.
  const Planned longer = plan(2.0, 0.1, 5.0, infinity);
  EXPECT_EQ(longer.plan.time_step, 0.1);
  EXPECT_EQ(longer.count(Severity::info), 1);
}

TEST(TimePlan, AutomaticIsTheLargestThatMeetsTheBound) {
  for (const double bound : {0.09, 0.034, 1e-3, 1.234e-5, 0.05}) {
    const Planned p = plan(2.0, 0.1, 0.0, bound);
    const double n = 0.1 / p.plan.time_step;
    EXPECT_NEAR(n, std::round(n), 1e-9);
    EXPECT_LE(p.plan.time_step, bound * (1.0 + 1e-9));
    EXPECT_GT(0.1 / (std::round(n) - 1.0), bound) << "one step less would be too long";
    EXPECT_TRUE(p.notes.empty());
  }
  EXPECT_EQ(plan(2.0, 0.1, 0.0, 0.3).plan.time_step, 0.1);
  EXPECT_EQ(plan(2.0, 0.1, 0.0, infinity).plan.time_step, 0.1) << "nothing can touch";
}

TEST(TimePlan, BoundThatDividesUpToRoundingCostsNoStep) {
  EXPECT_EQ(plan(1.0, 0.1, 0.0, 0.1 / 3.0).plan.steps_per_output, 3);
  EXPECT_EQ(plan(1.0, 0.3, 0.0, 0.1).plan.steps_per_output, 3);
}

TEST(TimePlan, StepAboveTheBoundIsKeptAndWarnedAbout) {
  const Planned p = plan(1.0, 0.1, 0.05, 0.02);
  EXPECT_EQ(p.plan.time_step, 0.05);
  ASSERT_EQ(p.count(Severity::warning), 1);
  EXPECT_NE(p.notes[0].what.find("0.05"), std::string::npos);
  EXPECT_NE(p.notes[0].what.find("0.02"), std::string::npos);
  EXPECT_EQ(plan(1.0, 0.1, 0.02, 0.02).count(Severity::warning), 0);
}

// Times are products rounded once, so outputs fall on the decimal numbers of the scene.
TEST(TimePlan, TimesComeOutAsWritten) {
  const Planned p = plan(100.0, 0.1, 1e-3, 1.0);
  ASSERT_EQ(p.plan.num_steps, 100000);
  int off = 0;
  for (std::int64_t k = 0; k <= 1000; ++k) {
    const std::int64_t step = k * p.plan.steps_per_output;
    EXPECT_TRUE(p.plan.output_due(step));
    // One rounding each of the product and the decimal number k/10.
    EXPECT_NEAR(p.plan.time(step), static_cast<double>(k) / 10.0, 1e-15 * static_cast<double>(k) / 10.0);
    off += p.plan.output_due(step + 1) ? 1 : 0;
  }
  EXPECT_EQ(off, 0);
}

TEST(TimePlan, LastTimeIsTheDuration) {
  for (const double duration : {0.7, 1.0 / 3.0, 2.1, 1e5 * 0.1}) {
    for (const double interval : {duration / 7.0, duration / 100.0, duration}) {
      const Planned p = plan(duration, interval, 0.0, interval / 3.3);
      ASSERT_FALSE(has_errors(p.notes));
      EXPECT_EQ(p.plan.time(p.plan.num_steps), duration);
      EXPECT_TRUE(p.plan.output_due(p.plan.num_steps));
      EXPECT_TRUE(p.plan.history_due(p.plan.num_steps));
      EXPECT_LT(p.plan.time(p.plan.num_steps - 1), duration);
    }
  }
}

// A frame every 0.3 s and one at the end, at 1 s: steps divide both.
TEST(TimePlan, DurationNeedNotBeAMultipleOfTheInterval) {
  const Planned p = plan(1.0, 0.3, 0.0, 0.07);
  ASSERT_FALSE(has_errors(p.notes));
  EXPECT_LE(p.plan.time_step, 0.07);
  EXPECT_NEAR(static_cast<double>(p.plan.steps_per_output) * p.plan.time_step, 0.3, 1e-15);
  EXPECT_NEAR(static_cast<double>(p.plan.num_steps) * p.plan.time_step, 1.0, 4e-15);
  EXPECT_EQ(p.plan.time(p.plan.num_steps), 1.0);
  EXPECT_TRUE(p.plan.output_due(p.plan.num_steps));
  EXPECT_EQ(plan(0.05, 0.3, 0.0, infinity).plan.time(1), 0.05) << "an interval longer than the run";
}

TEST(TimePlan, HistoryMayBeFinerOrCoarserThanFrames) {
  const Planned finer = plan(1.0, 0.1, 0.0, 0.03, 0.02);
  EXPECT_EQ(finer.plan.time_step, 0.02);
  EXPECT_EQ(finer.plan.steps_per_output, 5);
  EXPECT_EQ(finer.plan.steps_per_history, 1);
  const Planned coarser = plan(1.0, 0.1, 0.0, 0.03, 0.5);
  EXPECT_EQ(coarser.plan.steps_per_output, 4);
  EXPECT_EQ(coarser.plan.steps_per_history, 20);
}

TEST(TimePlan, TellsOfAHistoryThatShortensTheStep) {
  const Planned shorter = plan(1.0, 0.1, 0.0, 0.03, 0.005);
  ASSERT_EQ(shorter.notes.size(), 1U);
  EXPECT_EQ(shorter.notes[0].severity, Severity::info);
  const Planned tiny = plan(1.0, 0.1, 0.0, 5e-4, 1e-6);
  EXPECT_EQ(tiny.plan.time_step, 1e-6);
  ASSERT_EQ(tiny.notes.size(), 1U);
  EXPECT_EQ(to_string(tiny.notes[0]),
            "warning: output.history_interval = 1e-06 s shortens the time step to 1e-06 s, every row of a "
            "history falls on a step, the run takes 500 times more steps than with 0.0005 s, try a longer "
            "history_interval, such as 0.1");
  // A step that is given, that is hardly shortened, or that frames ask for, too.
  EXPECT_TRUE(plan(1.0, 0.1, 1e-6, 5e-4, 1e-6).notes.empty());
  EXPECT_TRUE(plan(1.0, 0.1, 0.0, 5e-4, 4e-4).notes.empty());
  EXPECT_TRUE(plan(1.0, 1e-6, 0.0, 5e-4, 1e-6).notes.empty());
  EXPECT_TRUE(plan(1.0, 1e-6, 0.0, 5e-4, 0.1).notes.empty());
}

TEST(TimePlan, IncommensurableTimesAreAnError) {
  const Planned p = plan(1.0, 1.0 / std::sqrt(2.0), 0.0, 0.1);
  ASSERT_EQ(p.count(Severity::error), 1);
  EXPECT_NE(p.notes[0].what.find("duration"), std::string::npos);
  EXPECT_FALSE(p.notes[0].hint.empty());
}

// A stage of 0.13 s with frames every 0.0013 s goes on to a limit of 5 s: 5 s are no multiple of the
// interval, and a common part of both would ask for another step. The limit comes at the next frame instead.
TEST(TimePlan, KeepsTheStepWhereALimitGrows) {
  const OutputSettings output{0.0013, 0.0013, 0.0, true};
  constexpr double bound = 4.5e-4;
  RunSettings run;
  run.duration = 0.13;
  Diagnostics notes;
  const TimePlan before = plan_time(run, output, bound, notes);
  run.duration = 5.0;
  const TimePlan planned = plan_time(run, output, bound, notes);
  ASSERT_NE(planned.time_step, before.time_step);
  const TimePlan plan = plan_with_step(before.time_step, 0.13, true, run, output, bound, planned);
  EXPECT_EQ(plan.time_step, before.time_step);
  EXPECT_NEAR(plan.duration, 5.0, 0.0013);
  EXPECT_GE(plan.duration, 5.0);
  EXPECT_EQ(step_to_go_on_from(plan, 0.13, before.time_step, notes), before.num_steps);
  EXPECT_FALSE(has_errors(notes));
  const TimePlan shorter = plan_with_step(before.time_step, 0.13, true, run, output, 2e-4, planned);
  EXPECT_EQ(shorter.time_step, planned.time_step) << "the old step lies above the bound";
}

} // namespace
} // namespace gcpdda::time_plan_test
