// A checkpoint has the same bytes on any number of ranks, and any number goes on from it to the same files.

#include "driver/restart.hpp"
#include "driver/stop_signal.hpp"
#include "gcpdda/driver/run.hpp"
#include "io/checkpoint/checkpoint.hpp"
#include "io/checkpoint/checkpoint_reader.hpp"
#include "io/checkpoint/checkpoint_writer.hpp"
#include "io/results/id_slabs.hpp"
#include "io/results/run_comparison.hpp"
#include "shared_folder.hpp"
#include "support/run_facts.hpp"
#include "support/scenes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <fstream>

namespace gcpdda::checkpoint_test {
namespace {

namespace fs = std::filesystem;
using testing::file_text;
using testing::summary_number;
using testing::summary_text;

std::vector<fs::path> checkpoints(const fs::path &run) {
  std::vector<fs::path> found;
  for (const fs::directory_entry &entry : fs::directory_iterator(run / "checkpoints")) {
    found.push_back(entry.path().filename());
  }
  std::sort(found.begin(), found.end());
  return found;
}

class Checkpoints : public ::testing::Test {
protected:
  /// Every block of it remembers something: contacts that stick and slide, strains, loads, fixed points, a
  /// velocity table; checkpoints in the middle and at the end.
  Checkpoints()
      : folder_(world_),
        scene_(testing::scene_of(testing::mixed_wall_toml(12, 8, 0.012),
                                 {"output.checkpoint_interval=0.006", "run.gravity_ramp=0.02",
                                  "block.l3_3.load=[{point=[7, 3.2], force=[1e5, -1e5]}]",
                                  "block.l5_1.fixed_points=[[2.6, 5.2]]",
                                  "block.b2_2.fixed_points=[[5.6, 2.8]]", "run.local_damping=0.1"})) {}

  int run(const Communicator &ranks, const std::string &name) const {
    return run_scene(ranks, scene_, {folder_.path(name), false, false});
  }
  int restart(const Communicator &ranks, const std::string &name) const {
    return restart_scene(ranks, scene_, scene_, folder_.path(name));
  }
  /// Back to the checkpoint in the middle, in a copy. Root only.
  void undo_half(const std::string &name, const std::string &copy) const {
    fs::copy(folder_.path(name), folder_.path(copy), fs::copy_options::recursive);
    fs::remove(folder_.path(copy) / "checkpoints" / checkpoints(folder_.path(copy)).back());
  }
  void expect_same(const std::string &a, const std::string &b) const {
    EXPECT_EQ(compare_runs(folder_.path(a), folder_.path(b)), std::vector<std::string>())
        << a << " and " << b;
    ASSERT_EQ(checkpoints(folder_.path(a)), checkpoints(folder_.path(b)));
    for (const fs::path &name : checkpoints(folder_.path(a))) {
      EXPECT_EQ(file_text(folder_.path(a) / "checkpoints" / name) ==
                    file_text(folder_.path(b) / "checkpoints" / name),
                true)
          << name << " of " << a << " and " << b;
    }
  }

