#pragma once

// Where a liner lies on which blocks, and its elements.
//
// Stations stand along the liner's path, a fraction of its thickness apart. At each a ray goes from a reach
// inside the void to a reach inside the rock, across the path; the first block that it enters owns the
// station. The reach, the thickness or 2 % of the path's extent if that is more, lets blocks have moved since
// the opening was cut. A station whose ray begins inside a block has no face.
//
// Stations of one block in a row are a stretch of face, and the point of the face in the middle of a stretch
// is a node. Stretches shorter than half the thickness, slivers and cracks, are skipped: a beam that is
// shorter than it is thick is none, and its stiffness would only cost steps. Without a face for more than
// the thickness the liner is interrupted. An element goes from each node to the next one of another block.

#include "dynamics/bolt_link.hpp"
#include "gcpdda/model/support.hpp"
#include "geometry/aabb.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace gcpdda {

/// A place on a liner's path.
struct LinerStation {
  double way = 0.0;    ///< along the path, m
  double length = 0.0; ///< of the part of the path for which it stands, m
  Vec2 point;          ///< m
  Vec2 inward;         ///< unit vector into the rock
};

struct LinerPath {
  std::vector<LinerStation> stations;
  double length = 0.0; ///< m
  double reach = 0.0;  ///< m
  Aabb box;            ///< of the stations
  bool is_closed = false;
};

/// Stations so that the rock lies on the right of the path, or on its left, which turns the path around.
LinerPath path_of(const Liner &liner, double thickness, bool has_rock_on_right);

/// What the ray at a station meets first.
struct FaceHit {
  static constexpr std::int64_t nothing = -1;
  static constexpr std::int64_t inside = -2; ///< it begins inside a block
  std::int64_t block = nothing;
  double depth = 0.0; ///< of the face behind the path, negative before it, m

  /// It comes before another one.
  [[nodiscard]] bool is_before(const FaceHit &other) const;
};

/// Note what the outline of a block is to the stations of a path.
void meet(const LinerPath &path, std::span<const Vec2> polygon, std::int64_t block, std::span<FaceHit> hits);

struct LinerElements {
  std::vector<BoltLink> links;    ///< along the path, ends in world positions
  std::int64_t num_stretches = 0; ///< of a block each
  std::int64_t num_gaps = 0;
};

/// @param index  into Scene::liners
/// @param hits  of all ranks, by station
LinerElements elements_of(std::int64_t index, const LinerPath &path, double thickness,
                          std::span<const FaceHit> hits);

} // namespace gcpdda
