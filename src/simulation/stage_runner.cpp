#include "simulation/stage_runner.hpp"

#include "base/check.hpp"
#include "base/exact_sum.hpp"
#include "dynamics/deformable.hpp"
#include "dynamics/frequency_bound.hpp"
#include "simulation/evaluation.hpp"
#include "simulation/ground.hpp"
#include "simulation/held_blocks.hpp"
#include "simulation/loose_blocks.hpp"
#include "simulation/mechanism.hpp"
#include "simulation/slid_blocks.hpp"
#include "simulation/stage_changes.hpp"
#include "simulation/stage_plan.hpp"
#include "simulation/static_stage.hpp"
#include "simulation/step_rows.hpp"
#include "simulation/unbalanced.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

namespace gcpdda {

namespace {

double kinetic_energy_of(const BlockSystem &blocks, std::size_t row, const RigidDof &v, const Mat2 &rate) {
  const BlockProperties &block = blocks.properties[row];
  const double turning = blocks.is_deformable(row) ? kinetic_energy(blocks.deformation_of(row), rate)
                                                   : 0.5 * block.inertia * v.r * v.r;
  return 0.5 * block.mass * dot(v.u, v.u) + turning;
}

} // namespace

double kinetic_energy_of(const BlockSystem &blocks, std::size_t row) {
  return kinetic_energy_of(blocks, row, blocks.velocity[row],
                           blocks.is_deformable(row) ? blocks.deformation_of(row).rate : Mat2{});
}

namespace {

void mark_stage(RunState &run) {
  if (!run.clock.is_staged) {
    return; // nobody looks
  }
  keep_unshaken(run);
  const bool fails = run.clock.stage().goes_on_failing;
  const bool confirms = run.clock.stage().begins_at_rest || fails; // a trial, under its water
  const std::span<BlockMark> marks = mark_rows(run.blocks);
  for (std::size_t row = 0; row < run.blocks.num_owned; ++row) {
    const RigidDof &now = run.blocks.displacement[row];
    marks[row] = {fails ? marks[row].stage : now, now, confirms ? marks[row].water : now};
  }
}

/// Of all blocks, which leaves RunState::looks behind. Collective.
StageLook look_at_blocks(RunState &run) {
  ExactSum kinetic;
  std::array<double, 5> largest{};
  auto &[acting, motion, moved, moved_beyond_sag, overlap] = largest;
  const std::span<BlockMark> marks = mark_rows(run.blocks);
  run.looks.assign(run.blocks.num_owned, {});
  run.unbalanced_forces.assign(run.blocks.num_owned, 0.0);
  for (std::size_t row = 0; row < run.blocks.num_owned; ++row) {
    const BlockProperties &block = run.blocks.properties[row];
    if (block.keeps_its_velocity()) {
      continue;
    }
    BlockLook &seen = run.looks[row];
    seen.unbalanced = unbalanced_force(run, row);
    run.unbalanced_forces[row] = seen.unbalanced;
    const double weight = block.heavy_mass() * norm(run.scene.run.gravity);
    seen.load = weight + norm(applied_forces(run.blocks, row).load.u);
    acting = std::max(acting, acting_force(run, row));
    BlockMark &mark = marks[row];
    const RigidDof &now = run.blocks.displacement[row];
    seen.motion = motion_between(block, mark.look, now);
    motion = std::max(motion, seen.motion);
    const double way = motion_between(block, mark.stage, now);
    const double share = way / std::sqrt(block.area);
    seen.moved = share;
    seen.beyond_sag = way > run.sag;
    moved = std::max(moved, share);
    moved_beyond_sag = std::max(moved_beyond_sag, seen.beyond_sag ? share : 0.0);
    mark.look = now;
    seen.kinetic = kinetic_energy_of(run.blocks, row);
    kinetic.add(seen.kinetic);
  }
  acting = std::max(acting, run.contacts.sums().largest_force());
  overlap = run.force_report.max_overlap;
  run.communicator.max(largest);
  if (overlap == 0.0) { // all hang on fixed points or bolts
    overlap = run.sag;
  }
  if (!is_static(run)) { // which has no velocities
    run.communicator.sum(kinetic.limbs());
  }
  const double ratio = measure_looks(run, acting);
  return {ratio, motion, overlap, acting, kinetic.value(), moved, moved_beyond_sag};
}

/// Looks at the stage at hand so far.
std::int64_t looks_before(const RunState &run) {
  return run.clock.stage_step() / steps_between_verdicts(num_blocks(run.scene));
}

/// The strengths of a trial fall up to this look. Blocks that fail have failed, those at rest may not stay
/// there.
bool is_weakening(const RunState &run) {
  return !is_static(run) && looks_before(run) <= std::ssize(run.clock.stage().weakening);
}

} // namespace

double time_of_trial(const RunState &run) {
  return run.clock.plan.time(std::max<std::int64_t>(0, run.clock.stage_step() - steps_of_weakening(run)));
}

namespace {

bool drag_has_ended(const RunState &run) {
  return time_of_trial(run) >= run.clock.stage().drag_limit;
}

/// Loads of the stage at hand are not there yet.
bool is_loading(const RunState &run) {
  const bool unloads = std::any_of(
      run.clock.state.unloading.begin(), run.clock.state.unloading.end(), [&](const Unloading &u) {
        return std::isfinite(u.duration) && run.clock.time() < u.begin + u.duration;
      });
  return unloads || run.clock.time() < run.scene.run.gravity_ramp ||
         run.clock.time() < run.loads.end_of_changes(run.scene, run.clock.state, run.clock.time());
}

} // namespace

// Three reductions, now and then; all are exact.
void look_at_stage(RunState &run) {
  StageLook look = look_at_blocks(run);
  const Stage &stage = run.clock.stage();
  if (stage.begins_at_rest && !is_static(run)) {
    const double length =
        static_cast<double>(steps_between_verdicts(num_blocks(run.scene))) * run.clock.plan.time_step;
    const double looks = static_cast<double>(run.clock.state.memory.confirming) + 0.5;
    look.fall = looks * length * length * norm(run.scene.run.gravity);
  }
  if (stage.until_verdict && (!stage.is_trial() || is_static(run))) {
    look_for_loose_blocks(run, look);
  }
  run.clock.state.verdict = judge(stage, look, looks_at_loose_blocks(is_static(run)), run.clock.state.memory);
  if (run.clock.state.verdict == Verdict::undecided && stage.is_trial() && !is_static(run)) {
    run.clock.state.verdict = judge_without_drag(stage, look, time_of_trial(run), run.clock.state.memory);
  }
  if (stage.is_trial() && stage.watches_mechanism() && !is_static(run)) {
    run.clock.state.verdict = judge_mechanism(run, look, run.clock.state.verdict);
  }
  const bool is_no_rest = is_weakening(run) || is_to_shake(run);
  if (is_loading(run) || (is_no_rest && run.clock.state.verdict == Verdict::settled)) {
    run.clock.state.verdict = Verdict::undecided;
  }
  run.clock.state.end_time = run.clock.time();
  run.clock.state.ended = stage.until_verdict && run.clock.state.verdict != Verdict::undecided;
}

// Stick springs keep their stretch: they go on from the last trial configuration.
void set_to_rest(RunState &run) {
  for (std::size_t row = 0; row < run.blocks.num_owned; ++row) {
    if (!run.blocks.properties[row].keeps_its_velocity()) {
      set_to_rest(run.blocks, row);
    }
  }
}

// What stopping takes from the energies of the ledger, which are those of the leapfrog of x*. It would have
// gone on to x*' = x + c1 dt v + c2 dt^2 a with the kinetic energy of (x*' - x*)/dt; it goes on from x
// instead, and the trapezoid of this evaluation and about that of the next, which begins from rest, take f
// along x - x*' and x - x*.
//
// A stop takes energy. With am = 0 (r = 0.5) the two ways are x - x* = dt v/3 + dt^2 a/6 and x*' - x = 2 dt
// v/3, and the net force is M a whatever it is made of, implicit elasticity included, so what is booked is
//     -(v M v/2 + (7/72) dt^2 a M a) <= 0.
// Springs k that act at x* alone make this exact but for + (x - x*) k (x - x*)/2, from the trapezoid of the
// coming evaluation. By Cauchy and Schwarz (x - x*) M (x - x*) <= (32/63) dt^2 (v M v/2 + (7/72) dt^2 a M a),
// so that the energy falls up to W = dt omega = sqrt(63/16) = 1.98. Elasticity K that acts implicitly
// remembers two steps, and the energy is a state's own again only at rest, where it is x (k + K) x/2: no
// stop, after whatever number of steps from rest, raises it. tests/unit/dynamics/kinetic_stop_test.cpp tries
// that for k and K at random up to 0.9 of the limit, which settle stages keep.
void stop(RunState &run, std::size_t row) {
  const double dt = run.clock.plan.time_step;
  const double by_velocity = run.scheme.trial_velocity * dt;
  const double by_acceleration = run.scheme.trial_acceleration * dt * dt;
  const RigidDof ahead =
      by_velocity * run.blocks.velocity[row] + by_acceleration * run.blocks.acceleration[row];
  const RigidDof behind = run.blocks.displacement[row] - run.blocks.trial[row];
  RigidDof force = run.blocks.contact[row].force + run.blocks.anchor_force(row);
  Mat2 stretch;
  double work_on_gradient = 0.0;
  if (run.blocks.is_deformable(row)) {
    const Deformation &d = run.blocks.deformation_of(row);
    const Mat2 gradient_ahead = by_velocity * d.rate + by_acceleration * d.acceleration;
    const Mat2 gradient_behind = d.gradient - d.trial;
    force.r = 0.0;
    stretch = (1.0 / dt) * (gradient_behind + gradient_ahead);
    work_on_gradient = contract(unbalanced_on_gradient(d), gradient_ahead - gradient_behind);
  }
  run.blocks.ledger[row].damping +=
      0.5 * (work(force, ahead - behind) + work_on_gradient) -
      kinetic_energy_of(run.blocks, row, (1.0 / dt) * (behind + ahead), stretch);
  set_to_rest(run.blocks, row);
}

namespace {

// Where the energy of motion has just been greatest the pile passes through the balance of the slowest mode
// that moves: from rest there it has less far to go. An exact sum, so that every number of ranks stops alike.
void stop_at_energy_peak(RunState &run) {
  ExactSum kinetic;
  for (std::size_t row = 0; row < run.blocks.num_owned; ++row) {
    if (!run.blocks.properties[row].keeps_its_velocity()) {
      kinetic.add(kinetic_energy_of(run.blocks, row));
    }
  }
  run.communicator.sum(kinetic.limbs());
  const double now = kinetic.value();
  const bool passed = now < run.clock.state.memory.kinetic_before;
  run.clock.state.memory.kinetic_before = passed ? 0.0 : now;
  if (passed) {
    for (std::size_t row = 0; row < run.blocks.num_owned; ++row) {
      if (!run.blocks.properties[row].keeps_its_velocity()) {
        stop(run, row);
      }
    }
  }
}

/// Of a stage that is over as soon as it has begun.
StageResult result_without_steps(const StageState &stage) {
  StageResult result;
  result.verdict = stage.verdict;
  result.time = stage.end_time;
  result.removed =
      std::accumulate(stage.results.begin(), stage.results.end(), std::ssize(stage.removed),
                      [](std::int64_t left, const StageResult &earlier) { return left - earlier.removed; });
  return result;
}

} // namespace

namespace {

VerdictMeans means_of_verdict(const RunState &run) {
  return run.clock.stage().solver == Solver::statics && run.clock.state.iteration.is_left == 0
             ? VerdictMeans::static_solver
         : drag_has_ended(run) ? VerdictMeans::no_drag
                               : VerdictMeans::dynamic_step;
}

} // namespace

void weaken_further(RunState &run) {
  const std::vector<std::vector<JointLaw>> &weakening = run.clock.stage().weakening;
  const std::int64_t number = looks_before(run);
  const std::int64_t since_look = run.clock.stage_step() % steps_between_verdicts(num_blocks(run.scene));
  if (number == 0 || number > std::ssize(weakening) || since_look != 0) {
    return;
  }
  change_strengths(run, number < std::ssize(weakening) ? weakening[static_cast<std::size_t>(number)]
                                                       : run.clock.stage().after->joints.laws);
  run.clock.state.memory.settled_looks = 0; // the looks so far were not at the strengths of the trial
}

void judge_stage(RunState &run) {
  if (run.clock.stage().kinetic_damping) {
    stop_at_energy_peak(run);
  }
  if (run.clock.is_staged && run.clock.stage_step() % steps_between_verdicts(num_blocks(run.scene)) == 0) {
    look_at_stage(run);
    note_loose_blocks_at_end(run);
    hold_at_look(run);
    if (drag_has_ended(run)) {
      run.local_damping = 0.0;
    }
  }
}

namespace {

/// How the stage stands now, which ends or pauses between two looks. Collective.
StageLook look_between(RunState &run) {
  StageLook look = run.clock.state.memory.last;
  look.unbalanced_ratio = unbalanced_ratio(run);
  ExactSum kinetic;
  double moved = 0.0;
  for (std::size_t row = 0; row < run.blocks.num_owned; ++row) {
    const BlockProperties &block = run.blocks.properties[row];
    if (!block.keeps_its_velocity()) {
      const double way = motion_between(block, run.blocks.mark_of(row).stage, run.blocks.displacement[row]);
      moved = std::max(moved, way / std::sqrt(block.area));
      kinetic.add(kinetic_energy_of(run.blocks, row));
    }
  }
  run.communicator.sum(kinetic.limbs());
  look.moved = run.communicator.max(moved);
  look.kinetic = kinetic.value();
  return look;
}

bool has_just_looked(const RunState &run) {
  return means_of_verdict(run) == VerdictMeans::static_solver ||
         run.clock.stage_step() % steps_between_verdicts(num_blocks(run.scene)) == 0;
}

} // namespace

std::vector<StageResult> stage_results(RunState &run) {
  std::vector<StageResult> results = run.clock.state.results;
  if (std::ssize(results) == run.clock.state.index) {
    std::int64_t contact_steps = run.counters.contact_steps;
    run.communicator.sum(std::span(&contact_steps, 1));
    const StageLook last =
        has_just_looked(run) || !run.clock.is_staged ? run.clock.state.memory.last : look_between(run);
    results.push_back({run.clock.state.verdict, run.clock.time(), run.clock.stage_step(),
                       contact_steps - run.clock.state.contact_steps_before, last.unbalanced_ratio,
                       last.kinetic, last.moved, 0, run.clock.state.memory.num_loose, means_of_verdict(run),
                       run.clock.state.first_block});
  }
  return results;
}

// A stage that reached its limit undecided stays as it is: with a longer limit a restart goes on with it.
void end_stage(RunState &run) {
  const Stage &stage = run.clock.stage();
  if (!run.clock.is_staged || !run.clock.stage_is_over() || run.fault ||
      std::ssize(run.clock.state.results) > run.clock.state.index ||
      (stage.until_verdict && !run.clock.state.ended)) {
    return;
  }
  run.clock.state.results = stage_results(run);
  run.clock.state.end_time = run.clock.time();
  run.clock.state.ended = true;
  if (stage.asks_for_rest() && run.clock.state.verdict == Verdict::settled && !has_begun_to_shake(run)) {
    note_slide(run, run.clock.state.results.back());
  }
  if (stage.kind == StageKind::settle) {
    close_statics(run);
    unscale_masses(run);
    if (run.clock.state.verdict == Verdict::settled) {
      set_to_rest(run);
    }
  }
}

namespace {

/// What is remembered of contacts between blocks that have not been removed.
ContactMemory remembered_of_those_left(const RunState &run) {
  ContactMemory memory = run.neighbours.remembered(run.blocks);
  const auto is_gone = [&](const auto &record) {
    return is_removed(run.clock.state, record.lower.value) ||
           is_removed(run.clock.state, record.higher.value);
  };
  std::erase_if(memory.plain, is_gone);
  std::erase_if(memory.others, is_gone);
  return memory;
}

/// The state of the clock in a stage in which nothing has happened yet.
void open_next_stage(RunState &run) {
  StageState &state = run.clock.state;
  state.start_time = run.clock.time();
  state.first_step = run.clock.step_count;
  ++state.index;
  state.ended = false;
  state.verdict = Verdict::undecided;
  const StageLook last = state.memory.last;
  state.memory = {};
  if (run.clock.stage().goes_on_failing) {
    state.memory.last = last;
    state.memory.last.motion = std::numeric_limits<double>::infinity(); // no look of a step
  }
  state.mechanism = {};
  state.first_block = Verdict::undecided;
  state.iteration = {};
  state.contact_steps_before = run.counters.contact_steps;
  run.communicator.sum(std::span(&state.contact_steps_before, 1));
  std::erase_if(state.unloading,
                [&](const Unloading &u) { return run.clock.time() >= u.begin + u.duration; });
  run.clock.plan.duration = 0.0; // so that time() is the beginning of the stage
  run.clock.plan.num_steps = 0;
}

} // namespace

void begin_next_stage(RunState &run) {
  expect(run.clock.stage_is_over() && !run.fault && !run.clock.is_finished(),
         "a stage begins when the one before is over");
  open_next_stage(run);
  const Stage &stage = run.clock.stage();
  const bool takes_away = stage.kind == StageKind::excavate || opens_viscous_sides(run);
  if (takes_away) {
    refresh(run);
    evaluate_still(run);
    if (stage.kind == StageKind::excavate) {
      excavate(run, stage);
    } else {
      excavate(run, held_beyond_viscous_sides(run), std::numeric_limits<double>::infinity());
    }
  }
  ContactMemory memory = remembered_of_those_left(run);
  if (takes_away) {
    remove_blocks(run, run.clock.state.removed);
  }
  run.bolts.share(run.communicator);
  const std::vector<Bolt> bolts_before = run.scene.bolts;
  const std::vector<Liner> liners_before = run.scene.liners;
  adopt(run, stage, run.clock.time());
  if (stage.solver == Solver::dynamic && !stage.weakening.empty()) {
    take_laws(run, stage.weakening.front());
    run.contacts = ContactForces(contact_parameters(run.scene));
  }
  change_support(run, bolts_before, liners_before);
  scale_masses(run);
  find_bound(run);
  plan_stage(run);
  prepare_matrices(run);
  refresh(run, std::move(memory));
  mark_stage(run); // first: the water of a trial presses where blocks are now
  evaluate_still(run);
  run.loads.time = run.clock.time();
  accelerate_owned(run);
  if (stage.goes_on_failing) {
    hold_after_statics(run);
  }
  if (!stage.takes_steps()) {
    run.clock.state.verdict = Verdict::done;
    run.clock.state.end_time = run.clock.time();
    run.clock.state.results.push_back(result_without_steps(run.clock.state));
    run.clock.state.ended = true;
  }
}

} // namespace gcpdda
