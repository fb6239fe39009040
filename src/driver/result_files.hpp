#pragma once

// What a run writes into its folder while it goes on: frames, histories and checkpoints.

#include "gcpdda/io/frame_writer.hpp"
#include "gcpdda/io/run_summary.hpp"
#include "io/checkpoint/checkpoint_writer.hpp"
#include "io/results/history_writer.hpp"
#include "simulation/energy_ledger.hpp"
#include "simulation/simulation.hpp"

#include <filesystem>
#include <optional>
#include <vector>

namespace gcpdda {

/// All members but energies and loads of supports are collective.
class ResultFiles {
public:
  /// Of a run that begins, or that goes on behind the checkpoint it was restored from: what was written after
  /// that goes, and will be written again.
  /// @param directory  made for the run
  /// @param scene  as it was given: stages change that of the simulation
  /// @param goes_on  the results before it are in the folder
  ResultFiles(const Simulation &simulation, const Scene &scene, std::filesystem::path directory,
              bool goes_on);

  void write_frame(Simulation &simulation);
  /// @param energy  null for a broken state, whose energies say nothing
  void write_history(Simulation &simulation, const EnergyRow *energy);
  /// Behind frames and histories of the same step, so that a restart owes none.
  void write_checkpoint(Simulation &simulation, const EnergyLedger &ledger);
  void sync_frames() { frames_.sync(); }

  /// The root tells what bolts and liners have borne.
  void tell_supports(const Simulation &simulation, RunSummary &summary) const;

private:
  Communicator communicator_;
  std::filesystem::path directory_;
  std::vector<Bolt> bolts_at_start_;
  std::vector<Liner> liners_at_start_;
  FrameWriter frames_;
  std::optional<HistoryWriter> histories_; ///< of the root
  CheckpointWriter checkpoints_;
  int num_frames_ = 0;
};

} // namespace gcpdda
