#include "simulation/short_traces.hpp"

#include "geometry/edge_tree.hpp"
#include "geometry/holds_point.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

namespace gcpdda {

namespace {

constexpr double short_share = 1e-3; ///< of the length of a trace
constexpr double joined = 1e-13;     ///< of coordinates; the cut joins what is so near

struct Line {
  std::string path; ///< empty: an outline, which has no ends
  SourcePosition where;
  std::size_t first = 0; ///< of its points in the chain of all lines
  std::size_t last = 0;  ///< one beyond
};

/// All lines one after the other, so that one tree holds the pieces of all of them.
class Drawing {
public:
  explicit Drawing(const RockRegion &region) {
    for (const FaultLine &fault : region.faults) {
      add(fault.name, fault.where, fault.points);
    }
    for (const JointMap &map : region.maps) {
      for (const std::vector<Vec2> &line : map.lines) {
        add(fmt::format("the joint map '{}'", map.path), map.where, line);
      }
    }
    add_outline(region.outline);
    for (const Opening &opening : region.openings) {
      add_outline(opening.outline);
    }
    for (const Layer &layer : region.layers) {
      add_outline(layer.outline);
    }
  }

  [[nodiscard]] const std::vector<Line> &lines() const { return lines_; }
  [[nodiscard]] const std::vector<Vec2> &points() const { return points_; }
  [[nodiscard]] std::span<const Vec2> points_of(const Line &line) const {
    return std::span(points_).subspan(line.first, line.last - line.first);
  }
  /// The piece behind point k belongs to a line, and does not lead to the next one.
  [[nodiscard]] bool is_piece(std::size_t k) const { return is_piece_[k] != 0; }

private:
  void add(const std::string &path, const SourcePosition &where, std::span<const Vec2> points) {
    const std::size_t first = points_.size();
    points_.insert(points_.end(), points.begin(), points.end());
    is_piece_.resize(points_.size(), 1);
    is_piece_.back() = 0;
    lines_.push_back({path, where, first, points_.size()});
  }
  void add_outline(std::vector<Vec2> outline) {
    if (!outline.empty()) {
      outline.push_back(outline.front());
      add("", {}, outline);
    }
  }

  std::vector<Line> lines_;
  std::vector<Vec2> points_;
  std::vector<char> is_piece_;
};

bool meet(Vec2 a, Vec2 b, Vec2 c, Vec2 d) {
  const auto parts = [](Vec2 from, Vec2 to, Vec2 p, Vec2 q) {
    return cross(to - from, p - from) * cross(to - from, q - from) <= 0.0;
  };
  const std::array first{a, b};
  const std::array second{c, d};
  return bounding_box(first).meets(bounding_box(second)) && parts(a, b, c, d) && parts(c, d, a, b);
}

double length_of(std::span<const Vec2> points) {
  double length = 0.0;
  for (std::size_t k = 1; k < points.size(); ++k) {
    length += norm(points[k] - points[k - 1]);
  }
  return length;
}

/// How far a line that ends at `end` is from the nearest piece of another within reach that it does not meet,
/// or from its own beginning; infinite where there is none, or where it ends on one.
double gap_at(const Drawing &drawing, const EdgeTree &tree, const Line &line, Vec2 end, double touching) {
  const std::vector<Vec2> &points = drawing.points();
  const auto meets_line = [&](std::size_t piece) {
    for (std::size_t k = line.first; k + 1 < line.last; ++k) {
      if (meet(points[k], points[k + 1], points[piece], points[piece + 1])) {
        return true;
      }
    }
    return false;
  };
  constexpr double none = std::numeric_limits<double>::infinity();
  const double reach = short_share * length_of(drawing.points_of(line));
  const double open = norm(points[line.last - 1] - points[line.first]);
  double gap = open > touching && open <= reach ? open : none;
  const bool ends_on_one = tree.any_meeting(Aabb{end, end}.inflated(reach), [&](std::size_t piece) {
    if (!drawing.is_piece(piece) || (piece >= line.first && piece < line.last)) {
      return false;
    }
    const double distance = distance_to_boundary(std::array{points[piece], points[piece + 1]}, end);
    if (distance > reach) {
      return false;
    }
    gap = std::min(gap, distance);
    return distance <= touching || meets_line(piece);
  });
  return ends_on_one ? none : gap;
}

} // namespace

std::vector<ShortTrace> short_traces(const RockRegion &region) {
  const Drawing drawing(region);
  const EdgeTree tree(drawing.points());
  const Aabb box = bounding_box(region.outline);
  const double touching = joined * std::max({std::abs(box.low.x), std::abs(box.low.y), std::abs(box.high.x),
                                             std::abs(box.high.y), norm(box.extent())});
  std::vector<ShortTrace> found;
  for (const Line &line : drawing.lines()) {
    if (line.path.empty()) {
      continue;
    }
    const std::span<const Vec2> points = drawing.points_of(line);
    for (const Vec2 end : {points.front(), points.back()}) {
      const double gap = gap_at(drawing, tree, line, end, touching);
      if (gap < std::numeric_limits<double>::infinity() && holds_point(region.outline, end)) {
        found.push_back({line.path, line.where, end, gap});
      }
    }
  }
  return found;
}

} // namespace gcpdda
