#include "simulation/step_report.hpp"

#include "simulation/ground.hpp"
#include "simulation/strain_watch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

namespace gcpdda {

namespace {

// The status of a rank after a step; the largest of all ranks counts.
constexpr double needs_refresh = 1.0;
constexpr double asked_to_stop = 2.0; // a refresh does no harm then
constexpr double failed = 3.0;

/// A block that may touch an owned one before the next refresh; none where nothing is near.
BlockId any_candidate_of(const RunState &run, std::size_t row) {
  for (const CandidatePair &pair : run.neighbours.candidates.pairs) {
    if (pair.lower.value == row || pair.higher.value == row) {
      return run.blocks.properties[pair.lower.value == row ? pair.higher.value : pair.lower.value].id;
    }
  }
  return {};
}

double own_status(RunState &run, const AdvanceReport &advance) {
  double status = 0.0;
  for (const RowSpan &rows : advance.rows_to_check) {
    for (std::size_t row = rows.first; row < rows.last; ++row) {
      if (most_motion(run.blocks, row, run.clock.plan.time_step) <=
          safe_motion(run)) { // true of nearly all blocks, and found without a root
        continue;
      }
      const double ahead = motion_bound(run.blocks, row, run.clock.plan.time_step);
      if (moved_since_refresh(run.blocks, row) + ahead > 0.5 * run.neighbours.skin) {
        status = needs_refresh;
      }
      if (ahead > most_motion_in_step(run) && num_blocks(run.scene) > 1) {
        keep_first(run.local_fault, {Fault::Cause::too_fast, run.blocks.properties[row].id,
                                     any_candidate_of(run, row), ahead, most_motion_in_step(run)});
      }
    }
  }
  return run.local_fault ? failed : run.stop_asked ? asked_to_stop : status;
}

} // namespace

void count_step(RunState &run, const AdvanceReport &advance) {
  run.counters.evaluations += run.force_report.evaluations;
  run.counters.most_pairs = std::max(run.counters.most_pairs, run.force_report.evaluations);
  run.counters.block_steps += static_cast<std::int64_t>(run.blocks.num_owned);
  run.counters.normals_undefined += run.force_report.normals_undefined;
  run.counters.messages += run.neighbours.ghosts.messages_per_update();
  run.counters.bytes += run.neighbours.ghosts.bytes_per_update();
  run.counters.reductions = run.communicator.reductions() - run.first_reduction;
  run.counters.max_overlap = std::max(run.counters.max_overlap, run.force_report.max_overlap);
  run.counters.max_overlap_share =
      std::max(run.counters.max_overlap_share, run.force_report.max_overlap_share);
  run.counters.contact_steps += run.contact_count.touching;
  run.counters.cross_rank_contacts = std::max(run.counters.cross_rank_contacts, run.contact_count.crossing);
  run.counters.cross_rank_contacts_formed += run.contact_count.crossing_formed;
  run.counters.fastest_turn = std::max(run.counters.fastest_turn, advance.largest_turn);
}

// The fault with the smallest block id, so that its report does not depend on the ranks.
void agree_on_fault(RunState &run) {
  std::vector<Fault> mine;
  if (run.local_fault) {
    mine.push_back(*run.local_fault);
  }
  for (const std::vector<Fault> &faults : run.communicator.all_gather(mine)) {
    for (const Fault &fault : faults) {
      keep_first(run.fault, fault);
    }
  }
  if (run.fault && run.fault->cause == Fault::Cause::not_finite) {
    run.fault->value = largest_strain(run.communicator, run.blocks).strain;
  }
}

// One reduction says whether any rank needs a refresh, has failed or was asked to stop. It cannot be a step
// late: how far a block may go in two steps depends on contacts that are not evaluated yet, so that a flag
// one step late is no bound. A reduction that runs while this rank counts is no shorter: to start it and to
// test for its end, each with the cache full of blocks, takes longer than counting.
void report_step(RunState &run, const AdvanceReport &advance) {
  const auto scope = run.phases.measure(Phase::report);
  count_step(run, advance);
  const double agreed = run.communicator.max(own_status(run, advance));
  run.neighbours.stale = agreed >= needs_refresh;
  run.stop_agreed = agreed == asked_to_stop;
  if (agreed >= failed) {
    agree_on_fault(run);
  }
}

Diagnostics warnings_of(const RunState &run) {
  std::array<double, 2> largest{run.counters.fastest_turn, run.counters.max_overlap_share};
  run.communicator.max(largest);
  const auto [turn, share] = largest;
  Diagnostics warnings;
  if (!run.fault && !run.stop_agreed) {
    if (auto cut = warning_of_cut_record(run)) {
      warnings.push_back(std::move(*cut));
    }
  }
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
                        "a joint that closes by more than 0.1 of its blocks is outside the model's validity",
                        "use a larger joint.normal_stiffness"});
  }
  return warnings;
}

} // namespace gcpdda
