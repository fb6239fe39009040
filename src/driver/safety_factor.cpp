#include "driver/safety_factor.hpp"

#include "driver/safety_search.hpp"
#include "driver/settled_state.hpp"
#include "driver/svg.hpp"
#include "driver/trial_facts.hpp"
#include "driver/trial_frames.hpp"
#include "gcpdda/driver/run.hpp"
#include "limit_analysis/limit_analysis.hpp"
#include "limit_analysis/safety_bound.hpp"
#include "model/kept_blocks.hpp"
#include "simulation/rank_facts.hpp"
#include "simulation/simulation.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <iostream>
#include <map>
#include <memory>
#include <optional>
#include <set>

namespace gcpdda {

namespace {

namespace fs = std::filesystem;

class SafetyFactor {
public:
  SafetyFactor(const Communicator &world, const Scene &scene, const SafetyOptions &options)
      : world_(world), scene_(scene), options_(options), settled_(world_, scene_, options_) {
    report_.left_out_stages = left_out_stages(scene);
  }

  void leave_out_earthquake() { report_.leaves_earthquake_out = true; }

  SafetyOutcome find() {
    const ExitCode code = settled_.find([this] { prepare_directory(); });
    report_.settled = settled_.run();
    report_.earlier_slides = settled_.slides();
    report_.fails = settled_.fails();
    if (code == exit_code::undecided && options_.settled.empty() && settled_.has_failed()) {
      conclude_without_search();
    }
    if (code != exit_code::done) {
      return {code, std::move(report_), settled_.message()};
    }
    const ExitCode outcome = options_.only_bound ? bound() : search();
    return {outcome, std::move(report_), std::move(message_)};
  }

private:
  void prepare_directory() { prepare_safety_directory(options_.directory, options_.overwrite, lock_); }

  ExitCode bound() {
    const Scene before = settling_scene(scene_, report_.settled.factor);
    Simulation state(world_, bounded_scene(scene_, report_.settled.factor), {settled_.directory(), &before});
    while (!state.finished()) {
      state.begin_next_stage();
    }
    report_.is_bound_alone = true;
    try {
      const SafetyBounds bounds = bounds_at(state, report_.settled.factor);
      report_.bound = bounds.sliding;
      report_.resting_bound = bounds.resting;
    } catch (const UnsolvedProgramme &unsolved) {
      message_ = unsolved.what();
      report_.unsolved_bound = message_;
      conclude_without_search();
      return exit_code::undecided;
    }
    conclude();
    return report_.bound ? exit_code::done : exit_code::undecided;
  }

  ExitCode search() {
    const std::size_t at_once = choose_groups();
    while (!confirms_in_vain()) {
      std::vector<double> factors = next_factors(
          range(), [&](double factor) { return verdict_of(factor); }, at_once);
      if (factors.empty() && watches_mechanism()) {
        factors = next_factors(
            range(), [&](double factor) { return verdict_on_first_block(factor); }, at_once);
      }
      const bool confirms = factors.empty();
      if (confirms) {
        factors = unconfirmed(at_once);
      }
      if (factors.empty()) {
        break;
      }
      if (run_trials(factors, confirms)) {
        tell(fmt::format("stopped by a signal in trial {}; a search does not go on from there\n",
                         trials_.size()));
        conclude(); // with what is known so far
        return exit_code::stopped;
      }
    }
    conclude();
    return report_.is_found() ? exit_code::done : exit_code::undecided;
  }

  void tell(const std::string &text) const { say(world_, options_, text); }

  /// Trials at once.
  std::size_t choose_groups() {
    const std::int64_t per_trial =
        std::clamp<std::int64_t>(settled_.num_blocks() / options_.fewest_blocks_per_rank, 1, world_.size());
    const std::int64_t groups = world_.size() / per_trial;
    group_number_ = static_cast<int>(world_.rank() * groups / world_.size());
    group_.emplace(world_.split(group_number_));
    return static_cast<std::size_t>(groups);
  }

