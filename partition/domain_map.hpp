#pragma once

// Background cells and the rank that owns each.

#include "geometry/aabb.hpp"

#include <cstdint>
#include <span>
#include <vector>

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

/// Who owns which cell: the only authority on where a block belongs.
struct DomainMap {
  CellGrid grid;
  std::vector<std::int32_t> owner; ///< (num_cells), rank
  [[nodiscard]] int rank_of(Vec2 point) const { return owner[static_cast<std::size_t>(grid.cell_of(point))]; }
};

struct PartitionReport {
  bool by_metis = false;        ///< false: the space-filling curve
  double imbalance = 1.0;       ///< max over parts of its weight / mean weight
  std::int64_t edge_cut = 0;    ///< sum over cell faces between parts of the two cells' mean weight
  std::int32_t empty_parts = 0; ///< parts without an occupied cell
};

/// How long METIS looks for short borders: a map for a whole run is worth several tries, one that a run waits
/// for is not.
enum class CutEffort { several_tries, one_try };

/// Distribute the cells over `num_parts` parts with equal weight and short borders.
///
/// Cells with weight 0 are empty: they take no part in the balance and get the owner of a near occupied cell.
/// METIS on the graph of occupied cells (8-neighbourhood; edge weight from the two cells' weights); where
/// METIS cannot (one part, fewer than 30 occupied cells per part, a cell above the mean part, an empty part
/// in its answer, or a heaviest part more than 5 % above the curve's) the cells are cut along a Hilbert
/// curve. Parts are numbered along that curve. More parts than occupied cells leave the last parts without
/// work; without any work all cells go to part 0. The same input gives the same answer in every call and on
/// every rank.
///
/// @param weights  (num_cells) counted work, >= 0, sum up to max_total_weight
DomainMap partition_cells(const CellGrid &grid, std::span<const std::int64_t> weights, int num_parts,
                          PartitionReport *report = nullptr, CutEffort effort = CutEffort::several_tries);

/// Work of a part that lies with a rank before the parts are handed out.
struct PartOnRank {
  std::int32_t part = 0;
  std::int32_t rank = 0;
  std::int64_t work = 0;
};

/// Rank of each part, one each, so that most of the work stays where it is: the largest share first. The
/// order of `held` does not matter.
std::vector<std::int32_t> ranks_of_parts(std::span<const PartOnRank> held, int num_parts);

/// Owners that are parts become ranks.
void give_parts_to_ranks(DomainMap &map, std::span<const std::int32_t> rank_of_part);

} // namespace gcpdda
