
#include "driver/safety_search.hpp"

#include "simulation/simulation.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <iterator>
#include <numeric>
#include <span>

namespace gcpdda {

namespace {

/// Follows the verdicts as far as they are known.
class Follower {
public:
  Follower(const SearchRange &range, const TrialVerdicts &verdicts)
      : reduction_(range.reduction), settled_(range.settled), verdicts_(verdicts) {}

  SafetySearch follow() {
    if (!find_holding_end() || !find_failing_end()) {
      return found_;
    }
    while (const std::optional<double> middle = widest_gap()) {
      const std::optional<Verdict> verdict = ask(*middle);
      if (!verdict) {
        return found_;
      }
      note(*middle, *verdict);
    }
    if (leaves_one_open()) {
      if (const std::optional<Verdict> verdict = ask(1.0)) {
        note(1.0, *verdict);
      }
    }
    return found_;
  }

private:
  std::optional<Verdict> ask(double factor) {
    const std::optional<Verdict> verdict = verdicts_(factor);
    if (verdict) {
      found_.decisive.push_back(factor);
    } else {
      found_.next = factor;
    }
    return verdict;
  }

  /// Whether the scene stands with its own strength is asked of every search.
  [[nodiscard]] bool leaves_one_open() const {
    return found_.undecided.empty() && *found_.holds < 1.0 && *found_.fails > 1.0;
  }

  bool find_holding_end() {
    const bool is_in_range = reduction_.from < settled_ && settled_ < reduction_.to;
    for (const double factor : {is_in_range ? settled_ : reduction_.from, reduction_.from}) {
      const std::optional<Verdict> verdict = ask(factor);
      if (!verdict) {
        return false;
      }
      note(factor, *verdict);
      if (verdict == Verdict::settled || factor == reduction_.from) {
        return verdict == Verdict::settled;
      }
    }
    return false;
  }

  // Far beyond its limit a pile may fall so wildly that the trial breaks down, and just beyond it so slowly
  // that nothing is decided: the search then comes down, and goes on up where that has not found a trial that
  // fails.
  bool find_failing_end() {
    double tried = *found_.holds;
    while (!found_.fails) {
      const bool comes_down = !found_.undecided.empty() && is_wide(found_.undecided.front());
      if (!comes_down && tried >= reduction_.to) {
        return false;
      }
      const double factor = comes_down ? std::midpoint(*found_.holds, found_.undecided.front())
                                       : std::min(growth() * tried, reduction_.to);
      const std::optional<Verdict> verdict = ask(factor);
      if (!verdict) {
        return false;
      }
      note(factor, *verdict);
      tried = std::max(tried, factor);
    }
    return true;
  }

  /// Growth of the factor from one trial to the next on the way up: the tolerance times a power of two, so
  /// that halving ends just where the bracket is as narrow as it has to be.
  [[nodiscard]] double growth() const {
    constexpr double most = 1.3;
    double share = reduction_.tolerance;
    while (1.0 + 2.0 * share <= most) {
      share *= 2.0;
    }
    return 1.0 + share;
  }

  [[nodiscard]] bool is_wide(double begin, double end) const {
    return !is_narrow(end - begin, *found_.holds, reduction_.tolerance);
  }
  /// What lies between the largest factor that holds and another one.
  [[nodiscard]] bool is_wide(double end) const { return is_wide(*found_.holds, end); }

  void note(double factor, Verdict verdict) {
    if (verdict == Verdict::settled) {
      found_.holds = factor;
    } else if (verdict == Verdict::failed) {
      found_.fails = factor;
    } else {
      found_.undecided.push_back(factor);
      std::sort(found_.undecided.begin(), found_.undecided.end());
    }
    std::erase_if(found_.undecided, [&](double between) {
      return (found_.holds && between < *found_.holds) || (found_.fails && between > *found_.fails);
    });
  }

  /// The middle of what lies below or else above everything undecided, if that is too wide.
  [[nodiscard]] std::optional<double> widest_gap() const {
    const double low_end = found_.undecided.empty() ? *found_.fails : found_.undecided.front();
    const double high_begin = found_.undecided.empty() ? *found_.fails : found_.undecided.back();
    if (is_wide(low_end)) {
      return std::midpoint(*found_.holds, low_end);
    }
    return is_wide(high_begin, *found_.fails) ? std::optional(std::midpoint(high_begin, *found_.fails))
                                              : std::nullopt;
  }

