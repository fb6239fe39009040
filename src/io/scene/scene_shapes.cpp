#include "io/scene/scene_shapes.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace gcpdda::scene_text {

namespace {

constexpr double pi = std::numbers::pi;

/// Points of an arc from `begin` on, its end left out.
void add_arc(Vec2 centre, double radius, double begin, double end, std::int64_t chords_of_circle,
             std::vector<Vec2> &outline) {
  const double share = std::abs(end - begin) / (2.0 * pi);
  const double pieces = std::max(1.0, std::ceil(share * static_cast<double>(chords_of_circle) - 1e-9));
  for (int k = 0; k < static_cast<int>(pieces); ++k) {
    const double angle = begin + (end - begin) * (k / pieces);
    outline.push_back(centre + radius * Vec2{std::cos(angle), std::sin(angle)});
  }
}

} // namespace

std::vector<Vec2> outline_of(const SlopeProfile &slope) {
  Vec2 at = slope.toe;
  std::vector<Vec2> surface{{at.x - slope.toe_length, at.y}, at};
  for (const SlopeProfile::Bench &bench : slope.benches) {
    at += Vec2{bench.height / std::tan(bench.face_angle), bench.height};
    if (bench.face_angle >= 0.5 * pi) {
      at.x = surface.back().x; // upright, without the rounding of the tangent
    }
    surface.push_back(at);
    if (bench.width > 0.0 && &bench != &slope.benches.back()) {
      at.x += bench.width;
      surface.push_back(at);
    }
  }
  at.x += slope.crest_length + slope.benches.back().width;
  surface.push_back(at);
  const double bottom = slope.toe.y - slope.depth;
  std::vector<Vec2> outline{{surface.front().x, bottom}, {at.x, bottom}};
  outline.insert(outline.end(), surface.rbegin(), surface.rend());
  return outline;
}

std::vector<Vec2> outline_of(const OpeningShape &shape) {
  const double radius = 0.5 * shape.width;
  std::vector<Vec2> outline;
  if (shape.kind == OpeningShape::Kind::circle) {
    add_arc(shape.centre, radius, 0.0, 2.0 * pi, shape.chords, outline);
    return outline;
  }
  const double floor = shape.centre.y - 0.5 * shape.height;
  const Vec2 spring{shape.centre.x, shape.centre.y + 0.5 * shape.height - radius};
  const Vec2 left = spring - Vec2{radius, 0.0};
  const Vec2 right = spring + Vec2{radius, 0.0};
  if (shape.kind == OpeningShape::Kind::d) {
    outline = {{left.x, floor}, {right.x, floor}};
    add_arc(spring, radius, 0.0, pi, shape.chords, outline);
    outline.push_back(left);
    return outline;
  }
  const double turn = std::asin((spring.y - floor) / shape.width);
  add_arc(left, shape.width, -turn, 0.0, shape.chords, outline);
  add_arc(spring, radius, 0.0, pi, shape.chords, outline);
  add_arc(right, shape.width, pi, pi + turn, shape.chords, outline);
  outline.push_back({right.x - shape.width * std::cos(turn), floor});
  outline.front().y = floor; // both ends of the floor at one height
  return outline;
}

} // namespace gcpdda::scene_text
