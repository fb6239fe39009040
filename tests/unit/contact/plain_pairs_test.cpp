// Plain pairs, several in the lanes of one evaluation, against the general way that takes one pair after the
// other with all its edges.

#include "contact/block_view.hpp"
#include "contact/geometry/overlap_energy.hpp"
#include "contact/pair_energies.hpp"
#include "support/blocks.hpp"
#include "support/plain_pairs.hpp"
#include "support/scenes.hpp"
#include "support/thinning.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

namespace gcpdda::plain_pairs_test {
namespace {

using namespace testing;

/// A convex polygon with corners on a circle.
std::vector<Vec2> corners_on_circle(std::mt19937 &engine, int num_vertices, Vec2 centre) {
  std::vector<Vec2> vertices;
  const double first = uniform(engine, 0.0, 2.0 * std::numbers::pi);
  for (int k = 0; k < num_vertices; ++k) {
    const double angle = first + (k + uniform(engine, -0.3, 0.3)) * 2.0 * std::numbers::pi / num_vertices;
    vertices.push_back(centre + Vec2{std::cos(angle), std::sin(angle)});
  }
  return vertices;
}

/// Couples of blocks that overlap a little, far from each other; every third couple touches face to face,
/// some of these with sides nearly in one line.
BlockSystem couples(
    std::mt19937 &engine, int count, std::size_t most_vertices,
    bool (*is_deformable)(std::size_t) = [](std::size_t) { return false; }) {
  std::vector<std::vector<Vec2>> blocks;
  for (int k = 0; k < count; ++k) {
    const Vec2 here{10.0 * k, uniform(engine, -5.0, 5.0)};
    if (k % 3 == 0) {
      const double shift = uniform(engine, -0.7, 0.7) * (k % 4 == 0 ? 1e-3 : 1.0);
      const double sunk = k % 2 == 0 ? 1e-3 : 1e-12;
      blocks.push_back(rectangle(here, here + Vec2{1.0, 1.0}));
      blocks.push_back(rectangle(here + Vec2{shift, 1.0 - sunk}, here + Vec2{shift + 1.0, 2.0}));
      continue;
    }
    const auto vertices = [&] { return 3 + static_cast<int>(engine() % (most_vertices - 2)); };
    const double direction = uniform(engine, 0.0, 2.0 * std::numbers::pi);
    const double distance = uniform(engine, 1.2, 1.9);
    blocks.push_back(corners_on_circle(engine, vertices(), here));
    blocks.push_back(corners_on_circle(engine, vertices(),
                                       here + distance * Vec2{std::cos(direction), std::sin(direction)}));
  }
  return system_of(blocks, {}, 1000.0, is_deformable);
}

/// Of each four couples two are rigid, one deforms, one is mixed.
bool some_deform(std::size_t row) {
  return row % 8 == 3 || row % 8 == 6 || row % 8 == 7;
}

Mat2 small_stretch(std::mt19937 &engine, double size) {
  return {uniform(engine, -size, size), uniform(engine, -size, size), uniform(engine, -size, size),
          uniform(engine, -size, size)};
}

/// Deformable blocks start out deformed.
void deform(std::mt19937 &engine, BlockSystem &system) {
  for (Deformation &d : system.deformation) {
    d.gradient = Mat2::identity() + small_stretch(engine, 0.02);
    d.trial = d.refreshed = d.gradient;
  }
  pose(system, 0, system.num_rows());
}

/// Some motion of every block, the same for two benches.
void move_all(std::mt19937 &engine, double size, ContactBench &first, ContactBench &second) {
  for (std::size_t row = 0; row < first.system.num_owned; ++row) {
    const RigidDof motion{{uniform(engine, -size, size), uniform(engine, -size, size)},
                          uniform(engine, -size, size)};
    const Mat2 stretch = small_stretch(engine, size);
    for (ContactBench *bench : {&first, &second}) {
      bench->system.trial[row] += motion;
      bench->system.velocity[row] = 100.0 * motion;
      if (bench->system.is_deformable(row)) {
        bench->system.deformation_of(row).trial += stretch;
        bench->system.deformation_of(row).rate = 100.0 * stretch;
      }
    }
  }
}

/// Three laws, and edges in turn of the second, of the third and without.
JointLaws laws_by_edge(const JointLaws &one, BlockSystem &system) {
  JointLaws joints = one;
  joints.laws.resize(3, one.laws.front());
  joints.laws[1].normal_stiffness *= 0.5;
  joints.laws[2].normal_stiffness *= 0.25;
  joints.laws[2].tan_friction *= 2.0;
  std::vector<std::vector<std::int32_t>> edge_joint(system.num_rows());
  for (std::size_t row = 0; row < system.num_rows(); ++row) {
    for (std::size_t k = 0; k < system.num_vertices(row); ++k) {
      edge_joint[row].push_back(static_cast<std::int32_t>((row + k) % 3) - (k % 2 == 0 ? 1 : 0));
    }
  }
  system = with_edges(system, edge_joint);
  return joints;
}

/// Both kernels have been at work.
void expect_all_ways(const ContactHistory &history, std::size_t most_edges) {
  for (const PlainOverlap overlap : {PlainOverlap::corners, PlainOverlap::polygon}) {
    EXPECT_GE(num_seen_as(overlap, history), most_edges == most_corner_edges ? 15 : 5);
  }
}

constexpr double small_steps = 3e-4;

void expect_agreement(bool (*is_deformable)(std::size_t), bool with_families = false,
                      std::size_t most_edges = most_plain_edges, double steps = small_steps) {
  std::mt19937 engine(91);
  constexpr int count = thinning > 1 ? 100 : 150;
  const double stiffness = 1e6;
  BlockSystem system = couples(engine, count, most_edges, is_deformable);
  deform(engine, system);
  JointLaws joints = one_law(stiffness, 0.3, 10.0);
  if (with_families) {
    joints = laws_by_edge(joints, system);
  }
  TwoWays ways(system, joints, 0.1);
  ASSERT_GE(ways.plain.candidates.plain.size(), static_cast<std::size_t>(count));
  int touching = 0;
  int sliding = 0;
  int deforming = 0;
  std::set<std::int32_t> laws;
  for (int step = 0; step < 4; ++step) {
    move_all(engine, steps, ways.plain, ways.general);
    evaluate_and_finish(ways.plain, ways.general);
    EXPECT_EQ(ways.plain.report.evaluations, ways.general.report.evaluations);
    for (std::size_t k = 0; k < ways.plain.candidates.pairs.size(); ++k) {
      const auto a = ways.plain.regions.of_pair(k);
      const auto b = ways.general.regions.of_pair(k);
      if (a.size() != b.size()) { // touching or not is a matter of rounding only
        EXPECT_LT((a.empty() ? b : a).front().normal_force, 1e-9) << k;
        continue;
      }
      if (!a.empty() && b.front().normal_force > 1e-3) {
        SCOPED_TRACE("pair " + std::to_string(k) + " step " + std::to_string(step));
        const double dyads = expect_same(a.front(), b.front(), stiffness, 10.0 * count);
        const CandidatePair &pair = ways.plain.candidates.pairs[k];
        for (const std::size_t row : {pair.lower.value, pair.higher.value}) {
          if (ways.plain.system.is_deformable(row)) {
            const BlockGradientSum &plain = dyads_on(ways.plain, row);
            const BlockGradientSum &general = dyads_on(ways.general, row);
            expect_near(plain.force, general.force, dyads, "dyad on a block");
            expect_near(plain.shear, general.shear, dyads, "shear dyad on a block");
            expect_near(plain.damping, general.damping, dyads, "damping dyad on a block");
            EXPECT_EQ(norm(plain.damping) > 0.0, norm(a.front().damping_force) > 0.0);
            ++deforming;
          }
        }
        const RegionMemory old = ways.plain.history.of_pair(k).front();
        const RegionMemory expected = ways.general.history.of_pair(k).front();
        EXPECT_EQ(old.state, expected.state);
        EXPECT_EQ(old.law, expected.law);
        laws.insert(old.law);
        ++touching;
        sliding += old.state == ContactState::slip ? 1 : 0;
        if (::testing::Test::HasFailure()) {
          return;
        }
      }
    }
  }
  expect_all_ways(ways.plain.history, most_edges);
  EXPECT_GT(touching, 4 * count / 3);
  EXPECT_GT(sliding, count / 20);
  EXPECT_EQ(deforming > count / 3, is_deformable(3));
  EXPECT_EQ(laws.size() > 2, with_families);
  EXPECT_EQ(*laws.rbegin() > 2, steps > small_steps) << "some have slid to other edges";
}

TEST(PlainPairs, AgreeWithTheGeneralWay) {
  expect_agreement([](std::size_t) { return false; });
}

TEST(PlainPairs, AgreeWhereBlocksDeform) {
  expect_agreement(some_deform);
}

/// Pairs whose corners are looked for first.
std::ptrdiff_t num_with_corners(const Candidates &candidates) {
  return std::count_if(candidates.plain.begin(), candidates.plain.end(),
                       [](const PlainPair &plain) { return plain.kind.may_be_corners(); });
}

TEST(PlainPairs, AgreeWhereCornersOverlap) {
  expect_agreement([](std::size_t) { return false; }, false, most_corner_edges);
  expect_agreement(some_deform, true, most_corner_edges);
}

// Regions are born one by one, since they look at edges, and live in the lanes.
TEST(PlainPairs, AgreeWhereEdgesHaveLawsOfTheirOwn) {
  expect_agreement(some_deform, true);
}

TEST(PlainPairs, AgreeWhereTheySlideToOtherEdges) {
  expect_agreement(some_deform, true, most_plain_edges, 0.1);
}

// Their blocks do not wait: what is born joins its group, in the order of the other blocks' ids.
TEST(PlainPairs, BornAmongLawsAreAddedWithTheirGroup) {
  std::mt19937 engine(95);
  constexpr int count = 150;
  BlockSystem system = couples(engine, count, most_plain_edges, some_deform);
  deform(engine, system);
  const JointLaws joints = laws_by_edge(one_law(1e6, 0.3, 10.0), system);
  ContactBench bench(std::move(system), joints, 0.1);
  ASSERT_TRUE(bench.candidates.waiting.empty());
  ASSERT_GT(bench.candidates.plain.back().group(), 2U);
  for (int step = 0; step < 2; ++step) { // they are born, then known
    bench.evaluate();
    const ContactCount counted = bench.forces.finish_sums(bench.system, bench.candidates);
    const Regions regions(bench.system, bench.candidates, bench.history, bench.forces);
    EXPECT_EQ(counted.touching, std::ssize(regions.all()));
    std::size_t mixed = 0;
    for (const RegionForce &force : regions.all()) {
      EXPECT_EQ(force.born, step == 0);
      mixed += bench.candidates.pairs[force.pair].is_mixed ? 1 : 0;
    }
    EXPECT_GT(mixed, static_cast<std::size_t>(count) / 2);
    for (std::size_t row = 0; row < bench.system.num_owned; ++row) {
      const BlockContactSum wanted = regions.sum_contacts(bench.candidates, row);
      const BlockContactSum &got = bench.forces.sums().of_blocks()[row];
      if (step == 0) { // born one by one, read in the lanes: eps of coordinates times k_n
        constexpr double rounding = 64.0 * std::numeric_limits<double>::epsilon() * 10.0 * count * 1e6;
        expect_near(got.force.u, wanted.force.u, rounding, "force");
        expect_near(got.damping.u, wanted.damping.u, rounding, "damping");
      } else {
        EXPECT_EQ(got.force, wanted.force);
        EXPECT_EQ(got.damping, wanted.damping);
      }
      if (bench.system.is_deformable(row)) {
        EXPECT_EQ(norm(dyads_on(bench, row).force) > 0.0, norm(wanted.force.u) > 0.0);
      }
    }
  }
}

// Machines of one cluster may differ.
void expect_same_bits_by(Instructions instructions) {
  std::mt19937 engine(93);
  BlockSystem system = couples(engine, 200, most_plain_edges, some_deform);
  deform(engine, system);
  ContactBench wider(system, one_law(1e6, 0.3, 10.0), 0.1, instructions);
  ContactBench portable(system, one_law(1e6, 0.3, 10.0), 0.1, Instructions::portable);
  std::size_t touching = 0;
  std::size_t deforming = 0;
  for (int step = 0; step < 3; ++step) {
    move_all(engine, 1e-3, wider, portable);
    evaluate_and_finish(wider, portable);
    const auto regions = portable.regions.all();
    ASSERT_EQ(wider.regions.all().size(), regions.size());
    for (std::size_t k = 0; k < regions.size(); ++k) {
      expect_same_bits(wider.regions.all()[k], regions[k]);
      const RegionState &memory = wider.history.state(regions[k].pair, 0);
      EXPECT_EQ(memory.shear, portable.history.state(regions[k].pair, 0).shear);
      EXPECT_EQ(memory.slip, portable.history.state(regions[k].pair, 0).slip);
    }
    touching += regions.size();
    deforming += expect_same_sums(wider, portable);
  }
  expect_all_ways(wider.history, most_plain_edges);
  EXPECT_GT(touching, 200U);
  EXPECT_GT(deforming, 50U);
}

TEST(PlainPairs, WiderRegistersChangeNoBit) {
  for (const Instructions instructions : {Instructions::widest, Instructions::avx2}) {
    expect_same_bits_by(instructions);
  }
}

/// Of all pairs.
std::vector<double> energies_of(const ContactBench &bench, Instructions instructions = Instructions::widest) {
  PairEnergies energies(instructions);
  std::vector<double> all;
  while (all.size() < bench.candidates.pairs.size()) {
    const auto group = static_cast<std::uint32_t>(all.size() / PlainPair::pairs_in_group);
    const std::span<const double> found = energies.of_group(bench.system, bench.candidates, group);
    all.insert(all.end(), found.begin(), found.end());
  }
  all.resize(bench.candidates.pairs.size());
  return all;
}

// By forces or boundaries, without cutting the overlap out.
TEST(PlainPairs, HaveTheEnergyOfTheirOverlap) {
  std::mt19937 engine(94);
  constexpr int count = 300;
  const ContactBench bench(couples(engine, count, most_corner_edges), one_law(1e6, 0.3, 10.0), 0.1);
  const BlockSystem &system = bench.system;
  // Depths are differences of coordinates up to 10 m a couple, over the area of an overlap in a block of 2 m.
  const double rounding = 64.0 * std::numeric_limits<double>::epsilon() * 10.0 * count;
  const std::vector<double> energies = energies_of(bench);
  const std::vector<double> portable = energies_of(bench, Instructions::portable);
  std::array<TrialOutline, 2> outlines;
  int known = 0;
  int left = 0;
  for (std::size_t k = 0; k < energies.size(); ++k) {
    const CandidatePair &pair = bench.candidates.pairs[k];
    const double cut = overlap_energy(view_of(system, pair.lower.value, outlines[0]),
                                      view_of(system, pair.higher.value, outlines[1]));
    ASSERT_EQ(std::isnan(energies[k]), std::isnan(portable[k]));
    if (std::isnan(energies[k])) {
      left += cut > rounding ? 1 : 0;
    } else {
      ASSERT_EQ(energies[k], portable[k]);
      ASSERT_NEAR(energies[k], cut, rounding) << k;
      known += cut > 1e3 * rounding ? 1 : 0;
    }
  }
  EXPECT_GT(known, count / 3);
  EXPECT_LE(left, count / 100) << "these are for the general way, as overlaps as small as rounding are";
}

void expect_same_bits_without_some_edges(std::size_t most_edges) {
  std::mt19937 engine(92);
  constexpr int count = thinning > 1 ? 80 : 200;
  BlockSystem system = couples(engine, count, most_edges, some_deform);
  deform(engine, system);
  ContactBench whole(system, one_law(1e6, 0.3, 10.0), 0.1);
  ContactBench cut(system, one_law(1e6, 0.3, 10.0), 0.1);
  std::vector<std::pair<BlockIndex, BlockIndex>> couple_pairs;
  for (std::uint32_t row = 0; row < system.num_owned; row += 2) {
    couple_pairs.emplace_back(BlockIndex{row}, BlockIndex{row + 1});
  }
  const double skin = 0.02;
  cut.candidates = make_candidates(system, couple_pairs, cut.forces.parameters(), {}, cut.history, skin);
  EXPECT_LT(cut.candidates.pairs.size(), couple_pairs.size()) << "some are kept apart by a line";
  EXPECT_LT(edges_a_pair(cut.candidates), 10.0);
  EXPECT_GT(num_with_corners(cut.candidates), most_edges == most_corner_edges ? count / 2 : 0);
  EXPECT_LT(edges_a_pair(cut.candidates), edges_a_pair(whole.candidates));
  int touching = 0;
  int with_energy = 0;
  for (int step = 0; step < 3; ++step) {
    move_all(engine, 1e-3, whole, cut);
    whole.evaluate();
    cut.evaluate();
    const std::vector<double> energies = energies_of(whole);
    const std::vector<double> cut_energies = energies_of(cut);
    for (std::size_t k = 0; k < whole.candidates.pairs.size(); ++k) {
      const auto expected = whole.regions.of_pair(k);
      const auto place = find_pair(cut, whole.candidates.pairs[k]);
      if (!place) {
        ASSERT_TRUE(expected.empty());
        ASSERT_FALSE(energies[k] > 0.0);
        continue;
      }
      const auto got = cut.regions.of_pair(*place);
      ASSERT_EQ(std::isnan(cut_energies[*place]), std::isnan(energies[k]));
      if (!std::isnan(energies[k])) {
        ASSERT_EQ(cut_energies[*place], energies[k]);
        ++with_energy;
      }
      ASSERT_EQ(got.size(), expected.size());
      if (!expected.empty()) {
        expect_same_bits(got.front(), expected.front());
        EXPECT_EQ(cut.history.of_pair(*place).front().shear, whole.history.of_pair(k).front().shear);
        ++touching;
      }
    }
  }
  expect_all_ways(cut.history, most_edges);
  EXPECT_GT(touching, count);
  EXPECT_GT(with_energy, most_edges == most_corner_edges ? count / 3 : count / 8);
}

// A neighbourhood may be refreshed at any time: with all edges in the list or those that a skin leaves, in
// other lanes, a contact is the same bit by bit.
TEST(PlainPairs, EdgesThatAreLeftOutChangeNoBit) {
  expect_same_bits_without_some_edges(most_plain_edges);
}

TEST(PlainPairs, EdgesThatAreLeftOutChangeNoBitWhereCornersOverlap) {
  expect_same_bits_without_some_edges(most_corner_edges);
}

} // namespace
} // namespace gcpdda::plain_pairs_test
