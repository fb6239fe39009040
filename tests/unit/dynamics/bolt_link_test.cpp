// The law of a bolt where it crosses a joint, its forces, and where it crosses which blocks.

#include "dynamics/bolt_link.hpp"
#include "simulation/bolt_pieces.hpp"
#include "simulation/bolts.hpp"
#include "support/blocks.hpp"
#include "support/setting.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <random>
#include <utility>
#include <vector>

namespace gcpdda::testing::bolt_link_test {
namespace {

LinkLaw elastic_law() {
  LinkLaw law;
  law.axial_stiffness = 5e7;
  law.shear_stiffness = 2e7;
  law.pretension = 3e4;
  return law;
}
const LinkLaw elastic = elastic_law();

/// A rigid block and a deformable one above it, both displaced, turned and the upper one strained.
struct TwoBlocks {
  BlockSystem system = system_of({rectangle({0.0, 0.0}, {2.0, 1.0}), rectangle({0.0, 1.0}, {2.0, 2.0})}, {},
                                 1000.0, [](std::size_t row) { return row == 1; });
  BoltLink link;
  std::array<std::size_t, 2> rows{0, 1};

  TwoBlocks() {
    link.length = 0.4;
    const Vec2 along{std::sin(0.3), std::cos(0.3)};
    const Vec2 crossing{1.2, 1.0};
    link.end[0] = {0, crossing - 0.2 * along - system.properties[0].centroid, along};
    link.end[1] = {1, crossing + 0.2 * along - system.properties[1].centroid, along};
  }

  void displace() {
    system.trial[0] = {{1e-3, -2e-3}, 0.02};
    system.trial[1] = {{9e-3, 4e-3}, -0.03};
    system.deformation_of(1).trial = {0.98, 0.035, -0.028, 1.03};
  }

  void move_as_one(double angle, Vec2 by) {
    const Rotation turn = Rotation::of(angle);
    const Mat2 rotation{turn.c, -turn.s, turn.s, turn.c};
    for (const std::size_t row : rows) {
      const Vec2 x = system.properties[row].centroid + system.trial[row].u;
      system.trial[row].u = rotation(x) + by - system.properties[row].centroid;
      system.trial[row].r += angle;
    }
    system.deformation_of(1).trial = rotation * system.deformation_of(1).trial;
  }

