#pragma once

// Cells cut along a space-filling curve.

#include "partition/occupied_cells.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace gcpdda {

/// Place of each occupied cell along the Hilbert curve of the smallest enclosing power of two.
std::vector<std::uint64_t> hilbert_positions(const OccupiedCells &cells);

/// Rows of the occupied cells in that order.
std::vector<std::size_t> rows_along_curve(const OccupiedCells &cells);

/// The contiguous cut of the curve whose heaviest part is lightest; no part is empty while there are cells.
Cut cut_along_curve(const OccupiedCells &cells, int num_parts);

} // namespace gcpdda
