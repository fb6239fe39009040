#include "gcpdda/blockgen/region_blocks.hpp"

#include "blockgen/region_cutter.hpp"

#include <memory>

namespace gcpdda {

void cut_region(Scene &scene) {
  if (scene.region.present()) {
    scene.region_blocks = std::make_shared<RegionCutter>(scene);
  }
}

} // namespace gcpdda
