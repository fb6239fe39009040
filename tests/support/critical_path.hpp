#pragma once

// Two blocks that pass through a critical configuration, for tests of continuity.

#include "shapes.hpp"

#include <functional>

namespace gcpdda::testing {

struct CriticalPath {
  const char *name;
  Shape moving;
  Shape still;
  Vec2 direction; ///< unit
  double turn;    ///< angle per length along the path
};

double perimeter_of_overlap(const Shape &a, const Shape &b);

/// On both sides of the critical configuration, ever closer, and on a sweep through it. Moving by s changes a
/// depth by at most s along the region's perimeter, and where the perimeter itself changes the depth is at
/// most s: |change of force| <= 2 s (perimeter), plus rounding.
///
/// @param reach  of the moving block's points from the centre of turning at most, m
/// @param also  looks at every configuration, with the region there
void expect_continuous_force(
    const CriticalPath &path, double reach,
    const std::function<void(const Shape &, const RegionIntegrals &)> &also = [](const auto &...) {});

} // namespace gcpdda::testing
