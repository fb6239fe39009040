#include "statics/pseudo_time.hpp"

#include "base/exact_sum.hpp"
#include "dynamics/deformable.hpp"
#include "statics/unbalanced_forces.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace gcpdda::statics {

void PseudoTime::lay(BlockSystem &system, std::span<const StiffnessBound> stiffness, bool any_deformable,
                     std::vector<BorderRows> border) {
  width_ = any_deformable ? 6 : 3;
  BlockMatrices mass(system.num_owned, width_);
  far_.lay(system, moving_rows(system));
  moving_.assign(far_.mobile().begin(), far_.mobile().end());
  for_rows(moving_,
           [&](std::size_t row) { add_boundary(system, row, stiffness[row], mass.of(row), width_); });
  solver_.lay(system, moving_, std::move(mass), std::move(border));
  force_ = Field(system.num_rows(), width_);
  driving_ = force_;
  direction_ = Field(system.num_rows(), width_);
  springs_.set_moving({});
  double some_rest = 0.0;
  const std::span<PseudoMotion> pseudo = pseudo_rows(system);
  for_rows(moving_, [&](std::size_t row) { some_rest = std::max(some_rest, pseudo[row].rests); });
  is_local_ = communicator_.max(some_rest) > 0.0;
  if (is_local_) {
    keep_resting(system);
  }
}

void PseudoTime::keep_resting(BlockSystem &system) {
  std::vector<std::uint8_t> moves(system.num_rows(), 0);
  moving_.clear();
  for_rows(far_.mobile(), [&](std::size_t row) {
    PseudoMotion &motion = system.pseudo[row];
    direction_.of(row)[0] = motion.rests == 0.0 ? 1.0 : 0.0;
    if (motion.rests == 0.0) {
      moves[row] = 1;
      append_row(moving_, row);
      return;
    }
    motion.velocity = {};
    motion.momentum = {};
    system.motion[row].set_increment({});
    if (system.is_deformable(row)) {
      system.motion[row].turn = {};
    }
  });
  solver_.copy_to_ghosts(direction_);
  for (std::size_t row = system.num_owned; row < system.first_fixed(); ++row) {
    moves[row] = direction_.of(row)[0] != 0.0 ? 1 : 0;
  }
  std::fill(direction_.values().begin(), direction_.values().end(), 0.0);
  solver_.choose(system, moving_, moves);
  springs_.set_moving(is_local_ ? std::move(moves) : std::vector<std::uint8_t>());
}

bool PseudoTime::choose_rows(BlockSystem &system, double balanced, bool is_near_rest,
                             const IterationState &state) {
  if (!may_pause(state) || load_share(state.evaluations) < 1.0) {
    return false;
  }
  const bool all_move =
      state.evaluations % rules_.window < (is_near_rest ? rules_.all_move_near_rest : rules_.all_move);
  const auto chosen = all_move ? std::nullopt : far_.find(system, solver_.mass(), balanced);
  const bool was_local = std::exchange(is_local_, chosen.has_value());
  if (!is_local_ && !was_local) {
    return false;
  }
  const std::span<PseudoMotion> pseudo = pseudo_rows(system);
  for_rows(far_.mobile(),
           [&](std::size_t row) { pseudo[row].rests = chosen && (*chosen)[row] == 0 ? 1.0 : 0.0; });
  keep_resting(system);
  return true;
}

void PseudoTime::hold(BlockSystem &system) {
  const std::span<PseudoMotion> pseudo = pseudo_rows(system);
  for_rows(moving_, [&](std::size_t row) {
    pseudo[row] = {};
    pseudo[row].held = unbalanced_forces(system, row);
  });
}

void PseudoTime::gather(const BlockSystem &system, double share) {
  for_rows(moving_, [&](std::size_t row) {
    double *const to = force_.of(row);
    const std::array<double, 6> sum = unbalanced_forces(system, row);
    const std::array<double, 6> &held = system.pseudo[row].held;
    for (std::size_t i = 0; i < width_; ++i) {
      to[i] = sum[i] - (1.0 - share) * held[i];
    }
  });
}

