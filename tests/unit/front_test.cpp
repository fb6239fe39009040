// Blocks that move while contacts are still evaluated: each only once its own are added.

#include "support/blocks.hpp"
#include "support/scenes.hpp"

#include "gcpdda/contact/contact_forces.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace gcpdda::front_test {
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

/// Where evaluation and blocks have come to.
struct Progress {
  std::size_t predicted = 0;
  std::size_t moved = 0;
  std::size_t moved_early = 0; ///< while some rows had no trial configuration yet
  std::vector<BlockContactSum> sums;
};

Front front_of(BlockSystem &system, ContactForces &forces, Progress &progress) {
  return {[&](std::size_t end) {
            EXPECT_LE(end, system.num_owned);
            if (end > progress.predicted) {
              forces.begin_rows(system, progress.predicted, end);
              progress.predicted = end;
            }
          },
          [&](std::size_t end) {
            EXPECT_LE(end, progress.predicted) << "no block moves on before it is predicted";
            EXPECT_GE(end, progress.moved);
            progress.moved_early += progress.predicted < system.num_owned ? end - progress.moved : 0;
            for (; progress.moved < end; ++progress.moved) {
              progress.sums.push_back(forces.sums().of_blocks()[progress.moved]);
            }
          }};
}

Progress evaluate(BlockSystem system) {
  ContactForces forces({one_law(1e6, 0.3), 0.1, PotentialKind::exact});
  ContactHistory history;
  const auto pairs = find_pairs(system, reach_boxes(system, 0.1));
  const Candidates candidates = make_candidates(system, pairs, forces.parameters(), {}, history, 0.1);
  EXPECT_GT(candidates.plain.back().group(), 0U);
  Progress progress;
  forces.evaluate_interior(system, candidates, history, front_of(system, forces, progress));
  EXPECT_EQ(progress.predicted, system.num_owned);
  EXPECT_EQ(progress.moved, system.num_owned);
  forces.evaluate_border(system, candidates, history);
  forces.finish_sums(system, candidates);
  std::size_t loaded = 0;
  for (std::size_t row = 0; row < system.num_owned; ++row) {
    EXPECT_EQ(progress.sums[row].force, forces.sums().of_blocks()[row].force);
    loaded += progress.sums[row].force == RigidDof{} ? 0 : 1;
  }
  EXPECT_GT(loaded, system.num_owned / 2);
  return progress;
}

TEST(Front, LeavesBlocksBehindWhoseContactsAreAdded) {
  const BlockSystem system = row_of_squares(3000, rectangle({-5.0, -3.0}, {0.0, 3.0}));
  EXPECT_GT(evaluate(system).moved_early, system.num_owned / 4);
}

// Its pairs come first, in several groups, and its row is behind all others.
TEST(Front, WaitsBehindAFixedBlockOfTheLowestId) {
  BlockSystem system = row_of_squares(3000, rectangle({-5.0, -3.0}, {3005.0, 1e-3}));
  for (std::size_t row = 0; row < system.num_owned; ++row) {
    system.properties[row].id = BlockId{static_cast<std::int64_t>(row) + 1};
  }
  system.properties.back().id = BlockId{0};
  evaluate(system);
}

} // namespace
} // namespace gcpdda::front_test
