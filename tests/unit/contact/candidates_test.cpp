#include "contact/candidates.hpp"

#include "contact/find_pairs.hpp"
#include "contact/stiffness_bound.hpp"
#include "support/blocks.hpp"
#include "support/scenes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace gcpdda::candidates_test {
namespace {

using namespace testing;
using Pairs = std::vector<std::pair<BlockIndex, BlockIndex>>;

/// The foolish way: all pairs with an owned mobile block whose boxes meet.
Pairs all_meeting_pairs(const BlockSystem &system, const std::vector<Aabb> &boxes) {
  Pairs pairs;
  for (std::uint32_t i = 0; i < system.num_owned; ++i) {
    for (std::uint32_t j = i + 1; j < system.num_rows(); ++j) {
      if (boxes[i].meets(boxes[j])) {
        const bool ordered = system.properties[i].id < system.properties[j].id;
        pairs.emplace_back(BlockIndex{ordered ? i : j}, BlockIndex{ordered ? j : i});
      }
    }
  }
  const auto id = [&](BlockIndex row) { return system.properties[row.value].id; };
  std::sort(pairs.begin(), pairs.end(), [&](const auto &a, const auto &b) {
    return std::pair(id(a.first), id(a.second)) < std::pair(id(b.first), id(b.second));
  });
  return pairs;
}

/// Give rows ids that interleave owned, ghost and fixed ones, ascending within each range.
void shuffle_ids(BlockSystem &system, std::mt19937 &engine) {
  std::vector<std::int64_t> ids(system.num_rows());
  std::iota(ids.begin(), ids.end(), 100);
  for (std::size_t k = ids.size(); k > 1; --k) {
    std::swap(ids[k - 1], ids[engine() % k]);
  }
  const auto at = [&](std::size_t row) { return ids.begin() + static_cast<std::ptrdiff_t>(row); };
  std::sort(at(0), at(system.num_owned));
  std::sort(at(system.num_owned), at(system.first_fixed()));
  std::sort(at(system.first_fixed()), ids.end());
  for (std::size_t row = 0; row < ids.size(); ++row) {
    system.properties[row].id = BlockId{ids[row]};
  }
}

void expect_all_pairs_found(const BlockSystem &system, double skin, std::size_t least) {
  const std::vector<Aabb> boxes = reach_boxes(system, skin);
  const Pairs expected = all_meeting_pairs(system, boxes);
  EXPECT_EQ(find_pairs(system, boxes), expected);
  EXPECT_GE(expected.size(), least) << "the scene must be able to tell";
}

std::vector<std::vector<Vec2>> random_boxes(std::mt19937 &engine, int count, double region) {
  std::vector<std::vector<Vec2>> boxes;
  for (int k = 0; k < count; ++k) {
    const Vec2 low{uniform(engine, 0.0, region), uniform(engine, 0.0, region)};
    boxes.push_back(rectangle(low, low + Vec2{uniform(engine, 0.2, 1.5), uniform(engine, 0.2, 1.5)}));
  }
  return boxes;
}

// Those that no contact acts between: find_pairs() leaves them out.
TEST(FindKeptPairs, AreThoseOfFixedBlocksWhoseBoxesMeet) {
  std::mt19937 engine(29);
  BlockSystem system = testing::system_of({rectangle({0.0, 0.0}, {1.0, 1.0})}, random_boxes(engine, 60, 8.0));
  std::size_t found = 0;
  for (const double skin : {0.0, 0.3}) {
    std::vector<Aabb> boxes = reach_boxes(system, 0.0);
    std::transform(boxes.begin(), boxes.end(), boxes.begin(),
                   [&](const Aabb &box) { return box.inflated(0.5 * skin); });
    Pairs expected;
    for (std::size_t p = system.first_fixed(); p < system.num_rows(); ++p) {
      for (std::size_t q = p + 1; q < system.num_rows(); ++q) {
        if (boxes[p].meets(boxes[q])) {
          expected.emplace_back(BlockIndex{static_cast<std::uint32_t>(p)},
                                BlockIndex{static_cast<std::uint32_t>(q)});
        }
      }
    }
    EXPECT_GE(expected.size(), found + 30U) << "the scene must be able to tell";
    found = expected.size();
    EXPECT_EQ(find_kept_pairs(system, skin), expected);
  }
}

TEST(FindPairs, AgreesWithAllPairs) {
  std::mt19937 engine(51);
  for (int trial = 0; trial < 30; ++trial) {
    const int count = 2 + static_cast<int>(engine() % 150);
    const double region = uniform(engine, 3.0, 15.0);
    BlockSystem system = system_of(random_boxes(engine, count, region), random_boxes(engine, 20, region));
    system.num_ghosts = engine() % static_cast<unsigned>(count);
    system.num_owned = static_cast<std::size_t>(count) - system.num_ghosts;
    shuffle_ids(system, engine);
    expect_all_pairs_found(system, uniform(engine, 0.0, 0.5), 0);
  }
}

TEST(FindPairs, WithAHugeFixedPlane) {
  std::mt19937 engine(52);
  BlockSystem system = system_of(random_boxes(engine, 100, 10.0),
                                 {rectangle({-1e5, -1e5}, {1e5, 0.5}), rectangle({3.0, 3.0}, {4.0, 1e4})});
  shuffle_ids(system, engine);
  expect_all_pairs_found(system, 0.1, 50);
}

TEST(FindPairs, WithAHugeMobileBlock) {
  std::mt19937 engine(53);
  auto boxes = random_boxes(engine, 100, 10.0);
  boxes.push_back(rectangle({-1000.0, -1000.0}, {5.0, 5.0}));
  BlockSystem system = system_of(boxes, {});
  shuffle_ids(system, engine);
  expect_all_pairs_found(system, 0.1, 50);
}

TEST(FindPairs, WithStrayBlocksFarAway) {
  std::mt19937 engine(54);
  auto boxes = random_boxes(engine, 100, 8.0);
  for (const Vec2 at : {Vec2{1e6, 0.0}, {1e6 + 0.5, 0.5}, {-3e5, 2e7}, {0.0, -4e6}, {0.3, -4e6}}) {
    boxes.push_back(rectangle(at, at + Vec2{1.0, 1.0}));
  }
  BlockSystem system = system_of(boxes, {rectangle({-10.0, -5e6}, {10.0, -1.0})});
  shuffle_ids(system, engine);
  expect_all_pairs_found(system, 0.1, 50);
}

TEST(FindPairs, ManyEqualBoxesAndBoxesOnCellBorders) {
  std::mt19937 engine(55);
  std::vector<std::vector<Vec2>> boxes(40, rectangle({2.0, 2.0}, {3.0, 3.0}));
  for (int i = 0; i < 10; ++i) {
    for (int j = 0; j < 10; ++j) { // a wall of unit squares: all boxes touch at borders exactly
      boxes.push_back(rectangle({1.0 * i, 1.0 * j}, {i + 1.0, j + 1.0}));
    }
  }
  BlockSystem system = system_of(boxes, {});
  shuffle_ids(system, engine);
  expect_all_pairs_found(system, 0.0, 40 * 39 / 2 + 300);
}

TEST(FindPairs, WithoutOwnedOrFixedBlocks) {
  BlockSystem ghosts_only =
      system_of({rectangle({0.0, 0.0}, {1.0, 1.0})}, {rectangle({0.5, 0.0}, {2.0, 1.0})});
  ghosts_only.num_owned = 0;
  ghosts_only.num_ghosts = 1;
  EXPECT_TRUE(find_pairs(ghosts_only, reach_boxes(ghosts_only, 0.1)).empty());
  const BlockSystem alone = system_of({rectangle({0.0, 0.0}, {1.0, 1.0})}, {});
  EXPECT_TRUE(find_pairs(alone, reach_boxes(alone, 0.1)).empty());
}

// Boxes are those of t_n, not of the trial configuration, and fixed blocks do not move.
TEST(ReachBoxes, InflateMobileBlocksByHalfTheSkin) {
  BlockSystem system = system_of({rectangle({0.0, 0.0}, {1.0, 1.0})}, {rectangle({5.0, 5.0}, {6.0, 6.0})});
  system.displacement[0] = {{2.0, 0.0}, 0.0};
  system.trial[0] = {{9.0, 9.0}, 0.0};
  const std::vector<Aabb> boxes = reach_boxes(system, 0.5);
  EXPECT_EQ(boxes[0].low, (Vec2{1.75, -0.25}));
  EXPECT_EQ(boxes[0].high, (Vec2{3.25, 1.25}));
  EXPECT_EQ(boxes[1].low, (Vec2{5.0, 5.0}));
  EXPECT_EQ(boxes[1].high, (Vec2{6.0, 6.0}));
}

TEST(MakeCandidates, MemoryIsMatchedByIds) {
  std::mt19937 engine(57);
  BlockSystem system = system_of(random_boxes(engine, 60, 6.0), {});
  shuffle_ids(system, engine);
  const Pairs pairs = find_pairs(system, reach_boxes(system, 0.1));
  // Every second pair remembers a number made of its ids; in any order, twice, and among strangers.
  std::vector<RegionRecord> memory;
  const auto mark = [](BlockId lower, BlockId higher) {
    RegionMemory region;
    region.shear = static_cast<double>(1000 * lower.value + higher.value);
    region.longest = 1.0;
    region.slip = 2.0;
    region.state = ContactState::slip;
    return RegionRecord{lower, higher, region};
  };
  for (std::size_t k = 0; k < pairs.size(); k += 2) {
    memory.push_back(
        mark(system.properties[pairs[k].first.value].id, system.properties[pairs[k].second.value].id));
    memory.push_back(memory.back());
  }
  const std::size_t known = memory.size();
  for (std::int64_t stranger = 0; stranger < 50; ++stranger) {
    memory.push_back(mark(BlockId{stranger}, BlockId{stranger + 1000}));
  }
  for (std::size_t k = memory.size(); k > 1; --k) {
    std::swap(memory[k - 1], memory[engine() % k]);
  }
  ASSERT_GT(known, 40U);
  ContactMemory all;
  for (const RegionRecord &record : memory) { // those of one pair in the same list
    if (record.lower.value % 2 == 0) {
      all.plain.push_back({record.lower, record.higher, record.memory});
    } else {
      all.others.push_back(record);
    }
  }
  ASSERT_GT(all.plain.size(), known / 4);
  ASSERT_GT(all.others.size(), known / 4);
  ContactHistory history;
  history.regions.resize(3); // leftovers of an older list must not shine through
  history.regions[1].shear = 77.0;
  history.overlaps.assign(3, PlainOverlap::polygon);
  history.plain.resize(3);
  make_candidates(system, pairs, {one_law(1e6), 0.0, {}}, all, history, testing::infinite_skin);
  ASSERT_EQ(history.overlaps.size(), pairs.size());
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    ASSERT_EQ(history.of_pair(k).size(), k % 2 == 0 ? 1U : 0U);
    if (k % 2 == 0) {
      const RegionMemory expected =
          mark(system.properties[pairs[k].first.value].id, system.properties[pairs[k].second.value].id)
              .memory;
      const RegionMemory found = history.of_pair(k).front();
      EXPECT_EQ(found.shear, expected.shear);
      EXPECT_EQ(found.longest, expected.longest);
      EXPECT_EQ(found.slip, expected.slip);
      EXPECT_EQ(found.state, expected.state);
    }
  }
}

