#pragma once

// Blocks in an HDF5 file, of which each rank reads its share.

#include "gcpdda/base/diagnostic.hpp"
#include "gcpdda/model/scene.hpp"
#include "gcpdda/parallel/communicator.hpp"

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

namespace gcpdda {

/// Looks at the scene's block file: sets scene.block_file.num_blocks and returns the faults that the names,
/// types and shapes of its datasets show, and the names in the scene that its blocks take or lack. The root
/// looks, all ranks get the same. Without a block file nothing happens. Collective.
Diagnostics open_block_file(const Communicator &communicator, Scene &scene);

/// Appends the blocks [first, last), numbers within the file, to `blocks`; each rank reads its own range and
/// no more, which may be empty. Without a block file nothing happens. Names and positions stay empty, to save
/// memory: block_name() and block_position() make them. All ranks get the same diagnostics: the first faults
/// of all ranges in the order of the blocks, and how many there are more. Open the file first and without
/// faults. Collective; throws FileError on all ranks where the file cannot be read.
Diagnostics read_block_file(const Communicator &communicator, const Scene &scene, std::int64_t first,
                            std::int64_t last, std::vector<SceneBlock> &blocks);

} // namespace gcpdda
