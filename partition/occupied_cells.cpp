#include "partition/occupied_cells.hpp"

#include "base/check.hpp"

namespace gcpdda {

OccupiedCells::OccupiedCells(const CellGrid &cells, std::span<const std::int64_t> weights)
    : grid(cells), row_of(weights.size(), -1) {
  std::int64_t room = max_total_weight;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    expect(weights[i] >= 0 && weights[i] <= room, "cell weights: not negative, sum up to 2^58");
    room -= weights[i];
    if (weights[i] > 0) {
      row_of[i] = static_cast<std::int32_t>(cell.size());
      cell.push_back(static_cast<std::int64_t>(i));
      weight.push_back(weights[i]);
    }
  }
}

} // namespace gcpdda
