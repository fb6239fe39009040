#include "blockgen/traces.hpp"

#include "blockgen/sampling.hpp"
#include "geometry/holds_point.hpp"
#include "model/joint_plane.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace gcpdda::blockgen {

namespace {

/// Which number of a joint a draw is for.
enum What : std::uint64_t { spacing_of, phase_of, trace_of, gap_of, dip_of, site_x, site_y };

/// Multiples of a right angle without rounding, so that joints along an outline lie on it exactly.
Vec2 direction_of(double angle) {
  const double quarter = angle / (0.5 * std::numbers::pi);
  const double nearest = std::round(quarter);
  if (std::abs(quarter - nearest) < 1e-14 * std::max(1.0, std::abs(quarter))) {
    constexpr std::array<Vec2, 4> axes{{{1.0, 0.0}, {0.0, 1.0}, {-1.0, 0.0}, {0.0, -1.0}}};
    return axes[static_cast<std::size_t>(((static_cast<std::int64_t>(nearest) % 4) + 4) % 4)];
  }
  return {std::cos(angle), std::sin(angle)};
}

struct Extent {
  double low = 0.0;
  double high = 0.0;
};

/// Of a box along a direction, from a point.
Extent extent_along(const Aabb &box, Vec2 from, Vec2 direction) {
  const std::array<Vec2, 4> corners{{box.low, {box.high.x, box.low.y}, box.high, {box.low.x, box.high.y}}};
  Extent extent{dot(corners[0] - from, direction), dot(corners[0] - from, direction)};
  for (const Vec2 corner : corners) {
    extent.low = std::min(extent.low, dot(corner - from, direction));
    extent.high = std::max(extent.high, dot(corner - from, direction));
  }
  return extent;
}

class Collector {
public:
  Collector(const RockRegion &region, const Aabb &box) : around_(bounding_box(region.outline)), box_(box) {
    // Joints end a little outside, so that they cross the outline and do not just touch it.
    const Vec2 extent = around_.extent();
    around_ = around_.inflated(0.01 * (extent.x + extent.y));
  }

  void add_ring(const std::vector<Vec2> &outline, std::int32_t joint, bool always) {
    for (std::size_t k = 0; k < outline.size(); ++k) {
      const Trace edge{outline[k], outline[(k + 1) % outline.size()], joint, true};
      if (always || edge.meets(box_)) {
        traces_.push_back(edge);
      }
    }
  }

  void add_line(const std::vector<Vec2> &points, std::int32_t joint) {
    for (std::size_t k = 0; k + 1 < points.size(); ++k) {
      add({points[k], points[k + 1], joint});
    }
  }

  void add_bricks(const BrickPattern &bricks) {
    const Aabb reach{{std::max(around_.low.x, box_.low.x), std::max(around_.low.y, box_.low.y)},
                     {std::min(around_.high.x, box_.high.x), std::min(around_.high.y, box_.high.y)}};
    const auto number = [](double x) { return static_cast<std::int64_t>(std::floor(x)); };
    const std::int64_t first_row = number((reach.low.y - bricks.origin.y) / bricks.size.y);
    const std::int64_t last_row = number((reach.high.y - bricks.origin.y) / bricks.size.y);
    for (std::int64_t row = first_row; row <= last_row; ++row) {
      const double y = bricks.origin.y + static_cast<double>(row) * bricks.size.y;
      const double top = bricks.origin.y + static_cast<double>(row + 1) * bricks.size.y;
      add({{around_.low.x, y}, {around_.high.x, y}, bricks.joint});
      const double shift = row % 2 != 0 ? bricks.bond * bricks.size.x : 0.0;
      const double left = bricks.origin.x + shift;
      const std::int64_t first = number((reach.low.x - left) / bricks.size.x);
      const std::int64_t last = number((reach.high.x - left) / bricks.size.x) + 1;
      for (std::int64_t column = first; column <= last; ++column) {
        const double x = left + static_cast<double>(column) * bricks.size.x;
        add({{x, y}, {x, top}, bricks.joint});
      }
    }
  }

  void add_set(const JointSet &set, std::uint64_t number) {
    const Vec2 direction = direction_of(set.dip.mean);
    const Vec2 across = perp(direction);
    Extent lines = extent_along(around_, set.origin, across);
    // Turned joints reach in from lines outside.
    const double slack = reach_of_turn(set);
    lines.low -= slack;
    lines.high += slack;
    if (set.spacing.spread == Spread::none) {
      const auto first = static_cast<std::int64_t>(std::ceil(lines.low / set.spacing.mean));
      const auto last = static_cast<std::int64_t>(std::floor(lines.high / set.spacing.mean));
      for (std::int64_t k = first; k <= last; ++k) {
        const double offset = static_cast<double>(k) * set.spacing.mean;
        add_traces_of_line(set, number, k, set.origin + offset * across);
      }
      return;
    }
    add_scattered_lines(set, number, lines, across);
  }

