#pragma once

// Checkpoints read, verified and distributed.

#include "gcpdda/io/result_manifest.hpp"
#include "gcpdda/parallel/communicator.hpp"
#include "io/checkpoint/checkpoint.hpp"
#include "model/block_system.hpp"

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace gcpdda {

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

/// Names of the files in DIR/checkpoints that are called like complete checkpoints; by one rank alone.
std::vector<std::filesystem::path> checkpoint_files(const std::filesystem::path &directory);

} // namespace gcpdda
