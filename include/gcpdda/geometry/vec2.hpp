#pragma once

// Vectors in the plane.

#include <cmath>

namespace gcpdda {

/// A vector of the plane.
struct Vec2 {
  double x = 0.0;
  double y = 0.0;

  /// By components.
  constexpr Vec2 &operator+=(Vec2 b) { return x += b.x, y += b.y, *this; }
  /// By components.
  constexpr Vec2 &operator-=(Vec2 b) { return x -= b.x, y -= b.y, *this; }
  /// Equal in both components.
  friend constexpr bool operator==(Vec2, Vec2) = default;
};

constexpr Vec2 operator+(Vec2 a, Vec2 b) {
  return {a.x + b.x, a.y + b.y};
}
constexpr Vec2 operator-(Vec2 a, Vec2 b) {
  return {a.x - b.x, a.y - b.y};
}
constexpr Vec2 operator-(Vec2 a) {
  return {-a.x, -a.y};
}
constexpr Vec2 operator*(double s, Vec2 a) {
  return {s * a.x, s * a.y};
}
constexpr double dot(Vec2 a, Vec2 b) {
  return a.x * b.x + a.y * b.y;
}
/// Out-of-plane component of a x b.
constexpr double cross(Vec2 a, Vec2 b) {
  return a.x * b.y - a.y * b.x;
}
/// a turned by +90 degrees; the velocity of a point at offset a from the centre of a unit spin.
constexpr Vec2 perp(Vec2 a) {
  return {-a.y, a.x};
}
inline double norm(Vec2 a) {
  return std::sqrt(dot(a, a));
}

/// sin(a) and 1 - cos(a) without cancellation, for angles small enough that their series end at rounding
/// error within a few terms.
struct SmallTurn {
  static constexpr double largest = 0.125; ///< rad
  double sine = 0.0;
  double versine = 0.0;

  /// @param a  rad, at most `largest` in size
  static constexpr SmallTurn of(double a) {
    const double q = a * a;
    return {
        a * (1.0 - q * (1.0 / 6.0) *
                       (1.0 - q * (1.0 / 20.0) *
                                  (1.0 - q * (1.0 / 42.0) * (1.0 - q * (1.0 / 72.0) * (1.0 - q / 110.0))))),
        0.5 * q *
            (1.0 - q * (1.0 / 12.0) *
                       (1.0 - q * (1.0 / 30.0) * (1.0 - q * (1.0 / 56.0) * (1.0 - q * (1.0 / 90.0)))))};
  }
};

/// Plane rotation, kept as its cosine and sine.
struct Rotation {
  double c = 1.0;
  double s = 0.0;

  /// Blocks mostly turn little: the series is several times as fast, and as exact.
  static Rotation of(double angle) {
    if (std::abs(angle) <= SmallTurn::largest) {
      const SmallTurn turn = SmallTurn::of(angle);
      return {1.0 - turn.versine, turn.sine};
    }
    return {std::cos(angle), std::sin(angle)};
  }
  /// The vector turned by the rotation.
  [[nodiscard]] constexpr Vec2 operator()(Vec2 a) const { return {c * a.x - s * a.y, s * a.x + c * a.y}; }
};

} // namespace gcpdda
