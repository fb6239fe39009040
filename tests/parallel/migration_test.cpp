// Blocks on random walks over the ranks. Every rank walks the whole system along and knows what it must own.

#include "parallel/migration.hpp"

#include "contact/find_pairs.hpp"
#include "parallel/ghosts.hpp"
#include "partition/partition_cells.hpp"
#include "random_blocks.hpp"
#include "simulation/balance.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

namespace gcpdda::migration_test {
namespace {

using testing::bits_of_row;
using testing::hashed;

constexpr std::size_t num_mobile = 60;
constexpr std::size_t num_fixed = 3;
constexpr double region = 20.0;

using Pair = std::pair<std::int64_t, std::int64_t>;

/// Contacts of a step by rule: a ring of partners near and far in id, and the fixed blocks; each lives for a
/// while, again and again.
std::vector<Pair> touching_pairs(int step) {
  std::vector<Pair> pairs;
  const auto n = static_cast<std::int64_t>(num_mobile);
  for (std::int64_t a = 0; a < n; ++a) {
    for (const std::int64_t b : {a + 1, a + 7, a + 31, n + a % static_cast<std::int64_t>(num_fixed)}) {
      const bool lives = hashed(a, b, step / 10) < 0.6;
      if (lives && b < n + static_cast<std::int64_t>(num_fixed)) {
        pairs.emplace_back(a, b);
      }
    }
  }
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  return pairs;
}

/// What a step does to the memory of a pair, old or new: depends on all that went before.
RegionMemory evaluated(RegionMemory memory, const Pair &pair, int step) {
  memory.shear = 1.25 * memory.shear + hashed(pair.first, pair.second, step);
  memory.longest = std::max(memory.longest, hashed(pair.second, pair.first, step));
  memory.slip += 1e-3 * memory.longest;
  memory.position = {hashed(step, pair.first, 1), hashed(step, pair.second, 2)};
  memory.opening = {1e-3 * memory.slip, hashed(step, pair.second, 3)};
  memory.higher_stretch = step % 3;
  memory.law = memory.law < 0 ? static_cast<std::int32_t>(pair.first % 5) : memory.law;
  memory.state = hashed(pair.first, step, 9) < 0.5 ? ContactState::stick : ContactState::slip;
  return memory;
}

bool operator==(const RegionMemory &a, const RegionMemory &b) {
  return a.shear == b.shear && a.longest == b.longest && a.slip == b.slip && a.state == b.state &&
         a.law == b.law && a.opening == b.opening && a.is_same_region(b);
}

using Memories = std::map<Pair, RegionMemory>;

/// The memories of the pairs that touch in this step; `held` says which of them are kept here.
template <class Held> Memories next_memories(const Memories &before, int step, Held &&held) {
  Memories after;
  for (const Pair &pair : touching_pairs(step)) {
    if (held(pair)) {
      const auto old = before.find(pair);
      after[pair] = evaluated(old == before.end() ? RegionMemory{} : old->second, pair, step);
    }
  }
  return after;
}

/// The walk of the whole system and of this rank's part of it.
class Walk {
public:
  Walk(const Communicator &world, DomainMap map)
      : world_(world), map_(std::move(map)),
        whole_(testing::random_system(11, num_mobile, num_fixed, region)), ghosts_(world) {
    mine_ = testing::part_of(whole_, map_, world.rank());
    own_.assign(num_mobile + num_fixed, false);
    note_owned();
  }

  void step(int step) {
    move(step);
    all_ = next_memories(all_, step, [](const Pair &) { return true; });
    held_ = next_memories(held_, step, [&](const Pair &pair) { return touches_owned(pair); });
    ContactMemory memory;
    for (const auto &[pair, region_memory] : held_) {
      const BlockId lower{pair.first};
      const BlockId higher{pair.second};
      memory.others.push_back({lower, higher, region_memory});
      memory.plain.push_back({lower, higher, region_memory});
    }
    std::int64_t leaving = 0;
    for (std::size_t id = 0; id < num_mobile; ++id) {
      leaving += own_[id] && map_.rank_of(whole_.centroid(id)) != world_.rank() ? 1 : 0;
    }
    EXPECT_EQ(migrate(world_, map_, mine_, memory), leaving);
    num_moved_ += leaving;
    expect_what_is_due();
    note_owned();
    take(memory);
    if (step % 3 == 0) { // ghosts of the time between must not hinder the next move
      ghosts_.rebuild(mine_, reach_boxes(mine_, 0.4));
    }
  }

