#pragma once

#include "setting.hpp"

#include <string>
#include <vector>

namespace gcpdda::testing {

/// A unit square on a long plane that falls towards +x; the middle of its base starts at `foot`.
struct Incline {
  double slope_deg = 30.0;
  double friction_deg = 15.0;
  double normal_stiffness = 1e9; ///< Pa/m
  Vec2 foot{};                   ///< m

  [[nodiscard]] Vec2 downhill() const;
  [[nodiscard]] Vec2 outward() const { return perp(downhill()); }
  [[nodiscard]] double weight() const { return rock_density * earth_gravity; } ///< N/m
  /// Acceleration of Coulomb sliding, m/s2.
  [[nodiscard]] double acceleration() const;
  /// Points given along (downhill, outward) of the foot.
  [[nodiscard]] std::vector<Vec2> in_world(const std::vector<Vec2> &points) const;

  [[nodiscard]] std::vector<Vec2> plane() const;
  /// The square, sunk into the plane by `depth` without tilt.
  [[nodiscard]] std::vector<Vec2> flat_square(double depth) const;
  /// Depth that carries the weight's normal component: k_n d (1 - d/2) = m g cos(slope).
  [[nodiscard]] double static_depth() const;
  /// The square in the depth and tilt of steady sliding.
  [[nodiscard]] std::vector<Vec2> sliding_square() const;

  /// The scene: block 0 is the plane, block 1 the square.
  [[nodiscard]] std::string toml(const std::vector<Vec2> &square, Setting setting) const;
};

} // namespace gcpdda::testing
