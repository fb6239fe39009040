#pragma once

// [ensemble]: what each of many members draws in place of the values of the scene.

#include "io/scene/scene_section.hpp"

namespace gcpdda::scene_text {

/// @param scene  with joints and stages
Ensemble read_ensemble(const SceneSource &source, const Scene &scene);

} // namespace gcpdda::scene_text
