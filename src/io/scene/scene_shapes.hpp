#pragma once

// Outlines of slopes, openings and other shapes that a scene gives by their sizes.

#include "gcpdda/geometry/vec2.hpp"

#include <cstdint>
#include <vector>

namespace gcpdda::scene_text {

/// Level ground, benches and level crest, rising to the right.
struct SlopeProfile {
  struct Bench {
    double height = 0.0;     ///< m
    double face_angle = 0.0; ///< rad, against the horizontal
    double width = 0.0;      ///< m, of the berm above the face
  };
  Vec2 toe;
  double toe_length = 0.0;
  double crest_length = 0.0;
  double depth = 0.0;
  std::vector<Bench> benches; ///< from below
};

/// Counter-clockwise, from the lower left corner.
std::vector<Vec2> outline_of(const SlopeProfile &slope);

/// Cross section of a tunnel.
struct OpeningShape {
  enum class Kind { circle, horseshoe, d, polygon };
  Kind kind = Kind::circle;
  Vec2 centre; ///< middle of width and height
  double width = 0.0;
  double height = 0.0;      ///< of a horseshoe or d; more than half the width
  std::int64_t chords = 24; ///< straight pieces of a whole circle
};

/// At this height over width the walls of a horseshoe would meet: (1 + sqrt 3)/2.
inline constexpr double highest_horseshoe = 1.3660254;

/// Counter-clockwise; vertices of curves lie on them. The horseshoe has a half circle over the spring line,
/// walls that are arcs of radius `width` about the opposite end of the spring line, and a flat floor.
std::vector<Vec2> outline_of(const OpeningShape &shape);

} // namespace gcpdda::scene_text
