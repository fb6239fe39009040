#include "driver/ensemble.hpp"

#include "base/check.hpp"
#include "driver/histogram.hpp"
#include "driver/safety_factor.hpp"
#include "driver/safety_search.hpp"
#include "driver/stop_signal.hpp"
#include "driver/trial_facts.hpp"
#include "gcpdda/driver/run.hpp"
#include "io/hdf5/passing_files.hpp"
#include "io/results/ensemble_report.hpp"
#include "simulation/rank_facts.hpp"
#include "simulation/simulation.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <iostream>
#include <optional>
#include <set>

namespace gcpdda {

namespace {

namespace fs = std::filesystem;

/// What the search or the run of a member says of it.
struct MemberFacts {
  EnsembleMember member;
  bool stopped = false; ///< by the signal: nothing is known of it
};

std::string words_on(const std::vector<EarlierSlide> &slides) {
  std::string words;
  for (const EarlierSlide &slide : slides) {
    words += (words.empty() ? "" : "; ") + slide.words;
  }
  return words;
}

MemberFacts facts_of(const SafetyOutcome &outcome) {
  MemberFacts facts;
  facts.stopped = outcome.exit_code == exit_code::stopped;
  const SafetyReport &report = outcome.report;
  facts.member.holds = report.holds;
  facts.member.fails = report.fails;
  facts.member.outcome = outcome.exit_code == exit_code::numerical_failure ? MemberOutcome::cannot_run
                         : report.fails && *report.fails <= 1.0            ? MemberOutcome::fails
                         : report.holds && *report.holds >= 1.0            ? MemberOutcome::holds
                                                                           : MemberOutcome::undecided;
  facts.member.message = facts.member.outcome == MemberOutcome::fails   ? std::string()
                         : facts.member.outcome == MemberOutcome::holds ? words_on(report.earlier_slides)
                                                                        : outcome.message;
  facts.member.steps = report.settled.steps;
  facts.member.cpu_s = report.settled.cpu_s;
  for (const StrengthTrial &trial : report.trials) {
    facts.member.steps += trial.decisive ? trial.steps : 0; // the others depend on the number of ranks
    facts.member.cpu_s += trial.cpu_s;
  }
  return facts;
}

/// @param largest  as far may blocks come to rest from where the ground began to shake, m
MemberFacts facts_of(const RunOutcome &outcome, double largest) {
  MemberFacts facts;
  facts.stopped = outcome.exit_code == exit_code::stopped;
  const Verdict verdict =
      outcome.summary.stages.empty() ? Verdict::undecided : outcome.summary.stages.back().result.verdict;
  facts.member.outcome = outcome.exit_code == exit_code::numerical_failure ? MemberOutcome::cannot_run
                         : verdict == Verdict::failed                      ? MemberOutcome::fails
                         : verdict == Verdict::settled                     ? MemberOutcome::holds
                                                                           : MemberOutcome::undecided;
  if (facts.member.outcome == MemberOutcome::holds && outcome.summary.permanent_displacement >= 0.0) {
    facts.member.displacement = outcome.summary.permanent_displacement;
    facts.member.outcome = *facts.member.displacement > largest ? MemberOutcome::fails : MemberOutcome::holds;
  }
  const bool is_plain =
      facts.member.outcome == MemberOutcome::holds || facts.member.outcome == MemberOutcome::fails;
  facts.member.message = facts.member.outcome == MemberOutcome::holds
                             ? words_on(slides_of(outcome.summary.stages))
                         : is_plain ? std::string()
                                    : outcome.summary.message;
  facts.member.steps = outcome.summary.steps;
  facts.member.cpu_s = outcome.summary.cpu_s;
  return facts;
}

std::string text_of(const SceneError &error) {
  std::string text;
  for (const Diagnostic &d : error.diagnostics()) {
    if (d.severity == Severity::error) {
      text += (text.empty() ? "" : "; ") + to_string(d);
    }
  }
  return text;
}

std::string line_of(const EnsembleMember &member) {
  std::string text = fmt::format("member {}: {}", member.number, word_of(member.outcome));
  if (const std::optional<double> factor = member.factor()) {
    text += fmt::format(", factor {:.5g} ({:.5g} to {:.5g})", *factor, *member.holds, *member.fails);
  }
  if (member.displacement) {
    text += fmt::format(", permanent displacement {:.3g} m", *member.displacement);
  }
  text += fmt::format(", {} steps, {:.2f} CPU s", member.steps, member.cpu_s);
  return text + (member.message.empty() ? "" : ": " + member.message) + "\n";
}

class EnsembleRun {
public:
  EnsembleRun(const Communicator &world, const Scene &scene, const MemberScene &member_scene,
              const EnsembleOptions &options)
      : world_(world), ensemble_(scene.ensemble), member_scene_(member_scene), options_(options),
        group_(world) {
    report_.measure = ensemble_.measure;
    report_.count = ensemble_.count;
    report_.shakes = ensemble_.measure == Measure::verdict && scene.earthquake.shakes();
    report_.largest_displacement = ensemble_.largest_displacement;
    for (const Variation &variation : ensemble_.variations) {
      report_.keys.push_back(variation.key);
    }
  }

