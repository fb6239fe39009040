#pragma once

// [earthquake]: how the ground moves.

#include "io/scene/scene_section.hpp"

#include <string>

namespace gcpdda::scene_text {

/// [earthquake] without its record, which is in a file.
/// @param scene  with its stages
/// @param scene_file  as the user gave it: the record's path starts from its folder
Earthquake read_earthquake(const SceneSource &source, const Scene &scene, const std::string &scene_file);

} // namespace gcpdda::scene_text
