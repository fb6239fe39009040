// A set is drawn whole, as for the cut, and measured where it counts.

#include "blockgen/set_statistics.hpp"

#include "blockgen/traces.hpp"
#include "geometry/common_area.hpp"
#include "geometry/holds_point.hpp"
#include "geometry/polygon.hpp"
#include "model/joint_plane.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace gcpdda::blockgen {

namespace {

constexpr double most_joints = 1e6;
constexpr double least_scatter = 1e-9; // rad, rounding of parallel traces
constexpr double degrees = 180.0 / std::numbers::pi;

/// An angle of undirected lines against another one, a quarter turn at most.
double off_angle(double angle, double mean) {
  return std::remainder(angle - mean, std::numbers::pi);
}

/// Standard deviation of the angle of traces that a set asks, rad. Poles that scatter by Fisher's constant k
/// do so by 1/sqrt(k) in each of two directions, of which the section sees one, enlarged by the pole's share
/// in it.
double asked_scatter(const JointSet &set) {
  if (set.plane) {
    return set.plane->fisher > 0.0
               ? 1.0 / (share_in_section(pole_of(*set.plane)) * std::sqrt(set.plane->fisher))
               : 0.0;
  }
  return set.dip.spread == Spread::normal   ? set.dip.width
         : set.dip.spread == Spread::fisher ? 1.0 / std::sqrt(set.dip.width)
                                            : 0.0;
}

class Measurement {
public:
  Measurement(const RockRegion &region, const JointSet &set) : region_(&region), set_(&set) {
    area_ = set.within.empty() ? signed_area(region.outline) : common_area(region.outline, set.within);
  }

  void measure(const DrawnSet &drawn, SetStatistics &result) const {
    result.is_drawn = true;
    measure_lines(drawn.offsets, result);
    double length = 0.0;
    double lengths = 0.0;
    double angles = 0.0; // off the mean that is asked
    double squares = 0.0;
    for (const Trace &joint : drawn.joints) {
      const double part = length_inside(joint);
      if (!(part > 0.0)) {
        continue;
      }
      ++result.joints;
      length += part;
      const Vec2 along = joint.to - joint.from;
      const double off = off_angle(std::atan2(along.y, along.x), set_->dip.mean);
      angles += off;
      squares += off * off;
      if (!set_->through_going && holds(0.5 * (joint.from + joint.to))) {
        ++result.lengths;
        lengths += norm(along);
      }
    }
    if (result.joints > 0) {
      const double mean = angles / static_cast<double>(result.joints);
      result.drawn.angle = set_->dip.mean + mean;
      result.drawn.scatter =
          std::sqrt(std::max(0.0, squares / static_cast<double>(result.joints) - mean * mean));
    }
    if (result.lengths > 0) {
      result.drawn.trace_length = lengths / static_cast<double>(result.lengths);
    }
    result.drawn.intensity = area_ > 0.0 ? length / area_ : 0.0;
  }

private:
  [[nodiscard]] bool holds(Vec2 point) const {
    return holds_point(region_->outline, point) && (set_->within.empty() || holds_point(set_->within, point));
  }

  [[nodiscard]] double length_inside(const Trace &joint) const {
    double length = 0.0;
    for (const Trace &part : parts_within(joint, region_->outline)) {
      if (set_->within.empty()) {
        length += norm(part.to - part.from);
        continue;
      }
      for (const Trace &piece : parts_within(part, set_->within)) {
        length += norm(piece.to - piece.from);
      }
    }
    return length;
  }

  // Those between the outermost points of the outline.
  void measure_lines(std::vector<double> offsets, SetStatistics &result) const {
    const Vec2 across{-std::sin(set_->dip.mean), std::cos(set_->dip.mean)};
    const std::vector<Vec2> &outline = set_->within.empty() ? region_->outline : set_->within;
    double low = dot(outline[0] - set_->origin, across);
    double high = low;
    for (const Vec2 p : outline) {
      low = std::min(low, dot(p - set_->origin, across));
      high = std::max(high, dot(p - set_->origin, across));
    }
    std::erase_if(offsets, [&](double offset) { return offset < low || offset > high; });
    result.lines = std::ssize(offsets);
    if (result.lines > 1) {
      const auto [first, last] = std::minmax_element(offsets.begin(), offsets.end());
      result.drawn.spacing = (*last - *first) / static_cast<double>(result.lines - 1);
    }
  }