  [[nodiscard]] double energy() const {
    const LinkPose pose = pose_of(system, link, rows);
    return stored_energy(elastic, respond(elastic, {}, pose.extension, pose.slide));
  }
  [[nodiscard]] LinkForce force() const {
    const LinkPose pose = pose_of(system, link, rows);
    return force_of(system, link, rows, pose, respond(elastic, {}, pose.extension, pose.slide));
  }
  /// -dU/dx of any number of the state.
  double pull_along(double &x) {
    const double step = 1e-6;
    const double before = x;
    x = before + step;
    const double above = energy();
    x = before - step;
    const double below = energy();
    x = before;
    return -(above - below) / (2.0 * step);
  }
};

TEST(BoltLink, DoesNotFeelAMotionOfBothBlocksTogether) {
  TwoBlocks blocks;
  blocks.displace();
  const LinkPose before = pose_of(blocks.system, blocks.link, blocks.rows);
  EXPECT_GT(std::abs(before.extension), 1e-3);
  EXPECT_GT(std::abs(before.slide), 1e-3);
  blocks.move_as_one(2.5, {3.0, -7.0});
  const LinkPose after = pose_of(blocks.system, blocks.link, blocks.rows);
  // Rounding of coordinates of 10 m.
  EXPECT_NEAR(after.extension, before.extension, 1e-14);
  EXPECT_NEAR(after.slide, before.slide, 1e-14);
}

// Forces and moments on a rigid and on a deformable block are the derivatives of one energy; the error of the
// difference quotient is 1e-12 of the third derivative, and rounding 1e-16 U/1e-6.
TEST(BoltLink, HasAPotential) {
  TwoBlocks blocks;
  blocks.displace();
  const LinkForce force = blocks.force();
  const double scale = norm(force.rigid[0].u);
  EXPECT_GT(scale, 1e5);
  const double near = 1e-7 * scale;
  RigidDof &a = blocks.system.trial[0];
  RigidDof &b = blocks.system.trial[1];
  Mat2 &gradient = blocks.system.deformation_of(1).trial;
  EXPECT_NEAR(force.rigid[0].u.x, blocks.pull_along(a.u.x), near);
  EXPECT_NEAR(force.rigid[0].u.y, blocks.pull_along(a.u.y), near);
  EXPECT_NEAR(force.rigid[0].r, blocks.pull_along(a.r), near);
  EXPECT_NEAR(force.rigid[1].u.x, blocks.pull_along(b.u.x), near);
  EXPECT_NEAR(force.rigid[1].u.y, blocks.pull_along(b.u.y), near);
  EXPECT_NEAR(force.gradient[1].xx, blocks.pull_along(gradient.xx), near);
  EXPECT_NEAR(force.gradient[1].xy, blocks.pull_along(gradient.xy), near);
  EXPECT_NEAR(force.gradient[1].yx, blocks.pull_along(gradient.yx), near);
  EXPECT_NEAR(force.gradient[1].yy, blocks.pull_along(gradient.yy), near);
}

TEST(BoltLink, KeepsMomentumAndMomentOfMomentum) {
  TwoBlocks blocks;
  blocks.displace();
  const LinkForce force = blocks.force();
  const double scale = norm(force.rigid[0].u);
  EXPECT_LE(norm(force.rigid[0].u + force.rigid[1].u), 1e-15 * scale);
  double torque = 0.0;
  for (const std::size_t k : blocks.rows) {
    const Vec2 centroid = blocks.system.properties[k].centroid + blocks.system.trial[k].u;
    torque += force.rigid[k].r + cross(centroid, force.rigid[k].u);
  }
  EXPECT_NEAR(torque, 0.0, 1e-14 * scale);
}

TEST(BoltLink, IsElasticThenYieldsAndUnloadsElastically) {
  LinkLaw law = elastic;
  law.axial_yield = 8e4;
  law.shear_yield = 4e4;
  const auto fresh = respond(law, {}, 0.0, 0.0);
  EXPECT_EQ(fresh.axial, 3e4); // the pre-tension
  EXPECT_EQ(fresh.shear, 0.0);
  const auto stretched = respond(law, fresh, 5e-4, 1e-3);
  EXPECT_DOUBLE_EQ(stretched.axial, 3e4 + 5e7 * 5e-4);
  EXPECT_DOUBLE_EQ(stretched.shear, 2e7 * 1e-3);
  EXPECT_FALSE(stretched.yielded);
  EXPECT_EQ(stretched.dissipated, 0.0);
  const auto yielded = respond(law, stretched, 2e-3, -5e-3);
  EXPECT_EQ(yielded.axial, 8e4);
  EXPECT_EQ(yielded.shear, -4e4);
  EXPECT_TRUE(yielded.yielded);
  // Capacity times what is beyond the elastic range: (2 - 1) mm along, (5 - 2) mm across.
  EXPECT_NEAR(yielded.dissipated, 8e4 * 1e-3 + 4e4 * 3e-3, 1e-10);
  const auto unloaded = respond(law, yielded, 1.5e-3, -4e-3);
  EXPECT_NEAR(unloaded.axial, 8e4 - 5e7 * 0.5e-3, 1e-8);
  EXPECT_NEAR(unloaded.shear, -4e4 + 2e7 * 1e-3, 1e-8);
  EXPECT_EQ(unloaded.dissipated, yielded.dissipated);
}

// Work along a random path is what is stored and what is gone: by the trapezoid, wrong by k step^2/2 at most
// in each of the steps in which yielding begins or ends.
TEST(BoltLink, LosesWhatItDissipates) {
  LinkLaw law = elastic;
  law.axial_yield = 8e4;
  law.shear_yield = 4e4;
  std::mt19937 random(5);
  const auto draw = [&] { return static_cast<double>(random()) / 2147483648.0 - 1.0; };
  LinkMemory memory = respond(law, {}, 0.0, 0.0);
  double work = -stored_energy(law, memory);
  const double step = 1e-6;
  std::array<double, 2> heading{1.0, 1.0};
  for (int k = 0; k < 40000; ++k) {
    if (k % 4000 == 0) {
      heading = {draw(), draw()};
    }
    const LinkMemory next =
        respond(law, memory, memory.extension + step * heading[0], memory.slide + step * heading[1]);
    work -=
        -0.5 * step * ((memory.axial + next.axial) * heading[0] + (memory.shear + next.shear) * heading[1]);
    memory = next;
  }
  EXPECT_GT(memory.dissipated, 100.0);
  EXPECT_NEAR(work + 2.0 * 0.5 * 3e4 * 3e4 / 5e7, stored_energy(law, memory) + memory.dissipated,
              40.0 * 5e7 * step * step);
}

TEST(BoltLink, BreaksForGoodAtItsRuptureStrain) {
  LinkLaw law = elastic;
  law.axial_yield = 8e4;
  law.rupture = 0.02;
  const double at_rupture = 0.02 - 3e4 / 5e7; // pre-tension has taken its part
  auto memory = respond(law, {}, 0.999 * at_rupture, 0.0);
  EXPECT_FALSE(memory.broken);
  EXPECT_EQ(memory.axial, 8e4);
  const double stored = stored_energy(law, memory);
  const double before = memory.dissipated;
  memory = respond(law, memory, 1.001 * at_rupture, 0.0);
  EXPECT_TRUE(memory.broken);
  EXPECT_EQ(memory.axial, 0.0);
  EXPECT_NEAR(memory.dissipated, before + stored + 8e4 * 0.002 * at_rupture, 1e-8);
  memory = respond(law, memory, 0.0, 0.0);
  EXPECT_EQ(memory.axial, 0.0);
  EXPECT_EQ(stored_energy(law, memory), 0.0);
}

TEST(BoltLink, CablesAreSlackInCompressionAndGroutSlips) {
  SupportType support;
  support.kind = SupportType::Kind::anchored;
  support.axial_rigidity = 1e8;
  support.spacing = 2.0;
  support.pretension = 1e5;
  BoltLink link;
  link.length = 5.0;
  const LinkLaw cable = law_of(support, link);
  EXPECT_DOUBLE_EQ(cable.axial_stiffness, 1e8 / 5.0 / 2.0);
  EXPECT_EQ(cable.shear_stiffness, 0.0);
  auto memory = respond(cable, {}, -0.02, 0.0);
  EXPECT_EQ(memory.axial, 0.0);
  memory = respond(cable, memory, 0.0, 0.0);
  EXPECT_DOUBLE_EQ(memory.axial, 0.5e5); // nothing has flown meanwhile

  support.kind = SupportType::Kind::grouted;
  support.axial_yield = 2e5;
  support.bond_strength = 1e5;
  link.length = 0.4;
  link.bond_length = 0.7;
  link.grout = {0.7, 3.0};
  const LinkLaw bolt = law_of(support, link);
  EXPECT_DOUBLE_EQ(axial_capacity(bolt, {}), 0.7e5 / 2.0);
  EXPECT_DOUBLE_EQ(bolt.pretension, 0.7e5 / 2.0); // more than the grout bears cannot be put in
  EXPECT_LT(respond(bolt, {}, -1e-3, 0.0).axial, 0.0);
  EXPECT_FALSE(respond(bolt, {}, 0.0, 0.0).yielded);
  link.bond_length = 3.0;
  link.grout[0] = 4.0;
  EXPECT_DOUBLE_EQ(axial_capacity(law_of(support, link), {}), 1e5);
}

/// An upright bolt from (0.5, 4) down to (0.5, 0).
Bolt upright() {
  Bolt bolt;
  bolt.from = {0.5, 4.0};
  bolt.to = {0.5, 0.0};
  return bolt;
}

TEST(BoltPieces, AreTheStretchesInsideABlock) {
  std::vector<BoltPiece> pieces;
  // A C that the bolt enters twice, through a mouth between y = 1 and y = 2.
  const std::vector<Vec2> block{{0, -1}, {2, -1}, {2, 1}, {0.2, 1}, {0.2, 2}, {2, 2}, {2, 3}, {0, 3}};
  append_pieces(upright(), 7, block, 3, pieces);
  ASSERT_EQ(pieces.size(), 2U);
  EXPECT_DOUBLE_EQ(pieces[0].begin, 0.25);
  EXPECT_DOUBLE_EQ(pieces[0].end, 0.5);
  EXPECT_DOUBLE_EQ(pieces[1].begin, 0.75);
  EXPECT_DOUBLE_EQ(pieces[1].end, 1.0);
  EXPECT_EQ(pieces[1].bolt, 7);
  EXPECT_EQ(pieces[1].block, 3);
  append_pieces(upright(), 7, rectangle({0.6, 0.0}, {2.0, 4.0}), 4, pieces);
  EXPECT_EQ(pieces.size(), 2U);
}

SupportType grouted() {
  SupportType support;
  support.axial_stiffness = 1e8;
  support.active_length = 0.4;
  return support;
}

TEST(BoltPieces, GroutedBoltsHaveALinkAtEachJoint) {
  SupportType support = grouted();
  // Blocks 5, 2, 9 from the head, the first two a hair apart, then a void of half a metre and block 1.
  std::vector<BoltPiece> pieces{
      {0, 9, 0.5, 0.75}, {0, 5, 0.0, 0.1249}, {0, 2, 0.1251, 0.5}, {0, 1, 0.875, 1.0}};
  const std::vector<BoltLink> links = links_of(upright(), 0, support, pieces);
  ASSERT_EQ(links.size(), 2U);
  EXPECT_EQ(links[0].end[0].block, 2);
  EXPECT_EQ(links[0].end[1].block, 5);
  EXPECT_FALSE(links[0].head_first);
  EXPECT_EQ(links[0].end[0].along, (Vec2{0.0, 1.0})); // from block 2 up to block 5
  EXPECT_NEAR(links[0].end[0].point.y, 3.3, 1e-12);
  EXPECT_NEAR(links[0].end[1].point.y, 3.7, 1e-12);
  EXPECT_NEAR(links[0].bond_length, 0.5, 1e-12); // towards the head
  EXPECT_NEAR(links[0].overhang[0], 0.3, 1e-12);
  EXPECT_TRUE(links[1].head_first);
  EXPECT_NEAR(links[1].bond_length, 1.0, 1e-12); // up to the void
  support.plate = true;
  EXPECT_NEAR(links_of(upright(), 0, support, pieces)[0].bond_length, 2.5, 1e-12); // towards the tip
}

TEST(BoltPieces, AnchoredBoltsJoinTheirTwoEnds) {
  SupportType support = grouted();
  support.kind = SupportType::Kind::anchored;
  std::vector<BoltPiece> pieces{{0, 5, 0.0, 0.2}, {0, 2, 0.3, 0.5}, {0, 9, 0.6, 0.9}};
  const std::vector<BoltLink> links = links_of(upright(), 0, support, pieces);
  ASSERT_EQ(links.size(), 1U);
  EXPECT_EQ(links[0].end[0].block, 5);
  EXPECT_EQ(links[0].end[1].block, 9);
  EXPECT_NEAR(links[0].length, 3.6, 1e-12);
  EXPECT_NEAR(links[0].end[0].point.y, 4.0, 1e-12);
  EXPECT_NEAR(links[0].end[1].point.y, 0.4, 1e-12);
  pieces = {{0, 5, 0.0, 0.2}};
  EXPECT_TRUE(links_of(upright(), 0, support, pieces).empty());
}

// From head to tip without a gap but where a joint has slipped, whatever the blocks do.
TEST(BoltLines, FollowTheBolt) {
  std::string toml = head({.duration = 0.01}) +
                     "[support.bar]\nkind = \"grouted\"\naxial_stiffness = 1e6\nshear_stiffness = 1e6\n"
                     "active_length = 0.3\n[[bolt]]\nsupport = \"bar\"\nfrom = [0.5, 3.9]\nto = [0.7, 0.1]\n";
  for (int k = 0; k < 4; ++k) { // sheared
    toml += block_toml(fmt::format("b{}", k), rectangle({0.0, 1.0 * k}, {1.0, 1.0 + k}),
                       fmt::format("velocity = [{}, 0, {}]", 2.0 * k * k, 0.3 * k));
  }
  Simulation simulation(Communicator::self(), scene_of(toml));
  const auto lines = [&] { return simulation.bolts().lines(Communicator::self(), simulation.blocks()); };
  constexpr double rounding = 1e-12;
  const std::vector<LinkLine> start = lines();
  ASSERT_EQ(start.size(), 3U);
  EXPECT_NEAR(norm(start.front().points.front() - Vec2{0.5, 3.9}), 0.0, rounding);
  EXPECT_NEAR(norm(start.back().points.back() - Vec2{0.7, 0.1}), 0.0, rounding);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR(start[k].points[1].y, 3.0 - static_cast<double>(k), rounding);
    EXPECT_NEAR(norm(start[k].points[2] - start[k].points[1]), 0.0, rounding);
  }
  advance(simulation, 0.01);
  const std::vector<LinkLine> end = lines();
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_NEAR(norm(end[k].points.back() - end[k + 1].points.front()), 0.0, rounding);
  }
  // The upper of two blocks is faster to the right by 10, 6 and 2 m/s, and hardly held back.
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR(end[k].points[1].x - end[k].points[2].x, 0.1 - 0.04 * static_cast<double>(k), 5e-3);
  }
}

