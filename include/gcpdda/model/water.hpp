#pragma once

// Water tables and pressures.

#include "gcpdda/geometry/vec2.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace gcpdda {

/// Water up to a phreatic line, in joints and around blocks.
struct Water {
  std::string name;
  std::vector<Vec2> phreatic;       ///< x ascending; level before the first point and behind the last, m
  std::vector<std::int32_t> joints; ///< laws of the joints that it wets, ascending; empty: all edges
  double density = 1000.0;          ///< kg/m3
  bool active = true;

  /// Height of the line at x, m.
  [[nodiscard]] double head(double x) const;
  /// Whether it wets a joint of this law, -1: an edge without a contact or a law.
  [[nodiscard]] bool wets(std::int32_t law) const;
  /// Equal in all that a scene gives.
  friend bool operator==(const Water &, const Water &) = default;
};

} // namespace gcpdda
