#pragma once

#include "blockgen/joint_map.hpp"
#include "blockgen/region_cutter.hpp"

#include <fstream>
#include <memory>
#include <sstream>

namespace gcpdda::testing {

/// Give a scene what the program gives it: the traces of its joint maps, and what cuts its region, if it has
/// one.
inline void prepare_region(Scene &scene) {
  for (JointMap &map : scene.region.maps) {
    std::ostringstream text;
    text << std::ifstream(map.path).rdbuf();
    map.lines = read_joint_map(text.str(), map.path).lines;
  }
  if (scene.region.present()) {
    scene.region_blocks = std::make_shared<RegionCutter>(scene);
  }
}

} // namespace gcpdda::testing
