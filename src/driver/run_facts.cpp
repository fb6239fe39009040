#include "driver/run_facts.hpp"

#include "model/generators.hpp"
#include "simulation/ground.hpp"
#include "simulation/rank_facts.hpp"

#include <algorithm>
#include <span>
#include <string>

namespace gcpdda {

namespace {

void take_work(const Communicator &communicator, const Simulation &simulation, std::int64_t first_step,
               RunSummary &summary) {
  const Counters &counters = simulation.counters();
  summary.contact_steps = total(communicator, counters.contact_steps);
  summary.evaluations_per_rank = counts_by_rank(communicator, counters.evaluations);
  summary.imbalance = imbalance_of(summary.evaluations_per_rank);
  summary.work_per_rank = counts_by_rank(communicator, counters.evaluations + counters.block_steps);
  summary.ghosts_per_rank =
      counts_by_rank(communicator, static_cast<std::int64_t>(simulation.blocks().num_ghosts));
  const double steps = static_cast<double>(std::max<std::int64_t>(summary.steps - first_step, 1));
  summary.bytes_sent_per_step = static_cast<double>(total(communicator, counters.bytes)) / steps;
  summary.messages_per_step = static_cast<double>(total(communicator, counters.messages)) / steps;
  const auto add = [&](const char *name, std::int64_t value) {
    summary.counters.emplace_back(name, static_cast<double>(value));
  };
  add("most_pairs", total(communicator, counters.most_pairs));
  add("products", counters.products);
  add("reductions", counters.reductions);
  add("migrations", total(communicator, counters.migrations));
  add("refreshes", counters.refreshes);
  add("rebalances", counters.rebalances);
  add("cross_rank_contacts", total(communicator, counters.cross_rank_contacts));
  add("cross_rank_contacts_formed", total(communicator, counters.cross_rank_contacts_formed));
  add("normals_undefined", total(communicator, counters.normals_undefined));
}

} // namespace

std::vector<RunSummary::StageLine> stage_lines(const Scene &scene, const std::vector<Stage> &stages,
                                               const std::vector<StageResult> &results) {
  std::vector<RunSummary::StageLine> lines;
  for (const StageResult &result : results) {
    const std::string slid = result.slid_block >= 0 ? block_name(scene, result.slid_block) : std::string();
    lines.push_back({stages[lines.size()].name, word_of(result.verdict), result, slid});
  }
  return lines;
}

void take_facts(const Communicator &communicator, Simulation &simulation, std::int64_t first_step,
                RunSummary &summary) {
  const TimePlan &plan = simulation.plan();
  summary.ranks = communicator.size();
  summary.blocks = total(communicator, simulation.blocks().num_owned);
  summary.fixed_blocks = static_cast<std::int64_t>(simulation.blocks().num_fixed);
  summary.steps = simulation.step_count();
  summary.time = simulation.time();
  summary.time_step = plan.time_step;
  summary.time_step_min = plan.time_step;
  take_work(communicator, simulation, first_step, summary);
  double max_overlap = simulation.counters().max_overlap;
  communicator.max(std::span(&max_overlap, 1));
  summary.max_overlap = max_overlap;
  if (const auto farthest = permanent_displacement(simulation.state())) {
    summary.permanent_displacement = farthest->distance;
    summary.permanent_block = block_name(simulation.scene(), farthest->block);
  }
  if (simulation.restored()) {
    summary.restarted_at = simulation.restored()->facts.time;
  }
  for (std::size_t p = 0; p < phase_names.size(); ++p) {
    const double seconds = simulation.phases().seconds(static_cast<Phase>(p));
    summary.phases.emplace_back(phase_names[p], spread(communicator, seconds));
  }
  if (simulation.is_staged()) {
    summary.stages = stage_lines(simulation.scene(), simulation.stages(), simulation.stage_results());
  }
}

} // namespace gcpdda
