#pragma once

// One tile of a region, cut into blocks.

#include "blockgen/dust_faces.hpp"
#include "blockgen/edge_joints.hpp"
#include "blockgen/face_merger.hpp"
#include "blockgen/region_cutter.hpp"

#include <functional>
#include <span>
#include <vector>

namespace gcpdda::blockgen {

/// One tile and what it takes to cut it.
struct Tile {
  Aabb box; ///< half-open: low belongs to it, high does not
  double halo = 0.0;
};

/// How far rounding may move the outline of a block, m.
double rounding_of(const RockRegion &region);

/// Cuts one tile of a region. Inside, coordinates are those of the scene less an origin.
class TileCutter {
public:
  /// @param laws    of the scene; like the region they must stay
  /// @param gather  traces of the region that reach into a box, in the order of traces_in()
  using Gather = std::function<std::vector<Trace>(const Aabb &)>;
  TileCutter(const RockRegion &region, const JointLaws &laws, Vec2 origin, Gather gather);

  /// Blocks of the tile, by their smallest vertex.
  std::vector<SceneBlock> cut(const Tile &tile, CutReport &report);

private:
  /// What lies around the tile.
  struct Surroundings {
    std::vector<Trace> traces;
    std::vector<RockFace> faces;
    Aabb seen; ///< everything in here is known
    MovedEdges moved;
  };
  [[nodiscard]] Surroundings look_around(const Tile &tile, CutReport &report) const;
  [[nodiscard]] std::vector<Trace> traces_in(const Aabb &box) const;
  [[nodiscard]] std::vector<RockFace> rock_in(const std::vector<Trace> &traces) const;
  [[nodiscard]] SceneBlock block_of(const RockFace &face, const Ring &ring, const EdgeJoints &joints,
                                    const MovedEdges &moved) const;

  const RockRegion *region_;
  const JointLaws *laws_;
  Vec2 origin_;
  Gather gather_;
  Aabb around_;
  double rounding_; ///< rounding_of(region)
  SliverSizes sizes_;
  PlanarGraph graph_;
};

} // namespace gcpdda::blockgen
