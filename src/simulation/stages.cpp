#include "simulation/stages.hpp"

#include "base/check.hpp"

#include <algorithm>
#include <cmath>

namespace gcpdda {

std::int64_t looks_at_loose_blocks(bool is_static) {
  return is_static ? 40 : 4;
}

Verdict judge(const Stage &stage, const StageLook &look, std::int64_t looks_at_loose, LookMemory &memory) {
  constexpr double most_loose = 1e-3;      // of the mobile blocks
  constexpr double most_loose_load = 1e-2; // of the load
  constexpr double energy_at_rest = 1e-12; // of what the largest contact holds
  constexpr double share_of_weight = 2e-4; // that drives no block, once a state of rest is confirmed
  constexpr std::int64_t confirming_looks = 4;
  const StageLook last = memory.last;
  memory.most_kinetic = std::max(memory.most_kinetic, look.kinetic);
  memory.last = look;

  const bool hardly_moves =
      look.motion <= motion_at_rest * look.overlap || (stage.begins_at_rest && look.motion <= last.motion);
  const bool is_settled =
      look.unbalanced_ratio <= stage.tolerance && hardly_moves &&
      (look.kinetic <= last.kinetic || look.kinetic <= energy_at_rest * look.force * look.overlap);
  memory.settled_looks = is_settled ? memory.settled_looks + 1 : 0;
  memory.confirming += look.fall > 0.0 ? 1 : 0;
  const bool is_confirmed = memory.confirming >= confirming_looks &&
                            look.unbalanced_ratio <= stage.tolerance &&
                            look.motion <= share_of_weight * look.fall;
  const bool others_rest = look.loose_share <= most_loose && look.loose_load <= most_loose_load &&
                           (look.resting_kinetic <= last.resting_kinetic ||
                            look.resting_kinetic <= energy_at_rest * look.force * look.overlap);
  memory.loose_looks = others_rest ? memory.loose_looks + 1 : 0;
  if (memory.settled_looks >= 2 || memory.loose_looks >= looks_at_loose || is_confirmed) {
    return Verdict::settled;
  }
  const bool goes_on =
      !others_rest && look.motion >= 0.5 * last.motion && look.kinetic >= 0.25 * memory.most_kinetic;
  return look.moved_beyond_sag >= stage.failure_motion && goes_on ? Verdict::failed : Verdict::undecided;
}

std::optional<double> note_motion(const StageLook &look, double now, double first_length, double growth,
                                  MotionWindows &windows) {
  constexpr double rate_kept = 0.8;
  constexpr double log_kept = 0.05;
  if (windows.length == 0.0) {
    windows = {};
    windows.begin = now;
    windows.length = first_length;
    windows.moved = look.moved;
    return std::nullopt;
  }
  windows.sum_of_logs += std::log10(std::max(look.unbalanced_ratio, 1e-300));
  ++windows.looks;
  if (now < windows.begin + windows.length * (1.0 - 1e-9)) {
    return std::nullopt;
  }
  const double rate = (look.moved - windows.moved) / (now - windows.begin);
  const double mean = windows.sum_of_logs / static_cast<double>(windows.looks);
  const bool goes_on = windows.closed > 0 && rate > 0.0 && rate >= rate_kept * windows.last_rate &&
                       mean >= windows.last_log - log_kept;
  const std::int64_t in_a_row = goes_on ? windows.undiminished + 1 : 0;
  const double ratio = windows.last_rate > 0.0 ? rate / windows.last_rate : 0.0;
  windows = {now, growth * windows.length, look.moved, 0.0, 0, windows.closed + 1, rate, mean, in_a_row};
  return ratio;
}

Verdict judge_without_drag(const Stage &stage, const StageLook &look, double time, LookMemory &memory) {
  constexpr double growth = 2.0;
  return time >= stage.drag_limit && note_motion(look, time, stage.drag_limit, growth, memory.windows) &&
                 memory.windows.undiminished > 0 && look.moved_beyond_sag > 0.0
             ? Verdict::failed
             : Verdict::undecided;
}

// Long enough to see a pile sway, whose slowest period of about 12 steps for each block of its height grows
// with the root of their number: between two verdicts it goes on by a tenth of a period or more.
std::int64_t steps_between_verdicts(std::int64_t num_blocks) {
  return 50 + static_cast<std::int64_t>(std::sqrt(static_cast<double>(num_blocks)));
}

bool is_removed(const StageState &state, std::int64_t block) {
  return std::binary_search(state.removed.begin(), state.removed.end(), block);
}

double start_of_stage(std::int64_t stage, const StageState &state) {
  return stage == 0             ? 0.0
         : stage == state.index ? state.start_time
                                : state.results[static_cast<std::size_t>(stage - 1)].time;
}

namespace {

/// The same list of fields for both ways.
template <class State, class Count, class Real> void visit_state(State &state, Count &&count, Real &&real) {
  count(state.index), count(state.first_step), count(state.ended), count(state.contact_steps_before);
  count(state.more_mobile), count(state.verdict), count(state.memory.settled_looks),
      count(state.memory.loose_looks), count(state.memory.num_loose);
  real(state.start_time), real(state.end_time), real(state.memory.most_kinetic),
      real(state.memory.kinetic_before);
  auto &last = state.memory.last;
  real(last.unbalanced_ratio), real(last.motion), real(last.overlap), real(last.force), real(last.kinetic);
  real(last.moved), real(last.resting_kinetic);
  auto &iteration = state.iteration;
  count(iteration.evaluations), count(iteration.products), count(iteration.is_left);
  count(iteration.run), count(iteration.short_runs);
  real(iteration.power_before), real(iteration.momentum), real(iteration.longest);
  real(iteration.least_ratio), real(iteration.last_least), real(iteration.least_loose);
  real(iteration.last_loose), real(iteration.skipped);
}
template <class Result, class Count, class Real>
void visit_result(Result &result, Count &&count, Real &&real) {
  count(result.verdict), count(result.steps), count(result.contact_steps), count(result.removed);
  count(result.loose), count(result.slid_block), count(result.slid_blocks);
  real(result.slide), real(result.slide_distance);
  real(result.time), real(result.unbalanced_ratio), real(result.kinetic), real(result.moved);
}
template <class Load, class Count, class Real> void visit_unloading(Load &u, Count &&count, Real &&real) {
  count(u.block);
  real(u.rigid.u.x), real(u.rigid.u.y), real(u.rigid.r), real(u.gradient.xx), real(u.gradient.xy);
  real(u.gradient.yx), real(u.gradient.yy), real(u.begin), real(u.duration);
}

template <class State, class Count, class Real> void visit_all(State &state, Count &&count, Real &&real) {
  visit_state(state, count, real);
  for (auto &result : state.results) {
    visit_result(result, count, real);
  }
  for (auto &load : state.unloading) {
    visit_unloading(load, count, real);
  }
  for (auto &id : state.removed) {
    count(id);
  }
}

} // namespace

StageNumbers to_numbers(const StageState &state) {
  StageNumbers numbers;
  numbers.counts = {std::ssize(state.results), std::ssize(state.unloading), std::ssize(state.removed)};
  visit_all(
      state, [&](const auto &x) { numbers.counts.push_back(static_cast<std::int64_t>(x)); },
      [&](double x) { numbers.reals.push_back(x); });
  return numbers;
}

StageState to_state(const StageNumbers &numbers) {
  // How many results, loads and ids follow: a list cannot be longer than what holds it.
  const auto length = [&](std::size_t list) {
    const std::int64_t count = list < numbers.counts.size() ? numbers.counts[list] : -1;
    if (count < 0 || count > std::ssize(numbers.counts)) {
      throw FileError("it is damaged: its stages are not whole");
    }
    return static_cast<std::size_t>(count);
  };
  StageState state;
  state.results.resize(length(0));
  state.unloading.resize(length(1));
  state.removed.resize(length(2));
  std::size_t num_counts = 3;
  std::size_t num_reals = 0;
  visit_all(
      state, [&](const auto &) { ++num_counts; }, [&](double) { ++num_reals; });
  if (num_counts != numbers.counts.size() || num_reals != numbers.reals.size()) {
    throw FileError("it is damaged: its stages are not whole");
  }
  std::size_t next_count = 3;
  std::size_t next_real = 0;
  visit_all(
      state,
      [&](auto &x) { x = static_cast<std::remove_reference_t<decltype(x)>>(numbers.counts[next_count++]); },
      [&](double &x) { x = numbers.reals[next_real++]; });
  const std::int64_t num_results = std::ssize(state.results);
  const auto is_known = [](Verdict verdict) {
    return Verdict::undecided <= verdict && verdict <= Verdict::done;
  };
  if (state.index < 0 || num_results < state.index || num_results > state.index + 1 ||
      !is_known(state.verdict) ||
      !std::all_of(state.results.begin(), state.results.end(),
                   [&](const StageResult &result) { return is_known(result.verdict); }) ||
      !std::is_sorted(state.removed.begin(), state.removed.end())) {
    throw FileError("it is damaged: its stages do not follow from each other");
  }
  return state;
}

} // namespace gcpdda