  Communicator world_ = Communicator::world();
  testing::SharedFolder folder_;
  testing::CapturedLog log_;
  Scene scene_;
};

TEST_F(Checkpoints, AreTheSameAndGoOnToTheSameOnAnyNumberOfRanks) {
  EXPECT_EQ(run(world_, "together"), 0);
  if (world_.is_root()) {
    EXPECT_EQ(run(Communicator::self(), "alone"), 0);
    expect_same("together", "alone");
    undo_half("alone", "one_to_many");
    undo_half("together", "many_to_one");
  }
  world_.barrier();
  EXPECT_EQ(restart(world_, "one_to_many"), 0);
  world_.barrier();
  if (world_.is_root()) {
    expect_same("alone", "one_to_many");
    EXPECT_EQ(restart(Communicator::self(), "many_to_one"), 0);
    expect_same("alone", "many_to_one");
    for (const char *name : {"one_to_many", "many_to_one"}) {
      for (const char *fact : {"steps", "time", "contacts", "contact_steps", "max_overlap", "energy"}) {
        EXPECT_EQ(summary_text(folder_.path(name), fact), summary_text(folder_.path("alone"), fact)) << fact;
      }
    }
    EXPECT_GE(summary_number(folder_.path("alone"), "contacts"), 100);
    EXPECT_GE(summary_number(folder_.path("together"), "refreshes"), 1);
    if (world_.size() > 1) {
      EXPECT_GE(summary_number(folder_.path("one_to_many"), "cross_rank_contacts"), 20);
    }
  }
  world_.barrier();
}

// One rank hears the signal, all stop after the same step; nobody writes what a run to the end would not.
TEST_F(Checkpoints, OfASignalToOneRank) {
  catch_stop_signal();
  if (world_.rank() == world_.size() - 1) {
    std::raise(SIGUSR1);
  }
  EXPECT_EQ(run(world_, "stopped"), 6);
  world_.barrier();
  EXPECT_EQ(summary_text(folder_.path("stopped"), "verdict"), "\"stopped\"");
  EXPECT_EQ(summary_number(folder_.path("stopped"), "steps"), 1);
  EXPECT_EQ(checkpoints(folder_.path("stopped")), std::vector<fs::path>{"checkpoint_000000001.h5"});
  world_.barrier();
  EXPECT_EQ(restart(world_, "stopped"), 0);
  world_.barrier();
  if (world_.is_root()) {
    EXPECT_EQ(run(Communicator::self(), "whole"), 0);
    expect_same("stopped", "whole");
  }
  world_.barrier();
}

/// Squares in a row, each with a state made of its id. Rows: those this rank takes.
template <class Take> BlockSystem numbered_squares(std::int64_t count, Take &&take) {
  const Material rock{"rock", 2600.0, 1e9, 0.2};
  BlockSystem blocks;
  for (std::int64_t id = 0; id < count; ++id) {
    if (!take(id)) {
      continue;
    }
    SceneBlock block;
    const auto x = static_cast<double>(id);
    block.vertices = {{x, 0}, {x + 1, 0}, {x + 1, 1}, {x, 1}};
    append_block(blocks, BlockId{id}, block, rock, id % 3 == 0 ? BlockKind::deformable : BlockKind::rigid);
    ++blocks.num_owned;
  }
  return blocks;
}

/// By lower block.
class KnownRegions : public RegionSource {
public:
  std::vector<RegionRecord> records;
  std::int64_t miscount = 0; ///< of block 0