// Both neighbours of a joint hold a bolt that runs along it; that is no crossing.
TEST(BoltPieces, AlongAJointThereIsNoLink) {
  std::vector<BoltPiece> pieces;
  append_pieces(upright(), 0, rectangle({0.0, 0.0}, {0.5, 4.0}), 4, pieces);
  append_pieces(upright(), 0, rectangle({0.5, 0.0}, {1.0, 4.0}), 5, pieces);
  EXPECT_EQ(pieces.size(), 2U);
  EXPECT_TRUE(links_of(upright(), 0, grouted(), pieces).empty());
}

TEST(BoltPattern, StandsOnACircleByItsRadii) {
  std::vector<Vec2> circle;
  const int chords = 24;
  for (int k = 0; k < chords; ++k) {
    const double angle = 2.0 * std::numbers::pi * k / chords;
    circle.push_back({3.0 + 5.0 * std::cos(angle), 5.0 * std::sin(angle)});
  }
  const BoltPattern pattern{4.0, 30.0 * degree, 150.0 * degree, 1.0, 0};
  const std::vector<BoltLine> bolts = bolts_of(pattern, circle);
  // A third of the perimeter of 24 chords of 1.3053 m, up to a whole number.
  ASSERT_EQ(bolts.size(), 10U);
  for (std::size_t k = 0; k < bolts.size(); ++k) {
    const Vec2 radius = bolts[k].from - Vec2{3.0, 0.0};
    const Vec2 line = bolts[k].to - bolts[k].from;
    EXPECT_NEAR(norm(line), 4.0, 1e-12);
    // Between middle and end of a chord its normal is interpolated by the way and not by the angle.
    EXPECT_NEAR(cross(radius, line) / (norm(radius) * norm(line)), 0.0, 1e-3);
    const double angle = std::atan2(radius.y, radius.x) / degree;
    EXPECT_NEAR(angle, 30.0 + 12.0 * (static_cast<double>(k) + 0.5), 0.1);
  }
}

