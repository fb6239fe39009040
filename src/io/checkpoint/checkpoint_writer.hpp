#pragma once

// Checkpoints written.

#include "gcpdda/parallel/communicator.hpp"
#include "io/checkpoint/checkpoint.hpp"
#include "model/block_system.hpp"

#include <cstdint>
#include <filesystem>

namespace gcpdda {

/// Writes checkpoints of one run.
class CheckpointWriter {
public:
  /// @param last  the checkpoint the run goes on from; empty for a run from t = 0
  /// @param ids_per_strip  that a rank writes at a time, 0 for the usual number; files do not depend on it
  CheckpointWriter(const Communicator &communicator, std::filesystem::path directory,
                   std::filesystem::path last, std::int64_t ids_per_strip = 0);

  /// State of all mobile blocks at the end of a step, read again before an older one is removed. Afterwards
  /// this and the checkpoint before are there, no others. Collective; throws FileError on all ranks and
  /// leaves what was there.
  ///
  /// @param blocks  each mobile block is owned by one rank; owned ones ascending
  /// @param regions  those of a pair on one rank
  void write(const RunFacts &facts, const BlockSystem &blocks, const RegionSource &regions);

private:
  Communicator communicator_;
  std::filesystem::path directory_;
  std::filesystem::path last_;
  std::int64_t ids_per_strip_;
};

} // namespace gcpdda
