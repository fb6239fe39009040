#include "io/results/safety_report.hpp"

#include "base/check.hpp"
#include "base/program_facts.hpp"
#include "io/hdf5/durable_file.hpp"
#include "io/results/json.hpp"
#include "io/results/result_directory.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>

namespace gcpdda {

namespace {

namespace fs = std::filesystem;

constexpr std::array<const char *, 6> own_names{"fos.txt",        "fos.json", "fos_trials.csv",
                                                "fos_blocks.csv", "fos.svg",  "fos_first_block.svg"};
constexpr double one_degree = std::numbers::pi / 180.0;

std::string bound_text(const SafetyReport &report) {
  if (!report.unsolved_bound.empty()) {
    return "limit analysis gives no bound: " + report.unsolved_bound;
  }
  std::string text =
      report.bound ? fmt::format("factor of safety at most {:.5g}, by limit analysis of rigid blocks at "
                                 "the settled state: with strengths divided by more no forces balance "
                                 "the loads",
                                 *report.bound)
                   : std::string("limit analysis gives no bound: forces balance the loads at the "
                                 "largest factor (fos.to), or the strengths have no part in it");
  if (report.resting_bound && report.resting_bound != report.bound) {
    text +=
        fmt::format("\nblocks that do not slide on hold at most at {:.5g}: beyond it joints have to close "
                    "that are open by up to a tenth of a block's size",
                    *report.resting_bound);
  }
  return text;
}

std::string unconfirmed_text(const UnconfirmedBracket &bracket) {
  constexpr int usual_patience = 8;
  const std::string ends =
      bracket.holds && bracket.fails
          ? fmt::format("hold at {:.6g} and fail at {:.6g}", *bracket.holds, *bracket.fails)
      : bracket.holds ? fmt::format("hold at {:.6g} and fail at no factor tried", *bracket.holds)
      : bracket.fails ? fmt::format("fail at {:.6g} and hold at no factor tried", *bracket.fails)
                      : std::string("neither hold nor fail at any factor tried");
  return fmt::format("no factor of safety: by the static solver alone the blocks {}, and {} confirmations by "
                     "the dynamic step are undecided in fos.limit = {:g} s; use a longer one, such as "
                     "fos.limit = {:.2g}{}",
                     ends, bracket.confirmations, bracket.limit, 10.0 * bracket.limit,
                     bracket.patience < usual_patience ? fmt::format(", or fos.patience = {}", usual_patience)
                                                       : std::string());
}

std::string factor_text(const SafetyReport &report) {
  if (report.is_bound_alone) {
    return bound_text(report);
  }
  if (report.unconfirmed) {
    return unconfirmed_text(*report.unconfirmed);
  }
  if (report.holds && report.fails) {
    return fmt::format(
        "factor of safety {:.5g}: the blocks hold at {:.6g} and fail at {:.6g}, {:.2g} % apart",
        0.5 * (*report.holds + *report.fails), *report.holds, *report.fails,
        100.0 * (*report.fails / *report.holds - 1.0));
  }
  if (report.fails) {
    return fmt::format("the blocks fail already at {:.6g}, the smallest factor tried", *report.fails);
  }
  return report.holds
             ? fmt::format("the blocks still hold at {:.6g}, no factor tried made them fail", *report.holds)
             : std::string("no trial came to a verdict");
}

std::string undecided_text(const SafetyReport &report) {
  if (report.undecided.empty() || report.unconfirmed) { // there is no bracket in which the factor lies
    return {};
  }
  return fmt::format(
      "undecided in the limit: {} trial{} from {:.6g} to {:.6g}; the factor lies anywhere in the "
      "bracket, a longer fos.limit may narrow it\n",
      report.undecided.size(), report.undecided.size() == 1 ? "" : "s", report.undecided.front(),
      report.undecided.back());
}

std::string slide_text(const SafetyReport &report) {
  if (!report.first_slide) {
    return {};
  }
  return fmt::format(
      "warning: at {:.6g} blocks slide to where they hold: one moves by {:.2g} of its size "
      "before it rests; where that is failure the factor is smaller, and fos.largest_motion = {:g} "
      "finds it\n",
      report.first_slide->factor, report.first_slide->moved, StageResult::telling_slide);
}

std::string earlier_slides_text(const SafetyReport &report) {
  std::string text;
  for (const EarlierSlide &slide : report.earlier_slides) {
    text += fmt::format("warning: {}: the {} is that of the place where the blocks came to hold, and their "
                        "strength without reduction may already have failed (a factor below 1); try "
                        "failure_motion = {:.1g} in that stage, or fos.largest_motion = {:g} with fos.from "
                        "below 1\n",
                        slide.words, report.is_bound_alone ? "bound" : "factor", 0.5 * slide.share,
                        StageResult::telling_slide);
  }
  return text;
}

/// Turning about a far point or a corner moves a block's points by more than its centroid.
std::string mechanism_text(const SafetyReport &report) {
  std::vector<const FailingBlock *> moving;
  double turning = 0.0;
  for (const FailingBlock &block : report.mechanism) {
    if (block.moves) {
      moving.push_back(&block);
      turning += std::abs(block.rotation);
    }
  }
  if (moving.empty()) {
    return {};
  }
  std::stable_sort(moving.begin(), moving.end(),
                   [](const FailingBlock *a, const FailingBlock *b) { return a->motion > b->motion; });
  std::string text = fmt::format(
      "{} of {} blocks move when it fails, and turn by {:.3g} degrees on average; the farthest:\n",
      moving.size(),
      std::count_if(report.mechanism.begin(), report.mechanism.end(),
                    [](const FailingBlock &b) { return !b.fixed; }),
      turning / one_degree / static_cast<double>(moving.size()));
  constexpr std::size_t most = 10;
  for (std::size_t k = 0; k < std::min(most, moving.size()); ++k) {
    const FailingBlock &block = *moving[k];
    text += fmt::format("  {:<16} moved by ({:.3g}, {:.3g}) m, turned by {:.3g} degrees\n", block.name,
                        block.displacement.x, block.displacement.y, block.rotation / one_degree);
  }
  return text;
}

/// The names of those that move, the farthest first, with their area.
std::string words_on_first_block(const FirstBlock &first) {
  const std::string bracket =
      first.holds && first.fails
          ? fmt::format("first block: factor {:.5g}, holds at {:.6g} and fails at {:.6g}",
                        0.5 * (*first.holds + *first.fails), *first.holds, *first.fails)
      : first.fails ? fmt::format("first block: fails already at {:.6g}", *first.fails)
                    : std::string("first block: none fails at any factor tried");
  std::vector<const FailingBlock *> moving;
  double area = 0.0;
  for (const FailingBlock &block : first.blocks) {
    if (block.moves) {
      moving.push_back(&block);
      area += block.area;
    }
  }
  std::stable_sort(moving.begin(), moving.end(),
                   [](const FailingBlock *a, const FailingBlock *b) { return a->motion > b->motion; });
  constexpr std::size_t most = 5;
  std::string names;
  for (std::size_t k = 0; k < std::min(most, moving.size()); ++k) {
    names += (names.empty() ? "" : ", ") + moving[k]->name;
  }
  return bracket +
         (moving.empty() ? std::string()
                         : fmt::format("; {} block{} of {:.3g} m2 together: {}{}", moving.size(),
                                       moving.size() == 1 ? "" : "s", area, names,
                                       moving.size() > most ? ", ..." : "")) +
         "\n";
}

std::string trial_line(const StrengthTrial &trial) {
  return fmt::format("{:>10.6g}  {:<9} {:>9.4g} {:>9} {:>12} {:>8.2f} {:>5} {:>9.3g}  {}{}{}\n", trial.factor,
                     word_of(trial.verdict), trial.time, trial.steps, trial.evaluations, trial.cpu_s,
                     trial.ranks, trial.moved, trial.decided_by, trial.decisive ? "" : "  (spare)",
                     trial.message.empty() ? "" : "  " + trial.message);
}

JsonObject trial_object(const StrengthTrial &trial) {
  return JsonObject()
      .add("factor", trial.factor)
      .add("verdict", std::string(word_of(trial.verdict)))
      .add("first_block", std::string(word_of(trial.first_block)))
      .add("decided_by", trial.decided_by)
      .add("decisive", trial.decisive ? 1 : 0)
      .add("time", trial.time)
      .add("steps", trial.steps)
      .add("evaluations", trial.evaluations)
      .add("cpu_s", trial.cpu_s)
      .add("ranks", trial.ranks)
      .add("moved", trial.moved)
      .add("unbalanced_ratio", trial.unbalanced_ratio)
      .add("message", trial.message)
      .add("directory", trial.directory.string());
}

std::string json_text(const SafetyReport &report) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN(); // null
  JsonObject object(",\n ");
  object.add("factor", report.holds && report.fails ? 0.5 * (*report.holds + *report.fails) : none)
      .add("holds", report.holds.value_or(none))
      .add("fails", report.fails.value_or(none))
      .add("bound", report.bound.value_or(none))
      .add("resting_bound", report.resting_bound.value_or(none))
      .add("slides_from", report.first_slide ? report.first_slide->factor : none)
      .add("tolerance", report.tolerance)
      .add("found", report.is_found() ? 1 : 0)
      .add("version", program_version())
      .add("command", command_line());
  if (const auto &first = report.first_block) {
    object.add("first_block_holds", first->holds.value_or(none))
        .add("first_block_fails", first->fails.value_or(none))
        .add("ignore_area", report.ignored_area);
  }
  if (const auto &found = report.unconfirmed) {
    object.add("static_holds", found->holds.value_or(none)).add("static_fails", found->fails.value_or(none));
  }
  std::vector<JsonObject> trials;
  std::transform(report.trials.begin(), report.trials.end(), std::back_inserter(trials), trial_object);
  std::vector<JsonObject> moving;
  for (const FailingBlock &block : report.mechanism) {
    if (block.moves) {
      moving.push_back(JsonObject()
                           .add("block", block.name)
                           .add("x", block.displacement.x)
                           .add("y", block.displacement.y)
                           .add("rotation", block.rotation)
                           .add("motion", block.motion));
    }
  }
  std::vector<JsonObject> slides;
  for (const EarlierSlide &slide : report.earlier_slides) {
    slides.push_back(JsonObject()
                         .add("stage", slide.stage)
                         .add("block", slide.block)
                         .add("slide", slide.share)
                         .add("distance", slide.distance)
                         .add("blocks", slide.blocks)
                         .add("words", slide.words));
  }
  return object.add("families", report.families)
             .add("undecided", report.undecided)
             .add("settled", trial_object(report.settled))
             .add("earlier_slides", slides)
             .add("left_out_stages", report.left_out_stages)
             .add("trials", trials)
             .add("moving", moving)
             .text() +
         "\n";
}

std::string trials_csv(const SafetyReport &report) {
  std::string text = "factor[-],verdict,decisive,time[s],steps,evaluations,cpu[s],ranks,moved[-],unbalanced_"
                     "ratio[-],decided_by\n";
  for (const StrengthTrial &trial : report.trials) {
    text += fmt::format("{:.17g},{},{},{:.9g},{},{},{:.3f},{},{:.9g},{:.9g},{}\n", trial.factor,
                        word_of(trial.verdict), trial.decisive ? 1 : 0, trial.time, trial.steps,
                        trial.evaluations, trial.cpu_s, trial.ranks, trial.moved, trial.unbalanced_ratio,
                        trial.decided_by);
  }
  return text;
}

std::string blocks_csv(const SafetyReport &report) {
  std::string text = "block,moves,x[m],y[m],rotation[rad],motion[m]\n";
  for (const FailingBlock &block : report.mechanism) {
    text += fmt::format("{},{},{:.9g},{:.9g},{:.9g},{:.9g}\n", block.name, block.moves ? 1 : 0,
                        block.displacement.x, block.displacement.y, block.rotation, block.motion);
  }
  return text;
}

/// Only a search alone can be replaced: a run or an ensemble beside it would stay.
void refuse_other_results(const fs::path &directory, bool overwrite) {
  const bool is_run = fs::exists(directory / "scene.toml");
  const bool cannot_be_replaced = is_run || holds_ensemble(directory);
  if (cannot_be_replaced || (holds_search(directory) && !overwrite)) {
    throw FileError(fmt::format("{} holds {} already, choose another folder with --out{}", directory.string(),
                                is_run               ? "a run"
                                : cannot_be_replaced ? "an ensemble"
                                                     : "a search for the factor of safety",
                                cannot_be_replaced ? "" : " or replace it with --overwrite"));
  }
}

} // namespace