TEST(MakeCandidates, ConstantsOfAPair) {
  BlockSystem system = system_of({rectangle({0.0, 0.0}, {1.0, 2.0}), rectangle({1.0, 0.0}, {4.0, 3.0})},
                                 {rectangle({-9.0, -0.5}, {9.0, 0.0})}, 1000.0);
  ContactParameters parameters{one_law(4e6, 0.7, 50.0, 0.25), 0.1, PotentialKind::exact};
  ContactHistory history;
  const Pairs pairs{{BlockIndex{0}, BlockIndex{1}}, {BlockIndex{0}, BlockIndex{2}}};
  const Candidates candidates =
      make_candidates(system, pairs, parameters, {}, history, testing::infinite_skin);
  const CandidatePair &mobile = candidates.pairs[0];
  const LawConstants &law = candidates.laws.at(static_cast<std::size_t>(mobile.law));
  EXPECT_EQ(law.half_stiffness, 2e6);
  EXPECT_EQ(law.tangential_stiffness, 1e6);
  EXPECT_EQ(law.tan_friction, 0.7);
  EXPECT_EQ(law.cohesion, 50.0);
  // A few roundings of products and a root.
  const double reduced = 2000.0 * 9000.0 / 11000.0;
  EXPECT_NEAR(mobile.mass, reduced, 1e-12 * reduced);
  // c'/2 = xi sqrt(k_n m/L_ref), L_ref = sqrt(2), the smaller one.
  const double damping = 0.1 * std::sqrt(4e6 * reduced / std::sqrt(2.0));
  EXPECT_NEAR(mobile.damping, damping, 1e-12 * damping);
  EXPECT_NEAR(mobile.allowed_overlap, 0.5, 1e-15);
  // A fixed block is infinitely heavy and sets no length, but its width limits the overlap.
  const CandidatePair &on_base = candidates.pairs[1];
  EXPECT_EQ(on_base.mass, system.properties[0].mass);
  const double base_damping = 0.1 * std::sqrt(4e6 * 2000.0 / std::sqrt(2.0));
  EXPECT_NEAR(on_base.damping, base_damping, 1e-12 * base_damping);
  EXPECT_NEAR(on_base.allowed_overlap, 0.25, 1e-15);
}

TEST(StiffnessBound, IsTheLargestOfAllPartners) {
  JointLaws joints;
  joints.laws.resize(3);
  joints.laws[0].normal_stiffness = 5.0; // no friction: nothing tangential
  joints.laws[1].normal_stiffness = 3.0;
  joints.laws[1].tan_friction = 0.5;
  joints.laws[2].normal_stiffness = 9.0;
  joints.laws[2].cohesion = 1.0;
  joints.num_materials = 2;
  joints.of_material = {0, 1, 1, 2};
  EXPECT_EQ(stiffness_bound(joints, 0).normal, 5.0);
  EXPECT_EQ(stiffness_bound(joints, 0).tangential, 1.5);
  EXPECT_EQ(stiffness_bound(joints, 1).normal, 9.0);
  EXPECT_EQ(stiffness_bound(joints, 1).tangential, 4.5);
}

} // namespace
} // namespace gcpdda::candidates_test
