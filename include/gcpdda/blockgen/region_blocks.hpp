#pragma once

// Regions of rock that are cut into blocks.

#include "gcpdda/model/scene.hpp"

namespace gcpdda {

/// The scene gets what cuts its region into blocks along the joints; a scene without a region stays as it is.
/// @param scene  with the lines of its joint maps
void cut_region(Scene &scene);

} // namespace gcpdda
