// How owned rows go through a step: each is predicted, loaded and advanced while the cache holds it.
//
// Pairs are evaluated by groups in the order of their blocks' ids (contact/candidates.hpp). Before a group
// only rows below its rows_read need their trial configurations, and after it rows below its rows_finished
// have all their contacts and can be advanced to the end of the step. A few hundred rows lie between the two
// bounds, so that a large model is read from memory once a step instead of three times. Where ids do not
// follow places, all rows are predicted before the first group and advanced after the last one.
//
// A row waits (Candidates::is_added) if it has a pair with a ghost or a general pair; these are evaluated
// last. Where there are bolts all rows wait, because the forces of bolts come after those of all pairs. The
// ghosts on other ranks need the trial configurations of border rows first: they follow from x_n, v_n and a_n
// alone and are sent before the rows themselves are predicted. Each row does the same operations on the same
// numbers whenever it does them, so that the order changes no bit.

#include "simulation/simulation.hpp"

#include <algorithm>
#include <cmath>

namespace gcpdda {

namespace {

constexpr std::size_t rows_at_once = 64; ///< rows that the cache holds through all their parts of a step
constexpr std::size_t rows_together = 8; ///< most rows in the SIMD lanes

/// Row of a block if this rank owns it.
std::optional<std::size_t> owned_row(const BlockSystem &blocks, BlockId id) {
  const auto end = blocks.properties.begin() + static_cast<std::ptrdiff_t>(blocks.num_owned);
  const auto found = std::lower_bound(blocks.properties.begin(), end, id,
                                      [](const BlockProperties &p, BlockId wanted) { return p.id < wanted; });
  return found == end || found->id != id
             ? std::nullopt
             : std::optional(static_cast<std::size_t>(found - blocks.properties.begin()));
}

} // namespace

void Simulation::send_border_trials() {
  const auto scope = phases_.measure(Phase::ghosts);
  border_trials_.clear();
  for (const std::uint32_t row : ghosts_.sent_rows()) {
    TrialConfiguration &trial =
        border_trials_.emplace_back(next_trial(blocks_, scheme_, plan_.time_step, row));
    for (const PrescribedRow &prescribed : prescribed_rows_) {
      trial.motion = prescribed.row == row ? prescribed.trial : trial.motion;
    }
  }
  ghosts_.begin(blocks_, border_trials_);
}

// At t_n + c1 dt, where the family takes x* of constant velocity.
void Simulation::find_prescribed_rows() {
  const double when = time() + scheme_.trial_velocity * plan_.time_step;
  prescribed_rows_.clear();
  for (const auto &[block, motion] : prescribed_) {
    if (const auto row = owned_row(blocks_, block)) {
      const RigidDof trial = motion.displacement(when);
      prescribed_rows_.push_back({*row, trial, trial - blocks_.trial[*row]});
    }
  }
}

void Simulation::predict_rows(RowSpan rows) {
  predict(blocks_, scheme_, plan_.time_step, rows);
  for (const auto &[row, motion, increment] : prescribed_rows_) {
    if (rows.first <= row && row < rows.last) {
      blocks_.trial[row] = motion;
      blocks_.motion[row].set_increment(increment);
      pose(blocks_, row, row + 1);
    }
  }
}

// The acceleration is the mean one of the coming step: motion_bound() then bounds the motion in it.
void Simulation::prescribe_motion() {
  const double dt = plan_.time_step;
  for (const auto &[block, motion] : prescribed_) {
    if (const auto row = owned_row(blocks_, block)) {
      blocks_.displacement[*row] = motion.displacement(time());
      blocks_.velocity[*row] = motion.velocity(time());
      blocks_.acceleration[*row] = (1.0 / dt) * (motion.velocity(time() + dt) - blocks_.velocity[*row]);
    }
  }
}

void Simulation::prepare_forces() {
  own_forces_.wave = incoming_wave();
  own_forces_.stiffness_damping = scene_.run.rayleigh.stiffness_damping;
  own_forces_.local_damping = local_damping_;
}

void Simulation::predict_to(std::size_t end) {
  if (end <= progress_.predicted) {
    return;
  }
  const auto scope = phases_.measure(Phase::predict);
  while (progress_.predicted < end) {
    const RowSpan rows{progress_.predicted, std::min(blocks_.num_owned, progress_.predicted + rows_at_once)};
    predict_rows(rows);
    add_half_works(blocks_, rows.first, rows.last);
    contacts_.begin_rows(blocks_, rows.first, rows.last);
    progress_.predicted = rows.last;
  }
}

// Waiting rows are grouped in runs of rows_together.
void Simulation::find_waiting_rows() {
  std::vector<RowSpan> &waiting = progress_.waiting;
  waiting.clear();
  for (std::size_t first = 0; first < blocks_.num_owned; first += rows_together) {
    const std::size_t last = std::min(blocks_.num_owned, first + rows_together);
    const std::uint8_t *is_added = candidates_.is_added.data();
    if (std::find(is_added + first, is_added + last, 0) == is_added + last) {
      continue;
    }
    if (waiting.empty() || waiting.back().last < first) {
      waiting.push_back({first, first});
    }
    waiting.back().last = last;
  }
}

void Simulation::advance_to(std::size_t end) {
  const std::size_t last = end == blocks_.num_owned ? end : end / rows_at_once * rows_at_once;
  if (last <= progress_.advanced || !bolts_.empty()) { // forces of bolts come after those of all pairs
    return;
  }
  const auto scope = phases_.measure(Phase::update);
  while (progress_.advanced < last) {
    const bool is_last_run = progress_.passed == progress_.waiting.size();
    const std::size_t stop = is_last_run ? last : std::min(last, progress_.waiting[progress_.passed].first);
    advance_rows(progress_.advanced, stop);
    progress_.advanced = stop < last ? progress_.waiting[progress_.passed++].last : last;
  }
}

void Simulation::advance_remaining() {
  const auto scope = phases_.measure(Phase::update);
  for (std::size_t k = 0; k < progress_.passed; ++k) {
    advance_rows(progress_.waiting[k].first, progress_.waiting[k].last);
  }
  advance_rows(progress_.advanced, blocks_.num_owned);
  blocks_.body = progress_.body;
  if (const auto row = progress_.report.broken) {
    keep_first(local_fault_, {Fault::Cause::not_finite, blocks_.properties[*row].id, {}, 0.0, 0.0});
  }
}

// A chunk of rows at a time: what one pass reads is in the cache for the next.
void Simulation::advance_rows(std::size_t first, std::size_t end) {
  for (first = advance_free(first, end); first < end;) {
    const std::size_t last = std::min(end, first + rows_at_once);
    gather_forces(first, last, progress_.body);
    solve_and_update(blocks_, own_forces_, scheme_, plan_.time_step, scene_.run.elasticity, first, last,
                     safe_motion(), progress_.report);
    first = advance_free(last, end);
  }
}

// Only contacts and gravity act on most blocks of most scenes: one kernel loads and advances them.
std::size_t Simulation::advance_free(std::size_t first, std::size_t end) {
  if (scene_.run.rayleigh.present()) {
    return first;
  }
  return advance_free_rows(blocks_, {progress_.body, local_damping_, safe_motion(), bolts_.empty()}, scheme_,
                           plan_.time_step, scene_.run.elasticity, first, end, progress_.report);
}

void Simulation::gather_forces(std::size_t first, std::size_t last, const BodyForces &body) {
  for (std::size_t row = first; row < last; ++row) {
    const WaterLoad water = scene_.water.empty()
                                ? WaterLoad{}
                                : water_load(blocks_, row, scene_.water, -body.gravity.y, outline_);
    const AppliedForces applied = gather_block(row, body, water);
    if (blocks_.is_deformable(row)) {
      gather_gradient(row, water);
    }
    apply_mass_damping(blocks_, row, scene_.run.rayleigh.mass_damping);
    apply_local_damping(blocks_, row, local_damping_);
    add_to_ledger(blocks_, row, half_works(blocks_, row, applied));
  }
}

// Returns the applied forces, which are stored as well where the row has an `applied` entry.
AppliedForces Simulation::gather_block(std::size_t row, const BodyForces &body, const WaterLoad &water) {
  const BlockProperties &block = blocks_.properties[row];
  RigidDof &force = blocks_.contact[row].force;
  AppliedForces *const own = blocks_.applied_to(row);
  const bool is_deformable = blocks_.is_deformable(row); // then moments stand in the deformation
  if (block.keeps_its_velocity()) {
    expect(own != nullptr, "a driven block needs an `applied` entry");
    const RigidDof held = std::exchange(force, {});
    return *own = {{-1.0 * held.u, is_deformable ? 0.0 : -held.r}, {}, {}};
  }
  AppliedForces applied = applied_by(body, block);
  if (own != nullptr) {
    applied.anchor = own->anchor;
    applied.load += stage_.unloading.empty() ? RigidDof{} : unloading_of(block.id).rigid;
    for (const MaterialLoad &load : blocks_.loads_of(row)) {
      const Vec2 arm = Rotation::of(blocks_.trial[row].r)(load.point);
      const Vec2 at_point = force_of(load);
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
void Simulation::gather_gradient(std::size_t row, const WaterLoad &water) {
  Deformation &d = blocks_.deformation_of(row);
  const Mat2 &to_reference = blocks_.trial_inverse[blocks_.deformation_begin[row]];
  d.contact = in_reference_axes(d.contact, to_reference);
  if (blocks_.applied_to(row) != nullptr) {
    d.load_force = unloading_of(blocks_.properties[row].id).gradient + water.dyad * transposed(to_reference);
    for (const MaterialLoad &load : blocks_.loads_of(row)) {
      d.load_force += outer(force_of(load), load.point);
    }
    d.contact.force += d.load_force;
  }
  if (!bolts_.empty()) {
    d.contact.force += bolts_.gradient_force(blocks_.deformation_begin[row]);
  }
  blocks_.contact[row].shear.r = 0.0;
  blocks_.contact[row].damping.r = 0.0;
}

} // namespace gcpdda
