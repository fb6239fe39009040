// Who is seen by whom, against all pairs. Every rank builds the same whole system from a seed, keeps its part
// of it, and checks its ghosts against the whole.

#include "parallel/ghosts.hpp"

#include "contact/candidates.hpp"
#include "contact/find_pairs.hpp"
#include "random_blocks.hpp"

#include <gtest/gtest.h>

#include <map>
#include <set>
#include <string>

namespace gcpdda::ghosts_test {
namespace {

using testing::bits_of_row;
using testing::map_of;

constexpr int num_mobile = 150;
constexpr int num_fixed = 12;
constexpr double region = 100.0;
constexpr double skin = 0.4;

/// One way to hand the cells to the ranks, fair or not.
struct Pattern {
  std::string name;
  DomainMap map;
};

std::vector<Pattern> patterns(int num_ranks) {
  // The grid covers a part of the blocks only: the others belong to border cells.
  const CellGrid coarse = CellGrid::over({{20.0, 10.0}, {90.0, 95.0}}, 64);
  const CellGrid fine = CellGrid::over({{0.0, 0.0}, {region, region}}, 4000);
  const CellGrid single = CellGrid::over({{0.0, 0.0}, {region, region}}, 1);
  std::vector<Pattern> all;
  for (const auto &[size, grid] : {std::pair("coarse", coarse), std::pair("fine", fine)}) {
    const CellGrid cells = grid;
    const auto add = [&, which = std::string(size)](const std::string &name, const auto &owner) {
      all.push_back({which + " " + name, map_of(cells, owner)});
    };
    add("checkerboard", [=](int i, int j) { return (i + j) % num_ranks; });
    add("random", [=](int i, int j) { return static_cast<int>(testing::hashed(i, j, 5) * num_ranks); });
    add("strips", [=](int i, int) { return i * num_ranks / cells.columns; });
    add("alternating rows", [=](int, int j) { return j % num_ranks; });
    add("first rank empty",
        [=](int i, int j) { return num_ranks == 1 ? 0 : 1 + (i + j) % std::max(1, num_ranks - 1); });
  }
  all.push_back({"all on the last rank", map_of(single, [=](int, int) { return num_ranks - 1; })});
  return all;
}

/// A part of a system with its ghosts, and the whole it came from.
struct Case {
  Case(const Communicator &world, const DomainMap &domain_map, unsigned seed)
      : whole(testing::random_system(seed, num_mobile, num_fixed, region)), boxes(reach_boxes(whole, skin)),
        map(domain_map), mine(testing::part_of(whole, map, world.rank())), num_owned(mine.num_owned),
        ghosts(world) {
    ghosts.rebuild(mine, reach_boxes(mine, skin), {}, &map);
  }

  [[nodiscard]] int owner(std::size_t id) const { return map.rank_of(whole.centroid(id)); }
  [[nodiscard]] std::size_t id_of(std::size_t row) const {
    return static_cast<std::size_t>(mine.properties[row].id.value);
  }
  [[nodiscard]] std::set<std::size_t> ghost_ids() const {
    std::set<std::size_t> ids;
    for (std::size_t row = mine.num_owned; row < mine.first_fixed(); ++row) {
      ids.insert(id_of(row));
    }
    return ids;
  }

