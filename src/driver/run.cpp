#include "gcpdda/driver/run.hpp"

#include "base/check.hpp"
#include "base/program_facts.hpp"
#include "driver/restart_changes.hpp"
#include "driver/result_files.hpp"
#include "driver/run_facts.hpp"
#include "driver/run_log.hpp"
#include "driver/run_words.hpp"
#include "driver/stop_signal.hpp"
#include "gcpdda/io/run_summary.hpp"
#include "io/checkpoint/checkpoint.hpp"
#include "io/checkpoint/checkpoint_reader.hpp"
#include "io/checkpoint/past_scenes.hpp"
#include "io/hdf5/durable_file.hpp"
#include "io/results/folder_lock.hpp"
#include "io/results/result_directory.hpp"
#include "io/results/summary.hpp"
#include "simulation/energy_ledger.hpp"
#include "simulation/impact_watch.hpp"
#include "simulation/rank_facts.hpp"
#include "simulation/results.hpp"
#include "simulation/simulation.hpp"
#include "simulation/static_stage.hpp"
#include "simulation/strain_watch.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <fmt/format.h>
#include <iostream>
#include <optional>

namespace gcpdda {

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

double cpu_seconds() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

Beginning beginning_of(const RunOptions &options) {
  return options.restart ? Beginning{options.directory, options.computed_with, options.earlier}
                         : Beginning{options.from, options.computed_with, EarlierResults::are_not_looked_at};
}

/// A run with its files.
class SceneRun {
public:
  /// @param lock  of the folder, if there is one yet
  SceneRun(const Communicator &communicator, const Scene &scene, const RunOptions &options, FolderLock &lock)
      : communicator_(communicator), directory_(options.directory), is_bare_(options.bare),
        is_once_(options.once), options_(options), simulation_(communicator, scene, beginning_of(options)) {
    if (options.restart && options.computed_with != nullptr) {
      const StageState &stage = simulation_.stage();
      expect_same_past(*options.computed_with, scene, stage.index + (stage.ended ? 1 : 0));
    }
    if (!options.restart) {
      begin_results(scene, options);
    } else if (!simulation_.finished()) {
      continue_results(scene, *simulation_.restored());
    }
    on_root(communicator, [&] { lock.acquire(directory_); });
    set_up_seconds_ = seconds_since(start_);
  }

  RunOutcome run() {
    if (simulation_.finished() && simulation_.restored()) {
      if (communicator_.is_root()) {
        std::cerr << fmt::format("the run in {} is finished at t = {:g} s, {} goes on from there\n",
                                 directory_.string(), simulation_.restored()->facts.time,
                                 simulation_.is_staged() ? "a longer limit or a further stage"
                                                         : "a longer run.duration");
      }
      return {exit_code_of_stages(), {}};
    }
    announce();
    write_owners_of_blocks();
    if (!simulation_.restored()) {
      write_due();
    }
    const Clock::time_point loop_start = Clock::now();
    const double cpu_start = cpu_seconds();
    const double output_before = output_seconds();
    const double output_cpu_before = output_cpu_seconds_;
    first_step_ = simulation_.step_count();
    begin_stages();
    while (!simulation_.finished() && !simulation_.stop_agreed()) {
      if (stop_signal_came()) {
        simulation_.ask_to_stop();
      }
      simulation_.step();
      tell_notes(); // of a stage that another solver goes on with
      end_stage_if_over();
      if (!simulation_.is_staged() &&
          simulation_.step_count() ==
              std::min<std::int64_t>(first_step_ + steps_to_predict, simulation_.plan().num_steps)) {
        predict_duration(seconds_since(loop_start));
      }
      write_due();
      write_checkpoint_if_due();
      show_progress(loop_start);
      begin_stages();
    }
    loop_seconds_ = seconds_since(loop_start) - (output_seconds() - output_before);
    cpu_seconds_ = cpu_seconds() - cpu_start - (output_cpu_seconds_ - output_cpu_before);
    return finish();
  }

private:
  static constexpr std::int64_t steps_to_predict = 20;

  void end_stage_if_over() {
    if (!simulation_.is_staged() || !simulation_.stage_is_over() || simulation_.fault()) {
      return;
    }
    ledger_->note_end(simulation_.state());
    simulation_.end_stage(); // a settled pile is set to rest
    ledger_->step_over(simulation_.state());
    log_stage();
  }

