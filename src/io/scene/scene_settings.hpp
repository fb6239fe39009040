#pragma once

// The tables [run], [output] and [fos].

#include "io/scene/scene_section.hpp"

namespace gcpdda::scene_text {

RunSettings read_run(const SceneSource &source);
OutputSettings read_output(const SceneSource &source, double duration);
StrengthReduction read_reduction(const SceneSource &source, const JointLaws &joints);

} // namespace gcpdda::scene_text
