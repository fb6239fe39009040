#pragma once

// Where a run stands in time and in its stages.

#include "gcpdda/model/scene.hpp"
#include "simulation/stages.hpp"
#include "simulation/time_plan.hpp"

#include <cstdint>
#include <vector>

namespace gcpdda {

struct StageClock {
  std::vector<Stage> stages; ///< at least one
  bool is_staged = false;    ///< the scene has stages; else all of the run is one stage
  StageState state;
  TimePlan plan; ///< of the stage
  std::int64_t step_count = 0;

  [[nodiscard]] const Stage &stage() const { return stages[static_cast<std::size_t>(state.index)]; }
  /// Steps since the stage began: what the plan counts.
  [[nodiscard]] std::int64_t stage_step() const { return step_count - state.first_step; }
  [[nodiscard]] double time() const {
    return state.ended ? state.end_time
                       : state.start_time + state.iteration.skipped + plan.time(stage_step());
  }
  [[nodiscard]] bool stage_is_over() const { return state.ended || stage_step() >= plan.num_steps; }
  /// No stage follows, or the next one must not begin.
  [[nodiscard]] bool is_finished() const {
    if (!stage_is_over() || state.index + 1 == std::ssize(stages)) {
      return stage_is_over();
    }
    const bool follows = stages[static_cast<std::size_t>(state.index + 1)].goes_on_failing;
    return stage().until_verdict && state.verdict != (follows ? Verdict::failed : Verdict::settled);
  }
};

} // namespace gcpdda
