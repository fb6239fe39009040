#pragma once

// Where the values of a scene were written.

#include "io/scene/scene_section.hpp"

#include <map>
#include <string>

namespace gcpdda::scene_text {

/// Scene::places. Blocks, monitors, stages and members of an ensemble have none: they know their own.
std::map<std::string, SourcePosition> places_of(const SceneSource &source);

} // namespace gcpdda::scene_text
