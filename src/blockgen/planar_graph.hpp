#pragma once

// The wall around GEOS: segments in, faces out.

#include "blockgen/traces.hpp"
#include "gcpdda/geometry/vec2.hpp"

#include <memory>
#include <span>
#include <string>
#include <vector>

namespace gcpdda::blockgen {

using Ring = std::vector<Vec2>; ///< not closed: the last vertex is not the first

/// A bounded face of a plane arrangement of segments, with a vertex wherever another segment ends or crosses.
struct PlaneFace {
  Ring outer;              ///< counter-clockwise, beginning with the smallest vertex (by x, then y)
  std::vector<Ring> holes; ///< clockwise
};

/// Noding and polygonizing by GEOS. Coordinates should lie near the origin. Two segments cross at the same
/// point, bit for bit, whichever other segments are given. Throws InternalError where GEOS fails.
class PlanarGraph {
public:
  PlanarGraph();
  ~PlanarGraph();
  PlanarGraph(const PlanarGraph &) = delete;
  PlanarGraph &operator=(const PlanarGraph &) = delete;

  /// All bounded faces; dangling segments bound none.
  [[nodiscard]] std::vector<PlaneFace> faces(std::span<const Trace> segments) const;
  /// On which side of the line through a segment a point lies, without a rounding error: 1 on the left, -1 on
  /// the right, 0 on the line.
  [[nodiscard]] int side(const Trace &segment, Vec2 p) const;
  /// A point inside.
  [[nodiscard]] Vec2 point_inside(const PlaneFace &face) const;
  /// Faces that share whole edges, as one.
  [[nodiscard]] PlaneFace unite(std::span<const PlaneFace *const> faces) const;
  /// The same area in faces without holes: cut upright through the middle of each hole.
  [[nodiscard]] std::vector<PlaneFace> without_holes(const PlaneFace &face) const;
  /// Edges of the Voronoi diagram of the sites; the outermost ones are cut off anyhow.
  [[nodiscard]] std::vector<Trace> voronoi_edges(std::span<const Vec2> sites) const;

private:
  struct Context;
  std::unique_ptr<Context> context_;
};

/// Version of the GEOS library that runs: "3.11.1-CAPI-1.17.1".
std::string geos_version();

} // namespace gcpdda::blockgen