  [[nodiscard]] std::int64_t count(std::int64_t first, std::int64_t last) const override {
    const auto [begin, end] = range(first, last);
    return end - begin + (first <= 0 && 0 < last ? miscount : 0);
  }
  void append(std::int64_t first, std::int64_t last, std::vector<RegionRecord> &to) const override {
    const auto [begin, end] = range(first, last);
    to.insert(to.end(), begin, end);
  }

private:
  using Place = std::vector<RegionRecord>::const_iterator;
  [[nodiscard]] std::pair<Place, Place> range(std::int64_t first, std::int64_t last) const {
    const auto lower = [](const RegionRecord &record) { return record.lower.value; };
    return {std::ranges::lower_bound(records, first, {}, lower),
            std::ranges::lower_bound(records, last, {}, lower)};
  }
};

// Blocks anywhere, contacts between any two: after reading, each rank has the state of its slab and every
// contact of a block in it, those of a pair in their order.
TEST(CheckpointFile, GivesEachRankItsRowsAndAllTheirContacts) {
  const Communicator world = Communicator::world();
  const testing::SharedFolder folder(world);
  const std::int64_t count = 97;
  BlockSystem blocks =
      numbered_squares(count, [&](std::int64_t id) { return (id * 31) % 7 % world.size() == world.rank(); });
  for (std::size_t row = 0; row < blocks.num_owned; ++row) {
    const auto id = static_cast<double>(blocks.properties[row].id.value);
    blocks.displacement[row] = {{id + 0.25, -id}, 1.0 / (id + 3.0)};
    blocks.ledger[row].load = 3.0 * id;
    if (blocks.is_deformable(row)) {
      blocks.deformation_of(row).rate = {id, 2 * id, 3 * id, 4 * id};
    }
  }
  KnownRegions regions;
  const auto num_regions = [](std::int64_t a, std::int64_t b) { return (a * b) % 5 == 0 ? (a + b) % 3 : 0; };
  for (std::int64_t a = 0; a < count; ++a) {
    for (std::int64_t b = a + 1; b < count; ++b) {
      for (std::int64_t k = 0; k < num_regions(a, b) && (a + b) % world.size() == world.rank(); ++k) {
        RegionRecord &record = regions.records.emplace_back();
        record.lower = BlockId{a};
        record.higher = BlockId{b};
        record.memory.shear = static_cast<double>(count * a + b);
        record.memory.lower_stretch = static_cast<std::int32_t>(10 - k); // not in the order of their numbers
        record.memory.law = static_cast<std::int32_t>(k) - 1;
        record.memory.seen_at = static_cast<std::uint16_t>(65535 - k);
        record.memory.opening = {static_cast<double>(a), static_cast<double>(k)};
      }
    }
  }
  RunFacts facts;
  facts.scene = {count, count, 0xfedcba9876543210U, 7, {1, 2, 3}};
  facts.step = 12;
  facts.time = 0.5;
  facts.frame_times = {0.0, 0.25, 0.5};
  CheckpointWriter(world, folder.path(""), {}).write(facts, blocks, regions);
  CheckpointWriter(world, folder.path("strips"), {}, 5).write(facts, blocks, regions);
  const fs::path file = fs::path("checkpoints") / "checkpoint_000000012.h5";
  EXPECT_TRUE(file_text(folder.path("") / file) == file_text(folder.path("strips") / file));

  const std::int64_t first = slab_begin(count, world.size(), world.rank());
  const std::int64_t last = slab_begin(count, world.size(), world.rank() + 1);
  const auto mine = [&](std::int64_t id) { return first <= id && id < last; };
  BlockSystem slab = numbered_squares(count, mine);
  const Restored restored = restore_newest_checkpoint(world, folder.path(""), facts.scene, slab);
  EXPECT_EQ(restored.facts.scene, facts.scene);
  EXPECT_EQ(restored.facts.step, 12);
  EXPECT_EQ(restored.facts.frame_times, facts.frame_times);
  for (std::size_t row = 0; row < slab.num_owned; ++row) {
    const auto id = static_cast<double>(slab.properties[row].id.value);
    EXPECT_EQ(slab.displacement[row], (RigidDof{{id + 0.25, -id}, 1.0 / (id + 3.0)}));
    EXPECT_EQ(slab.ledger[row].load, 3.0 * id);
    if (slab.is_deformable(row)) {
      EXPECT_EQ(slab.deformation_of(row).rate.yy, 4 * id);
    }
  }
  auto record = restored.memory.begin();
  for (std::int64_t a = 0; a < count; ++a) {
    for (std::int64_t b = a + 1; b < count; ++b) {
      for (std::int64_t k = 0; k < num_regions(a, b) && (mine(a) || mine(b)); ++k, ++record) {
        ASSERT_NE(record, restored.memory.end());
        EXPECT_EQ(record->lower.value, a);
        EXPECT_EQ(record->higher.value, b);
        EXPECT_EQ(record->memory.shear, static_cast<double>(count * a + b));
        EXPECT_EQ(record->memory.lower_stretch, 10 - k);
        EXPECT_EQ(record->memory.law, k - 1);
        EXPECT_EQ(record->memory.seen_at, 65535 - k);
        EXPECT_EQ(record->memory.opening, (Vec2{static_cast<double>(a), static_cast<double>(k)}));
      }
    }
  }
  EXPECT_EQ(record, restored.memory.end());
  EXPECT_GE(restored.memory.size(), world.size() > 1 ? 50U : 500U);
}

/// Two checkpoints of the same squares; the newer one is for damaging.
class DamagedCheckpoint : public ::testing::Test {
protected:
  static constexpr std::int64_t count = 12;
  DamagedCheckpoint()
      : folder_(world_), blocks_(numbered_squares(
                             count, [&](std::int64_t id) { return id % world_.size() == world_.rank(); })) {
    facts_.scene = {count, count, 1, 1, {}};
    CheckpointWriter writer(world_, folder_.path(""), {});
    for (facts_.step = 7; facts_.step < 9; ++facts_.step) {
      facts_.frame_times.push_back(0.1);
      facts_.results.push_back({"frames/frame_000000.hdf", 5, -1});
      writer.write(facts_, blocks_, KnownRegions());
    }
    if (world_.is_root()) {
      good_ = file_text(newest_);
    }
    world_.broadcast(good_); // before the root changes it
  }

