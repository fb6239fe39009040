#pragma once

// Cells are distributed over parts with equal work and short borders.

#include "partition/domain_map.hpp"

#include <cstdint>
#include <span>

namespace gcpdda {

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

} // namespace gcpdda
