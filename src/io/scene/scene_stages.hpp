#pragma once

// [[stage]]: what happens one after the other.

#include "io/scene/scene_section.hpp"

#include <vector>

namespace gcpdda::scene_text {

/// The stages, each without what it sets (scene_changes.hpp).
/// @param scene  with all its blocks
std::vector<Stage> read_stages(const SceneSource &source, const Scene &scene);

/// Longest time all stages may take together, s.
double duration_of_stages(const SceneSource &source);

} // namespace gcpdda::scene_text
