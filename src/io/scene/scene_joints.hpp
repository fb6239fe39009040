#pragma once

// Tables [joint.NAME] of a scene: the keys of contact laws, how they are read, and which materials have them.

#include "io/scene/scene_materials.hpp"

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace gcpdda::scene_text {

/// Number of the law that a name stands for; nothing, and a fault, where no joint is named so.
std::optional<std::int32_t> find_joint(const SceneSource &source, const toml::node &name,
                                       const JointLaws &joints);
/// The same of a list of names, ascending.
std::vector<std::int32_t> find_joints(const SceneSource &source, const Section &section, std::string_view key,
                                      const JointLaws &joints);

JointLaws read_joint_laws(const SceneSource &source, const MaterialIndex &materials);

} // namespace gcpdda::scene_text
