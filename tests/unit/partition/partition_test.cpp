#include "partition/domain_map.hpp"
#include "partition/partition_cells.hpp"
#include "partition/ranks_of_parts.hpp"

#include "base/check.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <set>
#include <utility>

namespace gcpdda::partition_test {
namespace {

using Weights = std::vector<std::int64_t>;

CellGrid unit_grid(std::int32_t columns, std::int32_t rows) {
  return {{0.0, 0.0}, 1.0, columns, rows};
}

Weights random_weights(std::size_t n, unsigned seed, unsigned percent_occupied, unsigned heaviest) {
  std::mt19937 random(seed);
  Weights weights(n, 0);
  for (std::int64_t &w : weights) {
    const bool occupied = random() % 100 < percent_occupied;
    const auto work = static_cast<std::int64_t>(1 + random() % heaviest);
    w = occupied ? work : 0;
  }
  return weights;
}

// The report is checked against sums made here from the map alone.
PartitionReport recount(const DomainMap &map, const Weights &weights, int num_parts) {
  Weights sums(static_cast<std::size_t>(num_parts), 0);
  PartitionReport report;
  std::int64_t total = 0;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    sums[static_cast<std::size_t>(map.owner[i])] += weights[i];
    total += weights[i];
    const auto columns = static_cast<std::size_t>(map.grid.columns);
    for (const std::size_t j : {i % columns + 1 < columns ? i + 1 : i, i + columns}) {
      if (j < weights.size() && map.owner[i] != map.owner[j] && weights[i] > 0 && weights[j] > 0) {
        report.edge_cut += (weights[i] + weights[j]) / 2;
      }
    }
  }
  report.imbalance = total == 0 ? 1.0
                                : static_cast<double>(*std::max_element(sums.begin(), sums.end())) *
                                      num_parts / static_cast<double>(total);
  report.empty_parts = static_cast<std::int32_t>(std::count(sums.begin(), sums.end(), 0));
  return report;
}

PartitionReport expect_sound(const CellGrid &grid, const Weights &weights, int num_parts) {
  PartitionReport report;
  const DomainMap map = partition_cells(grid, weights, num_parts, &report);
  EXPECT_EQ(map.owner.size(), weights.size());
  for (const std::int32_t owner : map.owner) {
    EXPECT_GE(owner, 0);
    EXPECT_LT(owner, num_parts);
  }
  const PartitionReport counted = recount(map, weights, num_parts);
  EXPECT_DOUBLE_EQ(report.imbalance, counted.imbalance);
  EXPECT_EQ(report.edge_cut, counted.edge_cut);
  EXPECT_EQ(report.empty_parts, counted.empty_parts);
  EXPECT_EQ(map.owner, partition_cells(grid, weights, num_parts).owner) << "not the same twice";
  return report;
}

TEST(CellGrid, CoversTheRegionWithAboutTheNumberAskedFor) {
  for (const Vec2 size : {Vec2{10.0, 10.0}, Vec2{300.0, 20.0}, Vec2{1.0, 1e4}, Vec2{1e-3, 2e-3}}) {
    for (const std::int64_t wanted : {1, 7, 100, 10'000}) {
      const Vec2 low{-5e5, 2e6};
      const CellGrid grid = CellGrid::over({low, low + size}, wanted);
      EXPECT_LE(grid.num_cells(), 2 * wanted + 2);
      EXPECT_GE(2 * grid.num_cells(), wanted);
      EXPECT_GE(grid.columns * grid.cell_size, size.x * (1.0 - 1e-9));
      EXPECT_GE(grid.rows * grid.cell_size, size.y * (1.0 - 1e-9));
    }
  }
  const CellGrid square = CellGrid::over({{0.0, 0.0}, {0.3, 0.3}}, 10'000);
  EXPECT_EQ(square.columns, 100);
  EXPECT_EQ(square.rows, 100);
}

TEST(CellGrid, DegenerateRegionsHaveCellsToo) {
  EXPECT_EQ(CellGrid::over(Aabb{}, 100).num_cells(), 1);
  EXPECT_EQ(CellGrid::over({{3.0, 4.0}, {3.0, 4.0}}, 100).num_cells(), 1);
  const CellGrid line = CellGrid::over({{0.0, 0.0}, {10.0, 0.0}}, 100);
  EXPECT_EQ(line.rows, 1);
  EXPECT_EQ(line.columns, 100);
  EXPECT_THROW(CellGrid::over({{0.0, 0.0}, {1.0, 1.0}}, 0), InternalError);
  EXPECT_THROW(CellGrid::over({{0.0, 0.0}, {std::numeric_limits<double>::infinity(), 1.0}}, 10),
               InternalError);
}

TEST(CellGrid, EveryPointHasACell) {
  const CellGrid grid{{10.0, -2.0}, 0.5, 4, 3};
  EXPECT_EQ(grid.cell_of({10.1, -1.9}), 0);
  EXPECT_EQ(grid.cell_of({10.6, -1.9}), 1);
  EXPECT_EQ(grid.cell_of({10.1, -1.4}), 4);
  EXPECT_EQ(grid.cell_of({12.0, -0.5}), 11) << "the upper corner";
  EXPECT_EQ(grid.cell_of({-1e300, 1e300}), 8);
  constexpr double inf = std::numeric_limits<double>::infinity();
  EXPECT_EQ(grid.cell_of({inf, -inf}), 3);
  EXPECT_EQ(grid.cell_of({std::nan(""), std::nan("")}), 0);
}

TEST(Partition, UniformGridIsBalancedByMetis) {
  const CellGrid grid = unit_grid(100, 100);
  const Weights weights(10'000, 5);
  for (const int parts : {2, 3, 4, 7, 16}) {
    const PartitionReport report = expect_sound(grid, weights, parts);
    EXPECT_TRUE(report.by_metis) << parts;
    EXPECT_LE(report.imbalance, 1.03) << parts;
    EXPECT_EQ(report.empty_parts, 0) << parts;
  }
}

TEST(Partition, BordersAreShort) {
  const Weights weights(10'000, 1);
  PartitionReport halves;
  PartitionReport quarters;
  PartitionReport many;
  partition_cells(unit_grid(100, 100), weights, 2, &halves);
  partition_cells(unit_grid(100, 100), weights, 4, &quarters);
  partition_cells(unit_grid(100, 100), weights, 64, &many);
  EXPECT_LE(halves.edge_cut, 2 * 100);
  EXPECT_LE(quarters.edge_cut, 2 * 200);
  EXPECT_LE(many.edge_cut, 2 * 1400) << "direct k-way cutting with a tight balance scatters: 10,000";
  PartitionReport strip;
  partition_cells(unit_grid(1000, 10), weights, 4, &strip);
  EXPECT_LE(strip.edge_cut, 2 * 30);
}

TEST(Partition, OnePartOwnsAll) {
  const PartitionReport report = expect_sound(unit_grid(50, 40), Weights(2'000, 3), 1);
  EXPECT_EQ(report.imbalance, 1.0);
  EXPECT_EQ(report.edge_cut, 0);
  EXPECT_FALSE(report.by_metis);
}

TEST(Partition, FewCellsAreCutAlongTheCurve) {
  const PartitionReport report = expect_sound(unit_grid(8, 8), Weights(64, 1), 4);
  EXPECT_FALSE(report.by_metis);
  EXPECT_EQ(report.imbalance, 1.0);
  EXPECT_EQ(report.edge_cut, 16) << "a quarter of a Hilbert curve is a quadrant";
}

TEST(Partition, CurveCutIsTheBestContiguousOne) {
  // One row: along it the Hilbert curve of the enclosing square runs from left to right.
  const Weights weights{4, 1, 1, 1, 1, 4, 4, 4};
  PartitionReport report;
  const DomainMap map = partition_cells(unit_grid(8, 1), weights, 3, &report);
  EXPECT_DOUBLE_EQ(report.imbalance, 8.0 * 3 / 20);
  EXPECT_TRUE(std::is_sorted(map.owner.begin(), map.owner.end()));
}

TEST(Partition, DominatingCellDoesNotEmptyOtherParts) {
  Weights weights(10'000, 1);
  weights[5'050] = 1'000'000;
  for (const int parts : {2, 3, 7, 16}) {
    const PartitionReport report = expect_sound(unit_grid(100, 100), weights, parts);
    EXPECT_EQ(report.empty_parts, 0);
    // Alone among three or more parts; with two, the cells on one side of it along the curve must join it.
    const double heaviest = parts == 2 ? 1'005'000.0 : 1'000'001.0;
    EXPECT_LE(report.imbalance, parts * heaviest / 1'009'999.0);
  }
  weights[5'050] = 3'000;
  EXPECT_LE(expect_sound(unit_grid(100, 100), weights, 4).imbalance, 1.03);
}

TEST(Partition, EmptyCellsGoToTheNearestOwner) {
  // Two islands in opposite corners.
  const CellGrid grid = unit_grid(40, 40);
  Weights weights(1'600, 0);
  for (std::size_t r = 0; r < 10; ++r) {
    for (std::size_t c = 0; c < 10; ++c) {
      weights[r * 40 + c] = 1;
      weights[(39 - r) * 40 + 39 - c] = 1;
    }
  }
  const PartitionReport report = expect_sound(grid, weights, 2);
  EXPECT_EQ(report.imbalance, 1.0);
  EXPECT_EQ(report.edge_cut, 0);
  const DomainMap map = partition_cells(grid, weights, 2);
  const int lower_left = map.rank_of({0.5, 0.5});
  EXPECT_EQ(lower_left, 0) << "parts are numbered along the curve";
  EXPECT_EQ(map.rank_of({12.5, 14.5}), lower_left);
  EXPECT_EQ(map.rank_of({-100.0, -100.0}), lower_left);
  EXPECT_EQ(map.rank_of({27.5, 25.5}), 1 - lower_left);
  EXPECT_EQ(map.rank_of({0.5, 39.5}), 0) << "equally far from both: the smaller";
}

TEST(Partition, RandomWeightsAreBalanced) {
  for (const unsigned seed : {1U, 2U, 3U}) {
    for (const int parts : {2, 3, 4, 7, 16}) {
      const Weights weights = random_weights(70 * 130, seed, 60, 1'000);
      const PartitionReport report = expect_sound(unit_grid(130, 70), weights, parts);
      EXPECT_LE(report.imbalance, 1.03);
      EXPECT_EQ(report.empty_parts, 0);
    }
  }
}

// Islands without edges between them: METIS alone would deal them out like cards.
TEST(Partition, SparseCellsStayTogether) {
  const CellGrid grid = unit_grid(100, 100);
  const Weights weights = random_weights(10'000, 5, 10, 20);
  const DomainMap map = partition_cells(grid, weights, 4);
  std::int64_t border = 0;
  for (std::size_t i = 0; i < 9'900; ++i) {
    border += map.owner[i] != map.owner[i + 100] ? 1 : 0;
    border += i % 100 < 99 && map.owner[i] != map.owner[i + 1] ? 1 : 0;
  }
  EXPECT_LE(border, 3 * 200);
  expect_sound(grid, weights, 4);
}

TEST(Partition, MorePartsThanCellsLeavesTheLastOnesEmpty) {
  Weights weights(25, 0);
  weights[3] = 10;
  weights[17] = 1;
  weights[24] = 5;
  const PartitionReport report = expect_sound(unit_grid(5, 5), weights, 7);
  EXPECT_EQ(report.empty_parts, 4);
  EXPECT_DOUBLE_EQ(report.imbalance, 10.0 * 7 / 16);
  const DomainMap map = partition_cells(unit_grid(5, 5), weights, 7);
  EXPECT_EQ((std::set<std::int32_t>{map.owner[3], map.owner[17], map.owner[24]}),
            (std::set<std::int32_t>{0, 1, 2}));
}

TEST(Partition, NoWorkGoesToPartZero) {
  const PartitionReport report = expect_sound(unit_grid(5, 5), Weights(25, 0), 3);
  EXPECT_EQ(report.imbalance, 1.0);
  EXPECT_EQ(report.empty_parts, 3);
  const DomainMap map = partition_cells(unit_grid(5, 5), Weights(25, 0), 3);
  EXPECT_EQ(map.owner, std::vector<std::int32_t>(25, 0));
}

TEST(Partition, HugeWeightsDoNotOverflow) {
  Weights weights = random_weights(6'400, 9, 100, 1'000);
  for (std::int64_t &w : weights) {
    w *= 30'000'000'000;
  }
  EXPECT_LE(expect_sound(unit_grid(80, 80), weights, 4).imbalance, 1.03);
}

TEST(Partition, RefusesWhatItCannotCut) {
  const CellGrid grid = unit_grid(2, 2);
  EXPECT_THROW(partition_cells(grid, Weights{1, 1, 1}, 2), InternalError);
  EXPECT_THROW(partition_cells(grid, Weights{1, 1, 1, -1}, 2), InternalError);
  EXPECT_THROW(partition_cells(grid, Weights{1, 1, 1, 1}, 0), InternalError);
  constexpr std::int64_t huge = std::numeric_limits<std::int64_t>::max();
  EXPECT_THROW(partition_cells(grid, Weights{huge, huge, 1, 1}, 2), InternalError);
}

TEST(RanksOfParts, MostOfTheWorkStays) {
  // METIS calls the part of rank 2 "0", and so on; a little has crossed the borders.
  const std::vector<PartOnRank> held{{0, 2, 90}, {1, 0, 80}, {2, 1, 85}, {0, 0, 10}, {1, 1, 20}, {2, 2, 15}};
  EXPECT_EQ(ranks_of_parts(held, 3), (std::vector<std::int32_t>{2, 0, 1}));
  const std::vector<PartOnRank> turned(held.rbegin(), held.rend());
  EXPECT_EQ(ranks_of_parts(turned, 3), ranks_of_parts(held, 3));
}

TEST(RanksOfParts, GivesEachRankOnePart) {
  // All lies with rank 1, which keeps the largest part; part 3 is nobody's yet.
  const std::vector<PartOnRank> held{{0, 1, 5}, {1, 1, 7}, {2, 1, 6}};
  EXPECT_EQ(ranks_of_parts(held, 4), (std::vector<std::int32_t>{0, 1, 2, 3}));
  EXPECT_EQ(ranks_of_parts({}, 3), (std::vector<std::int32_t>{0, 1, 2}));
  DomainMap map{unit_grid(2, 2), {3, 0, 1, 2}};
  give_parts_to_ranks(map, std::vector<std::int32_t>{2, 3, 0, 1});
  EXPECT_EQ(map.owner, (std::vector<std::int32_t>{1, 2, 3, 0}));
}

TEST(BoxWithoutStrays, LeavesOutTheFarthest) {
  std::vector<Vec2> points;
  for (int i = 0; i < 3000; ++i) {
    points.push_back({1.0 * i, -2.0 * i});
  }
  const Aabb box = box_without_strays(points);
  EXPECT_EQ(box.low, (Vec2{4.0, -2.0 * 2995}));
  EXPECT_EQ(box.high, (Vec2{2995.0, -8.0}));
  points.resize(19);
  EXPECT_EQ(box_without_strays(points).high, (Vec2{18.0, 0.0})) << "few points keep all";
  EXPECT_TRUE(box_without_strays({}).empty());
}

} // namespace
} // namespace gcpdda::partition_test
