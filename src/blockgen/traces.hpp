#pragma once

// The traces of joint sets, faults and maps within a box.

#include "gcpdda/model/rock_region.hpp"
#include "geometry/aabb.hpp"

#include <functional>
#include <vector>

namespace gcpdda::blockgen {

/// One straight piece of a joint, or of an outline.
struct Trace {
  Vec2 from;
  Vec2 to;
  std::int32_t joint = -1; ///< index into JointLaws::laws, -1: by the materials
  bool is_side = false;    ///< of the region, an opening or a layer

  [[nodiscard]] Aabb box() const;
  /// It has a point in the box.
  [[nodiscard]] bool meets(const Aabb &box) const;
};

/// Everything that cuts the region and reaches into `box`, whole, always in the same order: outlines of the
/// region, its openings and layers, faults, maps, masonry, joint sets. Outlines of the region come whether
/// they reach in or not, so that every place in the region lies within a closed ring.
/// Each trace depends on the region alone.
std::vector<Trace> traces_in(const RockRegion &region, const Aabb &box);

/// A joint set as it is drawn over the bounding box of the region.
struct DrawnSet {
  std::vector<double> offsets; ///< of its lines from the origin, across the mean dip, m
  std::vector<Trace> joints;   ///< whole, also where the set is for a part of the region only
};
DrawnSet drawn_set(const RockRegion &region, std::size_t number);

/// One point of each Voronoi cell whose grid cell meets `box`.
std::vector<Vec2> voronoi_sites(const VoronoiCells &cells, const RockRegion &region, const Aabb &box);

/// Parts of a segment inside a simple polygon.
std::vector<Trace> parts_within(const Trace &trace, const std::vector<Vec2> &outline);

} // namespace gcpdda::blockgen