  ExitCode run() {
    take_what_is_there();
    const std::vector<std::int64_t> missing = missing_members();
    const std::int64_t groups = split(static_cast<std::int64_t>(missing.size()));
    std::string trouble;
    try {
      for (std::size_t i = group_number_; i < missing.size() && !stopped_;
           i += static_cast<std::size_t>(groups)) {
        run_member(missing[i]);
      }
    } catch (const FileError &error) { // of the whole group; the others go on, and all hear of it in the end
      trouble = error.what();
    }
    share(trouble);
    return tell();
  }

private:
  void take_what_is_there() {
    std::string rows;
    on_root(world_, [&] {
      for (const std::string &row :
           prepare_ensemble_directory(options_.directory, options_.overwrite, options_.identity, lock_)) {
        rows += row + "\n";
      }
    });
    world_.broadcast(rows);
    take(rows);
    if (world_.is_root() && !report_.members.empty()) {
      std::cerr << fmt::format("{} of {} members are there already\n", report_.members.size(),
                               ensemble_.count);
    }
  }

  /// Lines of members, each in its place; more than were asked for are left out.
  void take(const std::string &rows) {
    for (std::size_t at = 0; at < rows.size();) {
      const std::size_t end = std::min(rows.find('\n', at), rows.size());
      const auto member = member_of(rows.substr(at, end - at), ensemble_.variations.size(), report_.shakes);
      if (member && member->number < ensemble_.count) {
        report_.members.push_back(*member);
      }
      at = end + 1;
    }
    std::sort(report_.members.begin(), report_.members.end(),
              [](const EnsembleMember &a, const EnsembleMember &b) { return a.number < b.number; });
  }

  [[nodiscard]] std::vector<std::int64_t> missing_members() const {
    std::set<std::int64_t> done;
    for (const EnsembleMember &member : report_.members) {
      done.insert(member.number);
    }
    std::vector<std::int64_t> missing;
    for (std::int64_t number = 0; number < ensemble_.count; ++number) {
      if (!done.contains(number)) {
        missing.push_back(number);
      }
    }
    return missing;
  }

  /// @return number of groups
  std::int64_t split(std::int64_t members) {
    const std::int64_t ranks = world_.size();
    const std::int64_t enough = ranks / std::clamp<std::int64_t>(members, 1, ranks);
    const std::int64_t each =
        std::clamp<std::int64_t>(ensemble_.ranks > 0 ? ensemble_.ranks : enough, 1, ranks);
    const std::int64_t groups = ranks / each;
    group_number_ = static_cast<std::size_t>(world_.rank() * groups / ranks);
    group_ = world_.split(static_cast<int>(group_number_));
    return groups;
  }

  void run_member(std::int64_t number) {
    const std::vector<double> values = sample(ensemble_, number);
    const fs::path directory = member_directory(options_.directory, number);
    MemberFacts facts;
    try {
      facts = measure(member_scene_(group_, values), directory);
    } catch (const SceneError &error) {
      facts.member.outcome = MemberOutcome::cannot_run;
      facts.member.message = text_of(error);
    }
    facts.member.number = number;
    facts.member.values = values;
    stopped_ = facts.stopped || signal_came();
    on_root(group_, [&] {
      if (!ensemble_.keep) {
        fs::remove_all(directory);
      }
      if (!facts.stopped) {
        write_member(options_.directory, facts.member, report_.shakes);
        std::cerr << line_of(facts.member) << std::flush;
        mine_ += row_of(facts.member, report_.shakes) + "\n";
      }
    });
  }

