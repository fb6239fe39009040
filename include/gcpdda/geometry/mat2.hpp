#pragma once

// 2x2 matrices.

#include "gcpdda/geometry/vec2.hpp"

namespace gcpdda {

/// 2x2 matrix, by rows.
struct Mat2 {
  double xx = 0.0;
  double xy = 0.0;
  double yx = 0.0;
  double yy = 0.0;

  /// [1 0; 0 1].
  static constexpr Mat2 identity() { return {1.0, 0.0, 0.0, 1.0}; }

  /// The product with a vector.
  constexpr Vec2 operator()(Vec2 a) const { return {xx * a.x + xy * a.y, yx * a.x + yy * a.y}; }
  /// By entries.
  constexpr Mat2 &operator+=(const Mat2 &b) { return xx += b.xx, xy += b.xy, yx += b.yx, yy += b.yy, *this; }
  /// Equal in all entries.
  friend constexpr bool operator==(const Mat2 &, const Mat2 &) = default;
};

constexpr Mat2 operator+(const Mat2 &a, const Mat2 &b) {
  return {a.xx + b.xx, a.xy + b.xy, a.yx + b.yx, a.yy + b.yy};
}
constexpr Mat2 operator-(const Mat2 &a, const Mat2 &b) {
  return {a.xx - b.xx, a.xy - b.xy, a.yx - b.yx, a.yy - b.yy};
}
constexpr Mat2 operator*(double s, const Mat2 &a) {
  return {s * a.xx, s * a.xy, s * a.yx, s * a.yy};
}
constexpr Mat2 operator*(const Mat2 &a, const Mat2 &b) {
  return {a.xx * b.xx + a.xy * b.yx, a.xx * b.xy + a.xy * b.yy, a.yx * b.xx + a.yy * b.yx,
          a.yx * b.xy + a.yy * b.yy};
}
constexpr Mat2 transposed(const Mat2 &a) {
  return {a.xx, a.yx, a.xy, a.yy};
}
constexpr double determinant(const Mat2 &a) {
  return a.xx * a.yy - a.xy * a.yx;
}
constexpr Mat2 inverse(const Mat2 &a) {
  const double d = 1.0 / determinant(a);
  return {d * a.yy, -d * a.xy, -d * a.yx, d * a.xx};
}
/// a : b, the sum of the products of their entries.
constexpr double contract(const Mat2 &a, const Mat2 &b) {
  return a.xx * b.xx + a.xy * b.xy + a.yx * b.yx + a.yy * b.yy;
}
/// a b^T.
constexpr Mat2 outer(Vec2 a, Vec2 b) {
  return {a.x * b.x, a.x * b.y, a.y * b.x, a.y * b.y};
}
inline double norm(const Mat2 &a) {
  return std::sqrt(contract(a, a));
}

} // namespace gcpdda
