// Groups of pairs: which rows each reads, and which rows may be advanced while later groups are evaluated.

#include "contact/contact_forces.hpp"
#include "contact/find_pairs.hpp"
#include "support/blocks.hpp"
#include "support/scenes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace gcpdda::pair_groups_test {
namespace {

using namespace testing;

/// Squares in a row that overlap a little, but every fifth one high above the others, and all of the last
/// hundred. The fixed block has the highest id.
BlockSystem row_of_squares(int count, const std::vector<Vec2> &fixed) {
  std::vector<std::vector<Vec2>> squares;
  for (int k = 0; k < count; ++k) {
    const bool is_alone = k % 5 == 4 || k >= count - 100;
    const Vec2 low{0.999 * k, is_alone ? 10.0 + 2.0 * (k % 7) : 0.0};
    squares.push_back(rectangle(low, low + Vec2{1.0, 1.0}));
  }
  return system_of(squares, {fixed});
}

/// Every owned row of pairs up to the end of a group is below its rows_read, and none of a later pair is
/// below its rows_finished.
void expect_rows_of(const PairGroup &group, const Candidates &candidates, std::size_t num_owned) {
  const std::size_t end = (std::size_t{group.number} + 1) * PlainPair::pairs_in_group;
  for (std::size_t k = 0; k < candidates.pairs.size(); ++k) {
    for (const BlockIndex row : {candidates.pairs[k].lower, candidates.pairs[k].higher}) {
      if (row.value < num_owned && k < end) {
        EXPECT_LT(row.value, group.rows_read);
      } else if (row.value < num_owned) {
        EXPECT_GE(row.value, group.rows_finished);
      }
    }
  }
}

/// @return number of rows that are finished while some rows have not begun
std::size_t evaluate_by_groups(BlockSystem system) {
  ContactForces forces({one_law(1e6, 0.3), 0.1, PotentialKind::exact});
  ContactHistory history;
  const auto pairs = find_pairs(system, reach_boxes(system, 0.1));
  const Candidates candidates = make_candidates(system, pairs, forces.parameters(), {}, history, 0.1);
  EXPECT_GT(candidates.plain.back().group(), 0U);
  std::size_t begun = 0;
  std::size_t finished_early = 0;
  std::vector<BlockContactSum> sums;
  forces.begin(system, candidates);
  for (const PairGroup &group : candidates.groups) {
    expect_rows_of(group, candidates, system.num_owned);
    EXPECT_GE(group.rows_read, begun);
    EXPECT_LE(group.rows_read, system.num_owned);
    forces.begin_rows(system, begun, group.rows_read);
    begun = group.rows_read;
    forces.evaluate_group(system, candidates, history, group);
    EXPECT_LE(group.rows_finished, begun) << "no row is finished before it has begun";
    EXPECT_GE(group.rows_finished, sums.size());
    finished_early += begun < system.num_owned ? group.rows_finished - sums.size() : 0;
    while (sums.size() < group.rows_finished) {
      sums.push_back(forces.sums().of_blocks()[sums.size()]);
    }
  }
  EXPECT_EQ(begun, system.num_owned);
  EXPECT_EQ(sums.size(), system.num_owned);
  forces.evaluate_border(system, candidates, history);
  forces.finish_sums(system, candidates);
  std::size_t loaded = 0;
  for (std::size_t row = 0; row < system.num_owned; ++row) {
    EXPECT_EQ(sums[row].force, forces.sums().of_blocks()[row].force);
    loaded += sums[row].force == RigidDof{} ? 0 : 1;
  }
  EXPECT_GT(loaded, system.num_owned / 2);
  return finished_early;
}

TEST(PairGroups, FinishRowsWhileLaterOnesHaveNotBegun) {
  const BlockSystem system = row_of_squares(3000, rectangle({-5.0, -3.0}, {0.0, 3.0}));
  EXPECT_GT(evaluate_by_groups(system), system.num_owned / 4);
}

// Its pairs come first, in several groups, and its row is behind all others.
TEST(PairGroups, FinishNoRowWhileAFixedBlockOfTheLowestIdHasPairs) {
  BlockSystem system = row_of_squares(3000, rectangle({-5.0, -3.0}, {3005.0, 1e-3}));
  for (std::size_t row = 0; row < system.num_owned; ++row) {
    system.properties[row].id = BlockId{static_cast<std::int64_t>(row) + 1};
  }
  system.properties.back().id = BlockId{0};
  evaluate_by_groups(system);
}

} // namespace
} // namespace gcpdda::pair_groups_test