  /// The older one is taken, and every rank knows so.
  void expect_older(const std::string &bytes, const std::string &told) {
    if (world_.is_root()) {
      std::ofstream(newest_, std::ios::binary) << bytes;
    }
    world_.barrier();
    const std::int64_t first = slab_begin(count, world_.size(), world_.rank());
    const std::int64_t last = slab_begin(count, world_.size(), world_.rank() + 1);
    BlockSystem slab = numbered_squares(count, [&](std::int64_t id) { return first <= id && id < last; });
    const Restored restored = restore_newest_checkpoint(world_, folder_.path(""), facts_.scene, slab);
    EXPECT_EQ(restored.facts.step, 7);
    EXPECT_EQ(restored.facts.frame_times.size(), 1U);
    if (world_.is_root()) {
      ASSERT_EQ(restored.rejected.size(), 1U);
      EXPECT_NE(restored.rejected[0].find(told), std::string::npos) << restored.rejected[0];
    }
    world_.barrier();
  }

  Communicator world_ = Communicator::world();
  testing::SharedFolder folder_;
  BlockSystem blocks_;
  RunFacts facts_;
  fs::path newest_ = folder_.path("checkpoints/checkpoint_000000008.h5");
  std::string good_;
};

TEST_F(DamagedCheckpoint, IsFoundWhereverItsBytesHaveChanged) {
  constexpr std::size_t num_flips = 16;
  for (std::size_t k = 0; k < num_flips; ++k) { // every bit of a byte once, in all of the file
    std::string bytes = good_;
    const std::size_t place = 512 + (good_.size() - 513) * k / (num_flips - 1);
    bytes[place] = static_cast<char>(bytes[place] ^ (1 << (k % 8)));
    expect_older(bytes, "it is damaged: its checksum is wrong");
  }
  for (std::size_t zeroed = 4096; zeroed + 2048 < good_.size(); zeroed += 16384) { // a page that was lost
    std::string bytes = good_;
    bytes.replace(zeroed, 2048, 2048, bytes[zeroed] == '\0' ? '\1' : '\0');
    expect_older(bytes, "it is damaged: its checksum is wrong");
  }
}

TEST_F(DamagedCheckpoint, IsFoundByItsSeal) {
  for (const std::size_t size : {std::size_t{0}, std::size_t{5}, std::size_t{511}}) {
    expect_older(good_.substr(0, size), size < 5 ? "begin with no seal" : "");
  }
  expect_older(good_.substr(0, good_.size() - 1), "it is damaged: it has ");
  expect_older(good_ + '\0', "it is damaged: it has ");
  for (const char *word : {"version", "step", "bytes", "sum"}) { // the last digit of each
    std::string bytes = good_;
    const std::size_t place = bytes.find('\n', bytes.find(word)) - 1;
    bytes[place] = static_cast<char>(bytes[place] == '1' ? '2' : '1');
    expect_older(bytes, *word == 'v' ? "it has format version 21, this gcpdda reads version 20" : "it ");
  }
  std::string bytes = good_;
  bytes[500] = 'x';
  expect_older(bytes, "it is damaged: its seal is broken");
  expect_older(file_text(folder_.path("checkpoints/checkpoint_000000007.h5")),
               "it is the checkpoint of step 7 under the name of another");
}

TEST(CheckpointFile, WithMoreOrFewerRegionsThanCountedIsRefusedOnEveryRank) {
  const Communicator world = Communicator::world();
  const testing::SharedFolder folder(world);
  const std::int64_t count = 12;
  const BlockSystem blocks =
      numbered_squares(count, [&](std::int64_t id) { return id % world.size() == world.rank(); });
  RunFacts facts;
  facts.scene = {count, count, 1, 1, {}};
  KnownRegions regions;
  if (world.is_root()) {
    regions.records = {{BlockId{0}, BlockId{1}, {}}};
  }
  for (const std::int64_t miscount : {-1, 1}) {
    regions.miscount = world.is_root() ? miscount : 0;
    EXPECT_THROW(CheckpointWriter(world, folder.path(""), {}, 2).write(facts, blocks, regions),
                 InternalError);
    EXPECT_TRUE(checkpoint_files(folder.path("")).empty());
  }
}

} // namespace
} // namespace gcpdda::checkpoint_test
