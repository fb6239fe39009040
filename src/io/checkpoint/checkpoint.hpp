#pragma once

// DIR/checkpoints/checkpoint_<step>.h5: everything of a run that its scene does not say and that cannot be
// computed again. Rows are in BlockId order, so the bytes do not depend on the number of ranks, and neither
// does the number that reads them. The file appears under its name only when it is complete and on the disk;
// the two newest are kept. A sum over all bytes is compared before anything else of a file is believed; one
// that is damaged, or of another scene, or whose results are not whole, is named and the one before is taken.

#include "gcpdda/io/result_manifest.hpp"
#include "gcpdda/parallel/communicator.hpp"
#include "model/block_system.hpp"
#include "model/contact_history.hpp"
#include "model/fingerprint.hpp"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <vector>

namespace gcpdda {

/// What a state fits (model/fingerprint.hpp).
struct SceneIdentity {
  std::int64_t num_blocks = 0; ///< fixed ones included
  std::int64_t num_mobile = 0;
  std::uint64_t blocks = 0; ///< sum of the fingerprints of all
  std::uint64_t materials = 0;
  ScenePrints parts{}; ///< of the scene with the stages up to that of the state

  friend bool operator==(const SceneIdentity &, const SceneIdentity &) = default;
};

/// What a checkpoint holds besides blocks and contacts; the same on all ranks.
struct RunFacts {
  SceneIdentity scene;
  std::int64_t step = 0;
  double time = 0.0;              ///< s
  double time_step = 0.0;         ///< s
  double total_at_start = 0.0;    ///< of the energies, J/m
  double stick_at_start = 0.0;    ///< energy of the stick springs, J/m
  std::int64_t contact_steps = 0; ///< and what follows: of the run so far, for its summary
  double max_overlap = 0.0;
  double max_overlap_share = 0.0;
  double fastest_turn = 0.0;
  double gravity_x = 0.0; ///< and what follows: BlockSystem::body, m/s2
  double gravity_y = 0.0;
  double shaking_x = 0.0;
  double shaking_y = 0.0;
  std::vector<double> ledger; ///< of the energies, what stages changed at once (simulation/energy_ledger.hpp)
  std::int64_t more_mobile = 0;           ///< mobile blocks now, beyond those of the scene; not written
  std::vector<std::int64_t> stage_counts; ///< where the run stands in its stages (simulation/stages.hpp)
  std::vector<double> stage_numbers;
  std::vector<std::int64_t> bolt_counts; ///< links of the bolts in place (simulation/bolts.hpp)
  std::vector<double> bolt_numbers;
  std::vector<std::int64_t> static_counts; ///< of a static solver at work (simulation/static_state.hpp)
  std::vector<double> static_numbers;
  std::vector<double> frame_times; ///< of the frames written, s
  std::vector<ResultFile> results; ///< files written so far; known to the root alone
};

/// Where the memory of contacts comes from: each rank hands over what it has, strip by strip, so that nobody
/// holds a copy of all.
class RegionSource {
public:
  RegionSource() = default;
  virtual ~RegionSource() = default;
  RegionSource(const RegionSource &) = delete;
  RegionSource &operator=(const RegionSource &) = delete;
  /// This rank's regions with first <= lower < last. Not collective.
  [[nodiscard]] virtual std::int64_t count(std::int64_t first, std::int64_t last) const = 0;
  /// The same regions behind `records`, those of a pair in their order.
  virtual void append(std::int64_t first, std::int64_t last, std::vector<RegionRecord> &records) const = 0;
};

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

/// A state that has been read.
struct Restored {
  std::filesystem::path path;
  RunFacts facts;
  std::vector<RegionRecord> memory;  ///< of all contacts of the rows
  std::vector<std::string> rejected; ///< newer checkpoints that could not be used, and why
  std::vector<std::string> gaps;     ///< what is wrong with results before this one; known to the root alone
};

/// Put the newest checkpoint of a run's folder that is whole and fits into the rows of `blocks`. Collective.
///
/// @param directory  the result folder
/// @param blocks  owned: the mobile ones of this rank's slab of ids (results/id_slabs.hpp), ascending; shapes
/// and
///                constants as the scene says
/// @param prepare  what these rows need to be those of a checkpoint with these facts; called before each one
///                 is tried; rejects it by a FileError on all ranks
/// @throws FileError with every file that was tried and why it was rejected
Restored restore_newest_checkpoint(const Communicator &communicator, const std::filesystem::path &directory,
                                   const SceneIdentity &scene, BlockSystem &blocks,
                                   const std::function<void(const RunFacts &)> &prepare = {},
                                   EarlierResults results = EarlierResults::are_not_looked_at);

/// Reads a checkpoint again and compares its checksum: not every file system tells of a write that failed.
/// Collective.
/// @throws FileError where it is not whole
void expect_readable_checkpoint(const Communicator &communicator, const std::filesystem::path &path);

/// Scenes that a run has left behind: `restart --set` changes a scene under a state, and the state stays one
/// of this run. DIR/checkpoints/past_scenes.txt has a fingerprint a line. By the root alone.
std::vector<std::uint64_t> past_scenes(const std::filesystem::path &directory);
/// Adds these; throws FileError.
void remember_scenes(const std::filesystem::path &directory, const std::vector<std::uint64_t> &prints);

/// Names of the files in DIR/checkpoints that are called like complete checkpoints; by one rank alone.
std::vector<std::filesystem::path> checkpoint_files(const std::filesystem::path &directory);

} // namespace gcpdda
