#pragma once

// Pairs of blocks whose boxes meet (candidates.hpp).

#include "base/ids.hpp"
#include "model/block_system.hpp"

#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace gcpdda {

/// Box of every row at t_n, or of rows [first, last); a mobile block's is inflated by half the skin.
std::vector<Aabb> reach_boxes(const BlockSystem &system, double skin);
std::vector<Aabb> reach_boxes(const BlockSystem &system, double skin, std::size_t first, std::size_t last);

/// All pairs with at least one owned block whose boxes meet and of which one can be moved, by a background
/// grid, as (row, row) with the lower id first, sorted by ids.
std::vector<std::pair<BlockIndex, BlockIndex>> find_pairs(const BlockSystem &system,
                                                          std::span<const Aabb> boxes);

/// All pairs of rows of which none can be moved, fixed and driven ones, and whose boxes meet, as find_pairs()
/// lists them. No contact acts between them.
/// @param skin  m, half of which each box is inflated by
std::vector<std::pair<BlockIndex, BlockIndex>> find_kept_pairs(const BlockSystem &system, double skin);

} // namespace gcpdda
