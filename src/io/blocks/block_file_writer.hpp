#pragma once

// Blocks written to an HDF5 file.

#include "gcpdda/model/scene.hpp"
#include "gcpdda/parallel/communicator.hpp"

#include <filesystem>
#include <span>

namespace gcpdda {

/// Writes a block file: outlines, materials, what is fixed and the laws of edges of the blocks that the ranks
/// hold, in the order of the ranks. Collective; throws FileError on all ranks.
void write_block_file(const Communicator &communicator, const std::filesystem::path &path,
                      std::span<const SceneBlock> mine);

} // namespace gcpdda
