#pragma once

#include "scene_section.hpp"

#include "gcpdda/model/scene.hpp"

#include <map>
#include <string>
#include <vector>

namespace gcpdda::scene_text {

/// What the parts of a scene are put together from.
struct SceneSource {
  const toml::table &root;
  const FaultyNodes &faulty;
  Faults &faults;
};

using MaterialIndex = std::map<std::string, std::int32_t>;

/// Index of a material, -1 (and a fault at `where`) where no material has that name.
std::int32_t find_material(const MaterialIndex &materials, const std::string &name,
                           const toml::source_region &where, Faults &faults);

JointLaws read_joint_laws(const SceneSource &source, const MaterialIndex &materials);

/// One SceneBlock per [[block]]; the faulty ones lack their faulty parts.
std::vector<SceneBlock> read_blocks(const SceneSource &source, const MaterialIndex &materials);

} // namespace gcpdda::scene_text
