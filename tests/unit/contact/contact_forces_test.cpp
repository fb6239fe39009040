// Friction, dashpot and bookkeeping of single contacts, configuration by configuration.

#include "contact/contact_sums.hpp"
#include "simulation/contact_digest.hpp"
#include "support/blocks.hpp"
#include "support/scenes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace gcpdda::contact_forces_test {
namespace {

using namespace testing;

constexpr double epsilon = std::numeric_limits<double>::epsilon();
constexpr double stiffness = 1e6; // k_n, Pa/m
constexpr double tangential = 0.5 * stiffness;
constexpr double depth = 0.01;

/// A unit square, sunk into a wide fixed plane by `depth`. The square is the lower block: n_r = +y, t_r = -x,
/// so the force on it along x is its shear.
ContactBench square_on_plane(double tan_friction, double cohesion = 0.0, double damping_ratio = 0.0) {
  return {system_of({rectangle({0.0, -depth}, {1.0, 1.0 - depth})}, {rectangle({-20.0, -5.0}, {20.0, 0.0})}),
          one_law(stiffness, tan_friction, cohesion), damping_ratio};
}

/// B1: (2 p_n l d/H)(1 - d/(2 l)), l = 1, k_n = 2 p_n/H.
constexpr double normal_force = stiffness * depth * (1.0 - 0.5 * depth);

/// Depths known to a few epsilon of coordinates near 1, relative to `depth`.
constexpr double rounding = 32.0 * epsilon / depth;

TEST(Contact, MeasuresOverlapExtentAndNormal) {
  ContactBench bench = square_on_plane(0.0);
  const ContactBench::Seen &force = bench.evaluate();
  ASSERT_TRUE(force.touching);
  EXPECT_NEAR(force.overlap, depth, 8.0 * epsilon);
  EXPECT_NEAR(force.extent_end - force.extent_begin, 1.0, 8.0 * epsilon);
  EXPECT_NEAR(force.normal_force, normal_force, rounding * normal_force);
  EXPECT_NEAR(norm(force.normal - Vec2{0.0, 1.0}), 0.0, rounding);
  EXPECT_NEAR(force.point.x, 0.5, rounding);
  EXPECT_GE(force.point.y, -depth);
  EXPECT_LE(force.point.y, 0.0) << "x_r lies in the hull of the patch";
  EXPECT_NEAR(bench.report.max_overlap, depth, 8.0 * epsilon);
  EXPECT_EQ(bench.report.evaluations, 1);
}

TEST(Friction, SpringFollowsTheSlideUntilTheCap) {
  ContactBench bench = square_on_plane(0.5);
  EXPECT_EQ(bench.evaluate().shear, 0.0) << "born without stretch";
  const double slide = 1e-4;
  const double expected = tangential * 1.0 * slide;
  for (int k = 1; k <= 3; ++k) {
    const ContactBench::Seen &force = bench.move(0, {{slide, 0.0}, 0.0});
    EXPECT_NEAR(force.force.x, -k * expected, rounding * expected);
    EXPECT_NEAR(force.shear_force.x, force.force.x, rounding * expected);
    EXPECT_EQ(bench.memory().state, ContactState::stick);
    EXPECT_EQ(bench.memory().slip, 0.0);
  }
  const ContactBench::Seen &back = bench.move(0, {{-3.0 * slide, 0.0}, 0.0});
  EXPECT_NEAR(back.force.x, 0.0, rounding * expected) << "elastic";
}

TEST(Friction, CutsAtTheCapAndCountsTheSlip) {
  const double cohesion = 300.0;
  ContactBench bench = square_on_plane(0.5, cohesion);
  bench.evaluate();
  const double cap = 0.5 * normal_force + cohesion * 1.0;
  const double slide = 0.1;
  const ContactBench::Seen &force = bench.move(0, {{slide, 0.0}, 0.0});
  EXPECT_NEAR(force.cap, cap, rounding * cap);
  EXPECT_NEAR(force.force.x, -cap, rounding * cap);
  EXPECT_EQ(bench.memory().state, ContactState::slip);
  const double slip = slide - cap / tangential;
  EXPECT_NEAR(bench.memory().slip, slip, rounding * slip);
  bench.move(0, {{slide, 0.0}, 0.0});
  EXPECT_NEAR(bench.memory().slip, slip + slide, rounding * slip) << "on the cap all is slip";
  // Back by half of what the spring holds: elastic at once.
  const ContactBench::Seen &back = bench.move(0, {{-0.5 * cap / tangential, 0.0}, 0.0});
  EXPECT_NEAR(back.force.x, -0.5 * cap, 4.0 * rounding * cap);
  EXPECT_EQ(bench.memory().state, ContactState::stick);
}

TEST(Friction, CohesionActsOverTheExtent) {
  ContactBench bench(
      system_of({rectangle({0.0, -depth}, {3.0, 1.0})}, {rectangle({-20.0, -5.0}, {20.0, 0.0})}),
      one_law(stiffness, 0.0, 200.0));
  EXPECT_NEAR(bench.evaluate().cap, 600.0, 600.0 * rounding);
}

TEST(Friction, NoneWithoutAStrength) {
  ContactBench bench = square_on_plane(0.0);
  bench.evaluate();
  const ContactBench::Seen &force = bench.move(0, {{0.01, 0.0}, 0.0});
  EXPECT_NEAR(force.force.x, 0.0, rounding * normal_force);
  EXPECT_EQ(bench.memory().shear, 0.0);
}

TEST(Friction, NoIncrementInTheStepOfBirth) {
  ContactBench bench = square_on_plane(0.5);
  bench.system.trial[0] = {{0.0, 2.0 * depth}, 0.0};
  EXPECT_FALSE(bench.evaluate().touching);
  // Comes down while it moves sideways: touches at the end of this step only.
  EXPECT_EQ(bench.move(0, {{0.003, -2.0 * depth}, 0.0}).shear, 0.0);
  EXPECT_EQ(bench.memory().state, ContactState::stick);
  EXPECT_GT(std::abs(bench.move(0, {{1e-4, 0.0}, 0.0}).shear), 0.0);
}

// Tips that touch by a rounding error have pressures down to the denormals, d^2 and less; a sixth of d^3 is
// below them, and its inverse above all numbers.
TEST(Contact, OfDenormalPressureIsFinite) {
  for (const double depth_of_tip : {1e-100, 1e-154, 1e-160, 1e-162}) {
    ContactBench bench(system_of({{{0.0, 0.0}, {1.0, 1.0}, {0.0, 2.0}, {-1.0, 1.0}}},
                                 {rectangle({-20.0, -5.0}, {20.0, depth_of_tip})}),
                       one_law(stiffness, 0.5), 0.3);
    bench.evaluate();
    const BlockContactSum sum = bench.regions.sum_contacts(bench.candidates, 0);
    for (const RigidDof &force : {sum.force, sum.shear, sum.damping}) {
      EXPECT_TRUE(std::isfinite(force.u.x) && std::isfinite(force.u.y) && std::isfinite(force.r))
          << depth_of_tip;
    }
  }
}

TEST(Friction, MemoryDiesWithTheRegion) {
  // Apart by boxes that do not meet, and by a tilted block whose box still meets the other one's.
  for (const bool boxes_meet : {false, true}) {
    ContactBench bench(system_of({{{0.0, -depth}, {1.0, 1.0}, {0.0, 2.0}, {-1.0, 1.0}}},
                                 {rectangle({-20.0, -5.0}, {0.5, 0.0})}),
                       one_law(stiffness, 0.5));
    bench.evaluate();
    bench.move(0, {{-1e-5, 0.0}, 0.0});
    ASSERT_GT(std::abs(bench.memory().shear), 0.0);
    const RigidDof away = boxes_meet ? RigidDof{{1.2, 0.0}, 0.0} : RigidDof{{0.0, 0.5}, 0.0};
    EXPECT_FALSE(bench.move(0, away).touching);
    EXPECT_EQ(bench.report.evaluations, boxes_meet ? 1 : 0);
    EXPECT_TRUE(testing::memories(bench.history).empty());
    EXPECT_EQ(bench.move(0, -1.0 * away).shear, 0.0) << "touches again, as new";
  }
}

// The square leaves the plane's edge by half: the extent falls, the tangential stiffness does not.
TEST(Friction, TangentialStiffnessNeverFalls) {
  ContactBench bench(
      system_of({rectangle({0.0, -depth}, {1.0, 1.0 - depth})}, {rectangle({-20.0, -5.0}, {1.0, 0.0})}),
      one_law(stiffness, 1e6));
  bench.evaluate();
  bench.move(0, {{0.5, 0.0}, 0.0});
  const double before = bench.memory().shear;
  const double longest = bench.memory().longest;
  EXPECT_GE(longest, 1.0 - 8.0 * epsilon);
  const ContactBench::Seen &force = bench.move(0, {{1e-3, 0.0}, 0.0});
  EXPECT_LT(force.extent_end - force.extent_begin, 0.5);
  EXPECT_EQ(bench.memory().longest, longest);
  // The slide along t_r; the difference of two shears 500 times larger costs three digits.
  const double increment = tangential * longest * 1e-3 * force.normal.y;
  EXPECT_NEAR(std::abs(bench.memory().shear - before), increment, 8.0 * epsilon * std::abs(before));
}

TEST(Friction, StiffnessRisesWithTheExtent) {
  ContactBench bench(system_of({{{0.0, -depth}, {1.0, 1.0}, {0.0, 2.0}, {-1.0, 1.0}}},
                               {rectangle({-20.0, -5.0}, {20.0, 0.0})}),
                     one_law(stiffness, 100.0));
  bench.evaluate();
  const double short_extent = bench.memory().longest;
  bench.move(0, {{0.0, -depth}, 0.0});
  const ContactBench::Seen &force = bench.move(0, {{1e-5, 0.0}, 0.0});
  EXPECT_GT(bench.memory().longest, 1.5 * short_extent);
  EXPECT_NEAR(std::abs(force.shear), tangential * bench.memory().longest * 1e-5,
              1e-9 * std::abs(force.shear));
}

// Objectivity: turning both blocks about any point stretches nothing and turns the force with them.
TEST(Friction, TurnsWithTheBlocks) {
  ContactBench bench(
      system_of({rectangle({0.0, -depth}, {1.0, 1.0 - depth}), rectangle({-1.0, -2.0}, {2.0, 0.0})}, {}),
      one_law(stiffness, 0.8));
  bench.evaluate();
  bench.move(0, {{2e-3, 0.0}, 0.0});
  const double shear = bench.memory().shear;
  const Vec2 force = bench.regions.all().front().force;
  const Vec2 about{3.0, -7.0};
  double angle = 0.0;
  for (const double step : {0.01, -0.3, 1.0, 2.5}) {
    angle += step;
    for (std::size_t row = 0; row < 2; ++row) {
      const Vec2 arm = bench.system.properties[row].centroid + bench.system.trial[row].u - about;
      bench.system.trial[row] += {Rotation::of(step)(arm) - arm, step};
    }
    const ContactBench::Seen &now = bench.evaluate();
    // Increments of about 20 m are known to a few epsilon each, times the tangential stiffness.
    EXPECT_NEAR(now.shear, shear, 100.0 * epsilon * tangential * 1.0);
    EXPECT_NEAR(norm(now.force - Rotation::of(angle)(force)), 0.0, 100.0 * epsilon * tangential);
  }
}

// A common translation of 1e6 m, not even the same for positions in double, stretches nothing at all.
TEST(Friction, IncrementsDoNotSubtractPositions) {
  ContactBench bench(
      system_of({rectangle({0.0, -depth}, {1.0, 1.0 - depth}), rectangle({-1.0, -2.0}, {2.0, 0.0})}, {}),
      one_law(stiffness, 0.8));
  bench.evaluate();
  bench.move(0, {{2e-3, 0.0}, 0.0});
  const double shear = bench.memory().shear;
  const RigidDof common{{1e6 / 3.0, 1e6 / 7.0}, 0.0};
  bench.system.trial[0] += common;
  bench.moved_on[0] = bench.system.trial[0] - common;
  bench.system.trial[1] += common;
  bench.evaluate();
  // The increment rounds at 3e5 m for both blocks: 1e-10 m.
  EXPECT_NEAR(bench.memory().shear, shear, 1e-10 * tangential);
}

/// Total normal force on the lower block of a pair that flies apart or closes.
TEST(Dashpot, OpposesClosingAndOpening) {
  for (const double speed : {-0.01, 0.01}) {
    ContactBench bench = square_on_plane(0.0, 0.0, 0.1);
    bench.system.velocity[0] = {{0.0, speed}, 0.0};
    const ContactBench::Seen &force = bench.evaluate();
    EXPECT_LT(force.damping_force.y * speed, 0.0);
    EXPECT_NEAR(force.force.y, normal_force + force.damping_force.y, rounding * normal_force);
    // Both faces carry c'/2 over length 1: c' = 2 xi sqrt(k_n m/L_ref), m = 1000, L_ref = 1.
    const double damping = 2.0 * 0.1 * std::sqrt(stiffness * 1000.0);
    EXPECT_NEAR(force.damping_force.y, -damping * speed, 0.02 * damping * std::abs(speed))
        << "corners differ";
  }
}

// Fast separation: the damping traction takes away what pressure there is, never more.
struct Separation {
  const char *name;
  std::vector<Vec2> block;
};

std::vector<Separation> separating_blocks() {
  const std::vector<Vec2> square = rectangle({0.0, 0.0}, {1.0, 1.0});
  const Vec2 sunk{0.0, -depth};
  return {{"flush", placed(square, 0.0, sunk)},
          {"tilted", placed(square, 0.005, sunk)},
          {"corner down", placed(square, 0.785398163397448, sunk)},
          {"corner down, oblique", placed(square, 0.5, sunk)},
          {"needle", {{0.0, -depth}, {0.1, 1.0}, {-0.1, 1.0}}},
          {"flat wedge", {{0.0, -depth}, {1.0, 0.2}, {-1.0, 0.2}}}};
}

TEST(Dashpot, NeverPullsHoweverFastTheSeparation) {
  for (const auto &[name, block] : separating_blocks()) {
    for (const double speed : {1e-3, 0.1, 1.0, 100.0}) {
      ContactBench bench(system_of({block}, {rectangle({-20.0, -5.0}, {20.0, 0.0})}), one_law(stiffness),
                         0.5);
      const Vec2 normal = bench.evaluate().normal;
      const double elastic = bench.regions.all().front().normal_force;
      bench.system.velocity[0] = {speed * normal, 0.0};
      const ContactBench::Seen &force = bench.evaluate();
      EXPECT_GE(dot(force.force, normal), -1e-12 * elastic) << name << " at " << speed << " m/s";
    }
  }
}

// A flush block that lifts off and spins: max(-p, d) on both faces, by sampling. The pressure is cut within
// the faces, at begin and end of pieces.
TEST(Dashpot, IsCutWhereTensionWouldBegin) {
  constexpr double xi = 0.1;
  const double half_damping = xi * std::sqrt(stiffness * 1000.0); // c'/2, L_ref = 1, m = 1000
  for (const RigidDof velocity :
       {RigidDof{{0.0, 0.5}, 0.0}, {{0.0, 0.1}, 1.0}, {{0.0, 0.3}, -2.0}, {{0.0, 0.0}, 3.0}}) {
    ContactBench bench = square_on_plane(0.0, 0.0, xi);
    bench.evaluate();
    bench.system.velocity[0] = velocity;
    const ContactBench::Seen &force = bench.evaluate();
    double total = 0.0;
    double moment = 0.0; // about x = 0
    constexpr int points = 20000;
    for (int i = 0; i < points; ++i) {
      const double x = (i + 0.5) / points;
      const double d = -half_damping * (velocity.u.y + velocity.r * (x - 0.5));
      const double on_bottom = 0.5 * stiffness * depth;
      const double on_plane = 0.5 * stiffness * std::min({depth, x, 1.0 - x});
      const double q = std::max(-on_bottom, d) + std::max(-on_plane, d);
      total += q / points;
      moment += q * x / points;
    }
    // Midpoint rule with a few kinks: 1/points^2 of slopes up to k_n/2.
    const double tolerance = 10.0 * stiffness / points / points;
    EXPECT_NEAR(force.damping_force.y, total, tolerance);
    EXPECT_NEAR(force.damping_torque[0] + 0.5 * force.damping_force.y, moment, tolerance);
  }
}

TEST(Dashpot, SlidingAlongTheJointIsNotDragged) {
  for (const auto &[name, block] : separating_blocks()) {
    ContactBench bench(system_of({block}, {rectangle({-20.0, -5.0}, {20.0, 0.0})}), one_law(stiffness), 0.5);
    const ContactBench::Seen at_rest = bench.evaluate();
    bench.system.velocity[0] = {3.0 * perp(at_rest.normal), 0.0};
    const ContactBench::Seen &force = bench.evaluate();
    // The normal is a unit vector to an epsilon, so is v.n_r; the dashpot's constant is about 3e4.
    EXPECT_LE(norm(force.force - at_rest.force), 16.0 * epsilon * 3e4 * 3.0) << name;
  }
}

/// A bench of two mobile random polygons in contact with friction, dashpot and motion.
TEST(Momentum, ForcesAndTorquesCancelWithinEveryPair) {
  std::mt19937 engine(21);
  int touching = 0;
  for (int trial = 0; trial < 300; ++trial) {
    const auto seed = static_cast<unsigned>(engine());
    ContactBench bench(system_of({random_polygon(seed, 5, 1.0, {0.0, 0.0}),
                                  random_polygon(seed + 1, 7, 1.2, {uniform(engine, 1.4, 2.0), 0.3})},
                                 {}),
                       one_law(stiffness, 0.6, 10.0), 0.1);
    bench.evaluate();
    for (std::size_t row = 0; row < 2; ++row) {
      bench.system.velocity[row] = {{uniform(engine, -1.0, 1.0), uniform(engine, -1.0, 1.0)},
                                    uniform(engine, -1.0, 1.0)};
    }
    const ContactBench::Seen &force = bench.move(0, {{1e-3, 2e-3}, 1e-3});
    if (!force.touching) {
      continue;
    }
    ++touching;
    const auto lower = bench.regions.sum_contacts(bench.candidates, 0);
    const auto higher = bench.regions.sum_contacts(bench.candidates, 1);
    const Vec2 c0 = bench.system.motion[0].centroid;
    const Vec2 c1 = bench.system.motion[1].centroid;
    const double size = norm(force.force);
    EXPECT_EQ(lower.force.u + higher.force.u, Vec2{});
    const double torque =
        lower.force.r + cross(c0, lower.force.u) + higher.force.r + cross(c1, higher.force.u);
    EXPECT_LE(std::abs(torque), 1e-14 * size * 4.0) << "arms are up to 4 m long";

    // Parts: force, dyad and torque of the same contact as the sums see it.
    for (const bool is_lower : {true, false}) {
      const ContactPart part = contact_part(force, is_lower, is_lower ? c0 : c1);
      const RigidDof &sum = is_lower ? lower.force : higher.force;
      EXPECT_EQ(part.force, sum.u);
      EXPECT_NEAR(part.dyad.xy - part.dyad.yx, sum.r, 1e-14 * size * 4.0);
    }
    // The pieces of the bookkeeping make up the whole, as torques about the origin of the moments too.
    EXPECT_NEAR(
        norm(force.shear_force + force.damping_force + force.normal_force * force.normal - force.force), 0.0,
        1e-13 * (size + force.normal_force));
  }
  EXPECT_GT(touching, 150);
}

// Two crossed plates: the normals of the four sides cancel, no direction is left.
TEST(Contact, CancellingNormalsAreReported) {
  ContactBench bench(
      system_of({rectangle({-1.0, -0.05}, {1.0, 0.05}), rectangle({-0.05, -1.0}, {0.05, 1.0})}, {}),
      one_law(stiffness, 0.5), 0.1);
  const ContactBench::Seen &force = bench.evaluate();
  EXPECT_TRUE(force.touching);
  EXPECT_TRUE(force.normal_undefined);
  EXPECT_EQ(bench.report.normals_undefined, 1);
  bench.system.velocity[0] = {{0.3, 0.2}, 0.0};
  const ContactBench::Seen &moving = bench.move(0, {{1e-4, 0.0}, 0.0});
  EXPECT_TRUE(moving.normal_undefined);
  EXPECT_EQ(moving.shear_force, Vec2{});
  EXPECT_EQ(moving.damping_force, Vec2{});
  EXPECT_EQ(bench.memory().shear, 0.0);
}

TEST(Contact, TooDeepAnOverlapIsAFault) {
  ContactBench bench(system_of({rectangle({0.0, 0.0}, {1.0, 0.2})}, {rectangle({-5.0, -5.0}, {5.0, 0.0})}),
                     one_law(stiffness));
  bench.move(0, {{0.0, -0.099}, 0.0});
  EXPECT_FALSE(bench.report.fault) << "half the narrowest width is 0.1";
  bench.move(0, {{0.0, -0.002}, 0.0});
  ASSERT_TRUE(bench.report.fault);
  EXPECT_EQ(bench.report.fault->cause, Fault::Cause::too_deep);
  EXPECT_EQ(bench.report.fault->block, BlockId{0});
  EXPECT_EQ(bench.report.fault->other, BlockId{1});
  EXPECT_NEAR(bench.report.fault->value, 0.101, 1e-15);
  EXPECT_NEAR(bench.report.fault->limit, 0.1, 1e-15);
}

// (1/A) int sym(x f): a column pressed by p at both ends carries -p along it. Ends sunk flush.
TEST(Contact, MeanStressOfAPressedColumn) {
  ContactBench bench(
      system_of({rectangle({0.0, 0.0}, {1.0, 3.0})},
                {rectangle({-5.0, -2.0}, {5.0, depth}), rectangle({-5.0, 3.0 - depth}, {5.0, 5.0})}),
      one_law(stiffness));
  bench.evaluate();
  ContactDigest digest;
  digest.find(bench.system, bench.candidates, bench.history, bench.forces);
  const auto stress = digest.mean_stress(bench.system, 0);
  // Half of each force acts on the end face, half on the sunk one: the arm is between 3 - 2 d and 3.
  EXPECT_LT(stress[1], -normal_force * (3.0 - 2.0 * depth) / 3.0);
  EXPECT_GT(stress[1], -normal_force);
  EXPECT_NEAR(stress[2], 0.0, rounding * normal_force);
}

} // namespace
} // namespace gcpdda::contact_forces_test
