#pragma once

#include "geometry/polygon.hpp"

#include <cmath>
#include <numbers>
#include <vector>

namespace gcpdda::testing {

/// Voussoirs of equal angles between two springings at y = 0; the centre is the origin.
struct SemicircularArch {
  static constexpr double radius = 5.0; ///< of the middle line, m
  int num_voussoirs = 9;
  double thickness = 1.0; ///< m

  /// Point of joint k of n + 1, from the right springing, at a distance from the centre.
  [[nodiscard]] Vec2 joint(int k, double distance) const {
    const double angle = std::numbers::pi * k / num_voussoirs;
    return distance * Vec2{std::cos(angle), std::sin(angle)};
  }
  [[nodiscard]] std::vector<Vec2> voussoir(int k) const {
    const double inner = radius - 0.5 * thickness;
    const double outer = radius + 0.5 * thickness;
    return {joint(k, inner), joint(k, outer), joint(k + 1, outer), joint(k + 1, inner)};
  }
};

} // namespace gcpdda::testing
