// Blocks that lie on each other with whole edges, their next edges in one line: no corner of one is clearly
// inside the other one.

#include "support/plain_pairs.hpp"
#include "support/scenes.hpp"
#include "support/thinning.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>

namespace gcpdda::edges_in_line_test {
namespace {

using namespace testing;

constexpr std::ptrdiff_t num_couples = thinning > 1 ? 40 : 120;
constexpr double farthest = 10.0 * num_couples; ///< m

/// Of each four couples two are rigid, one deforms, of one the second block alone does.
bool some_deform(std::size_t row) {
  return row % 8 == 3 || row % 8 == 6 || row % 8 == 7;
}

enum class Shape { oblique, upright };

/// Couples of quadrilaterals between two lines that run apart, cut across at places of their own so that the
/// parts overlap a little; or of rectangles.
BlockSystem strips(std::mt19937 &engine, bool (*is_deformable)(std::size_t), Shape shape = Shape::oblique,
                   double scale = 1.0) {
  const double skew = shape == Shape::upright ? 0.0 : 1.0;
  std::vector<std::vector<Vec2>> blocks;
  for (std::size_t k = 0; k < num_couples; ++k) {
    const Rotation turn = Rotation::of(uniform(engine, 0.0, 2.0 * std::numbers::pi));
    const Vec2 here{10.0 * static_cast<double>(k), uniform(engine, -5.0, 5.0)};
    const double opening = skew * uniform(engine, -0.3, 0.3);
    const auto right = [&](double s) { return here + turn(Vec2{s, 0.0}); };
    const auto left = [&](double s) { return here + turn(Vec2{s, 1.0 + opening * s}); };
    const double depth = scale * uniform(engine, 1e-3, 0.03);
    const double other_depth = depth + skew * scale * uniform(engine, 0.0, 0.02);
    const double slant = skew * uniform(engine, -0.3, 0.3);
    const double on_left = 1.0 + slant;
    blocks.push_back({right(0.0), right(1.0), left(on_left), left(0.1 * skew)});
    blocks.push_back({right(1.0 - depth), right(2.0), left(2.0 + 0.2 * skew), left(on_left - other_depth)});
    if (k % 2 == 0) { // the other one has the lower id
      std::swap(blocks[2 * k], blocks[2 * k + 1]);
    }
  }
  return system_of(blocks, {}, 1000.0, is_deformable);
}

/// The same affine motion for both blocks of a couple leaves their sides in line; rigid ones only turn. Their
/// velocities and what they did in the last step are anything.
void move_together(std::mt19937 &engine, std::initializer_list<ContactBench *> benches) {
  const BlockSystem &like = (*benches.begin())->system;
  for (std::size_t row = 0; row < like.num_owned; row += 2) {
    const double angle = uniform(engine, -3e-3, 3e-3);
    const Rotation turn = Rotation::of(angle);
    const Mat2 turned{turn.c, -turn.s, turn.s, turn.c};
    const auto random = [&](double size) { return uniform(engine, -size, size); };
    const Mat2 stretch{random(0.02), random(0.02), random(0.02), random(0.02)};
    const bool both_deform = like.is_deformable(row) && like.is_deformable(row + 1);
    const Mat2 gradient = both_deform ? turned * (Mat2::identity() + stretch) : turned;
    const Vec2 origin = like.properties[row].centroid;
    for (const std::size_t of : {row, row + 1}) {
      const Vec2 arm = like.properties[of].centroid - origin;
      const RigidDof trial{gradient(arm) - arm, angle};
      const RigidDof step{{random(1e-2), random(1e-2)}, random(1e-3)};
      const RigidDof velocity{{random(0.1), random(0.1)}, random(0.1)};
      const Mat2 rate{random(0.1), random(0.1), random(0.1), random(0.1)};
      for (ContactBench *bench : benches) {
        bench->system.trial[of] = trial;
        bench->moved_on[of] = trial - step;
        bench->system.velocity[of] = velocity;
        if (bench->system.is_deformable(of)) {
          Deformation &d = bench->system.deformation_of(of);
          d.trial = gradient;
          bench->stretched_on[bench->system.deformation_begin[of]] = gradient - 1e-3 * rate;
          d.rate = rate;
        }
      }
    }
  }
}

constexpr double stiffness = 1e6; ///< Pa/m

/// The contact of a couple, and what it does to blocks that deform.
void expect_same_contact(const TwoWays &ways, std::size_t couple) {
  const RegionForce &a = ways.plain.regions.all()[couple];
  const RegionForce &b = ways.general.regions.all()[couple];
  ASSERT_EQ(a.pair, b.pair);
  const double dyads = expect_same(a, b, stiffness, farthest);
  const CandidatePair &pair = ways.plain.candidates.pairs[a.pair];
  for (const std::size_t row : {pair.lower.value, pair.higher.value}) {
    if (ways.plain.system.is_deformable(row)) {
      expect_near(dyads_on(ways.plain, row).force, dyads_on(ways.general, row).force, dyads,
                  "dyad on a block");
    }
  }
  EXPECT_EQ(ways.plain.history.of_pair(a.pair).front().state,
            ways.general.history.of_pair(a.pair).front().state);
}

// Where edges that run in one line do not run along n_r, a dashpot acts on one of the two, if that is the one
// that rounding has put inside.
void expect_agreement(bool (*is_deformable)(std::size_t), Shape shape) {
  std::mt19937 engine(17);
  const double damping_ratio = shape == Shape::upright ? 0.1 : 0.0;
  TwoWays ways(strips(engine, is_deformable, shape), one_law(stiffness, 0.3, 10.0), damping_ratio);
  std::ptrdiff_t sliding = 0;
  for (int step = 0; step < 3; ++step) {
    move_together(engine, {&ways.plain, &ways.general});
    evaluate_and_finish(ways.plain, ways.general);
    EXPECT_GE(num_seen_as(PlainOverlap::polygon, ways.plain.history), num_couples * 9 / 10);
    ASSERT_EQ(std::ssize(ways.plain.regions.all()), num_couples);
    ASSERT_EQ(std::ssize(ways.general.regions.all()), num_couples);
    for (std::size_t couple = 0; couple < num_couples && !::testing::Test::HasFailure(); ++couple) {
      SCOPED_TRACE("couple " + std::to_string(couple) + " step " + std::to_string(step));
      expect_same_contact(ways, couple);
      const std::uint32_t pair = ways.plain.regions.all()[couple].pair;
      sliding += ways.plain.history.state(pair, 0).state == ContactState::slip ? 1 : 0;
    }
  }
  EXPECT_GT(sliding, 0);
}

TEST(EdgesInLine, AgreeWithTheGeneralWay) {
  expect_agreement([](std::size_t) { return false; }, Shape::oblique);
  expect_agreement([](std::size_t) { return false; }, Shape::upright);
}

TEST(EdgesInLine, AgreeWhereBlocksDeform) {
  expect_agreement(some_deform, Shape::oblique);
}

// A refresh may leave out the two edges that are far from the contact, or not.
TEST(EdgesInLine, EdgesThatAreLeftOutChangeNoBit) {
  std::mt19937 engine(18);
  const BlockSystem system = strips(engine, some_deform);
  ContactBench whole(system, one_law(1e6, 0.3, 10.0), 0.1);
  ContactBench cut(system, one_law(1e6, 0.3, 10.0), 0.1);
  std::vector<std::pair<BlockIndex, BlockIndex>> pairs;
  for (std::uint32_t row = 0; row < system.num_owned; row += 2) {
    pairs.emplace_back(BlockIndex{row}, BlockIndex{row + 1});
  }
  cut.candidates = make_candidates(system, pairs, cut.forces.parameters(), {}, cut.history, 0.05);
  ASSERT_LT(edges_a_pair(cut.candidates), 0.9 * edges_a_pair(whole.candidates));
  for (int step = 0; step < 3; ++step) {
    move_together(engine, {&whole, &cut});
    evaluate_and_finish(whole, cut);
    ASSERT_EQ(std::ssize(cut.regions.all()), num_couples);
    ASSERT_EQ(std::ssize(whole.regions.all()), num_couples);
    for (std::size_t k = 0; k < num_couples; ++k) {
      const RegionForce &expected = whole.regions.all()[k];
      expect_same_bits(cut.regions.all()[k], expected);
      EXPECT_EQ(cut.history.overlaps[k], whole.history.overlaps[expected.pair]);
    }
    expect_same_sums(cut, whole);
  }
  EXPECT_GE(num_seen_as(PlainOverlap::polygon, cut.history), num_couples * 9 / 10);
}

// A refresh forgets how a pair overlaps, and rank counts decide when maps are made anew; also where blocks
// touch by rounding only, as all do that a joint has cut apart.
TEST(EdgesInLine, WhatIsForgottenChangesNoBit) {
  std::ptrdiff_t by_polygon = 0;
  for (int digits = 0; digits <= 16; ++digits) {
    const double scale = std::pow(10.0, -digits);
    std::mt19937 engine(20);
    const BlockSystem system = strips(engine, some_deform, Shape::oblique, scale);
    ContactBench knowing(system, one_law(1e6, 0.3, 10.0), 0.1);
    ContactBench forgetful(system, one_law(1e6, 0.3, 10.0), 0.1);
    for (int step = 0; step < 4; ++step) {
      move_together(engine, {&knowing, &forgetful});
      evaluate_and_finish(knowing, forgetful);
      ASSERT_EQ(knowing.regions.all().size(), forgetful.regions.all().size()) << scale;
      for (std::size_t k = 0; k < knowing.regions.all().size(); ++k) {
        expect_same_bits(forgetful.regions.all()[k], knowing.regions.all()[k]);
      }
      EXPECT_EQ(forgetful.history.overlaps, knowing.history.overlaps);
      by_polygon += num_seen_as(PlainOverlap::polygon, knowing.history);
      for (PlainOverlap &overlap : forgetful.history.overlaps) {
        overlap = overlap == PlainOverlap::none ? overlap : PlainOverlap::corners;
      }
    }
  }
  EXPECT_GT(by_polygon, 4 * num_couples);
}

TEST(EdgesInLine, WiderRegistersChangeNoBit) {
  for (const Instructions instructions : {Instructions::widest, Instructions::avx2}) {
    std::mt19937 engine(19);
    const BlockSystem system = strips(engine, some_deform);
    ContactBench wider(system, one_law(1e6, 0.3, 10.0), 0.1, instructions);
    ContactBench portable(system, one_law(1e6, 0.3, 10.0), 0.1, Instructions::portable);
    move_together(engine, {&wider, &portable});
    evaluate_and_finish(wider, portable);
    EXPECT_EQ(wider.history.overlaps, portable.history.overlaps);
    ASSERT_EQ(std::ssize(wider.regions.all()), num_couples);
    for (std::size_t k = 0; k < num_couples; ++k) {
      expect_same_bits(wider.regions.all()[k], portable.regions.all()[k]);
    }
    EXPECT_GT(expect_same_sums(wider, portable), num_couples / std::size_t{4});
  }
}

// Out of line by little, one block has a corner in the other one and is looked at otherwise: the force
// follows.
TEST(EdgesInLine, LeaveTheLineWithoutAJump) {
  constexpr double sunk = 1e-3;
  ContactBench bench(
      system_of({rectangle({0.0, 0.0}, {1.0, 1.0}), rectangle({0.0, 1.0 - sunk}, {1.0, 2.0})}, {}),
      one_law(stiffness));
  bench.evaluate();
  const Vec2 in_line = bench.seen.force;
  const PairTorques turning = bench.seen.torque;
  // k_n d l (1 - d/l) of equal faces
  EXPECT_NEAR(in_line.y, -stiffness * sunk * (1.0 - sunk), 1e-12 * stiffness);
  std::set<PlainOverlap> ways{bench.history.overlaps.front()};
  double shift = 0.0;
  for (const double next : {1e-16, 1e-15, 1e-14, 1e-13, 1e-12, 1e-10, 1e-8, 1e-6}) {
    bench.move(1, {{next - shift, 0.0}, 0.0});
    shift = next;
    ways.insert(bench.history.overlaps.front());
    // The pressure over no more than the shift changes by no more than that of the depth.
    const double most = 2.0 * stiffness * sunk * shift + 1e-13 * stiffness;
    expect_near(bench.seen.force, in_line, most, "force");
    // Torques follow with arms of 0.5 m along the faces, and turn nothing in all.
    const Vec2 apart = bench.system.motion[1].centroid - bench.system.motion[0].centroid;
    EXPECT_NEAR(bench.seen.torque[0] + bench.seen.torque[1], cross(apart, bench.seen.force),
                1e-13 * stiffness);
    for (const std::size_t k : {0U, 1U}) {
      EXPECT_NEAR(bench.seen.torque[k], turning[k], most + norm(in_line) * shift);
    }
  }
  EXPECT_TRUE(ways.contains(PlainOverlap::polygon));
  EXPECT_TRUE(ways.contains(PlainOverlap::corners));
}

} // namespace
} // namespace gcpdda::edges_in_line_test
