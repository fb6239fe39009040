#pragma once

// Which factors are tried, and the scene of a trial.

#include "gcpdda/model/scene.hpp"
#include "io/results/safety_report.hpp"

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace gcpdda {

/// Verdict of the trial at a factor; none where it has not run.
using TrialVerdicts = std::function<std::optional<Verdict>(double factor)>;

/// What a search is about. It begins with the strengths of the settled state where that is one of its
/// factors, and goes up from there by 15 to 30 % at a time.
struct SearchRange {
  StrengthReduction reduction;
  double settled = 1.0; ///< what strengths are divided by in the settled state
};

/// Where a search stands.
struct SafetySearch {
  std::optional<double> next; ///< the factor to try; none at the end
  std::optional<double> holds;
  std::optional<double> fails;
  std::vector<double> undecided; ///< between these two, ascending
  std::vector<double> decisive;  ///< what all this rests on, in the order they were asked for
};
SafetySearch follow(const SearchRange &range, const TrialVerdicts &verdicts);

/// The next factor and those that would follow it after either outcome, in the order of how soon they may be
/// asked for; at most `most` of them.
std::vector<double> next_factors(const SearchRange &range, const TrialVerdicts &verdicts, std::size_t most);

/// A scene without stages settles by the static solver, for five times run.duration at most; its trials take
/// run.duration as limit.
Scene with_settle_stage(Scene scene);

/// What a search is made in: such a scene without its earthquake. The factor is that of blocks at rest.
Scene searched_scene(Scene scene);

/// The scene up to the end of its last settle stage, strengths divided by `factor` from the beginning.
/// @throws SceneError where no stage is of kind settle
Scene settling_scene(const Scene &scene, double factor);

/// The same with the stages behind it that take no steps: what the trials of a search and the bound of limit
/// analysis are about.
/// @throws SceneError where no stage is of kind settle
Scene bounded_scene(const Scene &scene, double factor);

/// Stages that change the scene after the last settle stage and take time, which are no part of a search.
std::vector<std::string> left_out_stages(const Scene &scene);

/// How Scene::resolved begins after a settling_scene() with another factor than 1; the factor follows.
inline constexpr std::string_view settled_weaker = "# settled by gcpdda fos: strengths as below divided by ";

/// The factor is that of a mechanism, besides which that of the first block is found.
bool watches_mechanism(const StrengthReduction &reduction);

/// Name of the stage in which the dynamic step confirms what the static solver has found at rest.
inline constexpr const char *confirming_stage = "confirm";

/// The scene of a trial: what follows the last settle stage at once, then a run with weakened joints.
/// @param settled_factor  what strengths were divided by in the settled state; from there those of a trial by
/// the dynamic step fall in increments
Scene weakened_scene(const Scene &scene, double factor, double settled_factor = 1.0);

/// A trial of weakened_scene() by the dynamic step, whatever the solver of the settle stage.
/// @param scene  that of the search; both factors as for weakened_scene()
Scene with_dynamic_solver(Scene weakened, const Scene &scene, double factor, double settled_factor);

/// A trial in which the static solver finds that the blocks hold, or that they fail, and a stage in which the
/// dynamic step confirms it.
Scene with_confirming_stage(Scene weakened, Verdict found);

} // namespace gcpdda