  [[nodiscard]] SearchRange range() const { return {scene_.reduction, report_.settled.factor}; }

  /// Ends of the bracket, as far as the static solver alone has found them; at most so many, the largest
  /// factors that hold first.
  [[nodiscard]] std::vector<double> unconfirmed(std::size_t most) const {
    std::vector<double> ends;
    const auto add = [&](std::optional<double> end) {
      const bool is_new = end && std::find(ends.begin(), ends.end(), *end) == ends.end();
      if (is_new && unconfirmed_.contains(*end) && ends.size() < most) {
        ends.push_back(*end);
      }
    };
    const SafetySearch search = follow(range(), [&](double factor) { return verdict_of(factor); });
    add(search.holds);
    if (watches_mechanism()) {
      add(follow(range(), [&](double factor) { return verdict_on_first_block(factor); }).holds);
    }
    add(search.fails);
    return ends;
  }

  /// Each group takes one; true if the signal came.
  /// @param confirms  trials that the static solver has found to hold go on by the dynamic step
  bool run_trials(const std::vector<double> &factors, bool confirms) {
    std::vector<TrialFacts> mine;
    std::string trouble;
    std::string message;
    if (static_cast<std::size_t>(group_number_) < factors.size()) {
      const double factor = factors[static_cast<std::size_t>(group_number_)];
      try {
        const RunOutcome outcome = confirms ? run_confirmation(factor) : run_trial(factor);
        message = outcome.exit_code == exit_code::done || outcome.exit_code == exit_code::undecided
                      ? ""
                      : outcome.summary.message;
        if (group_->is_root()) {
          TrialFacts facts = facts_of(factor, outcome, settled_.end_time(), watches_mechanism());
          look_how_far(confirms ? confirmation_directory(factor) : trial_directory(factor), facts);
          mine.push_back(facts);
        }
      } catch (const std::exception &error) { // of the whole group; the others must not wait for it
        trouble = fmt::format("the trial at factor {:g} cannot run: {}", factor, error.what());
      }
    }
    return share(mine, message, trouble, confirms);
  }

  /// Whether blocks that have come to rest are farther away than is allowed (fos.largest_motion).
  void look_how_far(const fs::path &directory, TrialFacts &facts) const {
    const StrengthReduction &rules = scene_.reduction;
    if (!std::isfinite(rules.largest_motion) || static_cast<Verdict>(facts.verdict) != Verdict::settled) {
      return;
    }
    const auto area_in = [&](const std::vector<Vec2> &region) {
      return area_moved_by(rules.largest_motion, region, settled_.directory(), directory);
    };
    facts.first_rests_far = area_in({}) > 0.0 ? 1 : 0;
    const double area = facts.first_rests_far != 0 ? area_in(rules.region) : 0.0;
    facts.rests_far = area > 0.0 && area >= rules.ignored_area ? 1 : 0;
  }

  [[nodiscard]] Scene trial_scene(double factor) const {
    Scene weakened = weakened_scene(scene_, factor, report_.settled.factor);
    weakened.output.contacts = weakened.output.contacts || !options_.quiet; // the pictures show its joints
    weakened.resolved =
        fmt::format("# a trial of gcpdda fos: strengths as below divided by {:.17g}\n", factor) +
        scene_.resolved;
    return weakened;
  }

  /// @param from  the settled state, or a trial that a confirming stage follows
  RunOutcome run_in(const fs::path &directory, const Scene &scene, const fs::path &from, double factor) {
    const bool shows = !options_.quiet && group_number_ == 0; // of trials at once the first one's
    const Scene before =
        from == settled_.directory() ? settling_scene(scene_, report_.settled.factor) : trial_scene(factor);
    RunOptions options{directory, true, false, from, true};
    options.computed_with = &before;
    options.once = true;
    options.keeps_end = scene.stages.back().solver == Solver::statics;
    options.progress_of = shows ? fmt::format("factor {:.6g}: ", factor) : std::string();
    return run_and_tell(*group_, scene, options);
  }

