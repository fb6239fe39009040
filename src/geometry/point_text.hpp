#pragma once

// Coordinates in messages.

#include "gcpdda/geometry/vec2.hpp"

#include <string>

namespace gcpdda {

/// A coordinate in m for a message: with so many significant digits, and always to the millimetre, without an
/// exponent where the number is large.
std::string coordinate_text(double x, int digits = 6);

/// A point as a scene writes it: [x, y].
std::string point_text(Vec2 point, int digits = 6);

} // namespace gcpdda
