#pragma once

// The stress that rock is under before anything is done to it.

#include "gcpdda/base/diagnostic.hpp"
#include "gcpdda/geometry/mat2.hpp"
#include "gcpdda/geometry/vec2.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace gcpdda {

/// A straight side of the region with its outward normal: points on it have normal.x = reach.
struct Boundary {
  Vec2 normal;
  double reach = 0.0;    ///< m
  double rounding = 0.0; ///< of points on it, m

  /// Whether the point lies on the boundary, to rounding.
  [[nodiscard]] bool holds(Vec2 x) const { return std::abs(dot(normal, x) - reach) <= rounding; }
};

/// The stress that is in the rock before anything happens, as compression C = -sigma (Pa):
///
///     C(x) = C_0 + z (d d^T + K0 (I - d d^T)) rho g,     z = level + d.x,  d = gravity/|gravity|,
///
/// z the depth below the level. div C = rho g d whatever C_0 and K0: the stress bears the weight of the rock,
/// and nothing moves. Without growth C is C_0 everywhere, which bears no weight.
struct InSituStress {
  bool present = false;
  Mat2 at_level;                    ///< C_0, symmetric, Pa
  Mat2 growth;                      ///< by depth, Pa/m; 0 of a stress that is the same everywhere
  Vec2 down;                        ///< d; 0 without growth
  double level = 0.0;               ///< height above [0, 0] against gravity, m
  std::vector<Boundary> boundaries; ///< where it acts on the region from outside, also after the start
  SourcePosition where;             ///< of its table

  /// Does it act from outside on an edge between these points at t = 0?
  [[nodiscard]] bool acts_on(Vec2 a, Vec2 b) const {
    return std::any_of(boundaries.begin(), boundaries.end(),
                       [&](const Boundary &boundary) { return boundary.holds(a) && boundary.holds(b); });
  }
  /// Compressive stress at a point, Pa.
  [[nodiscard]] Mat2 compression_at(Vec2 x) const { return at_level + (level + dot(down, x)) * growth; }
};

/// Least and largest principal value of a symmetric matrix.
struct PrincipalValues {
  double least = 0.0;
  double largest = 0.0;
};
inline PrincipalValues principal_values(const Mat2 &symmetric) {
  const double mean = 0.5 * (symmetric.xx + symmetric.yy);
  const double radius = std::hypot(0.5 * (symmetric.xx - symmetric.yy), symmetric.xy);
  return {mean - radius, mean + radius};
}

} // namespace gcpdda
