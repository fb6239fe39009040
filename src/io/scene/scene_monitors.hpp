#pragma once

// Tables [[monitor]] of a scene.

#include "io/scene/scene_section.hpp"

#include <vector>

namespace gcpdda::scene_text {

/// @param scene  with all its blocks
std::vector<Monitor> read_monitors(const SceneSource &source, const Scene &scene);

} // namespace gcpdda::scene_text
