#pragma once

// From a region and its joints to blocks. The bounding box of the region is laid out in tiles that depend on
// the scene alone. For each tile everything that reaches into its box grown by a halo is noded, whole, and
// the faces whose smallest vertex (by x, then y) lies in the tile are its blocks. A face that meets the tile
// must lie within the grown box, else joints that were not looked at might cut it: the halo grows until all
// do. So a tile is cut by one rank without a message, and nobody holds all blocks.

#include "base/exact_sum.hpp"
#include "gcpdda/model/scene.hpp"
#include "geometry/aabb.hpp"
#include "model/block_source.hpp"

#include <cstdint>
#include <vector>

namespace gcpdda {

/// What cutting had to mend, of the tiles cut together.
struct CutReport {
  std::int64_t merged_slivers = 0;
  std::int64_t cut_rings = 0;     ///< blocks around others, cut upright so that none has a hole
  std::int64_t t_junctions = 0;   ///< joints that end at a joint
  std::vector<Vec2> kept_slivers; ///< smallest vertices of those that could not be merged
  ExactSum excavated_area;        ///< m2
};

class RegionCutter final : public BlockSource {
public:
  static constexpr std::int64_t usual_blocks_per_tile = 4000;

  /// @param scene  with a region; its joint laws and region are kept
  explicit RegionCutter(const Scene &scene, std::int64_t blocks_per_tile = usual_blocks_per_tile);

  /// The last tile holds the fixed blocks along the sides, if the scene has any.
  [[nodiscard]] std::int64_t num_tiles() const override;
  [[nodiscard]] double expected_blocks() const override;
  [[nodiscard]] double expected_seconds() const override;
  [[nodiscard]] Made make(std::int64_t first, std::int64_t last) const override;
  /// The same, with what had to be mended.
  [[nodiscard]] Made make(std::int64_t first, std::int64_t last, CutReport &report) const;

  /// How far rounding may move the outline of a block, m.
  [[nodiscard]] double rounding() const;
  [[nodiscard]] std::int64_t num_columns() const { return num_columns_; }
  [[nodiscard]] std::int64_t num_rows() const { return num_rows_; }

private:
  [[nodiscard]] Aabb tile_box(std::int64_t tile) const;
  [[nodiscard]] std::vector<SceneBlock> fixed_blocks() const;

  RockRegion region_;
  JointLaws laws_;
  Aabb around_;
  Vec2 origin_; ///< of the coordinates GEOS sees
  std::int64_t num_columns_ = 1;
  std::int64_t num_rows_ = 1;
  double halo_ = 0.0; ///< to begin with, m
};

} // namespace gcpdda
