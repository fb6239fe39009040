// Stages of a Simulation: their plan, the looks at them, how one ends and the next begins.

#include "base/check.hpp"
#include "base/exact_sum.hpp"
#include "dynamics/deformable.hpp"
#include "dynamics/frequency_bound.hpp"
#include "simulation/simulation.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

namespace gcpdda {

namespace {

/// A component of a force before local damping took its share: f (1 - share sign(f) sign(v)).
double undamped(double force, double velocity, double share) {
  const double sign = force * velocity > 0.0 ? 1.0 : force * velocity < 0.0 ? -1.0 : 0.0;
  return force / (1.0 - share * sign);
}

double kinetic_energy_of(const BlockSystem &blocks, std::size_t row, const RigidDof &v, const Mat2 &rate) {
  const BlockProperties &block = blocks.properties[row];
  const double turning = blocks.is_deformable(row) ? kinetic_energy(blocks.deformation_of(row), rate)
                                                   : 0.5 * block.inertia * v.r * v.r;
  return 0.5 * block.mass * dot(v.u, v.u) + turning;
}
double kinetic_energy_of(const BlockSystem &blocks, std::size_t row) {
  return kinetic_energy_of(blocks, row, blocks.velocity[row],
                           blocks.is_deformable(row) ? blocks.deformation_of(row).rate : Mat2{});
}

/// Largest distance a point of the block has moved.
double motion_between(const BlockProperties &block, const RigidDof &from, const RigidDof &to) {
  return norm(to.u - from.u) + block.radius * std::abs(to.r - from.r);
}

} // namespace

// What cannot be run is told before anything is.
void Simulation::plan_all_stages() {
  for (const Stage &stage : stages_) {
    if (is_staged_ && stage.takes_steps()) {
      RunSettings run = scene_.run;
      run.duration = stage.duration;
      Diagnostics found;
      plan_time(run, scene_.output, std::numeric_limits<double>::infinity(), found);
      for (Diagnostic &d : found) {
        if (d.severity == Severity::error) {
          d.where = stage.where;
          notes_.push_back(std::move(d));
        }
      }
    }
  }
}

void Simulation::plan_stage() {
  const Stage &stage = stages_[static_cast<std::size_t>(stage_.index)];
  RunSettings run = scene_.run;
  run.duration = stage.takes_steps() ? stage.duration : scene_.output.interval;
  plan_ = plan_time(run, scene_.output, bound_.time_step, notes_);
  if (!stage.takes_steps()) {
    plan_.duration = 0.0;
    plan_.num_steps = 0;
  }
  local_damping_ = stage.local_damping_or(scene_.run.local_damping);
}

bool Simulation::finished() const {
  if (fault_) {
    return true;
  }
  if (!stage_is_over()) {
    return false;
  }
  const Stage &stage = stages_[static_cast<std::size_t>(stage_.index)];
  const bool goes_on = !stage.until_verdict || stage_.verdict == Verdict::settled;
  return stage_.index + 1 == std::ssize(stages_) || !goes_on;
}

void Simulation::mark_stage() {
  if (!is_staged_) {
    return; // nobody looks
  }
  const std::span<BlockMark> marks = mark_rows(blocks_);
  for (std::size_t row = 0; row < blocks_.num_owned; ++row) {
    marks[row] = {blocks_.displacement[row], blocks_.displacement[row]};
  }
}

// What local damping of the last evaluation acted against, to a positive factor.
RigidDof Simulation::damped_motion(std::size_t row) const {
  return blocks_.is_deformable(row) ? next_trial(blocks_, scheme_, plan_.time_step, row).motion -
                                          blocks_.trial[row] + blocks_.motion[row].increment()
                                    : blocks_.velocity[row];
}

void Simulation::judge_stage() {
  if (stages_[static_cast<std::size_t>(stage_.index)].kinetic_damping) {
    stop_at_energy_peak();
  }
  if (is_staged_ && stage_step() % steps_between_verdicts(num_blocks()) == 0) {
    look_at_stage();
  }
}

// Two reductions, now and then; both are exact.
void Simulation::look_at_stage() {
  ExactSum kinetic;
  std::array<double, 6> largest{};
  auto &[unbalanced, acting, motion, moved, moved_beyond_sag, overlap] = largest;
  const std::span<BlockMark> marks = mark_rows(blocks_);
  for (std::size_t row = 0; row < blocks_.num_owned; ++row) {
    const BlockProperties &block = blocks_.properties[row];
    if (block.keeps_its_velocity()) {
      continue;
    }
    const AppliedForces applied = applied_forces(blocks_, row);
    const RigidDof v = damped_motion(row);
    const RigidDof force = blocks_.contact[row].force + applied.anchor;
    const double along_x = undamped(force.u.x, v.u.x, local_damping_);
    const double along_y = undamped(force.u.y, v.u.y, local_damping_);
    const double turning = blocks_.is_deformable(row)
                               ? norm(unbalanced_on_gradient(blocks_.deformation_of(row)))
                               : std::abs(undamped(force.r, v.r, local_damping_));
    unbalanced = std::max({unbalanced, norm(Vec2{along_x, along_y}), turning / block.radius});
    acting = std::max({acting, block.heavy_mass() * norm(scene_.run.gravity), norm(applied.load.u)});
    BlockMark &mark = marks[row];
    const RigidDof &now = blocks_.displacement[row];
    motion = std::max(motion, motion_between(block, mark.look, now));
    const double way = motion_between(block, mark.stage, now);
    const double share = way / std::sqrt(block.area);
    moved = std::max(moved, share);
    moved_beyond_sag = std::max(moved_beyond_sag, way > sag_ ? share : 0.0);
    mark.look = now;
    kinetic.add(kinetic_energy_of(blocks_, row));
  }
  acting = std::max(acting, contacts_.sums().largest_force());
  overlap = force_report_.max_overlap;
  communicator_.max(largest);
  communicator_.sum(kinetic.limbs());
  const StageLook look{acting > 0.0 ? unbalanced / acting : 0.0,
                       motion,
                       overlap,
                       acting,
                       kinetic.value(),
                       moved,
                       moved_beyond_sag};
  const Stage &stage = stages_[static_cast<std::size_t>(stage_.index)];
  stage_.verdict = judge(stage, look, stage_.memory);
  const bool unloads = std::any_of(stage_.unloading.begin(), stage_.unloading.end(), [&](const Unloading &u) {
    return std::isfinite(u.duration) && time() < u.begin + u.duration;
  });
  if (unloads || time() < scene_.run.gravity_ramp || loads_are_changing()) { // the loads are not there yet
    stage_.verdict = Verdict::undecided;
  }
  stage_.end_time = time();
  stage_.ended = stage.until_verdict && stage_.verdict != Verdict::undecided;
}

// Where the energy of motion has just been greatest the pile passes through the balance of the slowest mode
// that moves: from rest there it has less far to go. An exact sum, so that every number of ranks stops alike.
void Simulation::stop_at_energy_peak() {
  ExactSum kinetic;
  for (std::size_t row = 0; row < blocks_.num_owned; ++row) {
    if (!blocks_.properties[row].keeps_its_velocity()) {
      kinetic.add(kinetic_energy_of(blocks_, row));
    }
  }
  communicator_.sum(kinetic.limbs());
  const double now = kinetic.value();
  const bool passed = now < stage_.memory.kinetic_before;
  stage_.memory.kinetic_before = passed ? 0.0 : now;
  if (passed) {
    book_stop();
    set_to_rest();
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
void Simulation::book_stop() {
  const double dt = plan_.time_step;
  const double by_velocity = scheme_.trial_velocity * dt;
  const double by_acceleration = scheme_.trial_acceleration * dt * dt;
  for (std::size_t row = 0; row < blocks_.num_owned; ++row) {
    if (blocks_.properties[row].keeps_its_velocity()) {
      continue;
    }
    const RigidDof ahead = by_velocity * blocks_.velocity[row] + by_acceleration * blocks_.acceleration[row];
    const RigidDof behind = blocks_.displacement[row] - blocks_.trial[row];
    RigidDof force = blocks_.contact[row].force + blocks_.anchor_force(row);
    Mat2 stretch;
    double work_on_gradient = 0.0;
    if (blocks_.is_deformable(row)) {
      const Deformation &d = blocks_.deformation_of(row);
      const Mat2 gradient_ahead = by_velocity * d.rate + by_acceleration * d.acceleration;
      const Mat2 gradient_behind = d.gradient - d.trial;
      force.r = 0.0;
      stretch = (1.0 / dt) * (gradient_behind + gradient_ahead);
      work_on_gradient = contract(unbalanced_on_gradient(d), gradient_ahead - gradient_behind);
    }
    blocks_.ledger[row].damping += 0.5 * (work(force, ahead - behind) + work_on_gradient) -
                                   kinetic_energy_of(blocks_, row, (1.0 / dt) * (behind + ahead), stretch);
  }
}

std::vector<StageResult> Simulation::stage_results() const {
  std::vector<StageResult> results = stage_.results;
  if (std::ssize(results) == stage_.index) {
    std::int64_t contact_steps = counters_.contact_steps;
    communicator_.sum(std::span(&contact_steps, 1));
    const StageLook &last = stage_.memory.last;
    results.push_back({stage_.verdict, time(), stage_step(), contact_steps - stage_.contact_steps_before,
                       last.unbalanced_ratio, last.kinetic, last.moved, 0});
  }
  return results;
}

// A stage that reached its limit undecided stays as it is: with a longer limit a restart goes on with it.
void Simulation::end_stage() {
  const Stage &stage = stages_[static_cast<std::size_t>(stage_.index)];
  if (!is_staged_ || !stage_is_over() || fault_ || std::ssize(stage_.results) > stage_.index ||
      (stage.until_verdict && !stage_.ended)) {
    return;
  }
  stage_.results = stage_results();
  stage_.end_time = time();
  stage_.ended = true;
  if (stage.kind == StageKind::settle) {
    close_statics();
    unscale_masses();
    if (stage_.verdict == Verdict::settled) {
      set_to_rest();
    }
  }
}

// Stick springs keep their stretch: they go on from the last trial configuration.
void Simulation::set_to_rest() {
  for (std::size_t row = 0; row < blocks_.num_owned; ++row) {
    if (blocks_.properties[row].keeps_its_velocity()) {
      continue;
    }
    blocks_.velocity[row] = {};
    blocks_.acceleration[row] = {};
    if (blocks_.is_deformable(row)) {
      blocks_.deformation_of(row).rate = {};
      blocks_.deformation_of(row).acceleration = {};
    }
  }
}

// The contact forces of the present trial configuration once more: nothing has moved since.
void Simulation::evaluate_still() {
  forget_increments(blocks_);
  take(contacts_.evaluate(blocks_, candidates_, history_));
  evaluate_bolts();
}

namespace {

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

void Simulation::begin_next_stage() {
  expect(stage_is_over() && !finished(), "a stage begins when the one before is over");
  stage_.start_time = time();
  stage_.first_step = step_count_;
  ++stage_.index;
  stage_.ended = false;
  stage_.verdict = Verdict::undecided;
  stage_.memory = {};
  stage_.iteration = {};
  stage_.contact_steps_before = counters_.contact_steps;
  communicator_.sum(std::span(&stage_.contact_steps_before, 1));
  std::erase_if(stage_.unloading, [&](const Unloading &u) { return time() >= u.begin + u.duration; });
  plan_.duration = 0.0; // so that time() is the beginning of the stage
  plan_.num_steps = 0;

  const Stage &stage = stages_[static_cast<std::size_t>(stage_.index)];
  const bool takes_away = stage.kind == StageKind::excavate || opens_viscous_sides();
  if (takes_away) {
    refresh();
    evaluate_still();
    if (stage.kind == StageKind::excavate) {
      excavate(select_blocks(stage.excavated), stage.relax);
    } else {
      excavate(held_beyond_viscous_sides(), std::numeric_limits<double>::infinity());
    }
  }
  ContactMemory memory = remembered_contacts();
  const auto is_gone = [&](const auto &record) {
    return is_removed(record.lower.value) || is_removed(record.higher.value);
  };
  std::erase_if(memory.plain, is_gone);
  std::erase_if(memory.others, is_gone);
  if (takes_away) {
    remove_blocks(stage_.removed);
  }
  bolts_.share(communicator_);
  const std::vector<Bolt> bolts_before = scene_.bolts;
  adopt(stage, time());
  change_bolts(bolts_before);
  scale_masses();
  find_bound();
  plan_stage();
  prepare_matrices();
  refresh(std::move(memory));
  evaluate_still();
  load_time_ = time();
  accelerate_owned();
  mark_stage();
  if (!stage.takes_steps()) {
    stage_.verdict = Verdict::done;
    stage_.end_time = time();
    stage_.results.push_back(result_without_steps(stage_));
    stage_.ended = true;
  }
}

} // namespace gcpdda
