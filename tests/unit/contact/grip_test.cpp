// Where friction acts on a pair with a deformable block: at a material point that moves only as grip.hpp
// says.

#include "support/blocks.hpp"
#include "support/scenes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace gcpdda::grip_test {
namespace {

using namespace testing;

constexpr double epsilon = std::numeric_limits<double>::epsilon();
constexpr double stiffness = 1e8; // k_n, Pa/m
constexpr double tangential = 0.5 * stiffness;
constexpr double depth = 1e-3;
/// Coordinates near 1 m, over depths.
constexpr double rounding = 64.0 * epsilon / depth;

bool all_deform(std::size_t) {
  return true;
}
bool none_deforms(std::size_t) {
  return false;
}

/// A block of 2 x 1 m, the lower one of its pair, on a wide fixed plane.
ContactBench block_on_plane(double tan_friction, bool (*is_deformable)(std::size_t) = all_deform) {
  return {system_of({rectangle({-1.0, -depth}, {1.0, 1.0 - depth})}, {rectangle({-20.0, -5.0}, {20.0, 0.0})},
                    1000.0, is_deformable),
          one_law(stiffness, tan_friction)};
}

/// Rotate a deformable block about the middle of its base, which does not slide, and lift it.
const ContactBench::Seen &turn(ContactBench &bench, double angle, double lift = 0.0) {
  Mat2 &trial = bench.system.deformation_of(0).trial;
  const Mat2 by{std::cos(angle), -std::sin(angle), std::sin(angle), std::cos(angle)};
  trial = by * trial;
  const double before = bench.system.trial[0].r;
  return bench.move(0, {{0.5 * (std::sin(before) - std::sin(before + angle)), lift}, angle});
}

/// Where the part that is closed begins on the left, and its middle; t_r = -x.
double left_end(const ContactBench::Seen &force) {
  return force.point.x - force.extent_end;
}
double middle(const ContactBench::Seen &force) {
  return force.point.x - 0.5 * (force.extent_begin + force.extent_end);
}

TEST(Grip, IsTheMiddleOfANewJoint) {
  ContactBench bench = block_on_plane(0.5);
  const ContactBench::Seen &force = bench.evaluate();
  ASSERT_TRUE(force.touching);
  EXPECT_NEAR(force.grip.x, 0.0, rounding);
  EXPECT_NEAR(force.grip.y, force.point.y, rounding);
}

// The centre of pressure of a joint that is tilted wanders by l^2 theta/(12 d).
TEST(Grip, StaysInTheMaterialWhileTheJointTilts) {
  ContactBench bench = block_on_plane(0.5);
  bench.evaluate();
  const Vec2 before = bench.memory().grip;
  const double small = 0.1 * depth; // the joint stays closed
  const ContactBench::Seen &force = turn(bench, small);
  const double wandered = 4.0 * small / (12.0 * depth);
  EXPECT_NEAR(force.point.x, -wandered, 0.01 * wandered) << "of d/l and theta l/d";
  EXPECT_NEAR(bench.memory().grip.x, before.x, depth * depth)
      << "but for the share of the depth by which the overlap is longer along its tangent";
  EXPECT_NEAR(force.grip.x, 0.0, small) << "as the material of the base moves";
}

// Between rigid blocks friction acts at the centre of pressure: strain, which could tell the difference, is
// not.
TEST(Grip, IsTheCentreOfPressureOfRigidBlocks) {
  ContactBench bench = block_on_plane(0.5, none_deforms);
  bench.evaluate();
  const ContactBench::Seen &force = bench.move(0, {{}, 0.1 * depth});
  EXPECT_EQ(force.grip, force.point);
  EXPECT_TRUE(bench.history.grips.empty()) << "a rigid scene keeps none";
}

// A joint that gapes over its left part leaves a grip in the middle behind: it goes on at the end of what is
// closed, and stays there as more of the joint closes again, up to what was the longest.
TEST(Grip, IsPushedAlongByTheEndOfTheClosedPart) {
  ContactBench bench = block_on_plane(0.5);
  bench.evaluate();
  const ContactBench::Seen &open = turn(bench, -4.0 * depth, 2.0 * depth); // closed right of 0.25 m
  const double left = left_end(open);
  ASSERT_NEAR(left, 0.25, 8.0 * depth);
  EXPECT_NEAR(open.grip.x, left, rounding);
  const Vec2 pushed = bench.memory().grip;
  const ContactBench::Seen &again = turn(bench, 2.0 * depth);
  ASSERT_NEAR(left_end(again), 0.5, 8.0 * depth);
  EXPECT_NEAR(again.grip.x, left_end(again), rounding);
  const Vec2 farthest = bench.memory().grip;
  ASSERT_NE(farthest, pushed);
  const ContactBench::Seen &closer = turn(bench, 0.0, -1.5 * depth);
  ASSERT_LT(left_end(closer), 0.0);
  EXPECT_EQ(bench.memory().grip, farthest) << "it does not go back, bit for bit";
  EXPECT_NEAR(closer.grip.x, 0.5, 8.0 * depth);
}

TEST(Grip, IsTheMiddleOfAJointThatIsLongerThanEver) {
  ContactBench bench = block_on_plane(0.5);
  turn(bench, -4.0 * depth);
  const ContactBench::Seen &open = bench.seen;
  ASSERT_LT(open.extent_end - open.extent_begin, 1.8);
  EXPECT_NEAR(open.grip.x, open.point.x - 0.5 * (open.extent_begin + open.extent_end), rounding);
  const ContactBench::Seen &closed = turn(bench, 4.0 * depth);
  EXPECT_NEAR(closed.extent_end - closed.extent_begin, 2.0, rounding);
  EXPECT_NEAR(closed.grip.x, 0.0, rounding);
}

// A grip off the middle is back once the joint has slipped by the stretch cap/k_t of its spring, in one step;
// in many steps each takes the share of the way that it slips of the stretch, and exp(-1) is left.
TEST(Grip, FollowsTheMiddleWithSlip) {
  for (const int steps : {1, 100}) {
    SCOPED_TRACE(steps);
    ContactBench bench = block_on_plane(0.1);
    bench.evaluate();
    turn(bench, -4.0 * depth, 2.0 * depth);
    turn(bench, 0.0, -0.5 * depth); // closed right of 0.125 m, with the grip at 0.25 m
    const double spring = tangential * bench.memory().longest;
    const double stretch = bench.seen.cap / spring;
    bench.move(0, {{0.999 * stretch + bench.seen.shear / spring, 0.0}, 0.0});
    ASSERT_EQ(bench.memory().state, ContactState::stick);
    const double off = bench.seen.grip.x - middle(bench.seen);
    ASSERT_LT(off, -0.2);
    for (int k = 0; k < steps; ++k) {
      bench.move(0, {{stretch / steps, 0.0}, 0.0});
    }
    ASSERT_EQ(bench.memory().state, ContactState::slip);
    const double left = (bench.seen.grip.x - middle(bench.seen)) / off;
    const double expected = steps == 1 ? 0.001 : std::exp(-1.0);
    EXPECT_NEAR(left, expected, 0.01) << "(1 - 1/n)^n, and the thousandth below the cap";
  }
}

// The same memory gives the same bits again, wherever the grip has been moved to.
TEST(Grip, IsFoundAgainFromItsMemory) {
  ContactBench bench = block_on_plane(0.1);
  for (const double angle : {0.0, -4.0 * depth, 1.3 * depth, 3.1 * depth, -0.7 * depth}) {
    turn(bench, angle);
    bench.move(0, {{0.3 * depth, 0.01 * depth}, 0.0});
    const Vec2 grip = bench.seen.grip; // found once more, from what the evaluation has left
    const Vec2 memory = bench.memory().grip;
    bench.move(0, {});
    EXPECT_EQ(bench.seen.grip, grip);
    EXPECT_EQ(bench.memory().grip, memory);
  }
}

} // namespace
} // namespace gcpdda::grip_test