  RunOutcome run_trial(double factor) {
    const Scene trial = trial_scene(factor);
    const RunOutcome outcome = run_in(trial_directory(factor), trial, settled_.directory(), factor);
    return fell_through(outcome, trial) ? run_dynamic_trial(trial_directory(factor), factor) : outcome;
  }
  RunOutcome run_confirmation(double factor) {
    const fs::path directory = confirmation_directory(factor);
    const Scene trial = trial_scene(factor);
    const StrengthTrial &known = trials_.at(factor);
    const Verdict found = known.rests_far ? Verdict::settled : known.verdict;
    const RunOutcome outcome =
        run_in(directory, with_confirming_stage(trial, found), trial_directory(factor), factor);
    return fell_through(outcome, trial) ? run_dynamic_trial(directory, factor) : outcome;
  }

  // Blocks that fall may pass through each other in pseudo-time. The dynamic step keeps them apart.
  static bool fell_through(const RunOutcome &outcome, const Scene &trial) {
    return outcome.exit_code == exit_code::numerical_failure && trial.stages.back().solver == Solver::statics;
  }
  RunOutcome run_dynamic_trial(const fs::path &directory, double factor) {
    const Scene trial = with_dynamic_solver(trial_scene(factor), scene_, factor, report_.settled.factor);
    return run_in(directory, trial, settled_.directory(), factor);
  }

  /// What every group has found goes to all; the first trouble ends the search on all ranks.
  bool share(const std::vector<TrialFacts> &mine, const std::string &message, const std::string &trouble,
             bool confirms) {
    const auto texts = world_.all_gather(std::vector<char>(trouble.begin(), trouble.end()));
    for (const std::vector<char> &text : texts) {
      if (!text.empty()) {
        throw FileError(std::string(text.begin(), text.end()));
      }
    }
    const auto messages = world_.all_gather(std::vector<char>(message.begin(), message.end()));
    const auto all = world_.all_gather(mine);
    bool stopped = false;
    bool is_overturned = false;
    for (std::size_t rank = 0; rank < all.size(); ++rank) {
      for (const TrialFacts &facts : all[rank]) {
        stopped = stopped || facts.exit_code == exit_code::stopped;
        if (is_overturned) {
          continue; // no end of the bracket any more; one group alone would not have looked
        }
        StrengthTrial trial = trial_of(facts);
        trial.message.assign(messages[rank].begin(), messages[rank].end());
        if (trial.rests_far) {
          trial.message = "at rest, but farther away than fos.largest_motion";
        }
        trial.directory = trial_directory(facts.factor);
        if (confirms) {
          trial.directory = confirmation_directory(facts.factor);
          trial.evaluations += trials_[facts.factor].evaluations;
          trial.cpu_s += trials_[facts.factor].cpu_s;
          is_overturned = trial.verdict != trials_[facts.factor].verdict;
          note_confirmation(facts, trial.verdict);
        }
        is_by_statics_alone(facts) ? void(unconfirmed_.insert(facts.factor))
                                   : void(unconfirmed_.erase(facts.factor));
        trials_[facts.factor] = trial;
        if (facts.exit_code == exit_code::stopped) {
          stopped_.insert(facts.factor);
        }
        tell(fmt::format("factor {:.6g}: {}{} after {:.4g} s, {} steps, {:.2f} CPU s on {} rank{} {}\n",
                         facts.factor, word_of(trial.verdict), confirms ? " by the dynamic step" : "",
                         trial.time, trial.steps, trial.cpu_s, trial.ranks, trial.ranks == 1 ? "" : "s",
                         trial.message));
      }
    }
    return stopped;
  }

