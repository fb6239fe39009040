#include "simulation/liner_face.hpp"

#include "geometry/holds_point.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

namespace gcpdda {

namespace {

constexpr double stations_of_thickness = 8.0;
constexpr double most_stations = 20000.0;
constexpr double reach_of_extent = 0.02;
constexpr double shortest_stretch = 0.5; ///< of the thickness

/// How far along a ray an outline is crossed first, in units of `ray`.
std::optional<double> first_crossing(std::span<const Vec2> polygon, Vec2 from, Vec2 ray) {
  std::optional<double> first;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Vec2 begin = polygon[k] - from;
    const Vec2 edge = polygon[(k + 1) % polygon.size()] - polygon[k];
    const double turn = cross(ray, edge);
    if (turn == 0.0) {
      continue;
    }
    const double on_ray = cross(begin, edge) / turn;
    const double on_edge = cross(begin, ray) / turn;
    if (on_edge >= 0.0 && on_edge <= 1.0 && on_ray >= 0.0 && on_ray <= 1.0 && !(first && *first <= on_ray)) {
      first = on_ray;
    }
  }
  return first;
}

/// Stations of one block, or without a face, in a row.
struct Stretch {
  std::int64_t block = FaceHit::nothing;
  std::vector<std::size_t> stations;

  [[nodiscard]] bool is_gap() const { return block < 0; }
};

class Chain {
public:
  Chain(const LinerPath &path, double thickness, std::span<const FaceHit> hits)
      : path_(&path), thickness_(thickness), hits_(hits) {}

  std::vector<Stretch> stretches() const {
    const std::size_t n = hits_.size();
    std::vector<Stretch> all;
    const std::size_t start = first_station();
    for (std::size_t k = 0; k < n; ++k) {
      const std::size_t station = (start + k) % n;
      const std::int64_t block = owner_of(station);
      if (all.empty() || all.back().block != block) {
        all.push_back({block, {}});
      }
      all.back().stations.push_back(station);
    }
    return merged(std::move(all));
  }

  /// The face in the middle of a stretch.
  Vec2 node_of(const Stretch &stretch) const {
    const std::vector<std::size_t> &stations = stretch.stations;
    const double middle = 0.5 * way_of(stretch, 0) + 0.5 * way_of(stretch, stations.size() - 1);
    std::size_t after = 0;
    while (way_of(stretch, after) < middle) {
      ++after;
    }
    const std::size_t before = way_of(stretch, after) > middle && after > 0 ? after - 1 : after;
    const double step = way_of(stretch, after) - way_of(stretch, before);
    const double share = step > 0.0 ? (middle - way_of(stretch, before)) / step : 0.0;
    const Vec2 low = face_at(stations[before]);
    return low + share * (face_at(stations[after]) - low);
  }

private:
  /// Block whose face lies at a station. A station that lies inside a block has none either.
  [[nodiscard]] std::int64_t owner_of(std::size_t station) const {
    return std::max(hits_[station].block, FaceHit::nothing);
  }

  /// A closed path is read from where the owner changes.
  [[nodiscard]] std::size_t first_station() const {
    for (std::size_t k = 1; k < hits_.size() && path_->is_closed; ++k) {
      if (owner_of(k) != owner_of(k - 1)) {
        return k;
      }
    }
    return 0;
  }

  [[nodiscard]] Vec2 face_at(std::size_t station) const {
    const LinerStation &at = path_->stations[station];
    return at.point + hits_[station].depth * at.inward;
  }

  /// Rises along a stretch, also beyond the end of a closed path.
  [[nodiscard]] double way_of(const Stretch &stretch, std::size_t k) const {
    const double way = path_->stations[stretch.stations[k]].way;
    return stretch.stations[k] < stretch.stations.front() ? way + path_->length : way;
  }

  [[nodiscard]] double extent_of(const Stretch &stretch) const {
    return std::accumulate(
        stretch.stations.begin(), stretch.stations.end(), 0.0,
        [&](double sum, std::size_t station) { return sum + path_->stations[station].length; });
  }

  /// Without the short ones, and those of one block that these have parted joined.
  [[nodiscard]] std::vector<Stretch> merged(std::vector<Stretch> all) const {
    std::erase_if(all, [&](const Stretch &stretch) {
      return extent_of(stretch) < (stretch.is_gap() ? 1.0 : shortest_stretch) * thickness_;
    });
    std::vector<Stretch> joined;
    for (Stretch &stretch : all) {
      if (!joined.empty() && joined.back().block == stretch.block) {
        std::vector<std::size_t> &stations = joined.back().stations;
        stations.insert(stations.end(), stretch.stations.begin(), stretch.stations.end());
      } else {
        joined.push_back(std::move(stretch));
      }
    }
    if (path_->is_closed && joined.size() > 1 && joined.back().block == joined.front().block) {
      std::vector<std::size_t> &stations = joined.back().stations;
      stations.insert(stations.end(), joined.front().stations.begin(), joined.front().stations.end());
      joined.erase(joined.begin());
    }
    return joined;
  }

