#pragma once

// [water.NAME]: phreatic lines.

#include "io/scene/scene_section.hpp"

#include <optional>
#include <vector>

namespace gcpdda::scene_text {

/// Active water needs gravity along -y.
/// @param where  where a stage sets gravity or water, which is then at fault; without it the table of the
/// water
void expect_gravity_of_water(const SceneSource &source, const std::vector<Water> &water,
                             const std::optional<toml::source_region> &where);

/// The water of [water.NAME]; the faulty ones lack their faulty parts.
std::vector<Water> read_water(const SceneSource &source, const JointLaws &joints);

} // namespace gcpdda::scene_text
