#include "simulation/step_rows.hpp"

#include "base/free_memory.hpp"
#include "contact/contact_sums.hpp"
#include "dynamics/deformable.hpp"
#include "dynamics/free_rows.hpp"
#include "dynamics/half_works.hpp"
#include "dynamics/local_damping.hpp"
#include "model/find_row.hpp"
#include "simulation/evaluation.hpp"
#include "simulation/ground.hpp"
#include "simulation/held_blocks.hpp"
#include "simulation/stage_changes.hpp"
#include "simulation/water_loads.hpp"

#include <algorithm>
#include <cmath>

namespace gcpdda {

namespace {

constexpr std::size_t rows_at_once = 64; ///< rows that the cache holds through all their parts of a step

} // namespace

void StepRows::begin() {
  const auto scope = run_.phases.measure(Phase::forces);
  run_.loads.time = run_.clock.time() + run_.scheme.load_time * run_.clock.plan.time_step;
  find_prescribed_rows();
  prepare_forces();
  body_ = {run_.loads.gravity(run_.scene.run), ground_acceleration(run_)};
  predicted_ = 0;
  advanced_ = 0;
  passed_ = 0;
  report_.clear();
  held_force_ = held_force(run_);
  held_share_ = held_share(run_);
  run_.contacts.begin(run_.blocks, run_.neighbours.candidates);
}

void StepRows::send_border_trials() {
  const auto scope = run_.phases.measure(Phase::ghosts);
  run_.neighbours.border_trials.clear();
  for (const std::uint32_t row : run_.neighbours.ghosts.sent_rows()) {
    TrialConfiguration &trial = run_.neighbours.border_trials.emplace_back(
        next_trial(run_.blocks, run_.scheme, run_.clock.plan.time_step, row));
    for (const PrescribedRow &prescribed : prescribed_rows_) {
      trial.motion = prescribed.row == row ? prescribed.trial : trial.motion;
    }
  }
  run_.neighbours.ghosts.begin(run_.blocks, run_.neighbours.border_trials);
}

// At t_n + c1 dt, where the family takes x* of constant velocity.
void StepRows::find_prescribed_rows() {
  const double when = run_.clock.time() + run_.scheme.trial_velocity * run_.clock.plan.time_step;
  prescribed_rows_.clear();
  for (const auto &[block, motion] : run_.loads.prescribed) {
    if (const auto row = find_owned_row(run_.blocks, block.value)) {
      const RigidDof trial = motion.displacement(when);
      prescribed_rows_.push_back({*row, trial, trial - run_.blocks.trial[*row]});
    }
  }
}

void StepRows::predict_rows(RowSpan rows) {
  predict(run_.blocks, run_.scheme, run_.clock.plan.time_step, rows);
  for (const auto &[row, motion, increment] : prescribed_rows_) {
    if (rows.first <= row && row < rows.last) {
      run_.blocks.trial[row] = motion;
      run_.blocks.motion[row].set_increment(increment);
      pose(run_.blocks, row, row + 1);
    }
  }
}

// The acceleration is the mean one of the coming step: motion_bound() then bounds the motion in it.
void StepRows::prescribe_motion() {
  const double dt = run_.clock.plan.time_step;
  for (const auto &[block, motion] : run_.loads.prescribed) {
    if (const auto row = find_owned_row(run_.blocks, block.value)) {
      run_.blocks.displacement[*row] = motion.displacement(run_.clock.time());
      run_.blocks.velocity[*row] = motion.velocity(run_.clock.time());
      run_.blocks.acceleration[*row] =
          (1.0 / dt) * (motion.velocity(run_.clock.time() + dt) - run_.blocks.velocity[*row]);
    }
  }
}

void StepRows::prepare_forces() {
  own_forces_.wave = incoming_wave(run_);
  own_forces_.stiffness_damping = run_.scene.run.rayleigh.stiffness_damping;
  own_forces_.local_damping = run_.local_damping;
}

void StepRows::predict_to(std::size_t end) {
  if (end <= predicted_) {
    return;
  }
  const auto scope = run_.phases.measure(Phase::predict);
  while (predicted_ < end) {
    const RowSpan rows{predicted_, std::min(run_.blocks.num_owned, predicted_ + rows_at_once)};
    predict_rows(rows);
    add_half_works(run_.blocks, rows.first, rows.last);
    run_.contacts.begin_rows(run_.blocks, rows.first, rows.last);
    predicted_ = rows.last;
  }
}

void StepRows::advance_to(std::size_t end) {
  const std::size_t last = end == run_.blocks.num_owned ? end : end / rows_at_once * rows_at_once;
  if (last <= advanced_ || !run_.bolts.empty()) { // forces of bolts come after those of all pairs
    return;
  }
  const auto scope = run_.phases.measure(Phase::update);
  while (advanced_ < last) {
    const bool is_last_run = passed_ == run_.neighbours.waiting.size();
    const std::size_t stop = is_last_run ? last : std::min(last, run_.neighbours.waiting[passed_].first);
    advance_rows(advanced_, stop);
    advanced_ = stop < last ? run_.neighbours.waiting[passed_++].last : last;
  }
}

void StepRows::advance_remaining() {
  const auto scope = run_.phases.measure(Phase::update);
  for (std::size_t k = 0; k < passed_; ++k) {
    advance_rows(run_.neighbours.waiting[k].first, run_.neighbours.waiting[k].last);
  }
  advance_rows(advanced_, run_.blocks.num_owned);
  run_.blocks.body = body_;
  if (const auto row = report_.broken) {
    keep_first(run_.local_fault, {Fault::Cause::not_finite, run_.blocks.properties[*row].id, {}, 0.0, 0.0});
  }
}

// A chunk of rows at a time: what one pass reads is in the cache for the next.
void StepRows::advance_rows(std::size_t first, std::size_t end) {
  held_.clear();
  for (std::size_t row = first; row < end && held_force_ > 0.0; ++row) {
    if (is_at_rest(run_.blocks, row) && !run_.blocks.properties[row].keeps_its_velocity()) {
      held_.push_back(row);
    }
  }
  for (first = advance_free(first, end); first < end;) {
    const std::size_t last = std::min(end, first + rows_at_once);
    gather_forces(first, last, body_);
    solve_and_update(run_.blocks, own_forces_, run_.scheme, run_.clock.plan.time_step,
                     run_.scene.run.elasticity, first, last, safe_motion(run_), report_);
    first = advance_free(last, end);
  }
  for (const std::size_t row : held_) {
    if (is_held_by(run_.blocks.properties[row], net_force(run_.blocks, row), held_force_, held_share_)) {
      hold(run_.blocks, row);
    }
  }
}

// Only contacts and gravity act on most blocks of most scenes: one kernel loads and advances them.
std::size_t StepRows::advance_free(std::size_t first, std::size_t end) {
  if (run_.scene.run.rayleigh.present()) {
    return first;
  }
  return advance_free_rows(run_.blocks, {body_, run_.local_damping, safe_motion(run_), run_.bolts.empty()},
                           run_.scheme, run_.clock.plan.time_step, run_.scene.run.elasticity, first, end,
                           report_);
}

void StepRows::gather_forces(std::size_t first, std::size_t last, const BodyForces &body) {
  for (std::size_t row = first; row < last; ++row) {
    const WaterLoad water =
        run_.scene.water.empty() ? WaterLoad{} : water_on(run_, row, -body.gravity.y, outline_);
    const AppliedForces applied = gather_block(row, body, water);
    if (run_.blocks.is_deformable(row)) {
      gather_gradient(row, water);
    }
    apply_mass_damping(run_.blocks, row, run_.scene.run.rayleigh.mass_damping);
    apply_local_damping(run_.blocks, row, run_.local_damping);
    add_to_ledger(run_.blocks, row, half_works(run_.blocks, row, applied));
  }
}

// Returns the applied forces, which are stored as well where the row has an `applied` entry.
AppliedForces StepRows::gather_block(std::size_t row, const BodyForces &body, const WaterLoad &water) {
  const BlockProperties &block = run_.blocks.properties[row];
  RigidDof &force = run_.blocks.contact[row].force;
  AppliedForces *const own = run_.blocks.applied_to(row);
  const bool is_deformable = run_.blocks.is_deformable(row); // then moments stand in the deformation
  if (block.keeps_its_velocity()) {
    expect(own != nullptr, "a driven block needs an `applied` entry");
    const RigidDof held = std::exchange(force, {});
    return *own = {{-1.0 * held.u, is_deformable ? 0.0 : -held.r}, {}, {}};
  }
  AppliedForces applied = applied_by(body, block);
  if (own != nullptr) {
    applied.anchor = own->anchor;
    applied.load += run_.clock.state.unloading.empty() ? RigidDof{} : unloading_of(run_, block.id).rigid;
    for (const MaterialLoad &load : run_.blocks.loads_of(row)) {
      const Vec2 arm = Rotation::of(run_.blocks.trial[row].r)(load.point);
      const Vec2 at_point = run_.loads.force_of(load);
      applied.load += {at_point, cross(arm, at_point)};
    }
    applied.load += {water.force, water.torque()};
    applied.load.r = is_deformable ? 0.0 : applied.load.r;
    *own = applied;
  }
  force += applied.load;
  force.u += applied.gravity;
  return applied;
}

// Forces on F; they contain the moments of the rigid part.
void StepRows::gather_gradient(std::size_t row, const WaterLoad &water) {
  Deformation &d = run_.blocks.deformation_of(row);
  const Mat2 &to_reference = run_.blocks.trial_inverse[run_.blocks.deformation_begin[row]];
  d.contact = in_reference_axes(d.contact, to_reference);
  if (run_.blocks.applied_to(row) != nullptr) {
    d.load_force =
        unloading_of(run_, run_.blocks.properties[row].id).gradient + water.dyad * transposed(to_reference);
    for (const MaterialLoad &load : run_.blocks.loads_of(row)) {
      d.load_force += outer(run_.loads.force_of(load), load.point);
    }
    d.contact.force += d.load_force;
  }
  if (!run_.bolts.empty()) {
    d.contact.force += run_.bolts.gradient_force(run_.blocks.deformation_begin[row]);
  }
  run_.blocks.contact[row].shear.r = 0.0;
  run_.blocks.contact[row].damping.r = 0.0;
}

void StepRows::load_all() {
  prepare_forces();
  run_.blocks.body = {run_.loads.gravity(run_.scene.run), ground_acceleration(run_)};
  gather_forces(0, run_.blocks.num_owned, run_.blocks.body);
}

void StepRows::accelerate() {
  load_all();
  gcpdda::accelerate(run_.blocks);
  prescribe_motion();
}

void StepRows::predict_all() {
  find_prescribed_rows();
  send_border_trials();
  predict_rows({0, run_.blocks.num_owned});
  receive_ghosts(run_);
}

void accelerate_owned(RunState &run) {
  sum_forces(run);
  StepRows(run).accelerate();
}

ComingTrial::ComingTrial(RunState &run)
    : blocks_(run.blocks), trial_(blocks_.trial), deformation_(blocks_.deformation),
      turns_(blocks_.deformation.size()) {
  increments_.reserve(blocks_.motion.size());
  for (std::size_t row = 0; row < blocks_.motion.size(); ++row) {
    increments_.push_back(blocks_.motion[row].increment());
    if (blocks_.is_deformable(row)) {
      turns_[blocks_.deformation_begin[row]] = blocks_.motion[row].turn;
    }
  }
  StepRows(run).predict_all();
}

ComingTrial::~ComingTrial() {
  blocks_.trial = std::move(trial_);
  blocks_.deformation = std::move(deformation_);
  for (std::size_t row = 0; row < increments_.size(); ++row) {
    blocks_.motion[row].set_increment(increments_[row]);
    if (blocks_.is_deformable(row)) {
      blocks_.motion[row].turn = turns_[blocks_.deformation_begin[row]];
    }
  }
  pose_in_lanes(blocks_, 0, blocks_.num_mobile());
  increments_ = {};
  give_back_free_memory(2 * blocks_.num_rows() * sizeof(RigidDof));
}

} // namespace gcpdda
