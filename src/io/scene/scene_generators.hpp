#pragma once

// Where blocks come from that the scene file does not list: walls, pyramids and the block file.

#include "io/scene/scene_blocks.hpp"

#include <string>
#include <vector>

namespace gcpdda::scene_text {

/// Walls and pyramids that can be built, in the order of the file. Blocks whose name is that of a brick are
/// faults, and more blocks than ids.
std::vector<BrickGenerator> read_generators(const SceneSource &source, Materials &materials, Names &names,
                                            Fidelity of_run, const std::vector<SceneBlock> &blocks);

/// @param scene_file  as the user gave it: the block file's path starts from its folder
BlockFile read_block_file_table(const SceneSource &source, Materials &materials, Fidelity of_run,
                                const std::string &scene_file);

} // namespace gcpdda::scene_text
