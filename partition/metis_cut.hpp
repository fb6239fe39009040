#pragma once

// Cells cut by METIS.

#include "partition/occupied_cells.hpp"
#include "partition/partition_cells.hpp"

#include <optional>
#include <string>

namespace gcpdda {

/// Nothing when METIS left a part empty.
std::optional<Cut> cut_by_metis(const OccupiedCells &cells, int num_parts, CutEffort effort);

/// Version of METIS that this was compiled with: "5.1.0".
std::string metis_version();

} // namespace gcpdda
