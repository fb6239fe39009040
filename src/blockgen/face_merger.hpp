#pragma once

// Faces that are too small or too thin become part of a neighbour.

#include "blockgen/planar_graph.hpp"
#include "geometry/aabb.hpp"

#include <cstdint>
#include <unordered_map>
#include <vector>

namespace gcpdda::blockgen {

/// A face of the region on its way to become a block.
struct RockFace {
  PlaneFace shape;
  double area = 0.0; ///< m2
  Aabb box;
  std::int32_t material = 0;
  std::int32_t opening = -1; ///< index into RockRegion::openings, the last that holds it; -1: none
  bool is_sliver = false;
  /// All that could change it is known; false near the end of what a tile sees.
  bool is_certain = true;

  [[nodiscard]] Vec2 corner() const { return shape.outer[0]; } ///< smallest vertex: names the face
};

/// Which face lies left of each edge.
class EdgeMap {
public:
  explicit EdgeMap(const std::vector<RockFace> &faces);
  /// Face that has the edge from -> to, -1 if none.
  [[nodiscard]] std::int64_t face_of(Vec2 from, Vec2 to) const;

private:
  struct Edge {
    Vec2 from;
    Vec2 to;
    friend bool operator==(const Edge &, const Edge &) = default;
  };
  struct Hash {
    std::size_t operator()(const Edge &edge) const;
  };
  std::unordered_map<Edge, std::int64_t, Hash> faces_;
};

struct SliverSizes {
  double min_width = 0.0; ///< m, of the mean width
  double min_area = 0.0;  ///< m2
};

/// Smaller, or narrower in the mean, than allowed.
bool is_sliver(const RockFace &face, const SliverSizes &sizes);

/// Every sliver becomes part of the neighbour that shares most of its boundary with it (of equals the one
/// with the smallest corner), among those of its material and opening; what is a sliver still after that once
/// more, three times at most. Those without such a neighbour stay.
void merge_slivers(const PlanarGraph &graph, const SliverSizes &sizes, std::vector<RockFace> &faces);

} // namespace gcpdda::blockgen
