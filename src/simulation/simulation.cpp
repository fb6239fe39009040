#include "simulation/simulation.hpp"

#include "parallel/migration.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>

namespace gcpdda {

namespace {

// The status of a rank after a step; the largest of all ranks counts.
constexpr double needs_refresh = 1.0;
constexpr double asked_to_stop = 2.0; // a refresh does no harm then
constexpr double failed = 3.0;

} // namespace

void Simulation::step() {
  if (is_static() && !statics_) {
    if (const std::string reason = not_served(); !reason.empty()) {
      leave_statics(reason);
    } else {
      open_statics();
    }
  }
  if (is_static()) {
    static_step();
    return;
  }
  rebalance_if_uneven();
  if (stale_) { // some block may use up half the skin in this step; all ranks agree
    refresh();
  }
  begin_step();
  send_border_trials();
  for (const PairGroup &group : candidates_.groups) { // blocks are read and advanced from the cache
    predict_to(group.rows_read);
    evaluate_group(group);
    progress_messages();
    advance_to(group.rows_finished);
  }
  receive_ghosts();
  evaluate_border();
  sum_forces();
  advance_remaining();
  ++step_count_;
  prescribe_motion();
  judge_stage();
  report();
}

bool Simulation::counts_here(const CandidatePair &pair) const {
  return gcpdda::counts_here(blocks_, pair.lower);
}

Vec2 Simulation::gravity() const {
  return Rise{0.0, scene_.run.gravity_ramp}.at(load_time_) * scene_.run.gravity;
}

// On a finished state: blocks migrate to the rank that owns their centroid, then ghosts and candidates are
// found anew.
void Simulation::refresh(std::optional<ContactMemory> given) {
  const auto scope = phases_.measure(Phase::refresh);
  bolts_.share(communicator_);
  // Rows change places. What is made anew goes first: old and new lists together would be the largest thing
  // in memory.
  blocks_.motion = {};
  digest_.reset();
  ContactMemory memory = given ? std::move(*given) : remembered_contacts();
  candidates_ = {};
  history_.plain = {};
  const std::int64_t left = migrate(communicator_, map_, blocks_, memory);

  // Fast blocks would use up the usual skin at once: it grows so that half of it outlasts several steps.
  constexpr double steps_in_skin = 16.0;
  std::array<double, 2> largest{};
  auto &[reach, dilation] = largest;
  for (const RegionRecord &record : memory.others) { // a joint that slip has opened still acts
    dilation = std::max(dilation, norm(record.memory.dilation));
  }
  for (std::size_t row = 0; row < blocks_.num_owned; ++row) {
    reach = std::max(reach, motion_bound(blocks_, row, plan_.time_step));
    blocks_.refreshed[row] = blocks_.displacement[row];
    if (blocks_.is_deformable(row)) {
      Deformation &d = blocks_.deformation_of(row);
      d.refreshed = d.gradient;
    }
  }
  communicator_.max(largest);
  dilation += contacts_.parameters().joints.largest_dilation();
  skin_ = std::max(base_skin_, steps_in_skin * reach);

  // A joint is remembered until it is open by twice that; only one of its blocks may be inflated.
  const double reach_skin = skin_ + 4.0 * dilation;
  std::vector<Aabb> boxes = reach_boxes(blocks_, reach_skin);
  ghosts_.rebuild(blocks_, boxes, bolts_.partners(communicator_, blocks_), &map_);
  border_trials_.reserve(ghosts_.sent_rows().size());
  const std::vector<Aabb> ghost_boxes =
      reach_boxes(blocks_, reach_skin, blocks_.num_owned, blocks_.first_fixed());
  boxes.insert(boxes.begin() + static_cast<std::ptrdiff_t>(blocks_.num_owned), ghost_boxes.begin(),
               ghost_boxes.end());
  const auto pairs = find_pairs(blocks_, boxes);
  boxes = {};
  candidates_ = make_candidates(blocks_, pairs, contacts_.parameters(), std::move(memory), history_, skin_);
  pose(blocks_, blocks_.first_fixed(), blocks_.num_rows());
  pose_in_lanes(blocks_, 0, blocks_.num_mobile());
  bolts_.connect(blocks_);
  find_waiting_rows();
  stale_ = false;
  if (step_count_ > 0) {
    counters_.migrations += left;
    ++counters_.refreshes;
  }
}

// The balance is checked every steps_between_checks; blocks follow a new map by the migration of a refresh.
void Simulation::rebalance_if_uneven() {
  constexpr std::int64_t steps_between_checks = 64;
  if (step_count_ == 0 || step_count_ % steps_between_checks != 0 ||
      !balance_.is_lost(counters_.evaluations + counters_.block_steps)) {
    return;
  }
  const auto scope = phases_.measure(Phase::refresh);
  std::vector<Vec2> centroids;
  for (std::size_t row = 0; row < blocks_.num_owned; ++row) {
    centroids.push_back(blocks_.centroid(row));
  }
  auto map = balance_.better_map(centroids, work_of_blocks(blocks_, candidates_), partition_);
  if (map) {
    map_ = std::move(*map);
    stale_ = true;
    ++counters_.rebalances;
  }
}

Diagnostics Simulation::warnings() const {
  std::array<double, 2> largest{counters_.fastest_turn, counters_.max_overlap_share};
  communicator_.max(largest);
  const auto [turn, share] = largest;
  Diagnostics warnings;
  if (turn > 0.05) {
    warnings.push_back({Severity::warning,
                        {},
                        fmt::format("a deformable block turned by {:.2g} rad in one step", turn),
                        "spinning loses energy then, 0.25 % in a turn at 0.25 rad with implicit elasticity",
                        "use a smaller run.time_step, or a rigid block"});
  }
  if (share > 0.1) {
    warnings.push_back({Severity::warning,
                        {},
                        fmt::format("two blocks overlapped by {:.2g} of the narrowest width of one", share),
                        "a joint that closes by more than 0.1 of its blocks is no joint any more",
                        "use a larger joint.normal_stiffness"});
  }
  return warnings;
}

void Simulation::begin_step() {
  const auto scope = phases_.measure(Phase::forces);
  load_time_ = time() + scheme_.load_time * plan_.time_step;
  find_prescribed_rows();
  prepare_forces();
  progress_.body = {gravity(), ground_acceleration()};
  progress_.predicted = 0;
  progress_.advanced = 0;
  progress_.passed = 0;
  progress_.report.clear();
  contacts_.begin(blocks_, candidates_);
}

void Simulation::evaluate_group(const PairGroup &group) {
  const auto scope = phases_.measure(Phase::forces);
  contacts_.evaluate_group(blocks_, candidates_, history_, group);
}

void Simulation::progress_messages() {
  const auto scope = phases_.measure(Phase::ghosts);
  ghosts_.progress();
}

void Simulation::receive_ghosts() {
  const auto scope = phases_.measure(Phase::ghosts);
  ghosts_.finish(blocks_);
}

void Simulation::evaluate_border() {
  const auto scope = phases_.measure(Phase::forces);
  take(contacts_.evaluate_border(blocks_, candidates_, history_));
  evaluate_bolts();
}

void Simulation::evaluate_bolts() {
  if (!bolts_.empty()) {
    bolts_.evaluate(blocks_);
  }
}

void Simulation::take(const ForceReport &report) {
  force_report_ = report;
  digest_.reset();
  if (report.fault) {
    keep_first(local_fault_, *report.fault);
  }
}

// Contact forces are summed on each block in the order of its partners' ids.
void Simulation::sum_forces() {
  const auto scope = phases_.measure(Phase::forces);
  contact_count_ = contacts_.finish_sums(blocks_, candidates_);
  contacts_.add_dilation_works(candidates_, blocks_);
  bolts_.add_forces(blocks_, contacts_.sums().of_blocks());
}

// One reduction says whether any rank needs a refresh, has failed or was asked to stop. It cannot be a step
// late: how far a block may go in two steps depends on contacts that are not evaluated yet, so that a flag
// one step late is no bound. A reduction that runs while this rank counts is no shorter: to start it and to
// test for its end, each with the cache full of blocks, takes longer than counting.
void Simulation::report() {
  const auto scope = phases_.measure(Phase::report);
  count();
  const double agreed = communicator_.max(own_status());
  stale_ = agreed >= needs_refresh;
  stop_agreed_ = agreed == asked_to_stop;
  if (agreed >= failed) {
    agree_on_fault();
  }
}

double Simulation::safe_motion() const {
  return std::min(0.5 * skin_, most_motion_in_step());
}

double Simulation::own_status() {
  double status = 0.0;
  for (const RowSpan &rows : progress_.report.rows_to_check) {
    for (std::size_t row = rows.first; row < rows.last; ++row) {
      if (most_motion(blocks_, row, plan_.time_step) <=
          safe_motion()) { // true of nearly all blocks, and found without a root
        continue;
      }
      const double ahead = motion_bound(blocks_, row, plan_.time_step);
      if (moved_since_refresh(blocks_, row) + ahead > 0.5 * skin_) {
        status = needs_refresh;
      }
      if (ahead > most_motion_in_step() && num_blocks() > 1) {
        keep_first(local_fault_,
                   {Fault::Cause::too_fast, blocks_.properties[row].id, {}, ahead, most_motion_in_step()});
      }
    }
  }
  return local_fault_ ? failed : stop_asked_ ? asked_to_stop : status;
}

void Simulation::count() {
  counters_.evaluations += force_report_.evaluations;
  counters_.block_steps += static_cast<std::int64_t>(blocks_.num_owned);
  counters_.normals_undefined += force_report_.normals_undefined;
  counters_.messages += ghosts_.messages_per_update();
  counters_.bytes += ghosts_.bytes_per_update();
  counters_.max_overlap = std::max(counters_.max_overlap, force_report_.max_overlap);
  counters_.max_overlap_share = std::max(counters_.max_overlap_share, force_report_.max_overlap_share);
  counters_.contact_steps += contact_count_.touching;
  counters_.cross_rank_contacts = std::max(counters_.cross_rank_contacts, contact_count_.crossing);
  counters_.cross_rank_contacts_formed += contact_count_.crossing_formed;
  counters_.fastest_turn = std::max(counters_.fastest_turn, progress_.report.largest_turn);
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
