#pragma once

// The cells that hold work, and their neighbours: the graph that is cut.

#include "partition/cell_grid.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace gcpdda {

/// The cells that hold work, ascending: the vertices of what is cut.
struct OccupiedCells {
  const CellGrid &grid;
  std::vector<std::int64_t> cell;
  std::vector<std::int64_t> weight;
  std::vector<std::int32_t> row_of; ///< (num_cells), row of a cell in the two above, -1 for an empty cell

  OccupiedCells(const CellGrid &cells, std::span<const std::int64_t> weights);
  [[nodiscard]] std::size_t size() const { return cell.size(); }
};

/// Part of each occupied cell.
using Cut = std::vector<std::int32_t>;

/// Calls visit(cell, shares_face) for the up to eight neighbours, ascending.
template <class Visit> void for_each_neighbour(const CellGrid &grid, std::int64_t cell, Visit visit) {
  const std::int64_t row = cell / grid.columns;
  const std::int64_t column = cell % grid.columns;
  for (std::int64_t r = row - 1; r <= row + 1; ++r) {
    for (std::int64_t c = column - 1; c <= column + 1; ++c) {
      const bool inside = r >= 0 && r < grid.rows && c >= 0 && c < grid.columns;
      if (inside && (r != row || c != column)) {
        visit(r * grid.columns + c, r == row || c == column);
      }
    }
  }
}

/// What a border through the face of two cells costs: the mean of their weights, since both sides become
/// ghosts.
inline std::int64_t face_weight(std::int64_t a, std::int64_t b) {
  return a / 2 + b / 2 + (a % 2 + b % 2) / 2;
}

} // namespace gcpdda
