#pragma once

// [water.NAME]: phreatic lines.

#include "io/scene/scene_section.hpp"

#include <vector>

namespace gcpdda::scene_text {

/// The water of [water.NAME]; the faulty ones lack their faulty parts.
std::vector<Water> read_water(const SceneSource &source, const JointLaws &joints);

} // namespace gcpdda::scene_text
