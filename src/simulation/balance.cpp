#include "simulation/balance.hpp"
#include "partition/partition_cells.hpp"
#include "partition/ranks_of_parts.hpp"

#include <algorithm>
#include <array>
#include <numeric>

namespace gcpdda {

namespace {

/// max/mean over the ranks.
double imbalance_of(const Communicator &communicator, std::int64_t work) {
  std::int64_t most = work;
  communicator.max(std::span(&most, 1));
  communicator.sum(std::span(&work, 1));
  return work > 0 ? static_cast<double>(most) * communicator.size() / static_cast<double>(work) : 1.0;
}

std::int64_t num_occupied(const CellGrid &grid, std::span<const Vec2> points) {
  std::vector<std::int64_t> cells;
  cells.reserve(points.size());
  for (const Vec2 p : points) {
    cells.push_back(grid.cell_of(p));
  }
  std::sort(cells.begin(), cells.end());
  return std::unique(cells.begin(), cells.end()) - cells.begin();
}

} // namespace

void WorkOfBlocks::add_pair(BlockIndex lower, BlockIndex higher) {
  for (const BlockIndex end : {lower, higher}) {
    if (end.value < work_.size()) {
      ++work_[end.value];
    }
  }
}

std::vector<std::int64_t> work_of_blocks(const BlockSystem &system, const Candidates &candidates) {
  WorkOfBlocks work(system.num_owned);
  for (const CandidatePair &pair : candidates.pairs) {
    if (system.motion[pair.lower.value].box.meets(system.motion[pair.higher.value].box)) {
      work.add_pair(pair.lower, pair.higher);
    }
  }
  return work.counted();
}

CellGrid lay_grid(const Communicator &communicator, std::span<const Vec2> centroids) {
  constexpr std::int64_t most_per_block = 64;
  constexpr std::int64_t least_per_rank = 64;
  // Every rank holds all cells, and a thousand for each rank balance to a thousandth.
  constexpr std::int64_t most_per_rank = 1024;
  constexpr std::int64_t most_of_few_ranks = std::int64_t{1} << 20U;
  const std::int64_t num_ranks = communicator.size();
  const Aabb mine = box_without_strays(centroids);
  std::array<double, 4> corners{-mine.low.x, -mine.low.y, mine.high.x, mine.high.y};
  communicator.max(corners);
  const Aabb region{{-corners[0], -corners[1]}, {corners[2], corners[3]}};
  auto num_blocks = static_cast<std::int64_t>(centroids.size());
  communicator.sum(std::span(&num_blocks, 1));
  const std::int64_t least = std::min(max_background_cells, least_per_rank * num_ranks);
  const std::int64_t most = std::clamp(
      std::min(most_per_block * num_blocks, std::max(most_of_few_ranks, most_per_rank * num_ranks)), least,
      max_background_cells);
  // More take longer to cut and let more blocks go back and forth.
  const std::int64_t enough = std::max(num_blocks / 2, most_per_rank * num_ranks);
  std::int64_t num_cells = std::clamp(std::min(2 * num_blocks, enough), least, most);
  const std::int64_t wanted = std::min(num_blocks, num_cells);
  // Of a strip that lies askew most cells would be empty and the others coarse.
  std::int64_t occupied = num_occupied(CellGrid::over(region, num_cells), centroids);
  communicator.sum(std::span(&occupied, 1));
  if (occupied > 0 && occupied < wanted) {
    const double finer = static_cast<double>(wanted) / static_cast<double>(occupied);
    num_cells = std::min(most, static_cast<std::int64_t>(finer * static_cast<double>(num_cells)));
  }
  return CellGrid::over(region, num_cells);
}

std::vector<std::int64_t> weights_by_cell(const Communicator &communicator, const CellGrid &grid,
                                          std::span<const Vec2> points,
                                          std::span<const std::int64_t> weights) {
  std::vector<std::int64_t> sums(static_cast<std::size_t>(grid.num_cells()), 0);
  for (std::size_t i = 0; i < points.size(); ++i) {
    sums[static_cast<std::size_t>(grid.cell_of(points[i]))] += weights[i];
  }
  communicator.sum(sums);
  return sums;
}

bool Balance::is_lost(std::int64_t work) {
  measured_ = imbalance_of(communicator_, work - work_before_);
  work_before_ = work;
  if (measured_ <= tolerated_) {
    return false;
  }
  lost_ += measured_ - 1.0;
  return lost_ > worth_a_map;
}

std::optional<DomainMap> Balance::better_map(std::span<const Vec2> centroids,
                                             std::span<const std::int64_t> weights, PartitionReport &report) {
  lost_ = 0.0;
  const CellGrid grid = lay_grid(communicator_, centroids);
  PartitionReport wanted;
  DomainMap map = partition_cells(grid, weights_by_cell(communicator_, grid, centroids, weights),
                                  communicator_.size(), &wanted, CutEffort::one_try);
  const double now =
      imbalance_of(communicator_, std::accumulate(weights.begin(), weights.end(), std::int64_t{0}));
  if (now < least_gain * wanted.imbalance) {
    tolerated_ = std::max(least_tolerated, least_gain * measured_);
    return std::nullopt;
  }
  std::vector<std::int64_t> in_part(static_cast<std::size_t>(communicator_.size()), 0);
  for (std::size_t i = 0; i < centroids.size(); ++i) {
    in_part[static_cast<std::size_t>(map.rank_of(centroids[i]))] += weights[i];
  }
  std::vector<PartOnRank> mine;
  for (std::int32_t part = 0; part < communicator_.size(); ++part) {
    if (in_part[static_cast<std::size_t>(part)] > 0) {
      mine.push_back({part, communicator_.rank(), in_part[static_cast<std::size_t>(part)]});
    }
  }
  std::vector<PartOnRank> all;
  for (const auto &from_rank : communicator_.all_gather(mine)) {
    all.insert(all.end(), from_rank.begin(), from_rank.end());
  }
  give_parts_to_ranks(map, ranks_of_parts(all, communicator_.size()));
  tolerated_ = least_tolerated;
  report = wanted;
  return map;
}

} // namespace gcpdda
