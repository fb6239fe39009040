#pragma once

#include <cmath>

namespace gcpdda {

struct Vec2 {
  double x = 0.0;
  double y = 0.0;

  constexpr Vec2 &operator+=(Vec2 b) { return x += b.x, y += b.y, *this; }
  constexpr Vec2 &operator-=(Vec2 b) { return x -= b.x, y -= b.y, *this; }
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

/// Plane rotation, kept as its cosine and sine.
struct Rotation {
  double c = 1.0;
  double s = 0.0;

  static Rotation of(double angle) { return {std::cos(angle), std::sin(angle)}; }
  [[nodiscard]] constexpr Vec2 operator()(Vec2 a) const { return {c * a.x - s * a.y, s * a.x + c * a.y}; }
};

} // namespace gcpdda