  const StrengthReduction &reduction_;
  double settled_;
  const TrialVerdicts &verdicts_;
  SafetySearch found_;
};

void weaken(Scene &scene, const StrengthReduction &reduction, double factor) {
  for (std::size_t i = 0; i < scene.joints.laws.size(); ++i) {
    if (reduction.weakens(i)) {
      scene.joints.laws[i].weaken(factor);
    }
  }
}

/// Joint laws between strengths divided by `from` and strengths divided by `to`, in increments of 2 % or
/// less.
std::vector<std::vector<JointLaw>> laws_between(const Scene &scene, const StrengthReduction &reduction,
                                                double from, double to) {
  constexpr double largest_increment = 1.02;
  const auto increments = static_cast<int>(std::ceil(std::log(to / from) / std::log(largest_increment)));
  std::vector<std::vector<JointLaw>> laws;
  for (int k = 1; k < increments; ++k) {
    Scene between = scene;
    weaken(between, reduction, from * std::pow(to / from, static_cast<double>(k) / increments));
    laws.push_back(std::move(between.joints.laws));
  }
  return laws;
}

/// The scene at the end of some stages, without any.
Scene scene_behind(const Scene &scene, std::span<const Stage> stages) {
  Scene after = scene;
  for (const Stage &stage : stages) {
    if (stage.after) {
      after = *stage.after;
    }
  }
  after.stages.clear();
  return after;
}

} // namespace

SafetySearch follow(const SearchRange &range, const TrialVerdicts &verdicts) {
  return Follower(range, verdicts).follow();
}

std::vector<double> next_factors(const SearchRange &range, const TrialVerdicts &verdicts, std::size_t most) {
  using Guess = std::vector<std::pair<double, Verdict>>;
  std::vector<double> factors;
  std::vector<Guess> guesses{{}};
  for (std::size_t k = 0; k < guesses.size() && factors.size() < most; ++k) {
    const Guess guess = guesses[k];
    const SafetySearch search = follow(range, [&](double factor) -> std::optional<Verdict> {
      const auto guessed =
          std::find_if(guess.begin(), guess.end(), [&](const auto &g) { return g.first == factor; });
      return guessed != guess.end() ? std::optional(guessed->second) : verdicts(factor);
    });
    if (!search.next) {
      continue;
    }
    if (std::find(factors.begin(), factors.end(), *search.next) == factors.end()) {
      factors.push_back(*search.next);
    }
    for (const Verdict verdict : {Verdict::settled, Verdict::failed}) {
      Guess further = guess;
      further.emplace_back(*search.next, verdict);
      guesses.push_back(std::move(further));
    }
  }
  return factors;
}

Scene searched_scene(Scene scene) {
  scene.earthquake = {};
  return with_settle_stage(std::move(scene));
}

Scene with_settle_stage(Scene scene) {
  if (scene.stages.empty()) {
    Stage &settle = scene.stages.emplace_back();
    settle.name = "settle";
    settle.kind = StageKind::settle;
    settle.duration = 5.0 * scene.run.duration; // which says how long a run is to be, not a settling
    if (scene.reduction.limit == 0.0) {
      scene.reduction.limit = scene.run.duration;
    }
    settle.until_verdict = true;
    settle.solver = Solver::statics; // this and the damping as of a settle stage that says nothing else
    settle.local_damping = 0.8;
  }
  return scene;
}

namespace {

/// The first stage behind the last settle stage.
/// @throws SceneError where no stage is of kind settle
std::vector<Stage>::iterator behind_settling(std::vector<Stage> &stages) {
  const auto last = std::find_if(stages.rbegin(), stages.rend(),
                                 [](const Stage &stage) { return stage.kind == StageKind::settle; });
  if (last == stages.rend()) {
    throw SceneError({{Severity::error,
                       {},
                       "the scene has stages but none of kind settle",
                       "strengths are lowered from a state of rest",
                       "write [[stage]] with kind = \"settle\" and a limit"}});
  }
  return last.base();
}

/// Divide strengths from the beginning, in all stages.
void weaken_throughout(Scene &start, const StrengthReduction &reduction, double factor) {
  if (factor == 1.0) {
    return;
  }
  start.resolved = fmt::format("{}{:.17g}\n", settled_weaker, factor) + start.resolved;
  weaken(start, reduction, factor);
  for (Stage &stage : start.stages) {
    if (stage.after) {
      auto after = std::make_shared<Scene>(*stage.after);
      weaken(*after, reduction, factor);
      stage.after = std::move(after);
    }
  }
}

} // namespace

Scene settling_scene(const Scene &scene, double factor) {
  Scene start = scene;
  start.stages.erase(behind_settling(start.stages), start.stages.end());
  weaken_throughout(start, scene.reduction, factor);
  return start;
}

Scene bounded_scene(const Scene &scene, double factor) {
  Scene start = scene;
  start.stages.erase(std::remove_if(behind_settling(start.stages), start.stages.end(),
                                    [](const Stage &stage) { return stage.takes_steps(); }),
                     start.stages.end());
  weaken_throughout(start, scene.reduction, factor);
  return start;
}

std::vector<std::string> left_out_stages(const Scene &scene) {
  std::vector<std::string> names;
  for (auto stage = scene.stages.rbegin(); stage != scene.stages.rend() && stage->kind != StageKind::settle;
       ++stage) {
    if (stage->takes_steps() && stage->after) {
      names.insert(names.begin(), stage->name);
    }
  }
  return names;
}

bool watches_mechanism(const StrengthReduction &reduction) {
  return reduction.ignored_area > 0.0 || !reduction.region.empty();
}

Scene weakened_scene(const Scene &scene, double factor, double settled_factor) {
  const auto is_settle = [](const Stage &stage) { return stage.kind == StageKind::settle; };
  const auto last_settle = std::find_if(scene.stages.rbegin(), scene.stages.rend(), is_settle).base();
  Scene weakened = scene;
  weakened.stages.assign(scene.stages.begin(), last_settle);
  std::copy_if(last_settle, scene.stages.end(), std::back_inserter(weakened.stages),
               [](const Stage &stage) { return !stage.takes_steps(); });

  auto after = std::make_shared<Scene>(scene_behind(scene, weakened.stages));
  Stage trial;
  trial.name = "trial";
  const double limit = scene.reduction.limit > 0.0 ? scene.reduction.limit : std::prev(last_settle)->duration;
  trial.drag_limit = limit;
  trial.duration = static_cast<double>(1 + scene.reduction.patience) * limit;
  trial.until_verdict = true;
  trial.failure_motion = scene.reduction.failure_motion;
  trial.local_damping = scene.reduction.local_damping;
  trial.solver = std::prev(last_settle)->solver;
  trial.increments = factor == settled_factor ? 1 : std::prev(last_settle)->increments;
  const bool is_static = trial.solver == Solver::statics;
  if (!is_static) {
    trial.weakening = laws_between(*after, scene.reduction, settled_factor, factor);
  }
  weaken(*after, scene.reduction, factor);
  trial.where = std::prev(last_settle)->where;
  trial.ignored_area = scene.reduction.ignored_area;
  trial.watched_region = scene.reduction.region;
  trial.after = std::move(after);
  weakened.output = {limit, limit, 0.0, scene.output.contacts};
  weakened.stages.push_back(std::move(trial));
  return weakened;
}

Scene with_dynamic_solver(Scene weakened, const Scene &scene, double factor, double settled_factor) {
  Stage &trial = weakened.stages.back();
  trial.solver = Solver::dynamic;
  const Scene before = scene_behind(scene, std::span(weakened.stages).first(weakened.stages.size() - 1));
  trial.weakening = laws_between(before, scene.reduction, settled_factor, factor);
  return weakened;
}

Scene with_confirming_stage(Scene weakened, Verdict found) {
  Stage confirm = weakened.stages.back();
  confirm.name = confirming_stage;
  confirm.after = nullptr;
  confirm.increments = 1; // nothing has changed
  if (found == Verdict::failed) {
    confirm.solver = Solver::dynamic;
    confirm.goes_on_failing = true;
    confirm.local_damping = 0.0; // as drag it would hold back what goes on moving
  } else {
    confirm.begins_at_rest = true;
    confirm.tolerance *= 10.0; // swings of the step about a state of rest are no motion away from it
  }
  weakened.stages.push_back(std::move(confirm));
  return weakened;
}

} // namespace gcpdda
