#pragma once

// Coordinates so large that their rounding disturbs forces at rest.

#include "geometry/aabb.hpp"
#include "simulation/run_state.hpp"

#include <cstdint>

namespace gcpdda {

/// What the rounding of coordinates is compared with.
struct ModelExtent {
  Aabb box;                    ///< of all blocks
  std::int64_t num_mobile = 0; ///< number of mobile blocks
  double smallest = 0.0;       ///< side of the smallest mobile block, sqrt(area), m
  double pressure = 0.0;       ///< largest pressure that joints bear at rest, Pa
};

/// Warns where the rounding of coordinates is no small part of the overlaps at rest, or keeps a stage from
/// settling. The extent must be that of all ranks together.
void doubt_coordinates(RunState &run, const ModelExtent &extent);

} // namespace gcpdda
