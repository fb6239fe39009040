// Each rank reads its part of a block file; faults are the same on all ranks, in the order of the blocks.

#include "io/blocks/block_file.hpp"
#include "model/generators.hpp"
#include "shared_folder.hpp"
#include "support/block_file_writer.hpp"

#include <gtest/gtest.h>

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace gcpdda::block_file_test {
namespace {

using testing::BlockFileWriter;

/// Triangles to octagons and a re-entrant shape, in turn, no two equal.
std::vector<SceneBlock> some_blocks(std::size_t count) {
  std::vector<SceneBlock> blocks(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double x = 3.0 * static_cast<double>(i);
    if (i % 7 == 6) {
      blocks[i].vertices = {{x, 0}, {x + 2, 0}, {x + 2, 2}, {x + 1, 0.5}, {x, 2}};
    } else {
      const std::size_t corners = 3 + i % 6;
      for (std::size_t k = 0; k < corners; ++k) {
        const double angle = 6.28318530717958648 * static_cast<double>(k) / static_cast<double>(corners);
        blocks[i].vertices.push_back({x + std::cos(angle), std::sin(angle)});
      }
    }
    blocks[i].material = static_cast<std::int32_t>(i % 2);
    blocks[i].fixed = i % 5 == 4;
    if (!blocks[i].fixed) {
      blocks[i].velocity = {0.1 * static_cast<double>(i), -1.0, 0.5};
    }
  }
  return blocks;
}

std::vector<std::string> texts(const Diagnostics &diagnostics) {
  std::vector<std::string> result;
  for (const Diagnostic &d : diagnostics) {
    result.push_back(to_string(d));
  }
  return result;
}

class BlockFiles : public ::testing::Test {
protected:
  BlockFiles() : folder_(world_) {
    scene_.materials.resize(2);
    scene_.block_file = {folder_.path("blocks.h5").string(), 0, {"s.toml", 9, 8}};
  }

  void write(const BlockFileWriter &writer) {
    if (world_.is_root()) {
      writer.write(scene_.block_file.path);
    }
    world_.barrier();
  }

  /// The faults of both steps without the path, as soon as there are some.
  std::vector<std::string> faults_of_file() {
    std::vector<std::string> faults = texts(open_block_file(world_, scene_));
    if (faults.empty()) {
      std::vector<SceneBlock> blocks;
      faults = texts(read_block_file(world_, scene_, first(), last(), blocks));
    }
    for (std::string &fault : faults) {
      if (const std::size_t at = fault.find(scene_.block_file.path); at != std::string::npos) {
        fault.replace(at, scene_.block_file.path.size(), "FILE");
      }
    }
    return faults;
  }

  std::int64_t first() const { return scene_.block_file.num_blocks * world_.rank() / world_.size(); }
  std::int64_t last() const { return scene_.block_file.num_blocks * (world_.rank() + 1) / world_.size(); }

  Communicator world_ = Communicator::world();
  testing::SharedFolder folder_;
  Scene scene_;
};

void expect_same(const SceneBlock &read, const SceneBlock &written) {
  EXPECT_EQ(read.vertices, written.vertices);
  EXPECT_EQ(read.edge_joint, written.edge_joint);
  EXPECT_EQ(read.material, written.material);
  EXPECT_EQ(read.fixed, written.fixed);
  EXPECT_EQ(read.velocity, written.velocity);
  EXPECT_EQ(read.name, "") << "made from the id where it is needed";
  EXPECT_FALSE(read.driven);
}

TEST_F(BlockFiles, GiveEachRankItsPart) {
  for (const std::size_t count : {1U, 2U, 5U, 83U}) {
    const std::vector<SceneBlock> written = some_blocks(count);
    write(BlockFileWriter(written));
    ASSERT_EQ(texts(open_block_file(world_, scene_)), std::vector<std::string>());
    ASSERT_EQ(scene_.block_file.num_blocks, static_cast<std::int64_t>(count));
    std::vector<SceneBlock> mine;
    EXPECT_EQ(texts(read_block_file(world_, scene_, first(), last(), mine)), std::vector<std::string>());
    ASSERT_EQ(static_cast<std::int64_t>(mine.size()), last() - first());
    for (std::size_t i = 0; i < mine.size(); ++i) {
      expect_same(mine[i], written[static_cast<std::size_t>(first()) + i]);
    }
    std::int64_t total = static_cast<std::int64_t>(mine.size());
    world_.sum(std::span(&total, 1));
    EXPECT_EQ(total, static_cast<std::int64_t>(count));
  }
}

TEST_F(BlockFiles, MayBeReadByOneRankWhileTheOthersReadNothing) {
  const std::vector<SceneBlock> written = some_blocks(20);
  write(BlockFileWriter(written));
  ASSERT_EQ(texts(open_block_file(world_, scene_)), std::vector<std::string>());
  const bool reads = world_.rank() == world_.size() - 1;
  std::vector<SceneBlock> mine(3);
  EXPECT_EQ(texts(read_block_file(world_, scene_, reads ? 4 : 20, reads ? 9 : 20, mine)),
            std::vector<std::string>());
  ASSERT_EQ(mine.size(), reads ? 8U : 3U) << "appended";
  for (std::size_t i = 3; i < mine.size(); ++i) {
    expect_same(mine[i], written[1 + i]);
  }
}

TEST_F(BlockFiles, NeedNoVelocityAndMayBeCompressedAndTurnedEitherWay) {
  std::vector<SceneBlock> written = some_blocks(13);
  std::vector<SceneBlock> clockwise = written;
  for (std::size_t i = 0; i < written.size(); ++i) {
    written[i].velocity = {};
    std::reverse(clockwise[i].vertices.begin() + 1, clockwise[i].vertices.end());
  }
  BlockFileWriter writer(clockwise);
  writer.remove("velocity");
  writer["points"].chunked = true;
  writer["fixed"].chunked = true;
  write(writer);
  ASSERT_EQ(texts(open_block_file(world_, scene_)), std::vector<std::string>());
  std::vector<SceneBlock> mine;
  EXPECT_EQ(texts(read_block_file(world_, scene_, first(), last(), mine)), std::vector<std::string>());
  for (std::size_t i = 0; i < mine.size(); ++i) {
    expect_same(mine[i], written[static_cast<std::size_t>(first()) + i]);
  }
}

TEST_F(BlockFiles, MayGiveLawsOfEdgesThatTurnRoundWithTheOutline) {
  scene_.joints.laws.resize(3);
  std::vector<SceneBlock> written = some_blocks(13);
  for (std::size_t i = 0; i < written.size(); ++i) {
    for (std::size_t k = 0; k < written[i].vertices.size(); ++k) {
      written[i].edge_joint.push_back(static_cast<std::int32_t>((i + k * k) % 4) - 1);
    }
  }
  std::vector<SceneBlock> given = written;
  for (std::size_t i = 0; i < given.size(); i += 2) {
    std::reverse(given[i].vertices.begin() + 1, given[i].vertices.end());
    std::reverse(given[i].edge_joint.begin(), given[i].edge_joint.end());
  }
  BlockFileWriter writer(given);
  write(writer);
  ASSERT_EQ(texts(open_block_file(world_, scene_)), std::vector<std::string>());
  std::vector<SceneBlock> mine;
  EXPECT_EQ(texts(read_block_file(world_, scene_, first(), last(), mine)), std::vector<std::string>());
  for (std::size_t i = 0; i < mine.size(); ++i) {
    expect_same(mine[i], written[static_cast<std::size_t>(first()) + i]);
  }
  writer.put("edge_joint", 4, std::int32_t{3});
  write(writer);
  EXPECT_EQ(faults_of_file(),
            std::vector<std::string>{
                "FILE: error: block 1: edge_joint of edge 1 is 3, the scene has joints 0 to 2, in "
                "the order of its file but default first, give one of these numbers, or -1 for "
                "the law of the materials"});
  writer.set("edge_joint", std::vector<std::int32_t>(5));
  write(writer);
  EXPECT_EQ(faults_of_file(),
            std::vector<std::string>{"FILE: error: '/edge_joint' has 5 rows, '/points' has "
                                     "71, and each begins an edge, write one row for each point"});
}

TEST_F(BlockFiles, AreNotLookedForWhereTheSceneNamesNone) {
  scene_.block_file = {};
  EXPECT_EQ(texts(open_block_file(world_, scene_)), std::vector<std::string>());
  std::vector<SceneBlock> none;
  EXPECT_EQ(texts(read_block_file(world_, scene_, 0, 0, none)), std::vector<std::string>());
  EXPECT_TRUE(none.empty());
}

/// One thing wrong with a good file of ten blocks.
struct BadFile {
  const char *what;
  std::function<void(BlockFileWriter &)> spoil;
  std::vector<std::string> faults;
};

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

// clang-format off
const std::vector<BadFile> bad_files{
    {"material", [](auto &f) { f.put("material", 7, std::int32_t{2}); f.put("material", 2, std::int32_t{-1}); },
     {"FILE: error: block 2: material is -1, the scene has materials 0 to 1, in the order of its file, give one of these numbers",
      "FILE: error: block 7: material is 2, the scene has materials 0 to 1, in the order of its file, give one of these numbers"}},
    {"fixed", [](auto &f) { f.put("fixed", 3, std::uint8_t{255}); },
     {"FILE: error: block 3: fixed is 255, it must be 0 or 1, write 1 for a block that never moves"}},
    {"moving fixed block", [](auto &f) { f.put("velocity", 3 * 4 + 2, 1.0); },
     {"FILE: error: block 4: it is fixed but has a velocity, a fixed block never moves, write velocity 0 or fixed 0"}},
    {"velocity", [](auto &f) { f.put("velocity", 3 * 5 + 1, nan); f.put("velocity", 3 * 5 + 2, -2e9); },
     {"FILE: error: block 5: entry 1 of velocity is nan, it must be finite, check where the file is written",
      "FILE: error: block 5: entry 2 of velocity is -2000000000, it must be at least -1e+09 and at most 1e+09, check where the file is written"}},
    {"coordinates", [](auto &f) { f.put("points", 2 * 2 + 1, HUGE_VAL); f.put("points", 2 * 3, 1.5e9); },
     {"FILE: error: block 0: y of vertex 2 is inf, it must be finite, check where the file is written",
      "FILE: error: block 1: x of vertex 0 is 1500000000, it must be at least -1e+09 and at most 1e+09, check where the file is written"}},
    {"equal neighbours", [](auto &f) { f.put("points", 0, 1.0); f.put("points", 2, 1.0); f.put("points", 1, 0.0); f.put("points", 3, 0.0); },
     {"FILE: error: block 0: vertex 1 of the outline equals vertex 0, an edge needs a length, leave one of them out"}},
    {"zero area", [](auto &f) { for (std::size_t k = 0; k < 3; ++k) { f.put("points", 2 * k, static_cast<double>(k)); f.put("points", 2 * k + 1, 2.0); } },
     {"FILE: error: block 0: the outline has zero area, all its vertices lie on one line, check the vertices"}},
    {"crossing", [](auto &f) { f.put("points", 6, 1.0); f.put("points", 7, 0.0); f.put("points", 8, 2.0); f.put("points", 9, 1.0); f.put("points", 10, 2.0); f.put("points", 11, 0.0); f.put("points", 12, 1.0); f.put("points", 13, 1.0); },
     {"FILE: error: block 1: the outline crosses itself, two of its edges meet away from a common vertex, list the vertices in order around the block"}},
    {"first offset", [](auto &f) { f.put("offsets", 0, std::int64_t{-1}); },
     {"FILE: error: '/offsets' begins with -1, the points of the first block begin with number 0, write 0 there",
      "FILE: error: block 0: its points are -1 to 3, '/points' has 53 rows, check '/offsets'"}},
    {"last offset", [](auto &f) { f.put("offsets", 10, std::int64_t{50}); },
     {"FILE: error: '/offsets' ends with 50, '/points' has 53 rows, end '/offsets' with the number of points"}},
    {"endless offset", [](auto &f) { f.put("offsets", 10, std::numeric_limits<std::int64_t>::max()); },
     {"FILE: error: block 9: its points are 47 to 9223372036854775807, '/points' has 53 rows, check '/offsets'"}},
    {"falling offset", [](auto &f) { f.put("offsets", 2, std::int64_t{2}); },
     {"FILE: error: block 1: '/offsets' falls from 3 to 2, the points of a block follow those of the block before, check '/offsets'"}},
    {"two vertices", [](auto &f) { f.put("offsets", 1, std::int64_t{2}); },
     {"FILE: error: block 0: it has 2 vertices, a block has at least 3, check '/offsets'"}},
    {"missing points", [](auto &f) { f.remove("points"); f.remove("velocity"); },
     {"FILE: error: '/points' is missing, it must hold 64-bit reals (n, 2), write it"}},
    {"misspelt with a control character", [](auto &f) { f.rename("offsets", "offset\n"); f.rename("velocity", "velocit\x1b"); },
     {"FILE: error: '/offsets' is missing, it must hold 64-bit integers (nb + 1), did you mean it by '/offset '?",
      "FILE: error: unknown dataset '/velocit ', did you mean '/velocity'?"}},
    {"misspelt", [](auto &f) { f.rename("offsets", "offset"); f.rename("velocity", "velocty"); },
     {"FILE: error: '/offsets' is missing, it must hold 64-bit integers (nb + 1), did you mean it by '/offset'?",
      "FILE: error: unknown dataset '/velocty', did you mean '/velocity'?"}},
    {"float points", [](auto &f) { f.set("points", std::vector<float>(102), 2); },
     {"FILE: error: '/points' holds 32-bit reals, it must hold 64-bit reals, convert it where the file is written"}},
    {"short offsets and long material", [](auto &f) { f.set("offsets", std::vector<std::int32_t>(11)); f.set("material", std::vector<std::int64_t>(10)); },
     {"FILE: error: '/offsets' holds 32-bit integers, it must hold 64-bit integers, convert it where the file is written",
      "FILE: error: '/material' holds 64-bit integers, it must hold 32-bit integers, convert it where the file is written"}},
    {"signed and real fixed", [](auto &f) { f.set("fixed", std::vector<std::int8_t>(10)); f.set("velocity", std::vector<std::int32_t>(30), 3); },
     {"FILE: error: '/fixed' holds 8-bit integers, it must hold unsigned 8-bit integers, convert it where the file is written",
      "FILE: error: '/velocity' holds 32-bit integers, it must hold 64-bit reals, convert it where the file is written"}},
    {"shapes", [](auto &f) { f.set("points", std::vector<double>(99), 3); f.set("material", std::vector<std::int32_t>(20), 2); f.set("velocity", std::vector<double>(30)); },
     {"FILE: error: '/points' has shape (33, 3), it must be (n, 2), reshape it where the file is written",
      "FILE: error: '/material' has shape (10, 2), it must be (nb), reshape it where the file is written",
      "FILE: error: '/velocity' has shape (30), it must be (nb, 3), reshape it where the file is written"}},
    {"counts", [](auto &f) { f.set("material", std::vector<std::int32_t>(9)); f.set("fixed", std::vector<std::uint8_t>(11)); f.set("velocity", std::vector<double>(6), 3); },
     {"FILE: error: '/material' has 9 rows, '/offsets' has 11 entries, which makes 10 blocks, write one row for each block",
      "FILE: error: '/fixed' has 11 rows, '/offsets' has 11 entries, which makes 10 blocks, write one row for each block",
      "FILE: error: '/velocity' has 2 rows, '/offsets' has 11 entries, which makes 10 blocks, write one row for each block"}},
    {"no blocks", [](auto &f) { f = BlockFileWriter(std::vector<SceneBlock>()); },
     {"FILE: error: the file has no blocks, '/offsets' has one entry more than there are blocks, write at least one block, or leave [blocks] out"}},
    {"claims", [](auto &f) { f["points"] = {H5T_NATIVE_DOUBLE, {hsize_t{1} << 50, 2}, {}, true}; },
     {"FILE: error: '/points' is not filled, the file stores 0 of its 18014398509481984 bytes, write all rows before the file is closed"}},
};
// clang-format on

TEST_F(BlockFiles, HaveFaultsThatAllRanksSee) {
  for (const BadFile &bad : bad_files) {
    SCOPED_TRACE(bad.what);
    BlockFileWriter writer(some_blocks(10));
    bad.spoil(writer);
    write(writer);
    EXPECT_EQ(faults_of_file(), bad.faults);
  }
}

TEST_F(BlockFiles, WithManyFaultsAreReportedInPartAndCounted) {
  std::vector<SceneBlock> blocks = some_blocks(90);
  for (SceneBlock &block : blocks) {
    block.material = 5;
    block.vertices = {{0, 0}, {1, 1}, {2, 2}};
  }
  write(BlockFileWriter(blocks));
  const std::vector<std::string> faults = faults_of_file();
  ASSERT_EQ(faults.size(), 21U);
  for (std::size_t k = 0; k < 10; ++k) {
    EXPECT_EQ(faults[2 * k],
              fmt::format("FILE: error: block {}: material is 5, the scene has materials 0 to 1, in "
                          "the order of its file, give one of these numbers",
                          k));
    EXPECT_EQ(faults[2 * k + 1],
              fmt::format("FILE: error: block {}: the outline has zero area, all its vertices lie on one "
                          "line, check the vertices",
                          k));
  }
  EXPECT_EQ(faults[20], "FILE: error: 160 more faults, only the first 20 are written out, mend these first");
}

TEST_F(BlockFiles, ThatAreNoneAreRefused) {
  EXPECT_EQ(faults_of_file(),
            std::vector<std::string>{
                "s.toml:9:8: error: cannot open the block file 'FILE', no such file or no right "
                "to read it, check the path, which starts from the folder of the scene"});
  if (world_.is_root()) {
    std::ofstream(scene_.block_file.path) << "points\n0 0\n";
  }
  world_.barrier();
  EXPECT_EQ(faults_of_file(),
            std::vector<std::string>{"FILE: error: this is no HDF5 file, [blocks] file names one, "
                                     "check the path or write the blocks as HDF5"});
  write(BlockFileWriter(some_blocks(10)));
  if (world_.is_root()) {
    std::filesystem::resize_file(scene_.block_file.path,
                                 std::filesystem::file_size(scene_.block_file.path) / 2);
  }
  world_.barrier();
  const std::vector<std::string> cut = faults_of_file();
  ASSERT_EQ(cut.size(), 1U);
  EXPECT_TRUE(cut[0].starts_with("FILE: error: the file is damaged or cut short, HDF5 says: truncated file"))
      << cut[0];
  EXPECT_TRUE(cut[0].ends_with(", write or copy it again")) << cut[0];
  EXPECT_EQ(scene_.block_file.num_blocks, 0);
}

TEST_F(BlockFiles, MustAgreeWithTheNamesOfTheScene) {
  write(BlockFileWriter(some_blocks(10)));
  scene_.blocks.resize(2);
  scene_.blocks[0] = {.name = "b11",
                      .vertices = {},
                      .edge_joint = {},
                      .velocity_table = {},
                      .fixed_points = {},
                      .loads = {},
                      .where = {"s.toml", 3, 1}};
  scene_.blocks[1].name = "b12";
  scene_.monitors = {{"b12", 12, false, {}, {"s.toml", 20, 9}}, {"b11", 11, false, {}, {"s.toml", 22, 9}}};
  EXPECT_EQ(
      faults_of_file(),
      (std::vector<std::string>{
          "s.toml:3:1: error: block 'b11' has the name of a block of FILE, those are b2 to b11, choose "
          "another "
          "name",
          "s.toml:20:9: error: no block is named 'b12', those of FILE are b2 to b11, name one of these"}));
  scene_.blocks.clear();
  scene_.monitors.clear();
  BrickGenerator wall;
  wall.rows = 2147483647 - 9;
  wall.bond = 0.0;
  scene_.generators = {wall};
  EXPECT_EQ(faults_of_file(),
            std::vector<std::string>{
                "FILE: error: the file has 10 blocks, a scene has at most 2147483647 in all, and "
                "this one has 2147483638 others, use fewer blocks"});
}

} // namespace
} // namespace gcpdda::block_file_test
