#include "gcpdda/simulation/simulation.hpp"

#include "gcpdda/dynamics/integrate.hpp"
#include "gcpdda/parallel/migration.hpp"

#include <algorithm>

namespace gcpdda {

void Simulation::step() {
  if (stale_) { // some block may use up half the skin in this step; all ranks agree
    refresh();
  }
  load_time_ = time() + scheme_.load_time * plan_.time_step;
  predict_next();
  evaluate_contacts();
  gather_forces();
  {
    const auto scope = phases_.measure(Phase::update);
    if (const auto row = solve_and_update(blocks_, forces_, scheme_, plan_.time_step)) {
      keep_first(local_fault_, {Fault::Cause::not_finite, blocks_.properties[*row].id, {}, 0.0, 0.0});
    }
  }
  ++step_count_;
  report();
}

bool Simulation::counts_here(const CandidatePair &pair) const {
  return pair.lower.value < blocks_.num_owned || blocks_.is_fixed(pair.lower.value);
}

Vec2 Simulation::gravity() const {
  if (load_time_ >= scene_.run.gravity_ramp) {
    return scene_.run.gravity;
  }
  const double share = load_time_ / scene_.run.gravity_ramp;
  return (share * share * (3.0 - 2.0 * share)) * scene_.run.gravity;
}

// Each block to the rank that owns its centroid, who is seen by whom, which pairs may touch: on a finished
// state.
void Simulation::refresh() {
  const auto scope = phases_.measure(Phase::refresh);
  std::vector<RegionRecord> memory;
  for (std::size_t k = 0; k < candidates_.pairs.size(); ++k) {
    if (history_.regions[k].state != ContactState::open) {
      memory.push_back({blocks_.properties[candidates_.pairs[k].lower.value].id,
                        blocks_.properties[candidates_.pairs[k].higher.value].id, history_.regions[k]});
    }
  }
  const std::int64_t left = migrate(communicator_, map_, blocks_, memory);

  // Fast blocks would use up the usual skin at once: it grows so that half of it outlasts several steps.
  constexpr double steps_in_skin = 16.0;
  double reach = 0.0;
  for (std::size_t row = 0; row < blocks_.num_owned; ++row) {
    reach = std::max(reach, motion_bound(blocks_, row, plan_.time_step));
    blocks_.refreshed[row] = blocks_.displacement[row];
  }
  communicator_.max(std::span(&reach, 1));
  skin_ = std::max(base_skin_, steps_in_skin * reach);

  ghosts_.rebuild(map_, blocks_, reach_boxes(blocks_, skin_));
  candidates_ = make_candidates(blocks_, find_pairs(blocks_, reach_boxes(blocks_, skin_)),
                                contacts_.parameters(), std::move(memory), history_);
  pose(blocks_, 0, blocks_.num_rows());
  stale_ = false;
  if (step_count_ > 0) {
    counters_.migrations += left;
    ++counters_.refreshes;
  }
}

void Simulation::predict_next() {
  {
    const auto scope = phases_.measure(Phase::predict);
    predict(blocks_, scheme_, plan_.time_step);
  }
  const auto scope = phases_.measure(Phase::ghosts);
  ghosts_.update(blocks_);
}

void Simulation::evaluate_contacts() {
  const auto scope = phases_.measure(Phase::forces);
  force_report_ = contacts_.evaluate(blocks_, candidates_, history_);
  if (force_report_.fault) {
    keep_first(local_fault_, *force_report_.fault);
  }
}

// Sum on each block in the order of its partners' ids; the ledger's works go on by the trapezoid over
// increments of x*.
void Simulation::gather_forces() {
  const auto scope = phases_.measure(Phase::forces);
  forces_.resize(blocks_.num_owned);
  const Vec2 gravity_now = gravity();
  for (std::size_t row = 0; row < blocks_.num_owned; ++row) {
    const BlockContactSum sum = sum_contacts(blocks_, candidates_, contacts_.pairs(), row);
    forces_[row] = sum.force;
    const Vec2 weight = blocks_.properties[row].mass * gravity_now;
    forces_[row].u += weight;
    const RigidDof increment = blocks_.trial[row] - blocks_.trial_previous[row];
    BlockLedger &ledger = blocks_.ledger[row];
    ledger.shear_work += 0.5 * work(ledger.shear_force + sum.shear, increment);
    ledger.damping_work += 0.5 * work(ledger.damping_force + sum.damping, increment);
    ledger.gravity_work += 0.5 * dot(ledger.gravity_force + weight, increment.u);
    ledger.gravity_force = weight;
    ledger.shear_force = sum.shear;
    ledger.damping_force = sum.damping;
  }
}

// One reduction: does anybody need a refresh, has anybody failed.
void Simulation::report() {
  const auto scope = phases_.measure(Phase::report);
  counters_.evaluations += force_report_.evaluations;
  counters_.normals_undefined += force_report_.normals_undefined;
  counters_.max_overlap = std::max(counters_.max_overlap, force_report_.max_overlap);
  std::int64_t crossing = 0;
  for (std::size_t k = 0; k < candidates_.pairs.size(); ++k) {
    const CandidatePair &pair = candidates_.pairs[k];
    const PairForce &force = contacts_.pairs()[k];
    if (force.touching && counts_here(pair)) {
      ++counters_.contact_steps;
      const bool higher_is_ghost =
          pair.higher.value >= blocks_.num_owned && !blocks_.is_fixed(pair.higher.value);
      crossing += higher_is_ghost ? 1 : 0;
      counters_.cross_rank_contacts_formed += higher_is_ghost && force.born ? 1 : 0;
    }
  }
  counters_.cross_rank_contacts = std::max(counters_.cross_rank_contacts, crossing);

  constexpr double failed = 2.0;
  constexpr double needs_refresh = 1.0;
  double status = 0.0;
  for (std::size_t row = 0; row < blocks_.num_owned; ++row) {
    const BlockProperties &block = blocks_.properties[row];
    const RigidDof moved = blocks_.displacement[row] - blocks_.refreshed[row];
    const double ahead = motion_bound(blocks_, row, plan_.time_step);
    if (norm(moved.u) + block.radius * std::abs(moved.r) + ahead > 0.5 * skin_) {
      status = needs_refresh;
    }
    if (ahead > thinnest_ && num_blocks() > 1) {
      keep_first(local_fault_, {Fault::Cause::too_fast, block.id, {}, ahead, thinnest_});
    }
  }
  if (local_fault_) {
    status = failed;
  }
  communicator_.max(std::span(&status, 1));
  stale_ = status >= needs_refresh;
  if (status >= failed) {
    agree_on_fault();
  }
}

// The fault with the smallest block id, so that its report does not depend on the ranks.
void Simulation::agree_on_fault() {
  std::vector<Fault> mine;
  if (local_fault_) {
    mine.push_back(*local_fault_);
  }
  for (const std::vector<Fault> &faults : communicator_.all_gather(mine)) {
    for (const Fault &fault : faults) {
      keep_first(fault_, fault);
    }
  }
}

} // namespace gcpdda