  std::vector<Trace> take() { return std::move(traces_); }
  /// Joints of sets go there.
  void draw_to(DrawnSet &drawn) { drawn_ = &drawn; }

private:
  void add(const Trace &trace) {
    if (trace.from != trace.to && trace.meets(box_)) {
      traces_.push_back(trace);
    }
  }

  void add(const JointSet &set, const Trace &trace) {
    if (drawn_ != nullptr) {
      drawn_->joints.push_back(trace);
      return;
    }
    if (!trace.meets(box_)) {
      return;
    }
    if (set.within.empty()) {
      add(trace);
      return;
    }
    for (const Trace &part : parts_within(trace, set.within)) {
      add(part);
    }
  }

  // Line k + 1 lies spacing(k) beyond line k, and line 0 goes through the origin. Where the origin is far
  // outside, nobody would see that: the lines are counted from a place near the region then.
  void add_scattered_lines(const JointSet &set, std::uint64_t number, const Extent &lines, Vec2 across) {
    const auto spacing = [&](std::int64_t k) {
      return sample_length(set.spacing, {set.seed, number, k, 0, spacing_of});
    };
    constexpr double far = 1000.0; // mean spacings
    const double outside = std::max(lines.low, 0.0) + std::min(lines.high, 0.0);
    const double skipped =
        std::abs(outside) > far * set.spacing.mean ? std::floor(outside / set.spacing.mean) : 0.0;
    const auto first = static_cast<std::int64_t>(skipped);
    const double begin = skipped * set.spacing.mean;
    double offset = begin;
    std::int64_t k = first;
    while (offset <= lines.high) {
      if (offset >= lines.low) {
        add_traces_of_line(set, number, k, set.origin + offset * across);
      }
      offset += spacing(k++);
    }
    k = first - 1;
    offset = begin - spacing(k);
    while (offset >= lines.low) {
      if (offset <= lines.high) {
        add_traces_of_line(set, number, k, set.origin + offset * across);
      }
      offset -= spacing(--k);
    }
  }

  /// The direction of one joint.
  static Vec2 own_direction(const JointSet &set, const Draw &draw) {
    const bool in_space = set.plane && set.plane->fisher > 0.0;
    return direction_of(in_space ? sample_trace_angle(*set.plane, draw) : sample_angle(set.dip, draw));
  }

  /// How far a joint may reach across its line: three deviations of its angle.
  [[nodiscard]] double reach_of_turn(const JointSet &set) const {
    double turn = 0.0;
    if (set.dip.spread == Spread::normal) {
      turn = 3.0 * set.dip.width;
    } else if (set.dip.spread == Spread::fisher) {
      turn = 3.0 / std::sqrt(set.dip.width);
    } else if (set.is_turned()) {
      turn = 3.0 / (std::sqrt(set.plane->fisher) * share_in_section(pole_of(*set.plane)));
    }
    const double longest = set.trace.spread == Spread::power_law ? set.trace.high : set.trace.mean;
    const double arm = set.through_going ? 0.5 * norm(around_.extent()) : longest;
    return arm * std::sin(std::min(turn, 0.5 * std::numbers::pi));
  }

  void add_traces_of_line(const JointSet &set, std::uint64_t number, std::int64_t line, Vec2 on_line) {
    const Vec2 direction = direction_of(set.dip.mean);
    if (drawn_ != nullptr) {
      drawn_->offsets.push_back(dot(on_line - set.origin, perp(direction)));
    }
    const Extent reach = extent_along(around_, on_line, direction);
    if (set.through_going) {
      add_through_going(set, number, line, on_line + (0.5 * (reach.low + reach.high)) * direction);
      return;
    }
    const double period = set.trace.mean + set.gap.mean;
    const double phase = set.stagger ? *set.stagger * static_cast<double>(line)
                                     : Draw(set.seed, number, line, 0, phase_of).uniform();
    // The pattern begins one period or two before the region, that of a power law before its longest joint.
    const double before = set.trace.spread == Spread::power_law ? std::ceil(set.trace.high / period) : 0.0;
    double at = (phase - std::floor(phase)) * period;
    at += (std::floor((reach.low - at) / period) - 1.0 - before) * period;
    for (std::int64_t joint = 0; at <= reach.high; ++joint) {
      const double length = sample_length(set.trace, {set.seed, number, line, joint, trace_of});
      const bool is_turned = set.is_turned();
      const Vec2 own = is_turned ? own_direction(set, {set.seed, number, line, joint, dip_of}) : direction;
      const Vec2 middle = on_line + (at + 0.5 * length) * direction;
      const double half = 0.5 * length;
      add(set, is_turned ? Trace{middle - half * own, middle + half * own, set.joint}
                         : Trace{on_line + at * direction, on_line + (at + length) * direction, set.joint});
      at += length + sample_length(set.gap, {set.seed, number, line, joint, gap_of});
    }
  }

