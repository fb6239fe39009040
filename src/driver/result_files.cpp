#include "driver/result_files.hpp"

#include "io/checkpoint/checkpoint.hpp"
#include "simulation/rank_facts.hpp"
#include "simulation/results.hpp"
#include "simulation/saved_state.hpp"

#include <utility>

namespace gcpdda {

ResultFiles::ResultFiles(const Simulation &simulation, const Scene &scene, std::filesystem::path directory,
                         bool goes_on)
    : communicator_(simulation.communicator()), directory_(std::move(directory)),
      bolts_at_start_(scene.bolts), liners_at_start_(scene.liners),
      frames_(communicator_, directory_, simulation.num_blocks()),
      checkpoints_(communicator_, directory_,
                   goes_on ? simulation.restored()->path : std::filesystem::path()) {
  if (goes_on) {
    const RunFacts &facts = simulation.restored()->facts;
    frames_.continue_behind(facts.frame_times, facts.results);
    num_frames_ = static_cast<int>(facts.frame_times.size());
    on_root(communicator_, [&] {
      histories_.emplace(directory_, scene.monitors, facts.time + 0.5 * facts.time_step, facts.results,
                         SupportHistories::of(scene));
    });
  } else {
    on_root(communicator_,
            [&] { histories_.emplace(directory_, scene.monitors, SupportHistories::of(scene)); });
  }
}

void ResultFiles::write_frame(Simulation &simulation) {
  const int index = num_frames_++;
  frames_.write(index, simulation.time(), SimulationFrame(simulation));
  if (simulation.scene().output.contacts) {
    frames_.write_contacts(index, simulation.time(), SimulationContacts(simulation));
  }
  if (!bolts_at_start_.empty()) {
    frames_.write_bolts(index, simulation.time(), collect_bolt_lines(simulation));
  }
  if (!liners_at_start_.empty()) {
    frames_.write_liners(index, simulation.time(), collect_liner_rows(simulation));
  }
}

void ResultFiles::write_history(Simulation &simulation, const EnergyRow *energy) {
  const std::vector<BlockHistoryRow> rows = collect_monitors(simulation);
  const std::vector<BoltHistoryRow> bolts = collect_bolts(simulation);
  const std::vector<LinerHistoryRow> liners = collect_liners(simulation);
  on_root(communicator_, [&] {
    for (std::size_t m = 0; m < rows.size(); ++m) {
      const std::int64_t block = simulation.scene().monitors[m].block;
      if (block < 0 || simulation.is_removed(block)) {
        continue;
      }
      histories_->write_monitor(m, simulation.time(), rows[m]);
    }
    if (energy != nullptr) {
      histories_->write_energy(simulation.time(), *energy);
    }
    if (!bolts.empty()) {
      histories_->write_bolts(simulation.time(), bolts);
    }
    if (!liners.empty()) {
      histories_->write_liners(simulation.time(), liners);
    }
    histories_->flush();
  });
}

void ResultFiles::write_checkpoint(Simulation &simulation, const EnergyLedger &ledger) {
  on_root(communicator_, [&] { histories_->sync(); });
  frames_.sync();
  RunFacts facts = facts_of(simulation.state());
  on_root(communicator_, [&] {
    facts.results = histories_->files();
    facts.results.insert(facts.results.end(), frames_.files().begin(), frames_.files().end());
  });
  ledger.tell(facts);
  facts.frame_times = frames_.times();
  checkpoints_.write(facts, simulation.blocks(), SimulationContacts(simulation));
}

void ResultFiles::tell_supports(const Simulation &simulation, RunSummary &summary) const {
  if (histories_) {
    summary.bolts = with_installation(histories_->bolt_loads(), bolts_at_start_, simulation);
    summary.liners = with_installation(histories_->liner_loads(), liners_at_start_, simulation);
  }
}

} // namespace gcpdda
