#include "driver/trial_facts.hpp"

#include "driver/run_words.hpp"
#include "driver/safety_search.hpp"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <numeric>
#include <string>
#include <vector>

namespace gcpdda {

namespace {

std::int64_t sum_of(const std::vector<std::int64_t> &counts) {
  return std::accumulate(counts.begin(), counts.end(), std::int64_t{0});
}

std::string words_on_means(const TrialFacts &facts) {
  const auto verdict = static_cast<Verdict>(facts.verdict);
  if (verdict == Verdict::undecided) {
    return "";
  }
  return is_by_statics_alone(facts)                                        ? "static solver"
         : facts.is_confirmed != 0                                         ? "static solver and dynamic step"
         : static_cast<VerdictMeans>(facts.means) == VerdictMeans::no_drag ? "dynamic step without damping"
                                                                           : "dynamic step";
}

} // namespace

TrialFacts facts_of(double factor, const RunOutcome &outcome, double start_time, bool watches) {
  TrialFacts facts;
  facts.factor = factor;
  facts.exit_code = outcome.exit_code;
  facts.ranks = outcome.summary.ranks;
  facts.evaluations = sum_of(outcome.summary.evaluations_per_rank);
  facts.cpu_s = outcome.summary.cpu_s;
  facts.time = outcome.summary.time - start_time;
  if (!outcome.summary.stages.empty()) {
    const StageResult &stage = outcome.summary.stages.back().result;
    facts.verdict =
        static_cast<std::int64_t>(outcome.exit_code == exit_code::done ? stage.verdict : Verdict::undecided);
    const bool are_two =
        watches && stage.means != VerdictMeans::static_solver; // that sees all blocks at rest
    facts.first_block = are_two && outcome.exit_code == exit_code::done
                            ? static_cast<std::int64_t>(stage.first_block)
                            : facts.verdict;
    facts.moved = stage.moved;
    facts.slide = stage.slide;
    facts.unbalanced_ratio = stage.unbalanced_ratio;
    facts.steps = stage.steps;
    facts.means = static_cast<std::int64_t>(stage.means);
    if (outcome.summary.stages.back().name == confirming_stage) {
      const StageResult &trial = outcome.summary.stages[outcome.summary.stages.size() - 2].result;
      facts.moved = std::max(facts.moved, trial.moved);
      facts.slide = std::max(facts.slide, trial.slide);
      facts.steps += trial.steps;
      facts.is_confirmed = stage.verdict == trial.verdict ? 1 : 0;
    }
  }
  return facts;
}

bool is_by_statics_alone(const TrialFacts &facts) {
  return static_cast<Verdict>(facts.verdict) != Verdict::undecided && facts.is_confirmed == 0 &&
         static_cast<VerdictMeans>(facts.means) == VerdictMeans::static_solver;
}

std::vector<EarlierSlide> slides_of(const std::vector<RunSummary::StageLine> &stages) {
  std::vector<EarlierSlide> slides;
  for (const auto &[name, verdict, result, block] : stages) {
    if (result.has_slid()) {
      slides.push_back({name, block, result.slide, result.slide_distance, result.slid_blocks,
                        words_on_slide(name, block, result)});
    }
  }
  return slides;
}

namespace {

/// A block that a given velocity moves without end; empty where there is none.
std::string block_that_never_stops(const Scene &scene) {
  for (const SceneBlock &block : scene.blocks) {
    const std::array<double, 3> &last =
        block.velocity_table.empty() ? block.velocity : block.velocity_table.back().velocity;
    if (block.driven && last != std::array<double, 3>{}) {
      return block.name;
    }
  }
  return {};
}

} // namespace

std::string words_on_no_rest(const StrengthTrial &settled, const Scene &scene) {
  const std::string begin = "the blocks do not settle, not even with the largest strength tried: ";
  if (const std::string driven = block_that_never_stops(scene); !driven.empty()) {
    return begin + fmt::format("block '{}' moves by a given velocity that never ends; let it end, by a "
                               "velocity_table whose last row has zero velocities",
                               driven);
  }
  if (settled.verdict != Verdict::failed) {
    return begin +
           "let them settle with more (stage[].set) and bring it back in a stage of kind change, or give "
           "them a longer limit";
  }
  return begin +
         fmt::format("they {} even with strengths multiplied by {:.4g}: either the factor of safety is "
                     "below {:g}, or friction has no part in it (geometry, loads); try fos.from = "
                     "{:.2g}, and look at the frames in settled",
                     settled.rests_far ? "slide by more than fos.largest_motion" : "fail",
                     1.0 / settled.factor, settled.factor, 0.2 * settled.factor);
}

StrengthTrial trial_of(const TrialFacts &facts) {
  StrengthTrial trial;
  trial.factor = facts.factor;
  trial.rests_far = facts.rests_far != 0;
  trial.verdict = trial.rests_far ? Verdict::failed : static_cast<Verdict>(facts.verdict);
  trial.first_block = facts.first_rests_far != 0 ? Verdict::failed : static_cast<Verdict>(facts.first_block);
  trial.decided_by = words_on_means(facts);
  trial.time = facts.time;
  trial.moved = facts.moved;
  trial.slide = facts.slide;
  trial.unbalanced_ratio = facts.unbalanced_ratio;
  trial.steps = facts.steps;
  trial.evaluations = facts.evaluations;
  trial.cpu_s = facts.cpu_s;
  trial.ranks = static_cast<int>(facts.ranks);
  return trial;
}

} // namespace gcpdda
