#pragma once

// Integrals of the distance from a point along a straight line.

#include <cmath>

namespace gcpdda {

struct CurveIntegral {
  double total = 0.0;  ///< int R dg
  double moment = 0.0; ///< int (g - g_begin) R dg
};

/// Of R = sqrt(q^2 + g^2) over [g, g + length], on one side of 0. With
///     int R dg = (g R + q^2 asinh(g/q))/2,   int g R dg = R^3/3
/// the differences are written so that nothing cancels for g >= 0:
///     R_1 - R_0 = length (g_0 + g_1)/(R_0 + R_1),
///     asinh(g_1/q) - asinh(g_0/q) = asinh(length (g_0 + g_1)/(g_1 R_0 + g_0 R_1)).
inline CurveIntegral integrate_curve(double q, double g, double length) {
  if (g < 0.0) {
    const CurveIntegral mirrored = integrate_curve(q, std::fmax(0.0, -g - length), length);
    return {mirrored.total, length * mirrored.total - mirrored.moment};
  }
  const double end = g + length;
  const double r0 = std::hypot(q, g);
  const double r1 = std::hypot(q, end);
  if (!(r0 + r1 > 0.0)) {
    return {};
  }
  const double rise = length * (g + end) / (r0 + r1);
  const double q2 = q * q;
  const double turn = q2 > 0.0 ? std::asinh(length * (g + end) / (end * r0 + g * r1)) : 0.0;
  const double total = 0.5 * (length * r1 + g * rise + q2 * turn);
  return {total, rise * (r0 * r0 + r0 * r1 + r1 * r1) / 3.0 - g * total};
}

} // namespace gcpdda