std::string to_text(const SafetyReport &report) {
  std::string families;
  for (const std::string &name : report.families) {
    families += (families.empty() ? "" : ", ") + name;
  }
  std::string text =
      fmt::format("{}\n{}strengths divided: friction, cohesion and tension of {}\n", factor_text(report),
                  undecided_text(report) + slide_text(report) + earlier_slides_text(report), families);
  if (report.leaves_earthquake_out) {
    text += "the earthquake of the scene is left out: the factor is that of blocks that were never shaken\n";
  }
  for (const std::string &stage : report.left_out_stages) {
    text += fmt::format(
        "warning: stage '{}' is left out with what it changes, since it comes after the last settle "
        "stage; kind = \"settle\" in it takes it into the search\n",
        stage);
  }
  text += mechanism_text(report);
  if (report.first_block) {
    text += report.is_bound_alone
                ? "the bound is that of any block: fos.ignore_area and fos.region have no part in it\n"
                : words_on_first_block(*report.first_block);
  }
  const double settled_at = report.settled.factor;
  text += fmt::format(
      "{}{}: t = {:.4g} s, {} steps, {} evaluations, {:.2f} CPU s\n",
      report.settled.verdict == Verdict::failed ? "run that has not settled" : "settled state",
      settled_at == 1.0 ? "" : fmt::format(" with strengths divided by {:g}", settled_at),
      report.settled.time, report.settled.steps, report.settled.evaluations, report.settled.cpu_s);
  if (report.trials.empty()) {
    return report.settled.message.empty() ? text : text + report.settled.message + "\n";
  }
  text += "    factor  verdict    time[s]     steps  evaluations   CPU[s] ranks     moved  decided by\n";
  for (const StrengthTrial &trial : report.trials) {
    text += trial_line(trial);
  }
  return text;
}

