#include "simulation/static_stage.hpp"

#include "base/check.hpp"
#include "dynamics/deformable.hpp"
#include "dynamics/half_works.hpp"
#include "simulation/evaluation.hpp"
#include "simulation/held_blocks.hpp"
#include "simulation/loose_blocks.hpp"
#include "simulation/stage_plan.hpp"
#include "simulation/stage_runner.hpp"
#include "simulation/static_evaluation.hpp"
#include "simulation/step_report.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <optional>
#include <string>
#include <utility>

namespace gcpdda {

double end_of_loads(const RunState &run) {
  const double now = run.clock.time();
  double end =
      std::max({now, run.scene.run.gravity_ramp, run.loads.end_of_changes(run.scene, run.clock.state, now)});
  for (const Unloading &unloading : run.clock.state.unloading) {
    if (std::isfinite(unloading.duration)) { // else the forces stay
      end = std::max(end, unloading.begin + unloading.duration);
    }
  }
  return end;
}

namespace {

/// Over the skin of blocks at rest: how far apart the boxes of two blocks may be while the spring of their
/// contact is kept after it has opened.
constexpr double spring_reach = 0.25;

/// Whether any block goes so fast that it could rise by a thousandth of its size or, without gravity, go by
/// its size within the limit: where such a block rests is where its motion ends. Collective.
bool blocks_are_under_way(const RunState &run) {
  constexpr double telling_rise = 1e-3;
  const double gravity = norm(run.scene.run.gravity);
  const double limit = run.clock.stage().duration;
  double most = 0.0;
  for (std::size_t row = 0; row < run.blocks.num_owned; ++row) {
    const BlockProperties &block = run.blocks.properties[row];
    const RigidDof &v = run.blocks.velocity[row];
    const double speed = norm(v.u) + block.radius * std::abs(v.r);
    const double size = std::sqrt(block.area);
    const bool is_fast =
        gravity > 0.0 ? speed * speed > 2.0 * gravity * telling_rise * size : speed * limit > size;
    most = is_fast ? speed : most;
  }
  return run.communicator.max(most) > 0.0;
}

/// Why the stage at hand is not for the static solver; empty if it is.
std::string not_served(const RunState &run) {
  double fastest = 0.0; // of what heeds no force
  for (std::size_t row = 0; row < run.blocks.num_owned; ++row) {
    if (run.blocks.properties[row].keeps_its_velocity()) {
      const RigidDof &v = run.blocks.velocity[row];
      fastest = std::max({fastest, norm(v.u), std::abs(v.r)});
    }
  }
  if (run.communicator.max(fastest) > 0.0 || !run.loads.prescribed.empty()) {
    return "blocks move by velocities that are given";
  }
  const Earthquake &earthquake = run.scene.earthquake;
  if (!earthquake.viscous.empty() && run.clock.state.index >= earthquake.stage) {
    return "the region has viscous sides";
  }
  if (blocks_are_under_way(run)) {
    return "blocks are under way";
  }
  const std::int64_t block = run.loads.find_pulse(run.scene, run.clock.state, run.clock.time());
  if (block >= 0) {
    return fmt::format("the table of a load of block '{}' rises and falls, and the static solver would see "
                       "no more of it than its last value",
                       run.scene.blocks[static_cast<std::size_t>(block)].name);
  }
  return std::isfinite(end_of_loads(run)) ? "" : "its loads go on changing";
}

void leave_statics(RunState &run) {
  run.clock.state.iteration.is_left = 1;
  run.clock.plan.lengthen(run.clock.state.iteration.evaluations);
  note_plan(run);
  close_statics(run);
}
void leave_statics(RunState &run, const std::string &reason,
                   const std::string &advice = "solver = \"dynamic\" in the stage says so from the start") {
  leave_statics(run);
  run.notes.push_back({Severity::info, run.clock.stage().where,
                       fmt::format("stage '{}' goes on with solver = \"dynamic\"", run.clock.stage().name),
                       reason, advice});
}

// The damping of pseudo-time, and what holds the load back, take all that the forces do together. By the
// trapezoid: half over the step that ends here, and half over the one that begins, which is found already.
enum class Step { behind, ahead };
void book_static_work(RunState &run, Step step) {
  statics::for_rows(run.statics->moving(), [&](std::size_t row) {
    const BlockSystem &blocks = run.blocks;
    const std::array<double, 6> &v = blocks.pseudo[row].velocity;
    RigidDof force = blocks.contact[row].force + blocks.anchor_force(row);
    double done_by_gradient = 0.0;
    if (blocks.is_deformable(row)) {
      const Deformation &d = blocks.deformation_of(row);
      const Mat2 increment = step == Step::ahead ? statics::gradient_after(d.trial, v) - d.trial
                                                 : blocks.gradient_increment(row);
      force.r = 0.0;
      done_by_gradient = contract(unbalanced_on_gradient(d), increment);
    }
    run.blocks.ledger[row].damping -= 0.5 * (work(force, {{v[0], v[1]}, v[2]}) + done_by_gradient);
  });
}

/// What may be left on a block that is balanced, N/m.
double balanced_force(const RunState &run) {
  const Stage &stage = run.clock.stage();
  return (stage.begins_at_rest ? held_ratio(stage) : stage.tolerance) * run.clock.state.memory.last.force;
}

void find_static_motion(RunState &run) {
  constexpr double near_rest = 100.0; // times the unbalanced ratio at rest
  const auto scope = run.phases.measure(Phase::update);
  run.statics->springs().set_links(
      run.bolts.static_springs(run.blocks, run.statics->rules().springs.slip_share));
  const bool was_local = run.statics->is_local();
  const bool is_near_rest =
      run.clock.state.memory.last.unbalanced_ratio <= near_rest * run.clock.stage().tolerance;
  statics::IterationState &iteration = run.clock.state.iteration;
  const std::int64_t products_before = iteration.products;
  const statics::BorderExchange::Sent sent_before = run.statics->sent();
  run.statics->find_motion(run.blocks, run.neighbours.candidates, run.neighbours.history, run.contacts,
                           run.force_report.max_overlap, balanced_force(run), is_near_rest, iteration);
  run.counters.products += iteration.products - products_before;
  run.counters.messages += run.statics->sent().messages - sent_before.messages;
  run.counters.bytes += run.statics->sent().bytes - sent_before.bytes;
  run.contacts.leave_out_resting(run.statics->is_local());
  if (was_local && !run.statics->is_local()) { // blocks that were not let move have not shown that they rest
    LookMemory &memory = run.clock.state.memory;
    memory.settled_looks = 0;
    memory.loose_looks = std::min(memory.loose_looks, looks_at_loose_blocks(true) - 2);
  }
}

/// Blocks of all ranks that can move. Collective.
std::int64_t count_mobile(const RunState &run) {
  std::int64_t num_mobile = 0;
  for (std::size_t row = 0; row < run.blocks.num_owned; ++row) {
    num_mobile += run.blocks.properties[row].keeps_its_velocity() ? 0 : 1;
  }
  run.communicator.sum(std::span(&num_mobile, 1));
  return num_mobile;
}

/// The iteration of a stage that begins, or goes on after a restart.
void open_statics(RunState &run) {
  statics::IterationRules rules;
  const std::int64_t num_mobile = count_mobile(run);
  if (num_mobile == 0) { // nothing to wait for
    run.clock.state.verdict = Verdict::settled;
    run.clock.state.ended = true;
    return;
  }
  rules.mass_share = statics::mass_share(num_mobile);
  rules.increments = run.clock.stage().increments;
  rules.all_move = run.clock.stage().is_trial() ? rules.all_move_in_trial : rules.all_move;
  rules.springs.reach = spring_reach * run.neighbours.base_skin;
  run.statics.emplace(run.communicator, rules);
  run.contacts.keep_details(true);
  if (run.clock.state.iteration.evaluations > 0) {
    const StaticState saved = std::exchange(run.saved_statics, {});
    refresh(run);
    const std::span<PseudoMotion> motions = pseudo_rows(run.blocks);
    for (std::size_t row = 0; row < run.blocks.num_owned; ++row) {
      const auto found =
          std::lower_bound(saved.blocks.begin(), saved.blocks.end(), run.blocks.properties[row].id.value);
      expect(found != saved.blocks.end() && *found == run.blocks.properties[row].id.value,
             "a checkpoint of the static solver holds all mobile blocks");
      motions[row] = saved.motions[static_cast<std::size_t>(found - saved.blocks.begin())];
    }
    run.statics->springs().take(run.blocks, saved.springs);
    lay_statics(run);
    return;
  }
  run.clock.state.iteration.skipped = std::max(0.0, end_of_loads(run) - run.clock.time());
  for (std::size_t row = 0; row < run.blocks.num_owned; ++row) { // where the contacts of the stage begin
    if (!run.blocks.properties[row].keeps_its_velocity()) {
      run.blocks.ledger[row].damping -= kinetic_energy_of(run.blocks, row);
    }
    hold(run.blocks, row); // blocks with a given velocity are at rest in such a stage
  }
  refresh(run);
  lay_statics(run);
  forget_increments(run.blocks);
  evaluate_statically(run);
  run.statics->hold(run.blocks);
  find_static_motion(run);
  book_static_work(run, Step::ahead);
}

/// Where a window ends in which neither the unbalanced ratio nor the share of loose blocks has fallen to half
/// of its least in the window before.
bool has_stalled(RunState &run) {
  statics::IterationState &iteration = run.clock.state.iteration;
  const StageLook &look = run.clock.state.memory.last;
  iteration.least_ratio = std::min(iteration.least_ratio, look.unbalanced_ratio);
  iteration.least_loose = std::min(iteration.least_loose, look.loose_share);
  if (iteration.evaluations % run.statics->rules().stall_window != 0) {
    return false;
  }
  const bool stalls = iteration.least_ratio > 0.5 * iteration.last_least &&
                      iteration.least_loose >= 0.5 * iteration.last_loose; // both may be none
  iteration.last_least = std::exchange(iteration.least_ratio, 1e300);
  iteration.last_loose = std::exchange(iteration.least_loose, 1.0);
  return stalls;
}

/// For what does not come nearer to rest.
constexpr std::int64_t enough_evaluations = 1500;

/// By which the motion of a single block has grown in the window of a trial that ends here, in its sizes.
/// Collective.
double farthest_in_window(RunState &run) {
  const std::span<PseudoMotion> motions = pseudo_rows(run.blocks);
  double farthest = 0.0;
  for (std::size_t row = 0; row < run.blocks.num_owned; ++row) {
    if (!run.blocks.properties[row].keeps_its_velocity()) {
      farthest = std::max(farthest, run.looks[row].moved - motions[row].moved);
      motions[row].moved = run.looks[row].moved;
    }
  }
  return run.communicator.max(farthest);
}

// A trial that fails ends here: where that is an end of the bracket, the dynamic step goes on with it in a
// stage of its own. What a watched part of the blocks does, the dynamic step says at once. Loose blocks do
// not hold up a trial where each of them would move by less than half of what fails if it went on as in the
// last window for all windows ahead, a tenth of how far a motion that fails has to go. A trial that does not
// come nearer to rest is left to the dynamic step unless a block has yet to go far and slides on, by a
// hundredth of what fails in the last window: the dynamic step takes many times as long to see where it comes
// to rest. (One of 100,290 blocks that came to rest after 1,200 evaluations more was still undecided after
// 8,000 steps.)
void judge_static_trial(RunState &run) {
  constexpr double window = 50.0; // evaluations
  constexpr double windows_ahead = 60.0;
  constexpr double times_as_far = 5.0;
  constexpr std::int64_t first_windows = 4; // see stages.hpp
  const std::int64_t evaluations = run.clock.state.iteration.evaluations;
  const bool stalls = has_stalled(run);
  const StageLook &look = run.clock.state.memory.last;
  MotionWindows &windows = run.clock.state.memory.windows;
  const bool all_rest = run.clock.state.memory.settled_looks >= 2;
  const bool stays_near = windows.farthest * windows_ahead <= 0.5 * run.clock.stage().failure_motion;
  if (run.clock.state.verdict == Verdict::settled && (all_rest || stays_near)) {
    if (!all_rest) {
      note_loose_blocks(run);
    }
    return;
  }
  const bool is_failing = run.clock.state.verdict == Verdict::failed;
  run.clock.state.ended = false;
  run.clock.state.verdict = Verdict::undecided;
  const std::optional<double> closed =
      note_motion(look, static_cast<double>(evaluations), window, 1.0, windows);
  if (closed) {
    windows.farthest = farthest_in_window(run);
  }
  const double ratio = std::min(closed.value_or(0.0), 1.0);
  const double series =
      ratio < 1.0 ? ratio * (1.0 - std::pow(ratio, windows_ahead)) / (1.0 - ratio) : windows_ahead;
  const double failure = run.clock.stage().failure_motion;
  const double far = times_as_far * failure;
  const bool goes_far =
      windows.closed >= first_windows && look.moved + series * window * windows.last_rate >= far;
  const bool goes_on = is_failing || windows.undiminished >= 2;
  const bool fails =
      look.moved_beyond_sag >= failure && (look.moved >= far || (closed && goes_on && goes_far));
  if (fails && !run.clock.stage().watches_mechanism()) {
    run.clock.state.verdict = Verdict::failed;
    run.clock.state.ended = true;
    return;
  }
  const bool slides = look.moved < far && windows.last_rate * window > 0.01 * failure;
  if (fails || (stalls && !slides && evaluations >= enough_evaluations)) {
    if (fails || windows.undiminished > 0) {
      run.local_damping = 0.0; // as drag it would hold back what goes on moving
    }
    windows = {};
    run.clock.state.memory.last.motion = std::numeric_limits<double>::infinity(); // no look of a step
    leave_statics(run, fails ? "its motion has gone far or goes on at an undiminished rate"
                             : fmt::format("it has no verdict after {} evaluations", evaluations));
  }
}

// The dynamic step takes over where hardly a block would move in it at once, or soon.
void judge_confirmation(RunState &run) {
  constexpr double most_moving = 1e-5; // of the mobile blocks
  const double ratio = held_ratio(run.clock.stage());
  std::array<std::int64_t, 2> counts{};
  auto &[moving, mobile] = counts;
  for (std::size_t row = 0; row < run.blocks.num_owned; ++row) {
    if (!run.blocks.properties[row].keeps_its_velocity()) {
      ++mobile;
      moving += run.looks[row].unbalanced > ratio * run.looks[row].yardstick ? 1 : 0;
    }
  }
  run.communicator.sum(counts);
  run.clock.state.ended = false;
  run.clock.state.verdict = Verdict::undecided;
  if (static_cast<double>(moving) <= most_moving * static_cast<double>(mobile) ||
      run.clock.state.iteration.evaluations >= enough_evaluations ||
      run.clock.state.memory.last.moved_beyond_sag >= run.clock.stage().failure_motion) {
    run.clock.state.memory.settled_looks = 0;
    leave_statics(run);
  }
}

void judge_statics(RunState &run) {
  look_at_stage(run);
  if (run.statics->load_share(run.clock.state.iteration.evaluations) < 1.0) {
    run.clock.state.ended = false;
    run.clock.state.verdict = Verdict::undecided;
    run.clock.state.memory.settled_looks = 0;
    run.clock.state.memory.loose_looks = 0;
    return;
  }
  if (run.clock.stage().begins_at_rest) {
    judge_confirmation(run);
    return;
  }
  if (run.statics->is_local() && run.clock.state.verdict == Verdict::settled) {
    run.clock.state.ended = false;
    run.clock.state.verdict = Verdict::undecided;
  }
  if (run.clock.stage().is_trial()) {
    judge_static_trial(run);
    return;
  }
  if (run.clock.state.verdict == Verdict::failed) {
    run.clock.state.ended = false;
    run.clock.state.verdict = Verdict::undecided;
    leave_statics(run, "a block has moved so far that the stage may have failed");
    return;
  }
  if (!run.clock.state.ended && has_stalled(run)) {
    leave_statics(run, fmt::format("neither the unbalanced ratio nor the number of blocks in motion has "
                                   "fallen by half in {} evaluations: {:.3g}",
                                   run.statics->rules().stall_window, run.clock.state.iteration.last_least));
  }
  note_loose_blocks_at_end(run);
}

/// Some owned row may leave the skin in the next step. Until then a rank knows both blocks of each spring
/// that is kept: boxes that are so near now met within the skin, or one of the blocks is fixed, which all
/// know.
bool uses_up_skin(const RunState &run) {
  const double most = 0.5 * (run.neighbours.skin - spring_reach * run.neighbours.base_skin);
  bool uses_up = false;
  statics::for_rows(run.statics->moving(), [&](std::size_t row) {
    const double ahead = statics::length_of_step(run.blocks, row);
    uses_up = uses_up || moved_since_refresh(run.blocks, row) + ahead > most;
  });
  return uses_up;
}

void report_statically(RunState &run) {
  const auto scope = run.phases.measure(Phase::report);
  count_step(run, {});
  std::array<double, 3> status{};
  auto &[is_stale, is_asked, has_failed] = status;
  const bool may_pause = !is_static(run) || run.statics->may_pause(run.clock.state.iteration);
  is_asked = run.stop_asked && may_pause ? 1.0 : 0.0;
  has_failed = run.local_fault ? 1.0 : 0.0;
  is_stale = is_static(run) && uses_up_skin(run) ? 1.0 : 0.0;
  run.communicator.max(status);
  run.neighbours.stale = run.clock.state.iteration.is_left != 0 || is_stale > 0.0;
  run.stop_agreed = is_asked > 0.0 && has_failed == 0.0;
  if (has_failed > 0.0) {
    agree_on_fault(run);
  }
  if (run.clock.state.iteration.is_left != 0 && !run.fault) {
    accelerate(run.blocks); // as at the beginning of a run
    hold_after_statics(run);
  }
}

} // namespace

bool is_static(const RunState &run) {
  return run.clock.stage().solver == Solver::statics && run.clock.state.iteration.is_left == 0 &&
         !run.clock.state.ended;
}

void prepare_statics(RunState &run) {
  if (run.statics) {
    return;
  }
  if (const std::string reason = not_served(run); !reason.empty()) {
    leave_statics(run, reason);
  } else {
    open_statics(run);
  }
}

void close_statics(RunState &run) {
  run.statics.reset();
  run.contacts.leave_out_resting(false);
  run.contacts.keep_details(false);
  drop_pseudo_rows(run.blocks);
}

namespace {

void move_and_evaluate(RunState &run) {
  run.statics->move(run.blocks);
  for (const statics::RowRun &rows : run.statics->moving()) { // the others are where they were
    pose_in_lanes(run.blocks, rows.first, rows.last);
    add_half_works(run.blocks, rows.first, rows.last);
  }
  run.neighbours.border_trials.clear();
  for (const std::uint32_t row : run.neighbours.ghosts.sent_rows()) {
    run.neighbours.border_trials.push_back({run.blocks.trial[row], run.blocks.is_deformable(row)
                                                                       ? run.blocks.deformation_of(row).trial
                                                                       : Mat2{}});
  }
  run.neighbours.ghosts.begin(run.blocks, run.neighbours.border_trials);
  receive_ghosts(run);
  evaluate_statically(run);
}

} // namespace

void static_step(RunState &run) {
  if (run.neighbours.stale) {
    refresh_statics(run);
  }
  move_and_evaluate(run);
  ++run.clock.step_count;
  book_static_work(run, Step::behind);
  const bool takes_back = !run.clock.stage().is_trial(); // whose dynamic step begins where the trial does
  if (takes_back && run.communicator.max(run.local_fault ? 1.0 : 0.0) > 0.0) {
    run.local_fault.reset();
    run.statics->turn_back(run.blocks);
    book_static_work(run, Step::ahead);
    move_and_evaluate(run);
    book_static_work(run, Step::behind);
    leave_statics(
        run, "a joint would have closed by more than half of a block",
        fmt::format("increments = {} in the stage lets the load in more slowly; where that does not "
                    "help, a larger joint.normal_stiffness or region.min_width closes it by less",
                    4 * run.clock.stage().increments));
  } else {
    judge_statics(run);
  }
  if (is_static(run)) {
    find_static_motion(run);
    book_static_work(run, Step::ahead);
  }
  report_statically(run);
}

bool checkpoint_is_due(const RunState &run) {
  const StageClock &clock = run.clock;
  if (!is_static(run) || !run.statics) {
    return clock.plan.checkpoint_due(clock.stage_step());
  }
  const std::int64_t since = std::min(clock.stage_step(), run.statics->rules().coarse_every);
  bool is_due = false;
  for (std::int64_t k = 0; k < since; ++k) {
    is_due = is_due || clock.plan.checkpoint_due(clock.stage_step() - k);
  }
  return is_due && run.statics->may_pause(clock.state.iteration);
}

} // namespace gcpdda