  /// Those that take no steps are over at once. No step shows what the last of them has changed: its frame
  /// and rows are written here.
  void begin_stages() {
    while (simulation_.is_staged() && simulation_.stage_is_over() && !simulation_.finished() &&
           !simulation_.stop_agreed()) {
      simulation_.begin_next_stage();
      ledger_->step_over(simulation_.state());
      impacts_.forget();
      tell_of_bolts();
      if (simulation_.stage_is_over()) {
        log_stage();
        if (simulation_.finished()) {
          write_due();
        }
      }
    }
  }

  void log_stage() {
    const StageResult result = simulation_.stage_results().back();
    const Stage &stage = simulation_.stages()[static_cast<std::size_t>(simulation_.stage().index)];
    log_->line(words_on_stage(stage.name, result));
    if (const auto warning = warning_of_slide(simulation_, stage, result)) {
      log_->diagnostic(*warning);
    }
  }

  /// undecided where a limit was reached without a verdict.
  [[nodiscard]] ExitCode exit_code_of_stages() const {
    const StageState &stage = simulation_.stage();
    const bool waited = simulation_.stages()[static_cast<std::size_t>(stage.index)].until_verdict;
    return waited && stage.verdict == Verdict::undecided ? exit_code::undecided : exit_code::done;
  }

  void begin_results(const Scene &scene, const RunOptions &options) {
    on_root(communicator_, [&] {
      if (options.prepare) {
        options.prepare();
      }
      prepare_result_directory(directory_, options.overwrite, scene.resolved);
      keep_drawings(scene);
    });
    log_.emplace(communicator_.is_root(), directory_, std::ios::trunc, options.quiet, options.progress_of);
    files_.emplace(simulation_, scene, directory_, false);
    simulation_.restored() ? ledger_.emplace(simulation_.restored()->facts)
                           : ledger_.emplace(simulation_.state());
  }

  /// A restart needs neither the drawings nor what has converted them.
  void keep_drawings(const Scene &scene) const {
    for (std::size_t i = 0; i < scene.region.maps.size() && !is_bare_ && !is_once_; ++i) {
      if (const auto &converted = scene.region.maps[i].converted) {
        write_file(kept_joint_map(directory_, i), *converted);
      }
    }
  }

  void continue_results(const Scene &scene, const Restored &restored) {
    const RunFacts &facts = restored.facts;
    on_root(communicator_, [&] {
      if (const auto before = changed_from(simulation_.state());
          !before.empty()) { // first: a restart may be repeated
        remember_scenes(directory_, before);
      }
      reopen_result_directory(directory_, scene.resolved);
    });
    files_.emplace(simulation_, scene, directory_, true);
    log_.emplace(communicator_.is_root(), directory_, std::ios::app);
    for (const std::string &rejected : restored.rejected) {
      log_->line("warning: a checkpoint is not used, " + rejected);
    }
    for (const std::string &gap : restored.gaps) {
      log_->line("warning: earlier results have a gap that stays: " + gap);
    }
    log_->line(fmt::format("restart from {}: t = {:.9g} s, step {}, {} frames", restored.path.string(),
                           facts.time, facts.step, facts.frame_times.size()));
    if (const Scene *before = options_.computed_with) {
      for (const Diagnostic &change :
           reports_of_changes(*before, scene, facts.time, simulation_.stage().index)) {
        log_->diagnostic(change);
      }
    }
    ledger_.emplace(facts);
  }

  void announce() {
    const Scene &scene = simulation_.scene();
    const std::string blocks = words_on_blocks(simulation_);
    tell_notes();
    log_->line(blocks);
    log_->line(words_on_time_step(simulation_));
    for (const JointLaw &law : scene.joints.laws) {
      log_->line(words_on_law(law));
    }
    for (const std::string &words : options_.words_on_joint_sets) {
      log_->line(words);
    }
    report_fidelity(scene.run);
    tell_of_bolts();
  }

  /// Whenever more or fewer are in place, and what is odd about new ones.
  void tell_of_bolts() {
    tell_notes();
    const std::size_t links = simulation_.bolts().links().size();
    if (links != num_links_) {
      log_->line(words_on_bolts(simulation_));
      num_links_ = links;
    }
  }

  void tell_notes() {
    for (; num_notes_ < simulation_.notes().size(); ++num_notes_) {
      log_->diagnostic(simulation_.notes()[num_notes_]);
    }
  }

