#pragma once

// [in_situ]: the stress that is in the rock before anything happens.

#include "io/scene/scene_section.hpp"

namespace gcpdda::scene_text {

/// @param scene  with run and materials
InSituStress read_in_situ(const SceneSource &source, const Scene &scene);

} // namespace gcpdda::scene_text
