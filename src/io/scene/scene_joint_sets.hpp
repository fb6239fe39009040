#pragma once

// Tables [[joint_set]] of a scene.

#include "io/scene/scene_section.hpp"

#include <vector>

namespace gcpdda::scene_text {

/// The outline of a region, an opening, a layer or a window, counter-clockwise; left as it is, and reported,
/// where it is at fault.
bool read_polygon(const SceneSource &source, const Section &section, const char *key,
                  std::vector<Vec2> &outline);

/// The joint sets without faults. Sets given in space are turned into their traces in the section.
/// @param region  the section [region], which has the azimuth
std::vector<JointSet> read_joint_sets(const SceneSource &source, const Section &region,
                                      const JointLaws &joints);

} // namespace gcpdda::scene_text
