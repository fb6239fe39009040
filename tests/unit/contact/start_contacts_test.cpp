// Which stretches of edges water tables choose by the contacts at the start.

#include "contact/start_contacts.hpp"

#include "contact/find_pairs.hpp"
#include "dynamics/water_pressure.hpp"
#include "support/blocks.hpp"
#include "support/scenes.hpp"

#include <gtest/gtest.h>

#include <tuple>
#include <vector>

namespace gcpdda::start_contacts_test {
namespace {

using namespace testing;

constexpr std::int32_t seam = 1;
constexpr std::int32_t weak = 2;

using Named = std::vector<std::int32_t>; // laws of the edges of a rectangle, from its bottom on

JointLaws laws() {
  JointLaws joints = one_law(1e6, 0.9);
  joints.laws.resize(3, joints.laws.front());
  joints.laws[seam].tan_friction = 0.5;
  joints.laws[weak].tan_friction = 0.1;
  return joints;
}

struct Rectangle {
  Vec2 low;
  Vec2 high;
  Named named{};
};

/// All stretches, by block.
std::vector<std::vector<WaterStretch>> stretches_of(const std::vector<Rectangle> &rectangles,
                                                    const std::vector<bool> &is_listed) {
  BlockSystem system;
  Material material;
  material.density = 1.0;
  for (const Rectangle &of : rectangles) {
    SceneBlock block;
    block.vertices = rectangle(of.low, of.high);
    block.edge_joint = of.named;
    append_block(system, BlockId{static_cast<std::int64_t>(system.num_rows())}, block, material);
  }
  system.num_owned = system.num_rows();
  const auto pairs = find_pairs(system, reach_boxes(system, 0.1));
  const std::vector<StartContact> contacts = find_start_contacts(system, pairs, laws());
  std::vector<std::vector<WaterStretch>> all;
  for (std::size_t row = 0; row < system.num_rows(); ++row) {
    std::vector<StartContact> own;
    for (const StartContact &contact : contacts) {
      if (contact.block == static_cast<std::int64_t>(row)) {
        own.push_back(contact);
      }
    }
    all.push_back(water_stretches_of(system, row, own, is_listed));
  }
  return all;
}

const std::vector<bool> seam_is_listed{false, true, false};
const Named on_bottom{seam, -1, -1, -1};
const Named on_top{-1, -1, seam, -1};

TEST(StartContacts, LieOnBothFacesWhicheverNamesTheLaw) {
  const Rectangle lower{{0.0, 0.0}, {4.0, 1.0}};
  const Rectangle upper{{0.0, 1.0}, {4.0, 2.0}};
  const auto by_upper = stretches_of({lower, {upper.low, upper.high, on_bottom}}, seam_is_listed);
  EXPECT_EQ(by_upper[0], (std::vector<WaterStretch>{{2, seam, 0.0, 1.0}}));
  EXPECT_EQ(by_upper[1], std::vector<WaterStretch>{}) << "the edge says it itself";
  const auto by_lower = stretches_of({{lower.low, lower.high, on_top}, upper}, seam_is_listed);
  EXPECT_EQ(by_lower[0], std::vector<WaterStretch>{});
  EXPECT_EQ(by_lower[1], (std::vector<WaterStretch>{{0, seam, 0.0, 1.0}}));
  const auto by_both =
      stretches_of({{lower.low, lower.high, on_top}, {upper.low, upper.high, on_bottom}}, seam_is_listed);
  EXPECT_EQ(by_both[0], std::vector<WaterStretch>{});
  EXPECT_EQ(by_both[1], std::vector<WaterStretch>{});
}

TEST(StartContacts, FollowTheWeakerLawOfTheContact) {
  const auto stretches = stretches_of(
      {{{0.0, 0.0}, {4.0, 1.0}, on_top}, {{0.0, 1.0}, {4.0, 2.0}, {weak, -1, -1, -1}}}, seam_is_listed);
  EXPECT_EQ(stretches[0], (std::vector<WaterStretch>{{2, -1, 0.0, 1.0}})) << "dry in spite of its name";
  EXPECT_EQ(stretches[1], std::vector<WaterStretch>{});
}

TEST(StartContacts, LieByTheMaterialsWhereNoEdgeNamesALaw) {
  const auto stretches =
      stretches_of({{{0.0, 0.0}, {4.0, 1.0}}, {{0.0, 1.0}, {4.0, 2.0}}}, {true, false, false});
  EXPECT_EQ(stretches[0], (std::vector<WaterStretch>{{2, 0, 0.0, 1.0}}));
  EXPECT_EQ(stretches[1], (std::vector<WaterStretch>{{0, 0, 0.0, 1.0}}));
}

// The top of a long block runs from right to left: under nothing, under one block without a name, under one
// with a name, and under nothing.
TEST(StartContacts, CoverTheStretchThatFacesTheJoint) {
  const Rectangle long_one{{0.0, 0.0}, {10.0, 1.0}};
  const Rectangle wet{{1.0, 1.0}, {4.0, 2.0}, on_bottom};
  const Rectangle dry{{4.0, 1.0}, {8.0, 2.0}};
  const auto near = [](const WaterStretch &is, const WaterStretch &expected) {
    EXPECT_EQ(is.edge, expected.edge);
    EXPECT_EQ(is.law, expected.law);
    EXPECT_NEAR(is.begin, expected.begin, 1e-12);
    EXPECT_NEAR(is.end, expected.end, 1e-12);
  };
  const auto unnamed = stretches_of({long_one, wet, dry}, seam_is_listed);
  ASSERT_EQ(unnamed[0].size(), 3U);
  near(unnamed[0][0], {2, -1, 0.0, 0.6});
  near(unnamed[0][1], {2, seam, 0.6, 0.9});
  near(unnamed[0][2], {2, -1, 0.9, 1.0});
  EXPECT_EQ(unnamed[2], std::vector<WaterStretch>{});
  const auto named = stretches_of({{long_one.low, long_one.high, on_top}, wet, dry}, seam_is_listed);
  EXPECT_EQ(named[0], std::vector<WaterStretch>{}) << "all of it is wet, what faces nothing too";
  ASSERT_EQ(named[2].size(), 1U);
  near(named[2][0], {0, seam, 0.0, 1.0});
}

TEST(StartContacts, AreVisitedAsOneWhereTheyMeet) {
  BlockSystem system;
  Material material;
  material.density = 1.0;
  SceneBlock block;
  block.vertices = rectangle({0.0, 0.0}, {1.0, 1.0});
  block.edge_joint = {-1, seam, -1, -1};
  append_block(system, BlockId{0}, block, material);
  system.water_stretch = {{0, seam, 0.0, 0.25}, {0, weak, 0.25, 0.5}, {0, -1, 0.5, 1.0}, {2, -1, 0.0, 1.0}};
  system.water_stretch_begin.lengthen(0, 4);
  Water water;
  using Visited = std::vector<std::tuple<std::size_t, double, double>>;
  const auto visited = [&](const std::vector<std::int32_t> &joints) {
    water.joints = joints;
    Visited all;
    for_wet_stretches(system, 0, water,
                      [&](std::size_t k, double begin, double end) { all.emplace_back(k, begin, end); });
    return all;
  };
  EXPECT_EQ(visited({seam, weak}), (Visited{{0, 0.0, 0.5}, {1, 0.0, 1.0}}));
  EXPECT_EQ(visited({weak}), (Visited{{0, 0.25, 0.5}}));
  EXPECT_EQ(visited({}), (Visited{{0, 0.0, 1.0}, {1, 0.0, 1.0}, {2, 0.0, 1.0}, {3, 0.0, 1.0}}));
}

} // namespace
} // namespace gcpdda::start_contacts_test