  /// A new map for blocks whose work has changed.
  void rebalance(int step) {
    std::vector<Vec2> centroids;
    std::vector<std::int64_t> weights;
    for (std::size_t row = 0; row < mine_.num_owned; ++row) {
      const std::int64_t id = mine_.properties[row].id.value;
      centroids.push_back(mine_.centroid(row));
      weights.push_back(1 + static_cast<std::int64_t>(100.0 * hashed(id / 10, step, 5)));
    }
    PartitionReport report;
    if (auto map = Balance(world_).better_map(centroids, weights, report)) {
      map_ = std::move(*map);
      ++num_maps_;
    }
  }

  [[nodiscard]] std::int64_t num_moved() const { return num_moved_; }
  [[nodiscard]] int num_maps() const { return num_maps_; }

private:
  [[nodiscard]] bool touches_owned(const Pair &pair) const {
    return own_[static_cast<std::size_t>(pair.first)] || own_[static_cast<std::size_t>(pair.second)];
  }

  // Short hops mostly, a jump now and then; some leave the grid.
  void move(int step) {
    for (std::size_t id = 0; id < num_mobile; ++id) {
      const auto k = static_cast<std::int64_t>(id);
      const double hop = hashed(k, step, 0) < 0.1 ? region : 0.1 * region;
      whole_.displacement[id].u += {hop * (hashed(k, step, 1) - 0.5), hop * (hashed(k, step, 2) - 0.5)};
      const Vec2 strayed = whole_.centroid(id) - Vec2{0.5 * region, 0.5 * region};
      if (norm(strayed) > region) {
        whole_.displacement[id].u -= strayed;
      }
      whole_.acceleration[id].r = hashed(k, step, 3);
      whole_.ledger[id].shear += hashed(k, step, 4);
    }
    for (std::size_t row = 0; row < mine_.num_owned; ++row) {
      const auto id = static_cast<std::size_t>(mine_.properties[row].id.value);
      mine_.displacement[row] = whole_.displacement[id];
      mine_.acceleration[row] = whole_.acceleration[id];
      mine_.ledger[row] = whole_.ledger[id];
    }
  }

  // Exactly the blocks in this rank's cells, by id, nothing else, bit by bit; fixed blocks stay.
  void expect_what_is_due() {
    const BlockSystem due = testing::part_of(whole_, map_, world_.rank());
    EXPECT_EQ(mine_.num_owned, due.num_owned);
    EXPECT_EQ(mine_.num_ghosts, 0U);
    EXPECT_EQ(mine_.num_fixed, num_fixed);
    EXPECT_EQ(mine_.num_rows(), due.num_rows());
    for (std::size_t row = 0; row < std::min(mine_.num_rows(), due.num_rows()); ++row) {
      EXPECT_EQ(bits_of_row(mine_, row), bits_of_row(due, row)) << "row " << row;
    }
  }

  void note_owned() {
    std::fill(own_.begin(), own_.end(), false);
    for (std::size_t row = 0; row < mine_.num_owned; ++row) {
      own_[static_cast<std::size_t>(mine_.properties[row].id.value)] = true;
    }
  }

