#pragma once

// Which rank owns which background cell.

#include "partition/cell_grid.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace gcpdda {

/// Who owns which cell: the only authority on where a block belongs.
struct DomainMap {
  CellGrid grid;
  std::vector<std::int32_t> owner; ///< (num_cells), rank
  [[nodiscard]] int rank_of(Vec2 point) const { return owner[static_cast<std::size_t>(grid.cell_of(point))]; }
};

} // namespace gcpdda
