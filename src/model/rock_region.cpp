#include "gcpdda/model/rock_region.hpp"

#include "geometry/aabb.hpp"
#include "geometry/polygon.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace gcpdda {

namespace {

/// Joints of one direction, or of all directions.
struct Density {
  double length = 0.0; ///< m of joint per m2
  std::optional<double> dip;
};

/// Crossings per area of two families; straight lines in all directions meet at the mean sine 2/pi.
double crossings(const Density &a, const Density &b) {
  const double sine = a.dip && b.dip ? std::abs(std::sin(*a.dip - *b.dip)) : 2.0 / std::numbers::pi;
  return a.length * b.length * sine;
}

/// Width of a polygon in a direction.
double width_along(const std::vector<Vec2> &outline, Vec2 direction) {
  double low = dot(outline[0], direction);
  double high = low;
  for (const Vec2 p : outline) {
    low = std::min(low, dot(p, direction));
    high = std::max(high, dot(p, direction));
  }
  return high - low;
}

/// Width of the region across the joints of a set. Of a compact region the root of its area says it well
/// enough; one that reaches far, by a vertex with a wrong coordinate perhaps, is crossed by as many joints as
/// it is wide.
double width_across(const RockRegion &region, const JointSet &set) {
  const double compact = std::sqrt(signed_area(region.outline));
  const Vec2 across{-std::sin(set.dip.mean), std::cos(set.dip.mean)};
  const double width = width_along(set.within.empty() ? region.outline : set.within, across);
  constexpr double far = 4.0;
  return width > far * compact ? width : compact;
}

/// Integral of x^power from 1 to `end`.
double integral_of_power(double power, double end) {
  const double exponent = (power + 1.0) * std::log(end);
  return exponent == 0.0 ? std::log(end) : std::log(end) * std::expm1(exponent) / exponent;
}

} // namespace

double Scattered::mean_of_power_law() const {
  const double ratio = high / low;
  return low * integral_of_power(1.0 - width, ratio) / integral_of_power(-width, ratio);
}

double expected_traces(const JointSet &set, const RockRegion &region) {
  const Vec2 extent = bounding_box(region.outline).extent();
  const double sine = std::abs(std::sin(set.dip.mean));
  const double cosine = std::abs(std::cos(set.dip.mean));
  const double lines = (extent.x * sine + extent.y * cosine) / set.spacing.mean;
  const double length = extent.x * cosine + extent.y * sine;
  return lines * (set.through_going ? 1.0 : 1.0 + length / (set.trace.mean + set.gap.mean));
}

double expected_cells(const VoronoiCells &cells, const RockRegion &region) {
  const Vec2 extent = bounding_box(region.outline).extent();
  return (extent.x / cells.size + 1.0) * (extent.y / cells.size + 1.0);
}

double expected_bricks(const BrickPattern &bricks, const RockRegion &region) {
  const Vec2 extent = bounding_box(region.outline).extent();
  return (extent.x / bricks.size.x + 1.0) * (extent.y / bricks.size.y + 1.0);
}

double expected_blocks(const RockRegion &region) {
  const double area = signed_area(region.outline);
  std::vector<Density> families;
  double blocks = 1.0;
  for (const JointSet &set : region.joint_sets) {
    families.push_back({set.persistence() / set.spacing.mean, set.dip.mean});
    blocks += set.persistence() * width_across(region, set) / set.spacing.mean;
  }
  for (const VoronoiCells &cells : region.voronoi) {
    families.push_back({2.0 / cells.size, {}});
    blocks += area / (cells.size * cells.size);
  }
  for (const BrickPattern &bricks : region.bricks) {
    families.push_back({1.0 / bricks.size.x + 1.0 / bricks.size.y, {}});
    blocks += area / (bricks.size.x * bricks.size.y);
  }
  for (std::size_t i = 0; i < families.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      blocks += area * crossings(families[i], families[j]);
    }
  }
  return blocks;
}

} // namespace gcpdda
