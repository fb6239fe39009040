#include "model/block_system.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace gcpdda::row_offsets_test {
namespace {

void expect_offsets(const RowOffsets &offsets, const std::vector<std::uint32_t> &wanted) {
  ASSERT_EQ(offsets.size(), wanted.size());
  for (std::size_t row = 0; row < wanted.size(); ++row) {
    EXPECT_EQ(offsets[row], wanted[row]) << row;
  }
  EXPECT_EQ(offsets.back(), wanted.back());
}

TEST(RowOffsets, TakeNoMemoryWhileTheListIsEmpty) {
  RowOffsets offsets;
  offsets.reserve(1000);
  expect_offsets(offsets, {0});
  for (int row = 0; row < 3; ++row) {
    offsets.push_back(0);
  }
  expect_offsets(offsets, {0, 0, 0, 0});
  EXPECT_EQ(offsets.capacity(), 0U);
  offsets.push_back(2);
  expect_offsets(offsets, {0, 0, 0, 0, 2});
  EXPECT_GE(offsets.capacity(), 1000U) << "room that was asked for before";
  offsets.push_back(2);
  offsets.resize(5);
  expect_offsets(offsets, {0, 0, 0, 0, 2});
  offsets.clear();
  expect_offsets(offsets, {0});
}

TEST(RowOffsets, RowsBehindOneThatGrowsFollow) {
  RowOffsets offsets;
  for (int row = 0; row < 3; ++row) {
    offsets.push_back(0);
  }
  offsets.lengthen(1, 0);
  EXPECT_EQ(offsets.capacity(), 0U);
  offsets.lengthen(1, 2);
  expect_offsets(offsets, {0, 0, 2, 2});
  offsets.lengthen(0, 1);
  offsets.lengthen(1, -2);
  expect_offsets(offsets, {0, 1, 1, 1});
}

/// Free, with a load, free, driven.
BlockSystem four_blocks() {
  BlockSystem system;
  for (std::int64_t id = 0; id < 4; ++id) {
    SceneBlock block;
    block.vertices = {{0.0, 0.0}, {1.0, 0.0}, {0.0, 1.0}};
    block.driven = id == 3;
    if (id == 1) {
      block.loads = {{{0.1, 0.1}, {5.0, 0.0}}};
    }
    append_block(system, BlockId{id}, block, {"rock", 2000.0, 0.0, 0.0});
  }
  system.num_owned = 4;
  return system;
}

TEST(AppliedForces, StandWhereMoreActsThanWeight) {
  BlockSystem system = four_blocks();
  expect_offsets(system.applied_begin, {0, 0, 1, 1, 2});
  system.applied_to(1)->load.u.x = 7.0;
  system.body = {{0.0, -10.0}, {1.0, 0.0}};
  EXPECT_EQ(system.applied_to(2), nullptr);
  const double mass = system.properties[2].mass;
  EXPECT_EQ(applied_forces(system, 2).gravity, (Vec2{0.0, -10.0 * mass}));
  EXPECT_EQ(applied_forces(system, 2).load, (RigidDof{{-mass, 0.0}, 0.0})) << "in the axes of the ground";
  EXPECT_EQ(applied_forces(system, 1).load.u.x, 7.0);

  list_applied(system, true);
  expect_offsets(system.applied_begin, {0, 1, 2, 3, 4});
  EXPECT_EQ(system.applied_to(1)->load.u.x, 7.0) << "it keeps what it has";
  list_applied(system, false);
  expect_offsets(system.applied_begin, {0, 0, 1, 1, 2});
  EXPECT_EQ(system.applied_to(1)->load.u.x, 7.0);
}

} // namespace
} // namespace gcpdda::row_offsets_test
