#pragma once

// Cells cut by METIS.

#include "partition/occupied_cells.hpp"
#include "partition/partition_cells.hpp"

#include <optional>

namespace gcpdda {

/// Nothing when METIS left a part empty.
std::optional<Cut> cut_by_metis(const OccupiedCells &cells, int num_parts, CutEffort effort);

} // namespace gcpdda
