#pragma once

// The grid of background cells.

#include "geometry/aabb.hpp"

#include <cstdint>
#include <span>

namespace gcpdda {

/// Cells and the edges between them stay below 2^31, the range of METIS.
inline constexpr std::int64_t max_background_cells = std::int64_t{1} << 27;

/// Leaves room for the edge weights of the graph, up to 26 times the cells', in 64 bits.
inline constexpr std::int64_t max_total_weight = std::int64_t{1} << 58;

/// The bounding region cut into square background cells, row by row from the lower left. Points outside
/// belong to the nearest border cell, so every point of the plane has a cell.
struct CellGrid {
  Vec2 origin;
  double cell_size = 1.0; ///< m
  std::int32_t columns = 1;
  std::int32_t rows = 1;

  /// A grid over `region` with about `num_cells` cells (at least 1 each way).
  static CellGrid over(const Aabb &region, std::int64_t num_cells);
  [[nodiscard]] std::int64_t num_cells() const { return std::int64_t{columns} * rows; }
  struct Place {
    std::int64_t column = 0;
    std::int64_t row = 0;
  };
  [[nodiscard]] Place place_of(Vec2 point) const {
    const Vec2 place = (1.0 / cell_size) * (point - origin);
    return {clamped(place.x, columns), clamped(place.y, rows)};
  }
  [[nodiscard]] std::int64_t cell_of(Vec2 point) const {
    const Place place = place_of(point);
    return place.row * columns + place.column;
  }

private:
  static std::int64_t clamped(double place, std::int32_t count) {
    if (!(place >= 0.0)) { // NaN too
      return 0;
    }
    return place < count ? static_cast<std::int64_t>(place) : count - 1;
  }
};

/// Box of the points but for the outermost few of each side (one in a thousand, none of less than twenty): a
/// grid over it keeps its cells small when some blocks fly far away.
Aabb box_without_strays(std::span<const Vec2> points);

} // namespace gcpdda
