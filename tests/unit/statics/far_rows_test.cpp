// Which blocks of a square of 30 by 30 are moved when some of them are out of balance.

#include "statics/far_rows.hpp"
#include "support/blocks.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <numeric>
#include <vector>

namespace gcpdda::testing::far_rows_test {
namespace {

constexpr int side = 30;
constexpr int cell = 6; // blocks a side of what is moved together
constexpr double stiffness = 1e3;

class FarBlocks : public ::testing::Test {
protected:
  FarBlocks() : rows_(Communicator::self(), {}) {
    std::vector<std::vector<Vec2>> squares;
    for (int line = 0; line < side; ++line) {
      for (int column = 0; column < side; ++column) {
        const double x = column;
        const double y = line;
        squares.push_back({{x, y}, {x + 1.0, y}, {x + 1.0, y + 1.0}, {x, y + 1.0}});
      }
    }
    system_ = system_of(squares, {});
    rows_.lay(system_, statics::moving_rows(system_));
    system_.pseudo.resize(system_.num_rows());
    boundary_ = statics::BlockMatrices(system_.num_owned, 3);
    for (std::size_t row = 0; row < system_.num_owned; ++row) {
      boundary_.of(row)[0] = stiffness;
    }
  }

  RigidDof &force_at(int column, int line) {
    return system_.contact[static_cast<std::size_t>(line * side + column)].force;
  }
  [[nodiscard]] int num_found(double balanced = 0.0) const {
    const auto found = rows_.find(system_, boundary_, balanced);
    return found ? std::accumulate(found->begin(), found->end(), 0) : 0;
  }

  BlockSystem system_;
  statics::FarRows rows_;
  statics::BlockMatrices boundary_;
};

TEST_F(FarBlocks, MoveWithTheNineSquaresAroundThem) {
  force_at(14, 20).u.x = 1.0;
  const auto found = rows_.find(system_, boundary_, 0.0);
  ASSERT_TRUE(found);
  ASSERT_EQ(found->size(), system_.num_owned);
  for (int line = 0; line < side; ++line) {
    for (int column = 0; column < side; ++column) {
      const bool is_near = std::abs(column / cell - 14 / cell) <= 1 && std::abs(line / cell - 20 / cell) <= 1;
      EXPECT_EQ((*found)[static_cast<std::size_t>(line * side + column)], is_near ? 1 : 0) << column << line;
    }
  }
}

// Where a block has gone counts, not where it came from.
TEST_F(FarBlocks, MoveWithThoseAroundTheirPlace) {
  force_at(0, 0).u.x = 1.0;
  EXPECT_EQ(num_found(), 4 * cell * cell);
  system_.trial[0].u = {14.0, 14.0};
  EXPECT_EQ(num_found(), 9 * cell * cell + 1);
}

TEST_F(FarBlocks, HaveMoreThanAShareOfTheLargestForceOutOfBalance) {
  force_at(0, 0).u.y = 1.0;
  force_at(side - 1, side - 1).u.x = 0.02;
  EXPECT_EQ(num_found(), 4 * cell * cell) << "one of them";
  force_at(side - 1, side - 1).u.x = 0.04;
  EXPECT_EQ(num_found(), 8 * cell * cell) << "both";
  force_at(side - 1, side - 1) = {{}, 0.04 * system_.properties.back().radius};
  EXPECT_EQ(num_found(), 8 * cell * cell) << "a moment at the arm of the radius";
}

TEST_F(FarBlocks, AreThereOnlyBeyondWhatIsBalanced) {
  EXPECT_EQ(num_found(), 0);
  force_at(3, 3).u.x = 1.0;
  EXPECT_EQ(num_found(1.0), 0);
  EXPECT_GT(num_found(0.99), 0);
}

// By more than the largest force of 1, with a point on the circumference of the block.
TEST_F(FarBlocks, LetThoseGoOnWhoseStopWouldBeFelt) {
  force_at(0, 0).u.x = 1.0;
  system_.pseudo[side * side - 1].velocity = {0.0, 0.9e-3, 0.0};
  EXPECT_EQ(num_found(), 4 * cell * cell);
  system_.pseudo[side * side - 1].velocity = {0.0, 1.1e-3, 0.0};
  EXPECT_EQ(num_found(), 4 * cell * cell + 1);
  system_.pseudo[side * side - 1].velocity = {0.0, 0.0, -1.1e-3 / system_.properties.back().radius};
  EXPECT_EQ(num_found(), 4 * cell * cell + 1) << "it turns";
  for (std::size_t row = 0; row < system_.num_owned; ++row) {
    system_.pseudo[row].velocity = {1.1e-3, 0.0, 0.0};
  }
  EXPECT_EQ(num_found(), 0) << "all of them";
}

// Where many are out of balance or what surrounds them is most of the model, all move.
TEST_F(FarBlocks, AreNoneWhereTheyAreManyOrEverywhere) {
  for (const int line : {3, 15, 27}) {
    for (const int column : {3, 15, 27}) {
      force_at(column, line).u.x = 1.0;
    }
  }
  EXPECT_EQ(num_found(), 0) << "everywhere";
  for (int column = 0; column < side; ++column) {
    for (int line = 0; line < side; ++line) {
      force_at(column, line).u.x = line < 4 ? 1.0 : 0.0;
    }
  }
  EXPECT_EQ(num_found(), 0) << "more than a tenth of them";
  for (int column = 0; column < side; ++column) {
    force_at(column, 3).u.x = 0.0;
  }
  EXPECT_GT(num_found(), 0) << "a tenth";
}

} // namespace
} // namespace gcpdda::testing::far_rows_test
