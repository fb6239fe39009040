// The fallback, and the yardstick, of METIS: cells in Hilbert order, cut where the heaviest part is lightest.
// Borders are longer than METIS's, but it works on any number of cells, any weights and any number of parts.

#include "partition/curve_cut.hpp"

#include <algorithm>
#include <bit>
#include <numeric>

namespace gcpdda {

namespace {

// Quadrant by quadrant from the coarsest, turning the frame so that the curve stays connected.
std::uint64_t hilbert_position(std::uint32_t x, std::uint32_t y, std::uint32_t side) {
  std::uint64_t position = 0;
  for (std::uint32_t s = side / 2; s > 0; s /= 2) {
    const bool right = (x & s) != 0;
    const bool upper = (y & s) != 0;
    const std::uint64_t quadrant = right ? (upper ? 2 : 3) : (upper ? 1 : 0);
    position += quadrant * s * s;
    if (!upper) {
      if (right) {
        x = side - 1 - x;
        y = side - 1 - y;
      }
      std::swap(x, y);
    }
  }
  return position;
}

/// Cells of each part when parts are filled in order up to `limit`, leaving one cell at least for each part
/// to come; the last entry is what did not fit.
std::vector<std::size_t> fill(std::span<const std::int64_t> weights, int num_parts, std::int64_t limit) {
  std::vector<std::size_t> counts;
  std::size_t next = 0;
  for (int part = 0; part < num_parts; ++part) {
    const auto parts_to_come = static_cast<std::size_t>(num_parts - part - 1);
    const std::size_t first = next;
    std::int64_t room = limit;
    while (next < weights.size() && weights[next] <= room &&
           (next == first || weights.size() - next > parts_to_come)) {
      room -= weights[next++];
    }
    counts.push_back(next - first);
  }
  counts.push_back(weights.size() - next);
  return counts;
}

} // namespace

std::vector<std::uint64_t> hilbert_positions(const OccupiedCells &cells) {
  const auto longest = static_cast<std::uint32_t>(std::max(cells.grid.columns, cells.grid.rows));
  const std::uint32_t side = std::bit_ceil(longest);
  std::vector<std::uint64_t> positions;
  positions.reserve(cells.size());
  for (const std::int64_t cell : cells.cell) {
    positions.push_back(hilbert_position(static_cast<std::uint32_t>(cell % cells.grid.columns),
                                         static_cast<std::uint32_t>(cell / cells.grid.columns), side));
  }
  return positions;
}

std::vector<std::size_t> rows_along_curve(const OccupiedCells &cells) {
  const std::vector<std::uint64_t> positions = hilbert_positions(cells);
  std::vector<std::size_t> order(cells.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return positions[a] < positions[b]; });
  return order;
}

Cut cut_along_curve(const OccupiedCells &cells, int num_parts) {
  const std::vector<std::size_t> order = rows_along_curve(cells);
  std::vector<std::int64_t> weights;
  weights.reserve(order.size());
  for (const std::size_t i : order) {
    weights.push_back(cells.weight[i]);
  }

  // Bisection on the heaviest part's weight.
  std::int64_t low = *std::max_element(weights.begin(), weights.end());
  std::int64_t high = std::accumulate(weights.begin(), weights.end(), std::int64_t{0});
  while (low < high) {
    const std::int64_t middle = low + (high - low) / 2;
    const bool everything_fits = fill(weights, num_parts, middle).back() == 0;
    low = everything_fits ? low : middle + 1;
    high = everything_fits ? middle : high;
  }

  Cut cut(cells.size());
  const std::vector<std::size_t> counts = fill(weights, num_parts, high);
  std::size_t next = 0;
  for (int part = 0; part < num_parts; ++part) {
    for (std::size_t i = 0; i < counts[static_cast<std::size_t>(part)]; ++i) {
      cut[order[next++]] = part;
    }
  }
  return cut;
}

} // namespace gcpdda