  void report_fidelity(const RunSettings &run) {
    if (run.rayleigh.present()) {
      log_->line(
          fmt::format("rayleigh damping takes {:.2g} of its speed a second from every block that moves: "
                      "what falls, slides or rolls is held back by it, too",
                      run.rayleigh.mass_damping));
    }
    const std::vector<Stage> &stages = simulation_.scene().stages;
    const bool moves_freely = stages.empty() || std::any_of(stages.begin(), stages.end(), [](const Stage &s) {
                                return s.kind == StageKind::run;
                              });
    if (constexpr double strong = 0.3; moves_freely && run.contact_damping > strong) {
      log_->line(
          fmt::format("warning: with a contact damping of {:g} a part of impacts has no friction: blocks "
                      "that land while they slide run out too far, compare with a smaller one",
                      run.contact_damping));
    }
    const FidelityReport &fidelity = simulation_.fidelity();
    log_->line(words_on_fidelity(fidelity, run.accepted_error));
    if (fidelity.worst_rigid > run.accepted_error) {
      log_->line("warning: the scene asks for rigid blocks that leave out more than is accepted "
                 "(run.accepted_error), use fidelity = \"auto\"");
    }
    if (run.local_damping > 0.0) {
      log_->line(fmt::format("warning: local damping {:g} is for static problems, speeds and times of this "
                             "run are not physical",
                             run.local_damping));
    }
  }

  void predict_duration(double seconds) {
    const auto steps = static_cast<double>(simulation_.step_count() - first_step_);
    log_->line(
        fmt::format("predicted time of the step loop: {:.3g} s",
                    seconds / steps * static_cast<double>(simulation_.plan().num_steps - first_step_)));
  }

  void show_progress(Clock::time_point loop_start) {
    if (!log_->progress_due()) {
      return;
    }
    const double elapsed = seconds_since(loop_start);
    const double per_step = elapsed / static_cast<double>(simulation_.step_count() - first_step_);
    log_->progress(words_on_progress(simulation_, energy_, per_step));
  }

  void conclude_impacts() {
    if (const auto gain = impacts_.conclude()) {
      log_->diagnostic(warning_of(simulation_, *gain));
    }
  }

  void write_due() {
    if (is_bare_) {
      return;
    }
    const std::int64_t step = simulation_.stage_step();
    const TimePlan &plan = simulation_.plan();
    const bool failed = simulation_.fault().has_value();
    const bool ended = (simulation_.is_staged() && simulation_.stage_is_over()) || // wherever it falls
                       (is_once_ && simulation_.stop_agreed());
    const bool output_due = failed || ended || plan.output_due(step);
    const bool history_due = failed || ended || plan.history_due(step);
    if (!output_due && !history_due) {
      if (impacts_.lacks_reference(simulation_)) {
        const auto scope = simulation_.phases().measure(Phase::output);
        impacts_.look(simulation_, ledger_->row(simulation_.state()));
        simulation_.state().digest.reset();
      }
      return;
    }
    const auto scope = simulation_.phases().measure(Phase::output);
    const double cpu_start = cpu_seconds();
    if (history_due && !failed) {                  // the energies of a broken state say nothing
      energy_ = ledger_->row(simulation_.state()); // first: frames take what it has seen of the contacts
      impacts_.look(simulation_, energy_);
    }
    if (simulation_.stage_is_over()) {
      conclude_impacts();
    }
    if (const auto warning = strains_.look(simulation_.state())) {
      log_->diagnostic(*warning);
    }
    if (output_due) {
      files_->write_frame(simulation_);
    }
    if (history_due) {
      files_->write_history(simulation_, failed ? nullptr : &energy_);
      contacts_at_end_ = count_contacts();
    }
    simulation_.state().digest.reset();
    output_cpu_seconds_ += cpu_seconds() - cpu_start;
  }

  void write_checkpoint_if_due() {
    const bool stopping = simulation_.stop_agreed() && !simulation_.finished();
    const bool stage_ends = simulation_.is_staged() && simulation_.stage_is_over();
    const bool is_due = is_once_ ? options_.keeps_end && stage_ends
                                 : stopping || stage_ends || checkpoint_is_due(simulation_.state());
    if (simulation_.fault() || is_bare_ || !is_due) {
      return;
    }
    const auto scope = simulation_.phases().measure(Phase::output);
    const double cpu_start = cpu_seconds();
    const Clock::time_point start = Clock::now();
    files_->write_checkpoint(simulation_, *ledger_);
    log_->line(fmt::format("checkpoint at t = {:.9g} s, written in {:.3g} s", simulation_.time(),
                           seconds_since(start)));
    output_cpu_seconds_ += cpu_seconds() - cpu_start;
  }

  [[nodiscard]] double output_seconds() { return simulation_.phases().seconds(Phase::output); }