namespace {

double row_product(const std::array<double, 6> &v, const double *f, std::size_t width) {
  double product = v[0] * f[0];
  for (std::size_t i = 1; i < width; ++i) {
    product += v[i] * f[i];
  }
  return product;
}

/// Two sums of all ranks in one reduction. Collective.
void sum_both(const Communicator &communicator, ExactSum &a, ExactSum &b) {
  std::array<std::int64_t, 2 * std::size_t{ExactSum::num_limbs}> limbs{};
  const auto half = std::copy(a.limbs().begin(), a.limbs().end(), limbs.begin());
  std::copy(b.limbs().begin(), b.limbs().end(), half);
  communicator.sum(limbs);
  std::copy(limbs.begin(), half, a.limbs().begin());
  std::copy(half, limbs.end(), b.limbs().begin());
}

} // namespace

double mass_share(std::int64_t num_blocks) {
  constexpr double share = 5e-4;
  constexpr double few_blocks = 2000.0;
  return share *
         std::sqrt(std::min(1.0, few_blocks / static_cast<double>(std::max<std::int64_t>(1, num_blocks))));
}

double PseudoTime::power(const BlockSystem &system) const {
  ExactSum sum;
  for_rows(moving_, [&](std::size_t row) {
    if (stands_[row] == Standing::touched) {
      sum.add(row_product(system.pseudo[row].velocity, force_.of(row), width_));
    }
  });
  communicator_.sum(sum.limbs());
  return sum.value();
}

void PseudoTime::find_motion(BlockSystem &system, const Candidates &candidates, const ContactHistory &history,
                             const ContactForces &contacts, double overlap, double balanced,
                             bool is_near_rest, IterationState &state) {
  const double share = load_share(state.evaluations);
  springs_.update(system, candidates, history, contacts,
                  share < 1.0 ? under_load(rules_.springs) : rules_.springs);
  if (may_pause(state)) { // all rows may move from here on
    springs_.set_moving({});
  }
  find_standing(system);
  gather(system, share);
  const double power_behind = power(system);
  const double square =
      state.momentum > 0.0 ? std::clamp((state.power_before - power_behind) / state.momentum, 0.0, 3.9) : 0.0;
  const bool others_move = choose_rows(system, balanced, is_near_rest, state);
  const bool is_coarse_due =
      may_pause(state) || state.evaluations < rules_.coarse_every; // joints still close
  ++state.evaluations;
  const double next_share = load_share(state.evaluations);
  const bool loads = next_share < 1.0;
  double power_ahead = power_behind;
  if (others_move || next_share != share) {
    gather(system, next_share);
    power_ahead = power(system);
  }
  const bool begins = !(state.momentum > 0.0) || power_ahead < 0.0;
  const double c = loads ? rules_.damping_under_load : 2.0 * rules_.damping_share * std::sqrt(square);
  if (!loads && (swings(begins, state) || begins)) {
    springs_.hold_slip();
  }
  solver_.set(system, springs_, rules_.mass_share, is_coarse_due);
  for_places(moving_, width_, [&](std::size_t i) { driving_.values()[i] = force_.values()[i]; });
  if (!begins && !loads && c < 1.0) {
    solver_.damp_strains(system, springs_, 1.0 - c, state.momentum, driving_);
    ++state.products;
  }
  state.products += solver_.solve(system, springs_, driving_, direction_);
  const double limit = longest_step(overlap, state);
  if (begins) {
    advance(system, 0.0, 0.5, limit, state);
  } else {
    advance(system, (2.0 - c) / (2.0 + c), 2.0 / (2.0 + c), limit, state);
  }
}

bool PseudoTime::swings(bool begins, IterationState &state) const {
  if (begins) {
    state.short_runs = state.run <= rules_.short_run ? state.short_runs + 1 : 0;
    state.run = 0;
  }
  ++state.run;
  return state.short_runs > rules_.most_short_runs && state.run <= rules_.short_run;
}

void PseudoTime::find_standing(BlockSystem &system) {
  stands_.assign(system.num_rows(), Standing::free);
  for (std::size_t k = 0; k < springs_.springs().size(); ++k) {
    if (springs_.memories()[k].open_for == 0) {
      stands_[springs_.springs()[k].lower] = Standing::touched;
      stands_[springs_.springs()[k].higher] = Standing::touched;
    }
  }
  for_rows(moving_, [&](std::size_t row) {
    PseudoMotion &motion = system.pseudo[row];
    const bool is_free = stands_[row] == Standing::free;
    if (motion.is_free != 0.0 && !is_free) {
      stands_[row] = Standing::lands;
      motion.velocity = {};
      motion.momentum = {};
    }
    motion.is_free = is_free ? 1.0 : 0.0;
  });
}