  MemberFacts measure(const Scene &scene, const fs::path &directory) const {
    std::optional<PassingFiles> passing;
    if (!ensemble_.keep) {
      passing.emplace();
    }
    if (ensemble_.measure == Measure::factor) {
      return facts_of(search_safety_factor(group_, scene, {directory, true, true}));
    }
    // Bare, and not with fewer outputs: the time step divides the time between them.
    const RunOptions run{directory, true, false, {}, true, !ensemble_.keep};
    return facts_of(run_and_tell(group_, with_settle_stage(scene), run), ensemble_.largest_displacement);
  }

  /// The same on all ranks of the group.
  [[nodiscard]] bool signal_came() const {
    std::int64_t came = stop_signal_came() ? 1 : 0;
    group_.max(std::span(&came, 1));
    return came > 0;
  }

  /// What every group has done goes to all; trouble of one is that of all.
  void share(const std::string &trouble) {
    for (const std::vector<char> &text :
         world_.all_gather(std::vector<char>(trouble.begin(), trouble.end()))) {
      if (!text.empty()) {
        throw FileError(std::string(text.begin(), text.end()));
      }
    }
    std::string rows;
    for (const std::vector<char> &text : world_.all_gather(std::vector<char>(mine_.begin(), mine_.end()))) {
      rows.append(text.begin(), text.end());
    }
    take(rows);
    std::int64_t stopped = stopped_ ? 1 : 0;
    world_.max(std::span(&stopped, 1));
    stopped_ = stopped > 0;
  }

  ExitCode tell() {
    const bool is_whole = static_cast<std::int64_t>(report_.members.size()) == ensemble_.count;
    const EnsembleStatistics found = statistics_of(report_);
    on_root(world_, [&] {
      write_ensemble_report(options_.directory, report_,
                            found.factor.number > 0         ? draw_factors(report_)
                            : found.displacement.number > 0 ? draw_displacements(report_)
                                                            : std::string());
      std::cout << to_text(report_) << std::flush;
      if (!is_whole) {
        std::cerr << "stopped by a signal; the same call goes on with the members that are missing\n";
      }
    });
    forget_stop_signal();
    return !is_whole                        ? exit_code::stopped
           : found.holds + found.fails == 0 ? exit_code::undecided
                                            : exit_code::done;
  }

  Communicator world_;
  const Ensemble &ensemble_;
  const MemberScene &member_scene_;
  EnsembleOptions options_;
  FolderLock lock_; ///< of the folder, until the report is written
  Communicator group_;
  std::size_t group_number_ = 0;
  bool stopped_ = false;
  std::string mine_; ///< rows of the members that this group has done; on its root
  EnsembleReport report_;
};

} // namespace

double copies_in(const Ensemble &ensemble, int ranks) {
  const std::int64_t groups = ensemble.ranks > 0 ? ranks / std::min<std::int64_t>(ensemble.ranks, ranks)
                                                 : std::min<std::int64_t>(ensemble.count, ranks);
  return static_cast<double>(std::max<std::int64_t>(1, groups));
}

ExitCode run_ensemble(const Communicator &communicator, const Scene &scene, const MemberScene &member_scene,
                      const EnsembleOptions &options) {
  if (scene.ensemble.count == 0) {
    throw SceneError({{Severity::error,
                       {},
                       "the scene has no ensemble",
                       "nothing says how many members there are and what they differ in",
                       "write [ensemble] with a count, and [[ensemble.vary]]"}});
  }
  const bool is_of_factors = scene.ensemble.measure == Measure::factor;
  if (!is_of_factors && scene.stages.empty() && scene.earthquake.shakes()) {
    throw SceneError(
        {{Severity::error, scene.earthquake.where,
          "the ground shakes, and no stage says when its blocks stand",
          "without stages a member is one settling, which has no earthquake",
          "write [[stage]] tables: one that settles, one of kind \"run\" that shakes, one that settles"}});
  }
  // What is wrong with the scene itself is refused for all members at once, before there is a folder.
  (void)Simulation(communicator,
                   is_of_factors ? settling_scene(searched_scene(scene), 1.0) : with_settle_stage(scene));
  return EnsembleRun(communicator, scene, member_scene, options).run();
}

} // namespace gcpdda
