#pragma once

// The region that joints cut into blocks: [region] and everything that lies in it.

#include "io/scene/scene_materials.hpp"

#include <string>

namespace gcpdda::scene_text {

/// [region] and everything that lies in it. Joint maps are named, not read.
/// @param of_run  what blocks are that do not say it
/// @param scene_file  as the user gave it: the paths of joint maps start from its folder
RockRegion read_region(const SceneSource &source, Materials &materials, Fidelity of_run,
                       const JointLaws &joints, const std::string &scene_file);

} // namespace gcpdda::scene_text
