#include "model/generators.hpp"

#include "geometry/polygon.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <utility>
#include <vector>

namespace gcpdda::generators_test {
namespace {

using Kind = BrickGenerator::Kind;

BrickGenerator wall(std::int64_t rows, std::int64_t columns, double bond, double gap = 0.0) {
  return {Kind::wall, "w", 0, {0.3, -0.7}, rows, columns, {0.4, 0.2}, bond, gap, {"s.toml", 5, 1}};
}

BrickGenerator pyramid(std::int64_t rows, double gap = 0.0) {
  return {Kind::pyramid, "p", 1, {0.3, -0.7}, rows, 1, {0.4, 0.2}, 0.5, gap, {"s.toml", 9, 1}};
}

std::vector<SceneBlock> all_blocks(const BrickGenerator &generator) {
  std::vector<SceneBlock> blocks;
  for (std::int64_t i = 0; i < num_blocks(generator); ++i) {
    blocks.push_back(make_block(generator, i));
  }
  return blocks;
}

/// Left and right ends of the bricks of each row, by the row's bottom.
std::map<double, std::vector<std::pair<double, double>>> rows_of(const std::vector<SceneBlock> &blocks) {
  std::map<double, std::vector<std::pair<double, double>>> rows;
  for (const SceneBlock &block : blocks) {
    rows[block.vertices[0].y].emplace_back(block.vertices[0].x, block.vertices[1].x);
  }
  return rows;
}

double area_of(const std::vector<SceneBlock> &blocks) {
  double area = 0.0;
  for (const SceneBlock &block : blocks) {
    EXPECT_GT(signed_area(block.vertices), 0.0) << block.name;
    area += signed_area(block.vertices);
  }
  return area;
}

TEST(Generators, CountTheirBlocks) {
  EXPECT_EQ(num_blocks(pyramid(100)), 5050);
  EXPECT_EQ(num_blocks(pyramid(1)), 1);
  EXPECT_EQ(num_blocks(wall(5, 10, 0.5)), 52) << "rows 1 and 3 have a brick more";
  EXPECT_EQ(num_blocks(wall(5, 10, 0.0)), 50);
  EXPECT_EQ(num_blocks(wall(1, 1, 0.5)), 1);
  EXPECT_EQ(num_blocks(pyramid(1'000'000)), 500'000'500'000);
  EXPECT_EQ(num_blocks(wall(1'000'000, 1'000'000, 0.5)), 1'000'000'500'000);
}

TEST(Generators, WallsWithoutGapsAreTiledBitForBit) {
  for (const double bond : {0.0, 0.1, 1.0 / 3.0, 0.5, 0.9}) {
    const BrickGenerator generator = wall(7, 13, bond);
    const auto blocks = all_blocks(generator);
    const auto rows = rows_of(blocks);
    ASSERT_EQ(rows.size(), 7U);
    const auto &[left, right] =
        std::pair(rows.begin()->second.front().first, rows.begin()->second.back().second);
    EXPECT_NEAR(right - left, 13 * 0.4, 1e-14);
    for (const auto &[bottom, row] : rows) {
      EXPECT_EQ(row.front().first, left) << "the ends are straight";
      EXPECT_EQ(row.back().second, right);
      for (std::size_t i = 0; i + 1 < row.size(); ++i) {
        EXPECT_EQ(row[i].second, row[i + 1].first) << "neighbours share an edge";
      }
    }
    for (std::size_t i = 0; i < blocks.size(); ++i) {
      const double top = blocks[i].vertices[2].y;
      EXPECT_TRUE(rows.contains(top) || blocks[i].vertices[0].y == rows.rbegin()->first) << "rows meet";
    }
    EXPECT_NEAR(area_of(blocks), 7 * 0.2 * 13 * 0.4, 1e-13);
  }
}

TEST(Generators, RowsWithGapsNeitherOverlapNorLeaveTheWall) {
  for (const double bond : {0.25, 0.5}) {
    const auto rows = rows_of(all_blocks(wall(4, 6, bond, 0.03)));
    const double right = rows.begin()->second.back().second;
    for (const auto &[bottom, row] : rows) {
      EXPECT_EQ(row.front().first, 0.3);
      EXPECT_EQ(row.back().second, right);
      for (std::size_t i = 0; i + 1 < row.size(); ++i) {
        EXPECT_NEAR(row[i + 1].first - row[i].second, 0.03, 1e-15);
      }
    }
  }
}

TEST(Generators, BondShiftsTheJointsOfEverySecondRow) {
  const auto rows = rows_of(all_blocks(wall(2, 3, 0.25)));
  const auto &odd = rows.rbegin()->second;
  ASSERT_EQ(odd.size(), 4U);
  EXPECT_NEAR(odd[0].second - odd[0].first, 0.1, 1e-15);
  EXPECT_NEAR(odd[1].second - odd[1].first, 0.4, 1e-15);
  EXPECT_NEAR(odd[3].second - odd[3].first, 0.3, 1e-15);
}

TEST(Generators, PyramidsLoseHalfABrickAtEachEndOfEachRow) {
  for (const double gap : {0.0, 0.05}) {
    const auto rows = rows_of(all_blocks(pyramid(9, gap)));
    ASSERT_EQ(rows.size(), 9U);
    std::size_t bricks = 9;
    double left = 0.3;
    for (const auto &[bottom, row] : rows) {
      EXPECT_EQ(row.size(), bricks--);
      EXPECT_NEAR(row.front().first, left, 1e-14);
      left += 0.5 * (0.4 + gap);
      for (std::size_t i = 0; i + 1 < row.size(); ++i) {
        EXPECT_NEAR(row[i + 1].first - row[i].second, gap, 1e-14);
        EXPECT_TRUE(gap > 0.0 || row[i + 1].first == row[i].second);
      }
    }
  }
}

Scene mixed_scene() {
  Scene scene;
  scene.blocks.resize(2);
  scene.blocks[0].name = "b0";
  scene.blocks[1].name = "floor";
  scene.generators = {pyramid(4), wall(3, 2, 0.5), wall(2, 2, 0.0)};
  scene.generators[2].name = "w.0";
  scene.block_file = {"blocks.h5", 5, {"s.toml", 20, 8}};
  return scene;
}

TEST(Generators, NamesAndIdsLeadToEachOther) {
  const Scene scene = mixed_scene();
  ASSERT_EQ(num_blocks(scene), 2 + 10 + 7 + 4 + 5);
  std::set<std::string> names;
  for (std::int64_t id = 0; id < num_blocks(scene); ++id) {
    const std::string name = block_name(scene, id);
    EXPECT_TRUE(names.insert(name).second) << name;
    EXPECT_EQ(find_generated_block(scene, name), id < 2 ? -1 : id) << name;
  }
  EXPECT_EQ(block_name(scene, 1), "floor");
  EXPECT_EQ(block_name(scene, 2), "p.0.0");
  EXPECT_EQ(block_name(scene, 6), "p.1.0");
  EXPECT_EQ(block_name(scene, 11), "p.3.0");
  EXPECT_EQ(block_name(scene, 16), "w.1.2");
  EXPECT_EQ(block_name(scene, 22), "w.0.1.1");
  EXPECT_EQ(block_name(scene, 23), "b23");
  EXPECT_EQ(block_position(scene, 2).line, 9);
  EXPECT_EQ(block_position(scene, 12).line, 5);
  EXPECT_EQ(block_position(scene, 25).file, "blocks.h5, block 2");
}

TEST(Generators, FindNothingByOtherNames) {
  const Scene scene = mixed_scene();
  for (const char *name : {"",       "p",       "p.",    "p.0",    "p.0.",
                           "p..0",   "p.0.4",   "p.4.0", "p.00.0", "p.0.+1",
                           "p.0.-1", "p.0.0.0", "w.0.2", "w.1.3",  "p.0.99999999999999999999",
                           "b22",    "b28",     "b023",  "b",      "b2 3",
                           "x.0.0"}) {
    EXPECT_EQ(find_generated_block(scene, name), -1) << name;
  }
  Scene unknown = mixed_scene();
  unknown.block_file.num_blocks = 0;
  EXPECT_EQ(find_generated_block(unknown, "b1000000"), 1'000'000);
}

TEST(Generators, AnyBrickIsMadeFromItsNumberAlone) {
  for (const BrickGenerator &generator : {wall(1'000'000, 1'001, 0.5), pyramid(1'000'000)}) {
    Scene scene;
    scene.generators = {generator};
    for (const std::int64_t index : {std::int64_t{0}, std::int64_t{123'456'789}, num_blocks(generator) - 1}) {
      const SceneBlock block = make_block(generator, index);
      EXPECT_EQ(find_generated_block(scene, block.name), index);
      EXPECT_EQ(block.material, generator.material);
      EXPECT_NEAR(block.vertices[2].y - block.vertices[0].y, 0.2, 1e-9);
    }
  }
}

} // namespace
} // namespace gcpdda::generators_test