  // Every contact of an owned block is remembered here; copies agree. The rest is forgotten, as the
  // candidates do.
  void take(const ContactMemory &memory) {
    held_.clear();
    ASSERT_EQ(memory.plain.size(), memory.others.size());
    for (std::size_t k = 0; k < memory.plain.size(); ++k) {
      EXPECT_EQ(memory.plain[k].lower, memory.others[k].lower);
      EXPECT_EQ(memory.plain[k].higher, memory.others[k].higher);
      EXPECT_EQ(memory.plain[k].memory.shear, memory.others[k].memory.shear);
    }
    for (const RegionRecord &record : memory.others) {
      const Pair pair{record.lower.value, record.higher.value};
      const auto due = all_.find(pair);
      EXPECT_TRUE(due != all_.end() && record.memory == due->second)
          << "contact " << pair.first << ", " << pair.second;
      if (touches_owned(pair)) {
        held_[pair] = record.memory;
      }
    }
    for (const auto &[pair, due] : all_) {
      if (touches_owned(pair)) {
        EXPECT_EQ(held_.count(pair), 1U)
            << "contact " << pair.first << ", " << pair.second << " is forgotten";
      }
    }
  }

  Communicator world_;
  DomainMap map_;
  BlockSystem whole_; ///< row is id
  BlockSystem mine_;
  Ghosts ghosts_;
  std::vector<bool> own_;
  Memories all_;
  Memories held_;
  std::int64_t num_moved_ = 0;
  int num_maps_ = 0;
};

enum class Maps { one, many };

void walk(const DomainMap &map, int num_steps, Maps maps = Maps::one) {
  const Communicator world = Communicator::world();
  Walk walk(world, map);
  for (int step = 0; step < num_steps; ++step) {
    SCOPED_TRACE("step " + std::to_string(step));
    if (maps == Maps::many && step % 5 == 4) {
      walk.rebalance(step);
    }
    walk.step(step);
  }
  EXPECT_EQ(walk.num_maps() >= 10, maps == Maps::many && world.size() > 1);
  std::int64_t moved = walk.num_moved();
  world.sum(std::span(&moved, 1));
  EXPECT_EQ(moved >= 1000, world.size() > 1) << moved << " migrations";
}

TEST(Migration, LosesNothingAcrossAQuilt) {
  const int num_ranks = Communicator::world().size();
  const CellGrid grid = CellGrid::over({{0.0, 0.0}, {region, region}}, 36);
  walk(testing::map_of(grid, [&](int i, int j) { return (i + 3 * j) % num_ranks; }), 200);
}

TEST(Migration, LosesNothingBetweenStripsOneOfThemEmpty) {
  const int num_ranks = Communicator::world().size();
  const CellGrid grid = CellGrid::over({{0.0, 0.0}, {region, region}}, 400);
  walk(testing::map_of(grid,
                       [&](int i, int) {
                         const int strip = i * num_ranks / grid.columns;
                         return num_ranks > 2 && strip == 1 ? 2 : strip;
                       }),
       450);
}

TEST(Migration, LosesNothingWhileMapsChange) {
  const CellGrid grid = CellGrid::over({{0.0, 0.0}, {region, region}}, 36);
  walk(testing::map_of(grid, [&](int, int) { return 0; }), 300, Maps::many);
}

// A new map is all that rebalancing needs.
TEST(Migration, ANewMapMovesEverything) {
  const Communicator world = Communicator::world();
  const CellGrid grid = CellGrid::over({{0.0, 0.0}, {region, region}}, 36);
  const BlockSystem whole = testing::random_system(12, num_mobile, num_fixed, region);
  const auto owner = [&](int shift) {
    return testing::map_of(grid, [&, shift](int i, int j) { return (i + j + shift) % world.size(); });
  };
  BlockSystem mine = testing::part_of(whole, owner(0), world.rank());
  for (int shift = 1; shift <= world.size(); ++shift) {
    const auto before = static_cast<std::int64_t>(mine.num_owned);
    ContactMemory memory;
    EXPECT_EQ(migrate(world, owner(shift), mine, memory), world.size() > 1 ? before : 0);
    EXPECT_TRUE(memory.plain.empty() && memory.others.empty());
  }
  const BlockSystem due = testing::part_of(whole, owner(0), world.rank());
  EXPECT_EQ(mine.num_rows(), due.num_rows());
  for (std::size_t row = 0; row < std::min(mine.num_rows(), due.num_rows()); ++row) {
    EXPECT_EQ(bits_of_row(mine, row), bits_of_row(due, row));
  }
}

} // namespace
} // namespace gcpdda::migration_test
