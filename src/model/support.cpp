#include "gcpdda/model/support.hpp"

#include "base/check.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace gcpdda {

namespace {

constexpr double whole_turn = 2.0 * std::numbers::pi;
constexpr double sharpest_of_curve = std::numbers::pi / 6.0; ///< a vertex that turns by more is a corner

/// A place on the outline: way from its first vertex (m) and direction of the normal (rad, rising).
struct Stop {
  double way = 0.0;
  double angle = 0.0;
};

/// Direction of the normal along the outline, linear between stops, three times around.
std::vector<Stop> stops_of(const std::vector<Vec2> &outline) {
  const std::size_t n = outline.size();
  const auto edge = [&](std::size_t k) { return outline[(k + 1) % n] - outline[k % n]; };
  std::vector<Stop> stops;
  Stop at{0.0, std::atan2(-edge(0).x, edge(0).y)};
  for (std::size_t k = 0; k < 3 * n; ++k) {
    const Vec2 next = edge(k + 1);
    const double length = norm(edge(k));
    const double turn = std::atan2(cross(edge(k), next), dot(edge(k), next));
    stops.push_back({at.way + 0.5 * length, at.angle});
    at.way += length;
    if (std::abs(turn) > sharpest_of_curve) {
      stops.push_back(at);
      stops.push_back({at.way, at.angle + turn});
    }
    at.angle += turn;
  }
  return stops;
}

/// Where the normal first reaches a direction.
std::size_t first_stop_at(const std::vector<Stop> &stops, double angle, double from) {
  const auto found = std::find_if(stops.begin(), stops.end(),
                                  [&](const Stop &s) { return s.way >= from && s.angle >= angle; });
  return static_cast<std::size_t>(std::min(found, stops.end() - 1) - stops.begin());
}

double way_at(const std::vector<Stop> &stops, double angle, double from) {
  const std::size_t k = first_stop_at(stops, angle, from);
  if (k == 0 || stops[k].angle <= stops[k - 1].angle) {
    return stops[k].way;
  }
  const double share = (angle - stops[k - 1].angle) / (stops[k].angle - stops[k - 1].angle);
  return std::max(from, stops[k - 1].way + std::clamp(share, 0.0, 1.0) * (stops[k].way - stops[k - 1].way));
}

Vec2 normal_at(const std::vector<Stop> &stops, double way) {
  const auto after = std::find_if(stops.begin(), stops.end(), [&](const Stop &s) { return s.way > way; });
  const Stop &high = *std::min(after, stops.end() - 1);
  const Stop &low = after == stops.begin() ? high : *(std::min(after, stops.end() - 1) - 1);
  const double step = high.way - low.way;
  const double share = step > 0.0 ? std::clamp((way - low.way) / step, 0.0, 1.0) : 0.0;
  const double angle = low.angle + share * (high.angle - low.angle);
  return {std::cos(angle), std::sin(angle)};
}

double length_around(const std::vector<Vec2> &outline) {
  double around = 0.0;
  for (std::size_t k = 0; k < outline.size(); ++k) {
    around += norm(outline[(k + 1) % outline.size()] - outline[k]);
  }
  return around;
}

Vec2 point_at(const std::vector<Vec2> &outline, double way) {
  for (std::size_t k = 0;; ++k) {
    const Vec2 begin = outline[k % outline.size()];
    const Vec2 edge = outline[(k + 1) % outline.size()] - begin;
    const double length = norm(edge);
    if (way <= length) {
      return begin + (way / length) * edge;
    }
    way -= length;
  }
}

/// Ways along the outline where an arc begins and ends.
struct Arc {
  double begin = 0.0;
  double end = 0.0;
};
/// @param around  length of the whole outline, m
Arc arc_between(const std::vector<Stop> &stops, double around, double from_angle, double to_angle) {
  constexpr double rounding = 1e-9; // a side whose normal is one of the two directions belongs to the arc
  const double from =
      from_angle + whole_turn * std::ceil((stops.front().angle - from_angle) / whole_turn - rounding);
  const double begin = way_at(stops, from - rounding, 0.0);
  if (to_angle - from_angle > whole_turn * (1.0 - rounding)) { // the side where it begins counts once
    return {begin, begin + around};
  }
  return {begin, way_at(stops, from + (to_angle - from_angle) + rounding, begin)};
}

} // namespace

std::vector<BoltLine> bolts_of(const BoltPattern &pattern, const std::vector<Vec2> &outline) {
  expect(outline.size() >= 3 && pattern.to_angle > pattern.from_angle, "a pattern on an arc of an outline");
  const std::vector<Stop> stops = stops_of(outline);
  const auto [begin, end] = arc_between(stops, length_around(outline), pattern.from_angle, pattern.to_angle);
  const double arc = end - begin;
  const std::int64_t count =
      pattern.count > 0 ? pattern.count : std::max<std::int64_t>(1, std::llround(arc / pattern.spacing));
  std::vector<BoltLine> bolts;
  for (std::int64_t k = 0; k < count; ++k) {
    const double way = begin + (static_cast<double>(k) + 0.5) / static_cast<double>(count) * arc;
    const Vec2 head = point_at(outline, way);
    bolts.push_back({head, head + pattern.length * normal_at(stops, way)});
  }
  return bolts;
}

std::vector<Vec2> arc_of(const std::vector<Vec2> &outline, double from_angle, double to_angle) {
  expect(outline.size() >= 3 && to_angle > from_angle, "an arc of an outline");
  const auto [begin, end] = arc_between(stops_of(outline), length_around(outline), from_angle, to_angle);
  std::vector<Vec2> path{point_at(outline, begin)};
  double way = 0.0;
  for (std::size_t k = 0; way < end; ++k) {
    if (way > begin) {
      path.push_back(outline[k % outline.size()]);
    }
    way += norm(outline[(k + 1) % outline.size()] - outline[k % outline.size()]);
  }
  path.push_back(point_at(outline, end));
  return path;
}

} // namespace gcpdda
