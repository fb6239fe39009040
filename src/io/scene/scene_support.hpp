#pragma once

// [support.NAME], [[bolt]], [[bolt_pattern]] and [[liner]].

#include "io/scene/scene_section.hpp"

#include <vector>

namespace gcpdda::scene_text {

/// [support.NAME]; the faulty ones lack their faulty parts.
std::vector<SupportType> read_supports(const SceneSource &source);
/// Every [[bolt]], then those of each [[bolt_pattern]]; none where it cannot be placed.
/// @param scene  with supports and region
std::vector<Bolt> read_bolts(const SceneSource &source, const Scene &scene);
/// Every [[liner]] that can be placed.
/// @param scene  with supports and region
std::vector<Liner> read_liners(const SceneSource &source, const Scene &scene);

} // namespace gcpdda::scene_text
