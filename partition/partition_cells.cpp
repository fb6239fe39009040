// Which cells hold work, who cuts them, and who gets the empty ones.

#include "partition/partition_cells.hpp"

#include "base/check.hpp"
#include "partition/curve_cut.hpp"
#include "partition/metis_cut.hpp"

#include <algorithm>
#include <limits>
#include <numeric>

namespace gcpdda {

namespace {

/// Below this METIS returns ragged or even empty parts.
constexpr std::size_t min_cells_per_part = 30;

/// Uneven weights cost METIS balance; this much above the curve's heaviest part, its shorter borders are not
/// worth it.
constexpr double balance_margin = 1.05;

std::vector<std::int64_t> part_weights(const OccupiedCells &cells, const Cut &cut, int num_parts) {
  std::vector<std::int64_t> sums(static_cast<std::size_t>(num_parts), 0);
  for (std::size_t i = 0; i < cells.size(); ++i) {
    sums[static_cast<std::size_t>(cut[i])] += cells.weight[i];
  }
  return sums;
}

std::int64_t total_weight(const OccupiedCells &cells) {
  return std::accumulate(cells.weight.begin(), cells.weight.end(), std::int64_t{0});
}

double heaviest(const OccupiedCells &cells, const Cut &cut, int num_parts) {
  const std::vector<std::int64_t> sums = part_weights(cells, cut, num_parts);
  return static_cast<double>(*std::max_element(sums.begin(), sums.end()));
}

/// Numbers the parts along the Hilbert curve: equal cuts get equal labels, and neighbouring ranks are near.
void number_along_curve(const OccupiedCells &cells, int num_parts, Cut &cut) {
  const std::vector<std::uint64_t> positions = hilbert_positions(cells);
  const auto n = static_cast<std::size_t>(num_parts);
  std::vector<std::uint64_t> first(n, std::numeric_limits<std::uint64_t>::max());
  for (std::size_t i = 0; i < cut.size(); ++i) {
    std::uint64_t &earliest = first[static_cast<std::size_t>(cut[i])];
    earliest = std::min(earliest, positions[i]);
  }
  std::vector<std::size_t> order(n);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return first[a] < first[b]; });
  std::vector<std::int32_t> label(n);
  for (std::size_t k = 0; k < n; ++k) {
    label[order[k]] = static_cast<std::int32_t>(k);
  }
  for (std::int32_t &part : cut) {
    part = label[static_cast<std::size_t>(part)];
  }
}

struct Choice {
  Cut cut;
  bool by_metis;
};

Choice choose_cut(const OccupiedCells &cells, int num_parts, CutEffort effort) {
  if (num_parts == 1 || cells.size() == 0) {
    return {Cut(cells.size(), 0), false};
  }
  Cut by_curve = cut_along_curve(cells, num_parts);
  const double lightest_peak = heaviest(cells, by_curve, num_parts);
  const bool too_few = cells.size() / min_cells_per_part < static_cast<std::size_t>(num_parts);
  // One cell beyond the mean part: the balance is lost anyhow, and METIS runs out of cells and complains on
  // stdout.
  const auto biggest = static_cast<double>(*std::max_element(cells.weight.begin(), cells.weight.end()));
  const bool dominated = biggest * num_parts > static_cast<double>(total_weight(cells));
  if (too_few || dominated) {
    return {std::move(by_curve), false};
  }
  std::optional<Cut> by_metis = cut_by_metis(cells, num_parts, effort);
  if (!by_metis || heaviest(cells, *by_metis, num_parts) > balance_margin * lightest_peak) {
    return {std::move(by_curve), false};
  }
  return {std::move(*by_metis), true};
}

/// Ring by ring around the occupied cells; among owners equally near the smallest.
std::vector<std::int32_t> spread(const OccupiedCells &cells, const Cut &cut) {
  constexpr auto unreached = std::numeric_limits<std::int32_t>::max();
  const auto num_cells = static_cast<std::size_t>(cells.grid.num_cells());
  if (cells.size() == 0) {
    return std::vector<std::int32_t>(num_cells, 0);
  }
  std::vector<std::int32_t> owner(num_cells, unreached);
  std::vector<std::int32_t> ring_of(num_cells, unreached);
  std::vector<std::int64_t> front = cells.cell;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    owner[static_cast<std::size_t>(cells.cell[i])] = cut[i];
    ring_of[static_cast<std::size_t>(cells.cell[i])] = 0;
  }
  for (std::int32_t ring = 1; !front.empty(); ++ring) {
    std::vector<std::int64_t> reached;
    for (const std::int64_t from : front) {
      for_each_neighbour(cells.grid, from, [&](std::int64_t cell, bool) {
        const auto c = static_cast<std::size_t>(cell);
        if (ring_of[c] == unreached) {
          ring_of[c] = ring;
          reached.push_back(cell);
        }
        if (ring_of[c] == ring) {
          owner[c] = std::min(owner[c], owner[static_cast<std::size_t>(from)]);
        }
      });
    }
    front = std::move(reached);
  }
  return owner;
}

std::int64_t weight_of_cut_faces(const OccupiedCells &cells, const Cut &cut) {
  std::int64_t sum = 0;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    for_each_neighbour(cells.grid, cells.cell[i], [&](std::int64_t cell, bool shares_face) {
      const std::int32_t row = cells.row_of[static_cast<std::size_t>(cell)];
      if (cell > cells.cell[i] && shares_face && row >= 0) {
        const auto j = static_cast<std::size_t>(row);
        sum += cut[i] == cut[j] ? 0 : face_weight(cells.weight[i], cells.weight[j]);
      }
    });
  }
  return sum;
}

PartitionReport report_on(const OccupiedCells &cells, const Choice &choice, int num_parts) {
  PartitionReport report;
  report.by_metis = choice.by_metis;
  const std::vector<std::int64_t> sums = part_weights(cells, choice.cut, num_parts);
  const std::int64_t total = total_weight(cells);
  if (total > 0) {
    report.imbalance = static_cast<double>(*std::max_element(sums.begin(), sums.end())) * num_parts /
                       static_cast<double>(total);
  }
  report.empty_parts = static_cast<std::int32_t>(std::count(sums.begin(), sums.end(), 0));
  report.edge_cut = weight_of_cut_faces(cells, choice.cut);
  return report;
}

} // namespace

DomainMap partition_cells(const CellGrid &grid, std::span<const std::int64_t> weights, int num_parts,
                          PartitionReport *report, CutEffort effort) {
  expect(num_parts >= 1, "partition: at least one part");
  expect(grid.num_cells() <= max_background_cells, "partition: at most 2^27 cells");
  expect(static_cast<std::int64_t>(weights.size()) == grid.num_cells(),
         "partition: one weight for each cell");
  const OccupiedCells cells(grid, weights);
  Choice choice = choose_cut(cells, num_parts, effort);
  number_along_curve(cells, num_parts, choice.cut);
  if (report != nullptr) {
    *report = report_on(cells, choice, num_parts);
  }
  return {grid, spread(cells, choice.cut)};
}

} // namespace gcpdda