TEST(BoltPattern, StandsAtRightAnglesOnEachSideOfACorner) {
  const std::vector<Vec2> square = rectangle({-2.0, 0.0}, {2.0, 4.0});
  const BoltPattern roof{3.0, 60.0 * degree, 120.0 * degree, 0.0, 4};
  const std::vector<BoltLine> bolts = bolts_of(roof, square);
  ASSERT_EQ(bolts.size(), 4U);
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_NEAR(bolts[k].from.x, 1.5 - static_cast<double>(k), 1e-12);
    EXPECT_NEAR(bolts[k].from.y, 4.0, 1e-12);
    EXPECT_NEAR(bolts[k].to.x, bolts[k].from.x, 1e-12);
    EXPECT_NEAR(bolts[k].to.y, 7.0, 1e-12);
  }
  // Right wall, roof and left wall: 12 m.
  const BoltPattern arch{3.0, 0.0, 180.0 * degree, 1.0, 0};
  EXPECT_EQ(bolts_of(arch, square).size(), 12U);
}

// The perimeter is 16 m. From 20 and from -45 degrees on the pattern begins at a corner, else at a side whose
// normal is the first direction; a whole turn ends where it begins.
TEST(BoltPattern, HasEverySideOnceOverAWholeTurn) {
  const std::vector<Vec2> square = rectangle({-2.0, 0.0}, {2.0, 4.0});
  for (const double begin : {-360.0, -90.0, -45.0, 0.0, 20.0, 90.0, 360.0}) {
    const BoltPattern pattern{3.0, begin * degree, (begin + 360.0) * degree, 1.0, 0};
    std::vector<std::pair<double, double>> heads;
    for (const BoltLine &bolt : bolts_of(pattern, square)) {
      heads.emplace_back(std::round(100.0 * bolt.from.x), std::round(100.0 * bolt.from.y));
    }
    EXPECT_EQ(heads.size(), 16U) << begin;
    std::vector<std::pair<double, double>> expected;
    for (const double along : {-150.0, -50.0, 50.0, 150.0}) {
      expected.insert(expected.end(),
                      {{along, 0.0}, {along, 400.0}, {-200.0, 200.0 + along}, {200.0, 200.0 + along}});
    }
    EXPECT_TRUE(std::is_permutation(heads.begin(), heads.end(), expected.begin(), expected.end())) << begin;
  }
}

} // namespace
} // namespace gcpdda::testing::bolt_link_test
