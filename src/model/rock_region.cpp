#include "gcpdda/model/rock_region.hpp"

#include "gcpdda/geometry/polygon.hpp"

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

double share_of_traces(const JointSet &set) {
  return set.through_going ? 1.0 : set.trace.mean / (set.trace.mean + set.gap.mean);
}

} // namespace

double expected_traces(const JointSet &set, double area) {
  const double lines = std::sqrt(area) / set.spacing.mean;
  return lines + (set.through_going ? 0.0 : area / set.spacing.mean / (set.trace.mean + set.gap.mean));
}

double expected_blocks(const RockRegion &region) {
  const double area = signed_area(region.outline);
  std::vector<Density> families;
  double blocks = 1.0;
  for (const JointSet &set : region.joint_sets) {
    families.push_back({share_of_traces(set) / set.spacing.mean, set.dip.mean});
    blocks += share_of_traces(set) * std::sqrt(area) / set.spacing.mean;
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