  void add_through_going(const JointSet &set, std::uint64_t number, std::int64_t line, Vec2 middle) {
    const Vec2 own = own_direction(set, {set.seed, number, line, 0, dip_of});
    const Extent reach = extent_along(around_, middle, own);
    const Extent aside = extent_along(around_, middle, perp(own));
    if (aside.low > 0.0 || aside.high < 0.0) {
      return;
    }
    add(set, {middle + reach.low * own, middle + reach.high * own, set.joint});
  }

  Aabb around_;
  Aabb box_;
  std::vector<Trace> traces_;
  DrawnSet *drawn_ = nullptr;
};

} // namespace

Aabb Trace::box() const {
  return {{std::min(from.x, to.x), std::min(from.y, to.y)}, {std::max(from.x, to.x), std::max(from.y, to.y)}};
}

// The stretch that lies between the sides of the box in x does so in y.
bool Trace::meets(const Aabb &box) const {
  double first = 0.0;
  double last = 1.0;
  const auto keep = [&](double at, double along, double low, double high) {
    if (along == 0.0) {
      return low <= at && at <= high;
    }
    const auto [enters, leaves] = std::minmax({(low - at) / along, (high - at) / along});
    first = std::max(first, enters);
    last = std::min(last, leaves);
    return first <= last;
  };
  return keep(from.x, to.x - from.x, box.low.x, box.high.x) &&
         keep(from.y, to.y - from.y, box.low.y, box.high.y);
}

std::vector<Trace> traces_in(const RockRegion &region, const Aabb &box) {
  Collector collector(region, box);
  collector.add_ring(region.outline, -1, true);
  for (const Opening &opening : region.openings) {
    collector.add_ring(opening.outline, opening.joint, false);
  }
  for (const Layer &layer : region.layers) {
    collector.add_ring(layer.outline, layer.joint, false);
  }
  for (const FaultLine &fault : region.faults) {
    collector.add_line(fault.points, fault.joint);
  }
  for (const JointMap &map : region.maps) {
    for (const std::vector<Vec2> &line : map.lines) {
      collector.add_line(line, map.joint);
    }
  }
  for (const BrickPattern &bricks : region.bricks) {
    collector.add_bricks(bricks);
  }
  for (std::size_t i = 0; i < region.joint_sets.size(); ++i) {
    collector.add_set(region.joint_sets[i], i);
  }
  return collector.take();
}

DrawnSet drawn_set(const RockRegion &region, std::size_t number) {
  Collector collector(region, bounding_box(region.outline));
  DrawnSet drawn;
  collector.draw_to(drawn);
  collector.add_set(region.joint_sets[number], number);
  return drawn;
}

std::vector<Vec2> voronoi_sites(const VoronoiCells &cells, const RockRegion &region, const Aabb &box) {
  const Aabb around = bounding_box(region.outline).inflated(3.0 * cells.size);
  const auto number = [&](double x) { return static_cast<std::int64_t>(std::floor(x / cells.size)); };
  std::vector<Vec2> sites;
  for (auto j = number(std::max(box.low.y, around.low.y)); j <= number(std::min(box.high.y, around.high.y));
       ++j) {
    for (auto i = number(std::max(box.low.x, around.low.x)); i <= number(std::min(box.high.x, around.high.x));
         ++i) {
      const auto place = [&](std::int64_t cell, What what) {
        const double u = Draw(cells.seed, 0, i, j, what).uniform() - 0.5;
        return (static_cast<double>(cell) + 0.5 + cells.irregularity * u) * cells.size;
      };
      sites.push_back({place(i, site_x), place(j, site_y)});
    }
  }
  return sites;
}

std::vector<Trace> parts_within(const Trace &trace, const std::vector<Vec2> &outline) {
  const Vec2 along = trace.to - trace.from;
  std::vector<double> shares{0.0, 1.0};
  for (std::size_t k = 0; k < outline.size(); ++k) {
    const Vec2 a = outline[k];
    const Vec2 edge = outline[(k + 1) % outline.size()] - a;
    const double across = cross(along, edge);
    if (across == 0.0) {
      continue;
    }
    const double share = cross(a - trace.from, edge) / across;
    const double on_edge = cross(a - trace.from, along) / across;
    if (share > 0.0 && share < 1.0 && on_edge >= 0.0 && on_edge <= 1.0) {
      shares.push_back(share);
    }
  }
  std::sort(shares.begin(), shares.end());
  std::vector<Trace> parts;
  for (std::size_t k = 0; k + 1 < shares.size(); ++k) {
    if (holds_point(outline, trace.from + (0.5 * (shares[k] + shares[k + 1])) * along)) {
      const Vec2 to = shares[k + 1] == 1.0 ? trace.to : trace.from + shares[k + 1] * along;
      parts.push_back({trace.from + shares[k] * along, to, trace.joint});
    }
  }
  return parts;
}

} // namespace gcpdda::blockgen
