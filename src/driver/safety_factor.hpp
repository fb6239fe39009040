#pragma once

// The factor of safety by strength reduction: friction (its tangent), cohesion and tension of the families of
// joints are divided by a factor, every time from the same settled state, until the blocks fail.
//
// Which factors are tried follows from the verdicts alone, never from how many trials run at once: first the
// two ends, then the middle of what lies between the largest factor that has settled and the smallest that
// has failed. Where there is no verdict at the upper end, the search comes down from there by halves until a
// trial fails. A trial without a verdict moves neither end of the bracket: what lies on both sides of it is
// narrowed down on its own, and the bracket keeps the stretch between. With ranks to spare the trials that
// would come next after either outcome run at the same time, each on its own ranks. A trial gives the same
// bits on any number of ranks, and so the factor is the same.

#include "gcpdda/base/exit_code.hpp"
#include "gcpdda/model/scene.hpp"
#include "gcpdda/parallel/communicator.hpp"
#include "io/results/safety_report.hpp"

#include <filesystem>
#include <functional>
#include <optional>
#include <string_view>
#include <vector>

namespace gcpdda {

struct SafetyOptions {
  std::filesystem::path directory;
  bool overwrite = false;
  bool quiet = false;                        ///< nothing but the runs is written, nothing is said
  std::int64_t fewest_blocks_per_rank = 500; ///< of a trial; below it another rank costs more than it saves
  /// The `settled` folder of an earlier search with the same scene but for [fos], [output], [ensemble] and
  /// monitors (scene_reader.hpp); empty to settle now.
  std::filesystem::path settled = {};
  bool only_bound = false; ///< no trials: the bound of limit analysis at the settled state (safety_bound.hpp)
  double settled_factor = 1.0; ///< what strengths were divided by then
};

struct SafetyOutcome {
  /// done: found within the tolerance; numerical_failure before the settled state; stopped by the signal;
  /// undecided: the scene does not settle, or the bracket is wider than asked for
  ExitCode exit_code = exit_code::done;
  SafetyReport report;
  std::string message; ///< why the search has not begun or has no bound; empty where there is an answer
};

/// Find the factor of a valid scene and write everything: `settled` (the run up to the end of the last settle
/// stage), `trials`, and the report. A scene without stages settles as with_settle_stage() says. One that
/// does not come to rest with its full strength begins from where it rests with the most that is tried, if
/// that is more. Collective.
/// @throws SceneError, FileError
SafetyOutcome search_safety_factor(const Communicator &communicator, const Scene &scene,
                                   const SafetyOptions &options);

/// Searches and returns SafetyOutcome::exit_code alone.
ExitCode find_safety_factor(const Communicator &communicator, const Scene &scene,
                            const SafetyOptions &options);

} // namespace gcpdda