  BlockSystem whole;
  std::vector<Aabb> boxes; ///< of the whole; row is id
  DomainMap map;
  BlockSystem mine;
  std::size_t num_owned; ///< before the ghosts came
  Ghosts ghosts;
};

// The requirement itself: two reach boxes that meet, on two ranks.
void expect_all_that_meet(const Case &c, int rank) {
  const std::set<std::size_t> ghosts = c.ghost_ids();
  for (std::size_t a = 0; a < num_mobile; ++a) {
    for (std::size_t b = 0; b < num_mobile; ++b) {
      if (c.owner(a) == rank && c.owner(b) != rank && c.boxes[a].meets(c.boxes[b])) {
        EXPECT_TRUE(ghosts.count(b) == 1) << "block " << b << " is no ghost beside block " << a;
      }
    }
  }
}

// And no more than the header promises: boxes of a cell's blocks are published as one.
void expect_no_superfluous(const Case &c, int rank) {
  std::map<std::int64_t, Aabb> of_cell;
  const BlockSystem part = testing::part_of(c.whole, c.map, rank);
  std::vector<RankReach> ranks;
  for (int r = 0; r < Communicator::world().size(); ++r) {
    const BlockSystem of_rank = testing::part_of(c.whole, c.map, r);
    const std::vector<Aabb> its_boxes = reach_boxes(of_rank, skin);
    ranks.push_back(reach_of_rank(of_rank, std::span(its_boxes).first(of_rank.num_owned)));
  }
  const std::vector<Aabb> boxes = reach_boxes(part, skin);
  const std::vector<std::uint32_t> near =
      rows_near_others(std::span(boxes).first(part.num_owned), ranks, static_cast<std::size_t>(rank), &c.map);
  const CellGrid grid = publishing_grid(part, boxes, near);
  for (std::size_t a = 0; a < num_mobile; ++a) {
    if (c.owner(a) == rank) {
      of_cell[grid.cell_of(c.whole.centroid(a))].include(c.boxes[a]);
    }
  }
  for (const std::size_t ghost : c.ghost_ids()) {
    bool met = false;
    for (const auto &[cell, box] : of_cell) {
      met = met || box.meets(c.boxes[ghost]);
    }
    EXPECT_TRUE(met) << "block " << ghost << " meets no box of this rank";
  }
}

void expect_rows_in_order(const Case &c, int rank) {
  const BlockSystem &s = c.mine;
  EXPECT_EQ(s.num_owned, c.num_owned);
  EXPECT_EQ(s.num_fixed, static_cast<std::size_t>(num_fixed));
  EXPECT_EQ(s.num_rows(), s.num_owned + s.num_ghosts + s.num_fixed);
  EXPECT_EQ(c.ghost_ids().size(), s.num_ghosts) << "a ghost stands there twice";
  for (std::size_t row = 0; row < s.num_rows(); ++row) {
    const bool starts_range = row == 0 || row == s.num_owned || row == s.first_fixed();
    EXPECT_TRUE(starts_range || c.id_of(row - 1) < c.id_of(row));
    EXPECT_EQ(s.is_fixed(row), c.id_of(row) >= num_mobile);
    if (!s.is_fixed(row)) {
      EXPECT_EQ(c.owner(c.id_of(row)) == rank, row < s.num_owned);
    }
  }
}

void expect_bits_of_whole(const Case &c) {
  for (std::size_t row = 0; row < c.mine.num_rows(); ++row) {
    EXPECT_EQ(bits_of_row(c.mine, row), bits_of_row(c.whole, c.id_of(row))) << "block " << c.id_of(row);
  }
}

TEST(Ghosts, AreAllBlocksWhoseReachMeetsOurs) {
  const Communicator world = Communicator::world();
  std::int64_t num_ghosts = 0;
  for (const Pattern &pattern : patterns(world.size())) {
    for (const unsigned seed : {1U, 2U, 3U}) {
      SCOPED_TRACE(pattern.name + ", seed " + std::to_string(seed));
      const Case c(world, pattern.map, seed);
      expect_all_that_meet(c, world.rank());
      expect_no_superfluous(c, world.rank());
      expect_rows_in_order(c, world.rank());
      expect_bits_of_whole(c);
      num_ghosts += static_cast<std::int64_t>(c.mine.num_ghosts);
    }
  }
  world.sum(std::span(&num_ghosts, 1));
  EXPECT_EQ(num_ghosts > 1000, world.size() > 1) << num_ghosts;
}

// One box per rank would make every block a ghost of every rank.
TEST(Ghosts, OneHugeBlockDoesNotInflateOtherHalos) {
  const Communicator world = Communicator::world();
  const CellGrid grid = CellGrid::over({{0.0, 0.0}, {region, region}}, 4000);
  const Case c(world, map_of(grid, [&](int i, int) { return i * world.size() / grid.columns; }), 4);
  const int owner_of_huge = c.owner(0);
  if (world.rank() != owner_of_huge) {
    EXPECT_EQ(c.ghost_ids().count(0), c.num_owned > 0 ? 1U : 0U);
    EXPECT_LT(c.mine.num_ghosts, static_cast<std::size_t>(num_mobile) - c.num_owned)
        << "everything is a ghost here";
  }
}

// Motion of a block in a round, the same on every rank.
RigidDof moved(std::size_t id, int round) {
  const auto number = [&](int which) {
    return testing::hashed(static_cast<std::int64_t>(id), round, which) - 0.5;
  };
  return {{number(0), number(1)}, number(2)};
}

/// Gradient of a deformable block in a round.
Mat2 stretched(std::size_t id, int round) {
  const auto number = [&](int which) {
    return 0.1 * testing::hashed(static_cast<std::int64_t>(id), round, which);
  };
  return {1.0 + number(3), number(4), number(5), 1.0 + number(6)};
}

void begin(Case &c) {
  std::vector<TrialConfiguration> trials;
  for (const std::uint32_t row : c.ghosts.sent_rows()) {
    trials.push_back(
        {c.mine.trial[row], c.mine.is_deformable(row) ? c.mine.deformation_of(row).trial : Mat2{}});
  }
  c.ghosts.begin(c.mine, trials);
}

void update(Case &c) {
  begin(c);
  c.ghosts.finish(c.mine);
}

TEST(Ghosts, UpdateBringsTheTrialAndKeepsTheOldOne) {
  const Communicator world = Communicator::world();
  const CellGrid grid = CellGrid::over({{0.0, 0.0}, {region, region}}, 400);
  Case c(world, map_of(grid, [&](int i, int j) { return (i + j) % world.size(); }), 5);
  std::mt19937_64 random(17);
  pose(c.whole, 0, c.whole.num_rows());
  for (int round = 0; round < 20; ++round) {
    SCOPED_TRACE("round " + std::to_string(round));
    for (std::size_t id = 0; id < num_mobile; ++id) { // every rank moves the whole
      set_trial(c.whole, id, {moved(id, round), stretched(id, round)});
      c.whole.velocity[id] = testing::any_bits(random);
      if (c.whole.is_deformable(id)) {
        c.whole.deformation_of(id).rate = 1e3 * stretched(id, round + 1000);
      }
    }
    pose(c.whole, 0, c.whole.num_rows());
    for (std::size_t row = 0; row < c.mine.num_owned; ++row) { // and what it owns
      c.mine.trial[row] = c.whole.trial[c.id_of(row)];
      c.mine.velocity[row] = c.whole.velocity[c.id_of(row)];
      if (c.mine.is_deformable(row)) {
        c.mine.deformation_of(row) = c.whole.deformation_of(c.id_of(row));
      }
    }
    pose(c.mine, 0, c.mine.num_owned);
    update(c);
    expect_bits_of_whole(c);
    for (std::size_t row = c.mine.num_owned; row < c.mine.first_fixed(); ++row) {
      const std::size_t id = c.id_of(row);
      EXPECT_EQ(c.mine.motion[row].increment(), c.whole.motion[id].increment());
      if (c.mine.is_deformable(row)) {
        EXPECT_EQ(c.mine.gradient_increment(row), c.whole.gradient_increment(id));
      }
      EXPECT_EQ(c.mine.motion[row].centroid, c.whole.motion[id].centroid);
      EXPECT_EQ(c.mine.motion[row].box.low, c.whole.motion[id].box.low);
      EXPECT_EQ(c.mine.motion[row].box.high, c.whole.motion[id].box.high);
      EXPECT_EQ(TrialOutline(c.mine, row).vertex, TrialOutline(c.whole, id).vertex);
      EXPECT_EQ(TrialOutline(c.mine, row).normal, TrialOutline(c.whole, id).normal);
    }
  }
  EXPECT_LE(c.ghosts.messages_per_update(), world.size() - 1) << "one message a neighbour";
  EXPECT_EQ(c.ghosts.bytes_per_update() > 0, world.size() > 1);
}

TEST(Ghosts, CopyBringsTheOwnersEntries) {
  const Communicator world = Communicator::world();
  const CellGrid grid = CellGrid::over({{0.0, 0.0}, {region, region}}, 400);
  Case c(world, map_of(grid, [&](int i, int j) { return (i + 2 * j) % world.size(); }), 6);
  struct Entry {
    double real = -1.0;
    std::int32_t whole = -1;
  };
  std::vector<Entry> entries(c.mine.num_rows());
  for (std::size_t row = 0; row < c.mine.num_owned; ++row) {
    entries[row] = {std::sqrt(static_cast<double>(c.id_of(row))), static_cast<std::int32_t>(c.id_of(row))};
  }
  c.ghosts.copy(entries);
  for (std::size_t row = 0; row < c.mine.num_rows(); ++row) {
    const bool fixed = c.mine.is_fixed(row); // nobody's to send
    EXPECT_EQ(entries[row].real, fixed ? -1.0 : std::sqrt(static_cast<double>(c.id_of(row))));
    EXPECT_EQ(entries[row].whole, fixed ? -1 : static_cast<std::int32_t>(c.id_of(row)));
  }
}

TEST(Ghosts, AreRebuiltFromOwnedBlocksAlone) {
  const Communicator world = Communicator::world();
  const CellGrid grid = CellGrid::over({{0.0, 0.0}, {region, region}}, 400);
  const DomainMap map = map_of(grid, [&](int i, int j) { return (i + j) % world.size(); });
  Case c(world, map, 7);
  const std::set<std::size_t> before = c.ghost_ids();
  c.mine = testing::part_of(c.whole, map, world.rank());
  c.ghosts.rebuild(c.mine, reach_boxes(c.mine, skin)); // a second time, with the plan of the first
  EXPECT_EQ(c.ghost_ids(), before);
  expect_bits_of_whole(c);
  update(c);
  for (std::size_t row = 0; row < c.mine.num_mobile(); ++row) {
    EXPECT_EQ(c.mine.trial[row], c.whole.trial[c.id_of(row)]);
  }
}

// Between begin and finish ghosts are as they were, and other messages may pass.
TEST(Ghosts, AreOldUntilTheUpdateIsFinished) {
  const Communicator world = Communicator::world();
  const CellGrid grid = CellGrid::over({{0.0, 0.0}, {region, region}}, 400);
  Case c(world, map_of(grid, [&](int i, int j) { return (i + j) % world.size(); }), 8);
  const std::vector<RigidDof> before = c.mine.trial;
  for (std::size_t row = 0; row < c.mine.num_owned; ++row) {
    c.mine.trial[row] = moved(c.id_of(row), 3);
  }
  begin(c);
  std::vector<std::int64_t> ids(c.mine.num_rows(), -1);
  for (std::size_t row = 0; row < c.mine.num_owned; ++row) {
    ids[row] = c.mine.properties[row].id.value;
  }
  c.ghosts.copy(ids);
  for (std::size_t row = c.mine.num_owned; row < c.mine.num_mobile(); ++row) {
    EXPECT_EQ(c.mine.trial[row], before[row]);
    EXPECT_EQ(ids[row], c.mine.properties[row].id.value);
  }
  c.ghosts.finish(c.mine);
  for (std::size_t row = c.mine.num_owned; row < c.mine.num_mobile(); ++row) {
    EXPECT_EQ(c.mine.trial[row], moved(c.id_of(row), 3));
    EXPECT_EQ(c.mine.motion[row].increment(), moved(c.id_of(row), 3) - before[row]);
  }
}

} // namespace
} // namespace gcpdda::ghosts_test