  /// Called before the verdict of the confirmation replaces that of the static solver.
  void note_confirmation(const TrialFacts &facts, Verdict verdict) {
    if (verdict != Verdict::undecided) {
      has_confirmed_ = true;
    } else if (facts.exit_code != exit_code::stopped) {
      by_statics_.emplace(facts.factor, trials_.at(facts.factor).verdict);
    }
  }

  /// Every end without a confirmed verdict sends the search to a lower one. Where the dynamic step comes to
  /// no verdict at all, for want of time, it would try all factors down to the smallest.
  [[nodiscard]] bool confirms_in_vain() const {
    constexpr std::size_t most_undecided = 3;
    return !has_confirmed_ && by_statics_.size() >= most_undecided;
  }

  /// The bracket that the static solver has found takes the place of one with confirmed ends.
  void note_unconfirmed_bracket(std::vector<double> &decisive) {
    const SafetySearch search = follow(range(), [&](double factor) {
      const auto known = by_statics_.find(factor);
      return known != by_statics_.end() ? std::optional(known->second) : verdict_of(factor);
    });
    const double limit = weakened_scene(scene_, report_.settled.factor).stages.back().drag_limit;
    report_.unconfirmed =
        UnconfirmedBracket{search.holds, search.fails, by_statics_.size(), limit, scene_.reduction.patience};
    report_.holds.reset();
    report_.fails.reset();
    decisive.insert(decisive.end(), search.decisive.begin(), search.decisive.end());
  }

  static std::string word_of(Verdict verdict) {
    return verdict == Verdict::settled ? "holds" : verdict == Verdict::failed ? "fails" : "undecided";
  }

  [[nodiscard]] std::optional<Verdict> verdict_of(double factor) const {
    const auto trial = trials_.find(factor);
    return trial == trials_.end() || stopped_.contains(factor) ? std::nullopt
                                                               : std::optional(trial->second.verdict);
  }

  [[nodiscard]] std::optional<Verdict> verdict_on_first_block(double factor) const {
    return verdict_of(factor) ? std::optional(trials_.at(factor).first_block) : std::nullopt;
  }
  [[nodiscard]] bool watches_mechanism() const { return gcpdda::watches_mechanism(scene_.reduction); }

  [[nodiscard]] fs::path trial_directory(double factor) const {
    return options_.directory / "trials" / fmt::format("F{:.9g}", factor);
  }

  [[nodiscard]] fs::path confirmation_directory(double factor) const {
    return trial_directory(factor) / confirming_stage;
  }

  void conclude() {
    const SafetySearch search = follow(range(), [&](double factor) { return verdict_of(factor); });
    report_.tolerance = scene_.reduction.tolerance;
    report_.settled.directory = fs::absolute(settled_.directory()).lexically_normal();
    report_.holds = search.holds;
    report_.fails = search.fails;
    report_.undecided = search.undecided;
    std::vector<double> decisive = search.decisive;
    if (confirms_in_vain()) {
      note_unconfirmed_bracket(decisive);
    }
    if (watches_mechanism()) {
      const SafetySearch first =
          follow(range(), [&](double factor) { return verdict_on_first_block(factor); });
      report_.first_block = FirstBlock{first.holds, first.fails, {}};
      report_.ignored_area = scene_.reduction.ignored_area;
      decisive.insert(decisive.end(), first.decisive.begin(), first.decisive.end());
    }
    note_families();
    for (const auto &[factor, trial] : trials_) {
      report_.trials.push_back(trial);
      report_.trials.back().decisive =
          std::count(decisive.begin(), decisive.end(), factor) > 0 || stopped_.contains(factor);
    }
    note_first_slide();
    on_root(world_, [&] {
      for (const auto &[factor, trial] : trials_) { // nobody goes on from them now
        fs::remove_all(trial_directory(factor) / "checkpoints");
      }
    });
    if (!options_.quiet) {
      on_root(world_, [&] {
        SafetyPictures pictures;
        if (report_.fails) {
          DrawnTrial trial = drawn_trial(*report_.fails, scene_.reduction.ignored_area);
          pictures.mechanism = draw_mechanism(trial.blocks, trial.joints, *report_.fails);
          report_.mechanism = std::move(trial.blocks);
        }
        if (report_.first_block && report_.first_block->fails) {
          DrawnTrial trial = drawn_trial(*report_.first_block->fails, 0.0);
          pictures.first_block = draw_mechanism(trial.blocks, trial.joints, *report_.first_block->fails);
          report_.first_block->blocks = std::move(trial.blocks);
        }
        write_safety_report(options_.directory, report_, pictures);
        std::cout << to_text(report_) << std::flush;
      });
    }
  }