void write_safety_report(const fs::path &directory, const SafetyReport &report,
                         const SafetyPictures &pictures) {
  write_file(directory / "fos.txt", to_text(report));
  write_file(directory / "fos.json", json_text(report));
  write_file(directory / "fos_trials.csv", trials_csv(report));
  if (!report.mechanism.empty()) {
    write_file(directory / "fos_blocks.csv", blocks_csv(report));
    write_file(directory / "fos.svg", pictures.mechanism);
  }
  if (!pictures.first_block.empty()) {
    write_file(directory / "fos_first_block.svg", pictures.first_block);
  }
}

void prepare_safety_directory(const fs::path &directory, bool overwrite, FolderLock &lock) {
  refuse_other_results(directory, overwrite);
  make_directory(directory);
  lock.acquire_for_many_runs(directory);
  refuse_other_results(directory, overwrite); // another search may have ended in between
  for (const char *name : own_names) {
    fs::remove(directory / name);
  }
  if (fs::is_directory(directory / "trials")) {
    for (const fs::directory_entry &entry : fs::directory_iterator(directory / "trials")) {
      if (fs::exists(entry.path() / "scene.toml")) { // a trial
        fs::remove_all(entry.path());
      }
    }
  }
  make_directory(directory / "trials");
}

} // namespace gcpdda
