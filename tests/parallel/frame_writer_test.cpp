// Frames: what the ranks put in is what a reader gets out, in BlockId order, in files that do not depend on
// the number of ranks. No fatal assertion: a rank that left early would leave the others waiting.

#include "gcpdda/io/frame_rows.hpp"
#include "gcpdda/io/frame_writer.hpp"
#include "io/results/frame_reader.hpp"
#include "io/results/id_slabs.hpp"
#include "io/results/run_comparison.hpp"
#include "shared_folder.hpp"
#include "support/frame_data.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <numbers>
#include <ostream>
#include <random>

namespace gcpdda::frame_writer_test {
namespace {

namespace fs = std::filesystem;

using testing::FrameData;
using testing::GivenContacts;
using testing::GivenFrame;
using testing::SharedFolder;

struct Block {
  FrameRow row;
  std::vector<Vec2> vertices;
};

// The same on every rank: a polygon of 3 to 9 vertices and numbers without pattern.
Block random_block(std::int64_t id, int frame) {
  std::mt19937_64 random(static_cast<std::uint64_t>(1000 * id + 7));
  std::uniform_int_distribution<std::int32_t> size(3, 9);
  Block block;
  block.row.num_vertices = size(random);
  block.row.block = id;
  block.row.material = static_cast<std::int32_t>(id % 5);
  block.row.kind = static_cast<std::uint8_t>(id % 3);
  random.seed(static_cast<std::uint64_t>(1000 * id + frame));
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  for (std::int32_t i = 0; i < block.row.num_vertices; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / block.row.num_vertices;
    block.vertices.push_back(Vec2{2.5 * static_cast<double>(id), number(random)} +
                             Rotation::of(angle)(Vec2{1.0, 0.0}));
  }
  block.row.displacement = {number(random), number(random)};
  block.row.rotation = number(random);
  for (auto *triple : {&block.row.velocity, &block.row.stress, &block.row.contact_force}) {
    std::generate(triple->begin(), triple->end(), [&] { return number(random); });
  }
  return block;
}

ContactRow random_contact(std::int64_t lower, std::int64_t higher, std::int32_t position) {
  std::mt19937_64 random(static_cast<std::uint64_t>(lower * 10000 + higher * 10 + position));
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  ContactRow row{lower, higher, position, static_cast<std::int32_t>(higher % 4), 1, {}, {}, 0, 0, 0, 0};
  row.state = static_cast<std::uint8_t>(1 + higher % 2);
  row.begin = {number(random), number(random)};
  row.end = {number(random), number(random)};
  row.normal_force = number(random);
  row.shear_force = number(random);
  row.overlap = number(random);
  row.slip = number(random);
  return row;
}

// In the order the file must have.
std::vector<ContactRow> all_contacts(std::int64_t num_blocks) {
  std::vector<ContactRow> rows;
  for (std::int64_t lower = 0; lower < num_blocks; lower += 2) {
    for (std::int64_t higher = lower + 1; higher < std::min(num_blocks, lower + 4); ++higher) {
      for (std::int32_t position = 0; position <= higher % 3; ++position) {
        rows.push_back(random_contact(lower, higher, position));
      }
    }
  }
  return rows;
}

using Owner = int (*)(std::int64_t, int size);
int scattered(std::int64_t id, int size) {
  return static_cast<int>((id * 2654435761) % 4294967291 % size);
}
int all_on_last(std::int64_t, int size) {
  return size - 1;
}
constexpr std::int64_t num_lost = 50;
int scattered_but_the_lost(std::int64_t id, int size) {
  return id < num_lost ? -1 : scattered(id, size);
}

FrameData my_blocks(const Communicator &communicator, std::int64_t num_blocks, int frame, Owner owner) {
  std::vector<std::int64_t> mine;
  for (std::int64_t id = 0; id < num_blocks; ++id) {
    if (owner(id, communicator.size()) == communicator.rank()) {
      mine.push_back(id);
    }
  }
  std::shuffle(mine.begin(), mine.end(), std::mt19937_64(static_cast<std::uint64_t>(communicator.rank())));
  FrameData data;
  for (const std::int64_t id : mine) {
    const Block block = random_block(id, frame);
    data.rows.push_back(block.row);
    data.vertices.insert(data.vertices.end(), block.vertices.begin(), block.vertices.end());
  }
  return data;
}

std::vector<ContactRow> my_contacts(const Communicator &communicator, std::int64_t num_blocks, Owner owner) {
  std::vector<ContactRow> rows = all_contacts(num_blocks);
  std::erase_if(rows, [&](const ContactRow &row) {
    return owner(row.higher, communicator.size()) != communicator.rank();
  });
  std::shuffle(rows.begin(), rows.end(), std::mt19937_64(5));
  return rows;
}

constexpr int num_frames = 3;
double time_of(int frame) {
  return 0.1 * frame + 1.0 / 3.0;
}

void write_run(const Communicator &communicator, const fs::path &directory, std::int64_t num_blocks,
               Owner owner, std::int64_t ids_per_strip = 0) {
  FrameWriter writer(communicator, directory, num_blocks, ids_per_strip);
  for (int frame = 0; frame < num_frames; ++frame) {
    writer.write(frame, time_of(frame), GivenFrame(my_blocks(communicator, num_blocks, frame, owner)));
    writer.write_contacts(
        frame, time_of(frame),
        GivenContacts(frame == 0 ? std::vector<ContactRow>{} : my_contacts(communicator, num_blocks, owner)));
  }
  EXPECT_TRUE(writer.all_writes_collective());
  writer.finish();
}

std::array<double, 3> in_plane(Vec2 a) {
  return {a.x, a.y, 0.0};
}

void expect_frame(const fs::path &directory, std::int64_t num_blocks, int frame) {
  const FrameContent content =
      read_frame(directory / "frames" / ("frame_00000" + std::to_string(frame) + ".hdf"));
  FrameContent wanted;
  wanted.offsets.push_back(0);
  for (std::int64_t id = 0; id < num_blocks; ++id) {
    const Block block = random_block(id, frame);
    for (const Vec2 vertex : block.vertices) {
      wanted.points.push_back(in_plane(vertex));
    }
    wanted.offsets.push_back(std::ssize(wanted.points));
    wanted.block.push_back(id);
    wanted.material.push_back(block.row.material);
    wanted.kind.push_back(block.row.kind);
    wanted.displacement.push_back(in_plane(block.row.displacement));
    wanted.rotation.push_back(block.row.rotation);
    wanted.velocity.push_back(block.row.velocity);
    wanted.stress.push_back(block.row.stress);
    wanted.contact_force.push_back(block.row.contact_force);
  }
  EXPECT_EQ(content.time, time_of(frame));
  EXPECT_EQ(content.points, wanted.points);
  EXPECT_EQ(content.offsets, wanted.offsets);
  EXPECT_EQ(content.block, wanted.block);
  EXPECT_EQ(content.material, wanted.material);
  EXPECT_EQ(content.kind, wanted.kind);
  EXPECT_EQ(content.displacement, wanted.displacement);
  EXPECT_EQ(content.rotation, wanted.rotation);
  EXPECT_EQ(content.velocity, wanted.velocity);
  EXPECT_EQ(content.stress, wanted.stress);
  EXPECT_EQ(content.contact_force, wanted.contact_force);
}

void expect_contacts(const fs::path &directory, std::int64_t num_blocks, int frame) {
  const ContactFrameContent content =
      read_contact_frame(directory / "frames" / ("contacts_00000" + std::to_string(frame) + ".hdf"));
  ContactFrameContent wanted;
  for (const ContactRow &row : frame == 0 ? std::vector<ContactRow>{} : all_contacts(num_blocks)) {
    wanted.points.push_back(in_plane(row.begin));
    wanted.points.push_back(in_plane(row.end));
    wanted.blocks.push_back({row.lower, row.higher});
    wanted.joint.push_back(row.joint);
    wanted.state.push_back(row.state);
    wanted.normal_force.push_back(row.normal_force);
    wanted.shear_force.push_back(row.shear_force);
    wanted.overlap.push_back(row.overlap);
    wanted.slip.push_back(row.slip);
  }
  EXPECT_EQ(content.time, time_of(frame));
  EXPECT_EQ(content.points, wanted.points);
  EXPECT_EQ(content.blocks, wanted.blocks);
  EXPECT_EQ(content.joint, wanted.joint);
  EXPECT_EQ(content.state, wanted.state);
  EXPECT_EQ(content.normal_force, wanted.normal_force);
  EXPECT_EQ(content.shear_force, wanted.shear_force);
  EXPECT_EQ(content.overlap, wanted.overlap);
  EXPECT_EQ(content.slip, wanted.slip);
}

struct Case {
  const char *name;
  std::int64_t num_blocks;
  Owner owner;
};
void PrintTo(const Case &c, std::ostream *out) {
  *out << c.num_blocks << " blocks";
}
const auto case_name = [](const auto &info) { return std::string(info.param.name); };

class Frames : public ::testing::TestWithParam<Case> {};

TEST_P(Frames, HoldWhatTheRanksGaveWhateverTheirNumber) {
  const Communicator world = Communicator::world();
  const SharedFolder folder(world);
  const auto [name, num_blocks, owner] = GetParam();
  write_run(world, folder.path("all"), num_blocks, owner, 8); // several strips
  if (world.is_root()) {
    for (int frame = 0; frame < num_frames; ++frame) {
      expect_frame(folder.path("all"), num_blocks, frame);
      expect_contacts(folder.path("all"), num_blocks, frame);
    }
    write_run(Communicator::self(), folder.path("one"), num_blocks, owner);
    const std::vector<std::string> differences = compare_runs(folder.path("all"), folder.path("one"));
    EXPECT_TRUE(differences.empty()) << differences.front();
    for (const fs::directory_entry &entry : fs::recursive_directory_iterator(folder.path("all"))) {
      EXPECT_NE(entry.path().extension(), ".tmp");
    }
  }
}

INSTANTIATE_TEST_SUITE_P(, Frames,
                         ::testing::Values(Case{"Scattered", 137, scattered},
                                           Case{"FewerBlocksThanRanks", 3, scattered},
                                           Case{"OneBlock", 1, all_on_last},
                                           Case{"AllOnOneRank", 50, all_on_last}),
                         case_name);

// With the first strips of the root, on three ranks all of them, which has the first offset to write.
TEST(FramesThatLoseBlocks, HoldTheOthersWhateverTheNumberOfStrips) {
  const Communicator world = Communicator::world();
  const SharedFolder folder(world);
  constexpr std::int64_t num_blocks = 137;
  const auto write = [](const Communicator &communicator, const fs::path &directory,
                        std::int64_t ids_per_strip) {
    FrameWriter writer(communicator, directory, num_blocks, ids_per_strip);
    writer.write(0, 0.0, GivenFrame(my_blocks(communicator, num_blocks, 0, scattered)));
    writer.write(1, 0.1, GivenFrame(my_blocks(communicator, num_blocks, 1, scattered_but_the_lost)));
    EXPECT_TRUE(writer.all_writes_collective());
    writer.finish();
  };
  write(world, folder.path("all"), 8);
  if (world.is_root()) {
    write(Communicator::self(), folder.path("one"), num_blocks);
    EXPECT_EQ(compare_runs(folder.path("all"), folder.path("one")), std::vector<std::string>{});
    EXPECT_TRUE(fs::exists(folder.path("all") / "frames/topology_000001.h5"));
    const FrameContent content = read_frame(folder.path("all") / "frames/frame_000001.hdf");
    EXPECT_EQ(content.offsets.front(), 0);
    EXPECT_EQ(content.offsets.back(), std::ssize(content.points));
    EXPECT_EQ(content.block.front(), num_lost);
    EXPECT_EQ(std::ssize(content.block), num_blocks - num_lost);
  }
}

TEST(FrameTrouble, IsAFileErrorOnEveryRank) {
  const Communicator world = Communicator::world();
  const SharedFolder folder(world);
  FrameWriter writer(world, folder.path("run"), 20);
  writer.write(0, 0.0, GivenFrame(my_blocks(world, 20, 0, scattered)));
  writer.finish();
  if (world.is_root()) {
    fs::remove_all(folder.path("run"));
  }
  world.barrier();
  try {
    writer.write(1, 0.1, GivenFrame(my_blocks(world, 20, 1, scattered)));
    ADD_FAILURE() << "no folder, no complaint";
  } catch (const FileError &error) {
    EXPECT_NE(std::string(error.what()).find("frame_000001.hdf"), std::string::npos) << error.what();
  }
}

TEST(FrameTrouble, OfFolderMakingIsAFileErrorOnEveryRank) {
  const Communicator world = Communicator::world();
  EXPECT_THROW(FrameWriter(world, "/dev/null/run", 20), FileError);
}

TEST(FrameTrouble, BlockTwiceOrMissingIsRefusedOnEveryRank) {
  const Communicator world = Communicator::world();
  const SharedFolder folder(world);
  FrameWriter writer(world, folder.path("run"), 20);
  FrameData data = my_blocks(world, 20, 0, all_on_last);
  if (!data.rows.empty()) {
    data.rows[3].block = data.rows[4].block;
  }
  EXPECT_THROW(writer.write(0, 0.0, GivenFrame(data)), InternalError);
}

TEST(Slabs, CoverTheIdsAndAgreeWithTheirOwners) {
  for (const std::int64_t num_blocks : {1, 2, 5, 7, 64, 1000}) {
    for (const int num_ranks : {1, 2, 3, 7, 64}) {
      EXPECT_EQ(slab_begin(num_blocks, num_ranks, 0), 0);
      EXPECT_EQ(slab_begin(num_blocks, num_ranks, num_ranks), num_blocks);
      for (int rank = 0; rank < num_ranks; ++rank) {
        for (std::int64_t id = slab_begin(num_blocks, num_ranks, rank);
             id < slab_begin(num_blocks, num_ranks, rank + 1); ++id) {
          EXPECT_EQ(slab_owner(num_blocks, num_ranks, id), rank);
        }
      }
    }
  }
}

} // namespace
} // namespace gcpdda::frame_writer_test