  const RockRegion *region_;
  const JointSet *set_;
  double area_ = 0.0;
};

std::string words_on_plane(const JointSet &set, double azimuth) {
  if (!set.plane) {
    return "";
  }
  const JointPlane &plane = *set.plane;
  const double angle = set.dip.mean * degrees;
  const std::string side = std::abs(angle) < 1e-9                    ? "level"
                           : std::abs(std::abs(angle) - 90.0) < 1e-9 ? "upright"
                           : angle < 0.0                             ? "falling to the right"
                                                                     : "falling to the left";
  const double direction = std::fmod(plane.bearing * degrees + azimuth * degrees + 720.0, 360.0);
  return fmt::format("dip {:.4g} towards {:.4g} degrees{}; in the section towards {:.4g} an apparent dip of "
                     "{:.4g} degrees, {}; spacing {:.4g} m across the planes, {:.4g} m in the section",
                     plane.dip * degrees, direction,
                     plane.fisher > 0.0 ? fmt::format(", Fisher's constant {:g}", plane.fisher) : "",
                     azimuth * degrees, std::abs(angle), side, plane.spacing, set.spacing.mean);
}

std::string words_on(const JointSetMeasures &measures) {
  return fmt::format(
      "spacing {}, P21 {:.4g} m/m2{}, traces at {:.4g} degrees{}",
      measures.spacing > 0.0 ? fmt::format("{:.4g} m", measures.spacing) : "unknown", measures.intensity,
      measures.trace_length > 0.0 ? fmt::format(", mean trace length {:.4g} m", measures.trace_length) : "",
      measures.angle * degrees,
      measures.scatter > least_scatter ? fmt::format(" with a scatter of {:.3g}", measures.scatter * degrees)
                                       : "");
}

std::string json_of(const JointSetMeasures &measures) {
  return fmt::format(
      "{{\"spacing\": {:.17g}, \"p21\": {:.17g}, \"trace_length\": {:.17g}, \"trace_angle_deg\": {:.17g}, "
      "\"scatter_deg\": {:.17g}}}",
      measures.spacing, measures.intensity, measures.trace_length, measures.angle * degrees,
      measures.scatter * degrees);
}

} // namespace

/// A set is named by its label, joint_set 'NAME'.
std::string bare_name(const JointSet &set) {
  std::string name;
  bool is_inside = false;
  for (const char c : set.name) {
    if (c == '\'') {
      is_inside = !is_inside;
    } else if (is_inside) {
      name += c;
    }
  }
  return name.empty() ? set.name : name;
}

std::vector<SetStatistics> set_statistics(const RockRegion &region) {
  std::vector<SetStatistics> all;
  for (std::size_t i = 0; i < region.joint_sets.size(); ++i) {
    const JointSet &set = region.joint_sets[i];
    SetStatistics &one = all.emplace_back();
    one.asked = {set.spacing.mean, set.persistence() / set.spacing.mean,
                 set.through_going ? 0.0 : set.trace.mean, set.dip.mean, asked_scatter(set)};
    if (expected_traces(set, region) <= most_joints) {
      Measurement(region, set).measure(drawn_set(region, i), one);
    }
  }
  return all;
}

std::vector<std::string> words_on_sets(const RockRegion &region,
                                       const std::vector<SetStatistics> &statistics) {
  std::vector<std::string> lines;
  for (std::size_t i = 0; i < statistics.size(); ++i) {
    const JointSet &set = region.joint_sets[i];
    const SetStatistics &one = statistics[i];
    const std::string name = fmt::format("'{}'", bare_name(set));
    if (const std::string plane = words_on_plane(set, region.azimuth); !plane.empty()) {
      lines.push_back(fmt::format("{}: {}", name, plane));
    }
    lines.push_back(fmt::format("{} asks {}", name, words_on(one.asked)));
    lines.push_back(one.is_drawn
                        ? fmt::format("{} has  {}, {} joints on {} lines", name, words_on(one.drawn),
                                      one.joints, one.lines)
                        : fmt::format("{} has  more than {:g} joints, not measured", name, most_joints));
  }
  return lines;
}

std::string json_of_sets(const RockRegion &region, const std::vector<SetStatistics> &statistics) {
  std::string text;
  for (std::size_t i = 0; i < statistics.size(); ++i) {
    const SetStatistics &one = statistics[i];
    const JointSet &set = region.joint_sets[i];
    text += fmt::format("{}{{\"name\": \"{}\", \"asked\": {}, \"drawn\": {}, \"joints\": {}, \"lines\": {}}}",
                        text.empty() ? "" : ", ", bare_name(set), json_of(one.asked),
                        one.is_drawn ? json_of(one.drawn) : "null", one.joints, one.lines);
  }
  return "[" + text + "]";
}

} // namespace gcpdda::blockgen
