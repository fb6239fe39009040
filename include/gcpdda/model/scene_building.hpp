#pragma once

// Scenes made in code. A scene that has been read from text is complete already (io/scene_reader.hpp).

#include "gcpdda/model/scene.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace gcpdda {

/// A scene without blocks.
///
/// @param law  of all contacts; its name becomes "default"
/// @param duration  s; a frame is due at its end
/// @throws std::invalid_argument where a number cannot be meant
Scene make_scene(const JointLaw &law, double duration);

/// @return its number, for SceneBlock::material
/// @throws std::invalid_argument where a number cannot be meant
std::int32_t add_material(Scene &scene, const Material &material);

/// A block at rest that moves; what it returns may be changed.
///
/// @param scene  gets the block behind those it has
/// @param name  of the block, in messages and results
/// @param vertices  m, in order around the block, either way round
/// @param material  what add_material() has returned
/// @throws std::invalid_argument where they do not bound a block, or the material is none of the scene's
SceneBlock &add_block(Scene &scene, std::string name, std::vector<Vec2> vertices, std::int32_t material = 0);

} // namespace gcpdda