  /// Where the blocks fail before there is a state to begin from, or where their bound is not found.
  void conclude_without_search() {
    report_.tolerance = scene_.reduction.tolerance;
    report_.settled.directory = fs::absolute(settled_.directory()).lexically_normal();
    note_families();
    if (!options_.quiet) {
      on_root(world_, [&] {
        write_safety_report(options_.directory, report_, {});
        std::cout << to_text(report_) << std::flush;
      });
    }
  }

  void note_families() {
    for (std::size_t i = 0; i < scene_.joints.laws.size(); ++i) {
      if (scene_.reduction.weakens(i)) {
        report_.families.push_back(scene_.joints.laws[i].name);
      }
    }
  }

  /// The least factor at which blocks hold no longer where they are but somewhere else. Of a mechanism it is
  /// not known: the motion of a trial is that of any block.
  void note_first_slide() {
    const double far = scene_.reduction.failure_motion;
    const auto slides = [far](const StrengthTrial &trial) {
      return trial.decisive && trial.verdict == Verdict::settled &&
             (trial.moved >= far || trial.slide >= StageResult::telling_slide);
    };
    if (settled_.slide() >= std::min(far, StageResult::telling_slide) && !watches_mechanism()) {
      report_.first_slide = report_.settled;
      report_.first_slide->moved = settled_.slide();
      return;
    }
    const auto first = std::find_if(report_.trials.begin(), report_.trials.end(), slides);
    if (first != report_.trials.end() && !watches_mechanism()) {
      report_.first_slide = *first;
    }
  }

  // Root alone, which reads the frames of both runs.
  [[nodiscard]] DrawnTrial drawn_trial(double factor, double ignored_area) const {
    return drawn_trial_of(scene_, settled_.directory(), trials_.at(factor).directory, ignored_area);
  }

  Communicator world_;
  const Scene &scene_;
  SafetyOptions options_;
  SettledState settled_;
  FolderLock lock_; ///< of the folder, until the report is written
  std::optional<Communicator> group_;
  int group_number_ = 0;
  std::map<double, StrengthTrial> trials_; ///< by factor
  std::set<double> unconfirmed_;           ///< factors whose verdict is by the static solver alone
  std::map<double, Verdict> by_statics_;   ///< verdicts of the static solver whose confirmation is undecided
  bool has_confirmed_ = false; ///< the dynamic step has come to a verdict on an end of the bracket
  std::set<double> stopped_;   ///< factors of those without a verdict because the signal came
  SafetyReport report_;
  std::string message_; ///< why there is no bound
};

} // namespace

SafetyOutcome search_safety_factor(const Communicator &communicator, const Scene &scene,
                                   const SafetyOptions &options) {
  Scene staged = searched_scene(scene);
  if (staged.region_blocks) { // strengths alone differ from trial to trial
    staged.region_blocks = std::make_shared<KeptBlocks>(staged.region_blocks);
  }
  SafetyFactor search(communicator, staged, options);
  if (scene.earthquake.shakes()) {
    search.leave_out_earthquake();
  }
  return search.find();
}

ExitCode find_safety_factor(const Communicator &communicator, const Scene &scene,
                            const SafetyOptions &options) {
  return search_safety_factor(communicator, scene, options).exit_code;
}

} // namespace gcpdda