  std::int64_t count_contacts() {
    std::int64_t count = 0;
    for (std::size_t k = 0; k < simulation_.candidates().pairs.size(); ++k) {
      const bool counts = simulation_.counts_here(simulation_.candidates().pairs[k]);
      count += counts && simulation_.history().is_living(k) ? 1 : 0;
    }
    return total(communicator_, count);
  }

  void write_owners_of_blocks() {
    std::vector<std::int64_t> owner(static_cast<std::size_t>(simulation_.num_blocks()), -1);
    for (std::size_t row = 0; row < simulation_.blocks().num_owned; ++row) {
      owner[static_cast<std::size_t>(simulation_.blocks().properties[row].id.value)] = communicator_.rank();
    }
    communicator_.max(owner);
    on_root(communicator_, [&] {
      write_owners(directory_, simulation_.step_count(), {owner.begin(), owner.end()});
    });
  }

  RunOutcome finish() {
    const bool failed = simulation_.fault().has_value();
    const bool stopped = !simulation_.finished();
    RunSummary summary;
    conclude_impacts(); // of a run that stops within a stage
    tell_end(simulation_, is_once_ ? std::filesystem::path() : directory_, summary);
    if (stopped) {
      contacts_at_end_ = count_contacts();
    }
    fill(summary);
    for (const Diagnostic &warning : warnings_of(simulation_.state())) {
      log_->line(to_string(warning));
    }
    files_->sync_frames();
    on_root(communicator_, [&] { write_summary(directory_, summary); });
    write_owners_of_blocks();
    log_->line("wall seconds   min      mean       max over ranks");
    for (const auto &[name, seconds] : summary.phases) {
      log_->line(fmt::format("{:>8} {:9.3f} {:9.3f} {:9.3f}", name, seconds[0], seconds[1], seconds[2]));
    }
    log_->line(fmt::format(
        "{} steps, {} contacts at the end, largest overlap {:.3g} m, energy residual {:.3g} J/m, "
        "{:.3g} s in the step loop",
        summary.steps, summary.contacts, summary.max_overlap, summary.energy.residual, summary.wall_s));
    for (const std::string &words : words_on_support(summary, simulation_.scene())) {
      log_->line(words);
    }
    log_->line((failed ? "error: " : "") + summary.verdict + ": " + summary.message + "; results in " +
               directory_.string());
    if (stopped) {
      forget_stop_signal(); // one that came too late is for what follows
    }
    return {failed    ? exit_code::numerical_failure
            : stopped ? exit_code::stopped
                      : exit_code_of_stages(),
            summary};
  }

  void fill(RunSummary &summary) {
    take_facts(communicator_, simulation_, first_step_, summary);
    summary.version = program_version();
    summary.command = command_line();
    summary.joint_sets = options_.joint_sets;
    summary.contacts = contacts_at_end_;
    summary.energy = energy_;
    files_->tell_supports(simulation_, summary);
    summary.wall_s = spread(communicator_, loop_seconds_)[2];
    const auto num_ranks = static_cast<double>(communicator_.size());
    summary.cpu_s = spread(communicator_, cpu_seconds_)[1] * num_ranks;
    summary.setup_wall_s = spread(communicator_, set_up_seconds_)[2];
    summary.output_wall_s = spread(communicator_, output_seconds())[2];
    summary.total_wall_s = spread(communicator_, seconds_since(start_))[2];
  }

  Clock::time_point start_ = Clock::now();
  Communicator communicator_;
  std::filesystem::path directory_;
  bool is_bare_;
  bool is_once_;
  const RunOptions &options_;
  Simulation simulation_;
  std::optional<ResultFiles> files_;
  std::optional<RunLog> log_;
  std::optional<EnergyLedger> ledger_;
  ImpactWatch impacts_;
  StrainWatch strains_;
  EnergyRow energy_;
  std::size_t num_notes_ = 0; ///< that have been told
  std::size_t num_links_ = 0;
  std::int64_t first_step_ = 0; ///< of this part of the run
  std::int64_t contacts_at_end_ = 0;
  double set_up_seconds_ = 0.0;
  double output_cpu_seconds_ = 0.0;
  double loop_seconds_ = 0.0;
  double cpu_seconds_ = 0.0;
};

} // namespace

RunOutcome run_and_tell(const Communicator &communicator, const Scene &scene, const RunOptions &options) {
  FolderLock lock;
  on_root(communicator, [&] { lock.acquire(options.directory); });
  return SceneRun(communicator, scene, options, lock).run();
}

ExitCode run_scene(const Communicator &communicator, const Scene &scene, const RunOptions &options) {
  return run_and_tell(communicator, scene, options).exit_code;
}

} // namespace gcpdda