// Before there is an overlap the block's own boundary says what it would be.
double PseudoTime::longest_step(double overlap, IterationState &state) const {
  double most = 0.0;
  for_rows(moving_, [&](std::size_t row) {
    const double *const f = force_.of(row);
    const double stiffness = solver_.mass().of(row)[0];
    most = stiffness > 0.0 ? std::max(most, norm(Vec2{f[0], f[1]}) / stiffness) : most;
  });
  state.longest = std::max(state.longest, communicator_.max(std::max(overlap, most)));
  return rules_.steps_of_overlap * state.longest;
}

void PseudoTime::advance(BlockSystem &system, double a, double b, double limit, IterationState &state) {
  ExactSum ahead;
  ExactSum momentum;
  for_rows(moving_, [&](std::size_t row) {
    PseudoMotion &motion = system.pseudo[row];
    const double *const g = direction_.of(row);
    const double *const f = force_.of(row);
    const double *const driving = driving_.of(row);
    const double part = stands_[row] == Standing::lands ? 0.5 : b;
    for (std::size_t i = 0; i < width_; ++i) {
      motion.velocity[i] = a * motion.velocity[i] + part * g[i];
      motion.momentum[i] = a * motion.momentum[i] + part * driving[i];
    }
    const double length = length_of_step(system, row);
    const double longest = std::min(limit, rules_.step_of_width * system.properties[row].width);
    const double share = length > longest ? longest / length : 1.0;
    for (std::size_t i = 0; i < width_; ++i) {
      motion.velocity[i] *= share;
      motion.momentum[i] *= share;
    }
    if (stands_[row] == Standing::touched) {
      ahead.add(row_product(motion.velocity, f, width_));
      momentum.add(row_product(motion.velocity, motion.momentum.data(), width_));
    }
  });
  sum_both(communicator_, ahead, momentum);
  state.power_before = ahead.value();
  state.momentum = momentum.value();
}

namespace {

/// R and I + E of a step v of F.
std::pair<Mat2, Mat2> parts_of(const std::array<double, 6> &v) {
  const Rotation turn = Rotation::of(0.5 * (v[4] - v[3]));
  const double shear = 0.5 * (v[3] + v[4]);
  return {{turn.c, -turn.s, turn.s, turn.c}, {1.0 + v[2], shear, shear, 1.0 + v[5]}};
}

} // namespace

Mat2 gradient_after(const Mat2 &gradient, const std::array<double, 6> &v) {
  const auto [turn, stretch] = parts_of(v);
  return turn * stretch * gradient;
}

// x + v - v, and (I + E)^-1 R^T R (I + E) F, of which the first two are R^T [R (I + E)^-1 R^T].
void PseudoTime::turn_back(BlockSystem &system) const {
  for_rows(moving_, [&](std::size_t row) {
    std::array<double, 6> &v = system.pseudo[row].velocity;
    for (double &part : v) {
      part = -part;
    }
    if (system.is_deformable(row)) {
      const auto [turn, stretch] = parts_of(v);
      const Mat2 back = transposed(turn) * inverse(Mat2{2.0, 0.0, 0.0, 2.0} - stretch) * turn;
      const double spin = 0.5 * (v[4] - v[3]);
      v[2] = back.xx - 1.0;
      v[3] = back.xy - spin;
      v[4] = back.yx + spin;
      v[5] = back.yy - 1.0;
    }
  });
}

void PseudoTime::move(BlockSystem &system) const {
  for_rows(moving_, [&](std::size_t row) {
    const std::array<double, 6> &v = system.pseudo[row].velocity;
    TrialConfiguration trial{system.trial[row], {}};
    trial.motion.u += Vec2{v[0], v[1]};
    if (system.is_deformable(row)) {
      Deformation &d = system.deformation_of(row);
      trial.gradient = gradient_after(d.trial, v);
      trial.motion.r += angle_between(d.trial, trial.gradient);
      set_trial(system, row, trial);
      d.gradient = trial.gradient;
      d.rate = {};
      d.acceleration = {};
    } else {
      trial.motion.r += v[2];
      set_trial(system, row, trial);
    }
    system.displacement[row] = trial.motion;
    system.velocity[row] = {};
    system.acceleration[row] = {};
  });
}

} // namespace gcpdda::statics
