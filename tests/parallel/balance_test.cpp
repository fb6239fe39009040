// Work stays even while blocks collapse, few blocks move for it, and a stray far away spoils nothing.

#include "simulation/balance.hpp"

#include "partition/partition_cells.hpp"
#include "simulation/simulation.hpp"
#include "support/scenes.hpp"

#include <gtest/gtest.h>

#include <fmt/format.h>

#include <random>

namespace gcpdda::balance_test {
namespace {

/// A grain heap of so many columns and rows on a floor: it flies apart, the farther from the middle the
/// faster, so that it soon lies outside the region it began in.
std::string bursting_heap_toml(int columns, int rows, double duration) {
  std::string toml = testing::rock_toml(duration, duration, "grain0_0");
  toml += testing::block_toml("floor", testing::rectangle({-500.0, -2.0}, {500.0, 0.0}), "fixed = true");
  std::mt19937 random(7);
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const double from_middle = column - 0.3 * columns;
      toml += testing::block_toml(
          fmt::format("grain{}_{}", row, column),
          testing::random_polygon(static_cast<unsigned>(random()), 6, 0.499, {1.0 * column, 0.5 + row}),
          fmt::format("velocity = [{:.6g}, 0, 0]", 0.5 * from_middle));
    }
  }
  return toml;
}

std::int64_t work_of(const Simulation &simulation) {
  return simulation.counters().evaluations + simulation.counters().block_steps;
}

TEST(Balance, StaysEvenInACollapse) {
  const Communicator world = Communicator::world();
  Simulation simulation(world, testing::scene_of(bursting_heap_toml(40, 12, 1.2)));
  std::int64_t before = 0;
  double worst = 1.0;
  while (!simulation.finished()) {
    for (int k = 0; k < 100 && !simulation.finished(); ++k) {
      simulation.step();
    }
    std::int64_t sum = work_of(simulation) - before;
    std::int64_t most = sum;
    before = work_of(simulation);
    world.sum(std::span(&sum, 1));
    world.max(std::span(&most, 1));
    worst = std::max(worst, static_cast<double>(most) * world.size() / static_cast<double>(sum));
  }
  EXPECT_FALSE(simulation.fault().has_value());
  EXPECT_EQ(simulation.counters().rebalances >= 3, world.size() > 1) << simulation.counters().rebalances;
  std::int64_t moved = simulation.counters().migrations;
  world.sum(std::span(&moved, 1));
  // On many ranks a few blocks more or less, and border pairs that both sides count, are a large share.
  const double allowed = world.size() <= 2 ? 1.10 : 1.35;
  EXPECT_LE(worst, allowed) << simulation.counters().rebalances << " maps, " << moved << " blocks moved";
}

// Neither the sweeps of the initial friction nor the ledger's look ahead are of a step.
TEST(Balance, MessagesAreCountedByStepsAlone) {
  const Communicator world = Communicator::world();
  Simulation simulation(world, testing::scene_of(bursting_heap_toml(20, 4, 0.01)));
  EXPECT_EQ(simulation.counters().bytes, 0);
  { const ComingTrial ahead(simulation.state()); }
  EXPECT_EQ(simulation.counters().messages, 0);
  simulation.step();
  EXPECT_EQ(simulation.counters().bytes, simulation.ghosts().bytes_per_update());
  EXPECT_EQ(simulation.counters().messages, simulation.ghosts().messages_per_update());
  EXPECT_EQ(simulation.counters().bytes > 0, world.size() > 1);
}

TEST(Balance, IsLostOnlyBeyondWhatIsTolerated) {
  const Communicator world = Communicator::world();
  Balance balance(world);
  const std::int64_t extra = world.rank() == 0 ? 1 : 0;
  EXPECT_FALSE(balance.is_lost(1000 + 10 * extra));
  EXPECT_EQ(balance.is_lost(2000 + 300 * extra), world.size() > 1) << "counts since the last call";
  EXPECT_FALSE(balance.is_lost(3000 + 300 * extra));
}

// What is a little uneven has to be so for some time before a map is worth its cost.
TEST(Balance, IsLostOnceUnevennessHasCostAMap) {
  const Communicator world = Communicator::world();
  Balance balance(world);
  const std::int64_t share =
      world.rank() == 0 ? 1000 : 1000 - 40 * world.size() / std::max(1, world.size() - 1);
  int looks = 1; // max/mean is 1.042: twice that is more than 0.05
  while (!balance.is_lost(looks * share) && looks < 10) {
    ++looks;
  }
  EXPECT_EQ(looks, world.size() > 1 ? 2 : 10);
}

/// Blocks of this rank: unit places of a band of 8 rows, dealt out in strips, the first to the last rank.
std::vector<Vec2> strip_of_band(const Communicator &world, int columns) {
  std::vector<Vec2> mine;
  for (int i = 0; i < columns; ++i) {
    for (int j = 0; j < 8; ++j) {
      if (i * world.size() / columns == world.size() - 1 - world.rank()) {
        mine.push_back({i + 0.5, j + 0.5});
      }
    }
  }
  return mine;
}

// Even work needs no map. After a map was refused, the same imbalance asks for none.
TEST(Balance, LeavesAloneWhatCannotBeBettered) {
  const Communicator world = Communicator::world();
  const std::vector<Vec2> places = strip_of_band(world, 840); // a multiple of 1, 2, 3, 4 and 7
  const std::vector<std::int64_t> weights(places.size(), 3);
  Balance balance(world);
  PartitionReport report;
  const std::int64_t uneven = world.rank() == 0 ? 1200 : 1000;
  EXPECT_EQ(balance.is_lost(uneven), world.size() > 1);
  EXPECT_FALSE(balance.better_map(places, weights, report).has_value());
  EXPECT_FALSE(balance.is_lost(2 * uneven));
}

// One strip has become a quarter heavier: blocks near borders move, whatever the parts are called.
TEST(Balance, MovesFewBlocks) {
  const Communicator world = Communicator::world();
  const std::vector<Vec2> places = strip_of_band(world, 840);
  const bool heavy = world.rank() == world.size() - 1;
  const std::vector<std::int64_t> weights(places.size(), heavy ? 5 : 4);
  PartitionReport report;
  const auto map = Balance(world).better_map(places, weights, report);
  EXPECT_EQ(map.has_value(), world.size() > 1);
  if (!map) {
    return;
  }
  EXPECT_LE(report.imbalance, 1.01);
  std::int64_t staying = 0;
  for (const Vec2 place : places) {
    staying += map->rank_of(place) == world.rank() ? 1 : 0;
  }
  world.sum(std::span(&staying, 1));
  // Parts as they are numbered, from the left, would move them all.
  EXPECT_GE(static_cast<double>(staying) / (840.0 * 8.0), 0.8);
}

TEST(Balance, StraysDoNotCoarsenTheGrid) {
  const Communicator world = Communicator::world();
  std::vector<Vec2> places = strip_of_band(world, 840);
  const double size = lay_grid(world, places).cell_size;
  places.push_back({1e9, -1e9}); // one of each rank
  const CellGrid grid = lay_grid(world, places);
  EXPECT_LE(std::abs(grid.cell_size / size - 1.0), 0.05);
  EXPECT_EQ(grid.cell_of({1e9, -1e9}), grid.columns - 1) << "in a border cell";
}

} // namespace
} // namespace gcpdda::balance_test
