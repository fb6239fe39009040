// Settle stages with the static solver (statics/pseudo_time.hpp). A step is one evaluation of the contacts:
// blocks move by what the last evaluation has found, forces are found where they are then, and the iteration
// finds the motion of the next step. What a step leaves behind is the state of the iteration (StageState),
// the motions of the blocks (BlockSystem::pseudo) and the springs of their contacts.
//
// Time goes on by the step of the dynamic solver, so that frames, histories and the limit of a stage are
// those of any stage; it means nothing else. Loads that take their time (run.gravity_ramp, relax, ramp)
// would have it mean something: the time of the stage therefore begins when they are complete, and the
// iteration lets them in by its own increments.
//
// A stage that the iteration does not serve, or in which it stalls, goes on with the dynamic solver from
// where the blocks are. Rules of a stall, once all of the load acts: the least unbalanced ratio of
// `stall_window` evaluations is more than half of that of the window before, or a block has moved so far that
// the stage may have failed, of which the dynamic solver is the judge.

#include "base/check.hpp"
#include "contact/stiffness_bound.hpp"
#include "dynamics/deformable.hpp"
#include "dynamics/static_springs.hpp"
#include "simulation/simulation.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <utility>

namespace gcpdda {

bool Simulation::is_static() const {
  return stages_[static_cast<std::size_t>(stage_.index)].solver == Solver::statics &&
         stage_.iteration.is_left == 0 && !stage_.ended;
}

/// Why the stage at hand is not for the static solver; empty if it is.
std::string Simulation::not_served() const {
  const auto has_law = [&](auto &&holds) {
    return std::any_of(scene_.joints.laws.begin(), scene_.joints.laws.end(), holds);
  };
  double fastest = 0.0; // of what heeds no force
  for (std::size_t row = 0; row < blocks_.num_owned; ++row) {
    if (blocks_.properties[row].keeps_its_velocity()) {
      const RigidDof &v = blocks_.velocity[row];
      fastest = std::max({fastest, norm(v.u), std::abs(v.r)});
    }
  }
  if (communicator_.max(fastest) > 0.0 || !prescribed_.empty()) {
    return "blocks move by velocities that are given";
  }
  if (!scene_.earthquake.viscous.empty()) {
    return "the region has viscous sides";
  }
  if (has_law([](const JointLaw &law) { return law.has_bonds; })) {
    return "bonds break for good, also in a swing of the iteration";
  }
  if (has_law([](const JointLaw &law) { return law.dilates(); })) {
    return "the stiffness of joints that dilate is not known to it";
  }
  return std::isfinite(end_of_loads()) ? "" : "its loads go on changing";
}

double Simulation::end_of_loads() const {
  double end = std::max(time(), scene_.run.gravity_ramp);
  for (const Unloading &unloading : stage_.unloading) {
    if (std::isfinite(unloading.duration)) { // else the forces stay
      end = std::max(end, unloading.begin + unloading.duration);
    }
  }
  for (const LoadCourse &course : courses_) {
    if (course.in.begin <= time()) { // else the force comes in with a later stage
      end = std::max(end, course.end());
    }
  }
  return end;
}

void Simulation::close_statics() {
  statics_.reset();
  contacts_.keep_details(false);
  drop_pseudo_rows(blocks_);
}

void Simulation::leave_statics(const std::string &reason) {
  stage_.iteration.is_left = 1;
  close_statics();
  notes_.push_back({Severity::info, stages_[static_cast<std::size_t>(stage_.index)].where,
                    fmt::format("stage '{}' goes on with solver = \"dynamic\"",
                                stages_[static_cast<std::size_t>(stage_.index)].name),
                    reason, "leave 'solver' out of the stage, or give it as \"dynamic\""});
}

void Simulation::lay_statics() {
  std::vector<statics::Surroundings> around;
  for (std::size_t row = 0; row < blocks_.num_owned; ++row) {
    const StiffnessBound stiffness = stiffness_bound(scene_.joints, blocks_.properties[row].material);
    around.push_back(
        {stiffness.normal, stiffness.tangential, bolts_.springs_at(blocks_.properties[row].id.value)});
  }
  const bool any_deformable = communicator_.max(blocks_.deformation.empty() ? 0.0 : 1.0) > 0.0;
  std::vector<statics::BorderRows> border;
  ghosts_.for_neighbours(
      [&](int rank, const std::vector<std::uint32_t> &send, const std::vector<std::uint32_t> &receive) {
        border.push_back({rank, send, receive});
      });
  statics_->lay(blocks_, around, any_deformable, std::move(border));
}

/// The iteration of a stage that begins, or goes on after a restart.
void Simulation::open_statics() {
  statics::IterationRules rules;
  // Boxes of two blocks that are this near meet within what each may move before the next refresh.
  rules.springs.reach = share_of_skin_kept * base_skin_;
  statics_.emplace(communicator_, rules);
  contacts_.keep_details(true);
  // The limit of the stage comes where the iteration may pause, because a restart may go on from there: after
  // n steps it has found n + 1 motions.
  plan_.num_steps += rules.coarse_every - 1 - plan_.num_steps % rules.coarse_every;
  if (stage_.iteration.evaluations > 0) {
    const StaticState saved = std::exchange(restored_statics_, {});
    refresh();
    const std::span<PseudoMotion> motions = pseudo_rows(blocks_);
    for (std::size_t row = 0; row < blocks_.num_owned; ++row) {
      const auto found =
          std::lower_bound(saved.blocks.begin(), saved.blocks.end(), blocks_.properties[row].id.value);
      expect(found != saved.blocks.end() && *found == blocks_.properties[row].id.value,
             "a checkpoint of the static solver holds all mobile blocks");
      motions[row] = saved.motions[static_cast<std::size_t>(found - saved.blocks.begin())];
    }
    statics_->springs().take(blocks_, saved.springs);
    lay_statics();
    return;
  }
  stage_.iteration.skipped = std::max(0.0, end_of_loads() - time());
  set_to_rest();
  for (std::size_t row = 0; row < blocks_.num_owned; ++row) { // where the contacts of the stage begin
    blocks_.displacement[row] = blocks_.trial[row];
    if (blocks_.is_deformable(row)) {
      blocks_.deformation_of(row).gradient = blocks_.deformation_of(row).trial;
    }
  }
  refresh();
  lay_statics();
  forget_increments(blocks_);
  evaluate_statically();
  statics_->hold(blocks_);
  find_static_motion();
  book_static_work();
}

// Springs are known to both ranks of a border pair; the one that counts the pair sends them to the owners of
// its blocks.
void Simulation::refresh_statics() {
  std::vector<std::vector<statics::SpringRecord>> leaving(static_cast<std::size_t>(communicator_.size()));
  for (const statics::SpringRecord &record : statics_->springs().records()) {
    if (!gcpdda::counts_here(blocks_, BlockIndex{record.spring.lower})) {
      continue;
    }
    std::array<int, 2> owners{-1, -1};
    const std::array<std::size_t, 2> rows{record.spring.lower, record.spring.higher};
    for (std::size_t k = 0; k < 2; ++k) {
      if (!blocks_.is_fixed(rows[k])) {
        owners[k] = map_.rank_of(blocks_.properties[rows[k]].centroid + blocks_.trial[rows[k]].u);
      }
    }
    for (std::size_t k = 0; k < 2; ++k) {
      if (owners[k] >= 0 && (k == 0 || owners[1] != owners[0])) {
        leaving[static_cast<std::size_t>(owners[k])].push_back(record);
      }
    }
  }
  std::vector<statics::SpringRecord> here;
  refresh();
  for (const auto &brought : communicator_.all_to_all(std::move(leaving))) {
    here.insert(here.end(), brought.begin(), brought.end());
  }
  statics_->springs().take(blocks_, std::move(here));
  lay_statics();
}

void Simulation::static_step() {
  if (stale_) {
    refresh_statics();
  }
  statics_->move(blocks_);
  pose_in_lanes(blocks_, 0, blocks_.num_owned);
  add_half_works(blocks_, 0, blocks_.num_owned);
  border_trials_.clear();
  for (const std::uint32_t row : ghosts_.sent_rows()) {
    border_trials_.push_back(
        {blocks_.trial[row], blocks_.is_deformable(row) ? blocks_.deformation_of(row).trial : Mat2{}});
  }
  ghosts_.begin(blocks_, border_trials_);
  receive_ghosts();
  evaluate_statically();
  ++step_count_;
  book_static_work();
  judge_statics();
  if (is_static()) {
    find_static_motion();
    book_static_work();
  }
  report_statically();
}

void Simulation::evaluate_statically() {
  load_time_ = time();
  {
    const auto scope = phases_.measure(Phase::forces);
    take(contacts_.evaluate(blocks_, candidates_, history_));
    evaluate_bolts();
  }
  sum_forces();
  prepare_forces();
  blocks_.body = {gravity(), {}};
  gather_forces(0, blocks_.num_owned, blocks_.body);
  take_own_springs(blocks_);
}

// The damping of pseudo-time, and what holds the load back, take all that the forces do together. By the
// trapezoid: half over the step that ends here, and half over the one that begins, which is found already.
void Simulation::book_static_work() {
  for (std::size_t row = 0; row < blocks_.num_owned; ++row) {
    if (!blocks_.properties[row].keeps_its_velocity()) {
      const std::array<double, 6> force = statics::unbalanced_forces(blocks_, row);
      const std::array<double, 6> &step = blocks_.pseudo[row].velocity;
      double done = 0.0;
      for (std::size_t i = 0; i < step.size(); ++i) {
        done += force[i] * step[i];
      }
      blocks_.ledger[row].damping -= 0.5 * done;
    }
  }
}

void Simulation::find_static_motion() {
  const auto scope = phases_.measure(Phase::update);
  const double overlap = communicator_.max(force_report_.max_overlap);
  statics_->find_motion(blocks_, candidates_, history_, contacts_, overlap, stage_.iteration);
}

void Simulation::judge_statics() {
  statics::IterationState &iteration = stage_.iteration;
  const std::int64_t window = statics_->rules().stall_window;
  look_at_stage();
  if (statics_->load_share(iteration.evaluations) < 1.0) {
    stage_.ended = false;
    stage_.verdict = Verdict::undecided;
    stage_.memory.settled_looks = 0;
    return;
  }
  if (stage_.verdict == Verdict::failed) {
    stage_.ended = false;
    stage_.verdict = Verdict::undecided;
    leave_statics("a block has moved so far that the stage may have failed");
    return;
  }
  iteration.least_ratio = std::min(iteration.least_ratio, stage_.memory.last.unbalanced_ratio);
  if (!stage_.ended && iteration.evaluations % window == 0) {
    const bool has_stalled = iteration.least_ratio > 0.5 * iteration.last_least;
    iteration.last_least = std::exchange(iteration.least_ratio, 1e300);
    if (has_stalled) {
      leave_statics(fmt::format("the unbalanced ratio has not fallen by half in {} evaluations: {:.3g}",
                                window, iteration.last_least));
    }
  }
}

void Simulation::report_statically() {
  const auto scope = phases_.measure(Phase::report);
  count();
  std::array<double, 3> status{};
  auto &[is_stale, is_asked, has_failed] = status;
  const bool may_pause = !is_static() || statics_->may_pause(stage_.iteration);
  is_asked = stop_asked_ && may_pause ? 1.0 : 0.0;
  has_failed = local_fault_ ? 1.0 : 0.0;
  for (std::size_t row = 0; row < blocks_.num_owned && is_static(); ++row) {
    const double ahead = statics::length_of_step(blocks_, row);
    if (moved_since_refresh(blocks_, row) + ahead > share_of_skin_kept * skin_) {
      is_stale = 1.0;
    }
  }
  communicator_.max(status);
  stale_ = stage_.iteration.is_left != 0 || is_stale > 0.0;
  stop_agreed_ = is_asked > 0.0 && has_failed == 0.0;
  if (has_failed > 0.0) {
    agree_on_fault();
  }
  if (stage_.iteration.is_left != 0 && !fault_) {
    accelerate(blocks_); // as at the beginning of a run
  }
}

bool Simulation::checkpoint_is_due() const {
  if (!is_static() || !statics_) {
    return plan_.checkpoint_due(stage_step());
  }
  const std::int64_t since = std::min(stage_step(), statics_->rules().coarse_every);
  bool is_due = false;
  for (std::int64_t k = 0; k < since; ++k) {
    is_due = is_due || plan_.checkpoint_due(stage_step() - k);
  }
  return is_due && statics_->may_pause(stage_.iteration);
}

} // namespace gcpdda
