#pragma once

// What the groups of ranks that search for a factor of safety tell each other of their trials.

#include "gcpdda/driver/run.hpp"
#include "gcpdda/model/scene.hpp"
#include "io/results/safety_report.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace gcpdda {

/// Of one trial, as it is sent.
struct TrialFacts {
  double factor = 0.0;
  std::int64_t verdict = 0;
  std::int64_t first_block = 0; ///< the verdict on any block
  std::int64_t means = 0;
  std::int64_t is_confirmed = 0;    ///< by a stage of its own
  std::int64_t rests_far = 0;       ///< has settled, but farther than fos.largest_motion
  std::int64_t first_rests_far = 0; ///< the same for any block
  double time = 0.0;
  double moved = 0.0;
  double slide = 0.0; ///< StageResult::slide
  double unbalanced_ratio = 0.0;
  std::int64_t steps = 0;
  std::int64_t evaluations = 0;
  double cpu_s = 0.0;
  std::int64_t ranks = 0;
  std::int64_t exit_code = exit_code::done;
};

/// @param start_time  of all trials, s
/// @param watches  the verdict is that of a part of the blocks
TrialFacts facts_of(double factor, const RunOutcome &outcome, double start_time, bool watches);

/// The static solver has found the verdict, and no dynamic step has confirmed it.
bool is_by_statics_alone(const TrialFacts &facts);

/// Of the settle stages whose blocks have slid so far that users are told.
std::vector<EarlierSlide> slides_of(const std::vector<RunSummary::StageLine> &stages);

/// Why no search begins where the blocks do not settle with the largest strength tried.
/// @param scene  that of the search
std::string words_on_no_rest(const StrengthTrial &settled, const Scene &scene);

/// Without its message and its folder.
StrengthTrial trial_of(const TrialFacts &facts);

} // namespace gcpdda