  const LinerPath *path_;
  double thickness_;
  std::span<const FaceHit> hits_;
};

BoltLink element_between(std::int64_t index, std::int64_t first, Vec2 from, std::int64_t second, Vec2 to) {
  BoltLink link;
  link.bolt = -1;
  link.liner = static_cast<std::int32_t>(index);
  link.head_first = first < second;
  link.length = norm(to - from);
  const Vec2 direction = (1.0 / link.length) * (to - from);
  const Vec2 along = link.head_first ? direction : -direction;
  const std::size_t head = link.head_first ? 0 : 1;
  link.end[head] = {first, from, along};
  link.end[1 - head] = {second, to, along};
  return link;
}

Vec2 direction_of(const BoltLink &element) {
  return element.head_first ? element.end[0].along : -element.end[0].along;
}

/// Where an element ends at the node from which the other one goes on, the liner turns; rock lies on the
/// right.
void note_turn(BoltLink &element, BoltLink &next) {
  LinkEnd &tail = element.end[element.head_first ? 1 : 0];
  LinkEnd &head = next.end[next.head_first ? 0 : 1];
  if (tail.block == head.block && tail.point == head.point) {
    const Vec2 from = direction_of(element);
    const Vec2 to = direction_of(next);
    tail.away = 0.5 * std::atan2(cross(from, to), dot(from, to));
    head.away = tail.away;
  }
}

} // namespace

LinerPath path_of(const Liner &liner, double thickness, bool has_rock_on_right) {
  std::vector<Vec2> points = liner.path;
  if (liner.is_closed) {
    points.push_back(points.front());
  }
  if (!has_rock_on_right) {
    std::reverse(points.begin(), points.end());
  }
  LinerPath path;
  path.is_closed = liner.is_closed;
  for (std::size_t k = 0; k + 1 < points.size(); ++k) {
    path.length += norm(points[k + 1] - points[k]);
  }
  const Vec2 extent = bounding_box(points).extent();
  path.reach = std::max(thickness, reach_of_extent * std::max(extent.x, extent.y));
  const double wanted = std::max(thickness / stations_of_thickness, path.length / most_stations);
  double way = 0.0;
  for (std::size_t k = 0; k + 1 < points.size(); ++k) {
    const Vec2 edge = points[k + 1] - points[k];
    const double length = norm(edge);
    const auto count = static_cast<std::int64_t>(std::ceil(length / wanted));
    for (std::int64_t i = 0; i < count; ++i) { // symmetric on each edge
      const double share = (static_cast<double>(i) + 0.5) / static_cast<double>(count);
      path.stations.push_back({way + share * length, length / static_cast<double>(count),
                               points[k] + share * edge, -(1.0 / length) * perp(edge)});
    }
    way += length;
  }
  for (const LinerStation &station : path.stations) {
    path.box.include(station.point);
  }
  return path;
}

bool FaceHit::is_before(const FaceHit &other) const {
  if (block == inside || other.block == inside) {
    return other.block != inside;
  }
  if (block == nothing || other.block == nothing) {
    return block != nothing;
  }
  return depth < other.depth || (depth == other.depth && block < other.block);
}

void meet(const LinerPath &path, std::span<const Vec2> polygon, std::int64_t block, std::span<FaceHit> hits) {
  const Aabb box = bounding_box(polygon).inflated(path.reach);
  if (!box.meets(path.box)) {
    return;
  }
  for (std::size_t k = 0; k < path.stations.size(); ++k) {
    const LinerStation &station = path.stations[k];
    if (!box.holds(station.point)) {
      continue;
    }
    const Vec2 from = station.point - path.reach * station.inward;
    FaceHit hit;
    if (holds_point(polygon, from)) {
      hit.block = FaceHit::inside;
    } else if (const auto at = first_crossing(polygon, from, (2.0 * path.reach) * station.inward)) {
      hit = {block, (2.0 * *at - 1.0) * path.reach};
    }
    if (hit.is_before(hits[k])) {
      hits[k] = hit;
    }
  }
}

LinerElements elements_of(std::int64_t index, const LinerPath &path, double thickness,
                          std::span<const FaceHit> hits) {
  const Chain chain(path, thickness, hits);
  const std::vector<Stretch> stretches = chain.stretches();
  LinerElements elements;
  const std::size_t n = stretches.size();
  for (std::size_t k = 0; k < n; ++k) {
    if (stretches[k].is_gap()) {
      elements.num_gaps += path.is_closed || (k > 0 && k + 1 < n) ? 1 : 0;
      continue;
    }
    ++elements.num_stretches;
    const bool closes = k + 1 == n;
    const Stretch &next = stretches[closes ? 0 : k + 1];
    if (closes && !(path.is_closed && n > 2)) {
      continue;
    }
    if (!next.is_gap() && next.block != stretches[k].block) {
      elements.links.push_back(element_between(index, stretches[k].block, chain.node_of(stretches[k]),
                                               next.block, chain.node_of(next)));
    }
  }
  for (std::size_t k = 0; k < elements.links.size(); ++k) {
    note_turn(elements.links[k], elements.links[k + 1 == elements.links.size() ? 0 : k + 1]);
  }
  return elements;
}

} // namespace gcpdda
