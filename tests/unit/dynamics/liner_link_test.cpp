// The element of a liner between two blocks: its stiffness, its forces and its strength.

#include "dynamics/bolt_link.hpp"
#include "support/blocks.hpp"
#include "support/setting.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

namespace gcpdda::testing::liner_link_test {
namespace {

constexpr double thickness = 0.2;
constexpr double length = 0.8;

SupportType concrete() {
  SupportType support;
  support.kind = SupportType::Kind::liner;
  support.thickness = thickness;
  support.youngs_modulus = 24e9;
  support.poissons_ratio = 0.2;
  return support;
}

BoltLink element() {
  BoltLink link;
  link.bolt = -1;
  link.liner = 0;
  link.length = length;
  return link;
}

/// A rigid block and a deformable one beside it, with an element along their lower faces.
struct TwoBlocks {
  BlockSystem system = system_of({rectangle({0.0, 0.0}, {1.0, 1.0}), rectangle({1.0, 0.0}, {2.0, 1.0})}, {},
                                 1000.0, [](std::size_t row) { return row == 1; });
  BoltLink link = element();
  std::array<std::size_t, 2> rows{0, 1};
  LinkLaw law = law_of(concrete(), link);

  TwoBlocks() {
    const Vec2 along{1.0, 0.0};
    link.end[0] = {0, Vec2{0.6, 0.0} - system.properties[0].centroid, along};
    link.end[1] = {1, Vec2{1.4, 0.0} - system.properties[1].centroid, along};
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

  [[nodiscard]] LinkMemory state() const {
    const LinkPose pose = pose_of(system, link, rows);
    return respond(law, {}, pose.extension, pose.slide, pose.turn);
  }
  [[nodiscard]] LinkForce force() const {
    return force_of(system, link, rows, pose_of(system, link, rows), state());
  }
  /// -dU/dx of any number of the state.
  double pull_along(double &x) {
    const double step = 1e-6;
    const double before = x;
    x = before + step;
    const double above = stored_energy(law, state());
    x = before - step;
    const double below = stored_energy(law, state());
    x = before;
    return -(above - below) / (2.0 * step);
  }
};

// E' = 25 GPa, I = t^3/12, Phi = 12 E'I/((5/6) G t L^2) with G = 10 GPa.
TEST(LinerLink, HasTheStiffnessOfATimoshenkoBeam) {
  const LinkLaw law = law_of(concrete(), element());
  const double bending = 25e9 * std::pow(thickness, 3) / 12.0;
  const double phi = 12.0 * bending / (5.0 / 6.0 * 10e9 * thickness * length * length);
  EXPECT_DOUBLE_EQ(law.axial_stiffness, 25e9 * thickness / length);
  EXPECT_DOUBLE_EQ(law.bending_stiffness, bending / length);
  EXPECT_NEAR(law.shear_stiffness * std::pow(length, 3) * (1.0 + phi) / (12.0 * bending), 1.0, 1e-15);
}

// A cantilever that is clamped in block 0 and loaded by P across at its other end: P L^3/(3 E'I) of bending
// and P L/(5/6 G t) of shear. The couple on block 1 has to vanish, M = Q L/2.
TEST(LinerLink, BendsLikeACantilever) {
  const LinkLaw law = law_of(concrete(), element());
  const double load = 1000.0;
  const double turn = 0.5 * load * length / law.bending_stiffness; // M = P L/2
  const double slide = load / law.shear_stiffness;
  const double deflection = slide + 0.5 * length * turn; // s = v - L (turn of both)/2
  const double bending = 25e9 * std::pow(thickness, 3) / 12.0;
  EXPECT_NEAR(deflection,
              load * std::pow(length, 3) / (3.0 * bending) + load * length / (5.0 / 6.0 * 10e9 * thickness),
              1e-15);
}

TEST(LinerLink, MeasuresStretchSlideAndTurn) {
  TwoBlocks blocks;
  // Block 1 turns about the middle of the element, as by bending with a constant moment.
  const double angle = 2e-3;
  blocks.system.trial[0].r = -0.5 * angle;
  const Rotation turn = Rotation::of(0.5 * angle);
  blocks.system.deformation_of(1).trial = {turn.c, -turn.s, turn.s, turn.c};
  EXPECT_NEAR(pose_of(blocks.system, blocks.link, blocks.rows).turn, angle, 1e-15);
  blocks.system.deformation_of(1).trial = {1.0, 0.0, 0.0, 1.0};
  blocks.system.trial[0] = {};
  blocks.system.trial[1].u = {3e-4, -2e-3};
  const LinkPose moved = pose_of(blocks.system, blocks.link, blocks.rows);
  EXPECT_NEAR(moved.slide, -2e-3, 1e-15);
  EXPECT_NEAR(moved.extension, std::hypot(length + 3e-4, 2e-3) - length, 1e-15);
  EXPECT_EQ(moved.turn, 0.0);
}

TEST(LinerLink, DoesNotFeelAMotionOfBothBlocksTogether) {
  TwoBlocks blocks;
  blocks.displace();
  const LinkPose before = pose_of(blocks.system, blocks.link, blocks.rows);
  EXPECT_GT(std::abs(before.turn), 1e-3);
  blocks.move_as_one(2.5, {3.0, -7.0});
  const LinkPose after = pose_of(blocks.system, blocks.link, blocks.rows);
  // Rounding of coordinates of 10 m.
  EXPECT_NEAR(after.extension, before.extension, 1e-14);
  EXPECT_NEAR(after.slide, before.slide, 1e-14);
  EXPECT_NEAR(after.turn, before.turn, 1e-14);
}

// The error of the difference quotient is 1e-12 of the third derivative, and rounding 1e-16 U/1e-6.
TEST(LinerLink, HasAPotential) {
  TwoBlocks blocks;
  blocks.displace();
  const LinkForce force = blocks.force();
  const double scale = norm(force.rigid[0].u);
  EXPECT_GT(scale, 1e6);
  EXPECT_GT(std::abs(blocks.state().moment), 1e5);
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

TEST(LinerLink, KeepsMomentumAndMomentOfMomentum) {
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

// The couple by a pair of forces: the springs that bound it hold a turn of the block about the end at least
// as stiffly as the element does, and the whole block no less than all its stiffness.
TEST(LinerLink, SpringsThatBoundItHoldABlockAsStiffly) {
  const TwoBlocks blocks;
  for (std::size_t end = 0; end < 2; ++end) {
    double turning = 0.0;
    double holding = 0.0;
    for (const PointSpring &spring : springs_of(blocks.law, blocks.link, end)) {
      const Vec2 arm = spring.point - blocks.link.end[end].point;
      turning += spring.stiffness * dot(arm, arm);
      holding += spring.stiffness;
    }
    // About its end a block with the other one held turns against 4 E'I/L (1 + Phi/4)/(1 + Phi).
    const double exact = blocks.law.bending_stiffness + 0.25 * length * length * blocks.law.shear_stiffness;
    EXPECT_GE(turning, exact * (1.0 - 1e-12));
    EXPECT_GE(holding, std::max(blocks.law.axial_stiffness, blocks.law.shear_stiffness));
  }
}

LinkLaw brittle(double residual = 0.0) {
  SupportType support = concrete();
  support.compressive_strength = 30e6;
  support.tensile_strength = 3e6;
  support.residual_tensile_strength = residual;
  return law_of(support, element());
}

// Stress blocks of f_c over x and f over t - x, integrated over the section in 4,000 layers, each of which is
// off by its own stress times a layer at most.
TEST(LinerSection, HasThePlasticMomentOfItsStressBlocks) {
  const LinerSection section = brittle().section;
  constexpr int layers = 4000;
  for (const double tensile : {0.0, 1e6, 3e6}) {
    for (const double x : {0.0, 0.01, 0.1, 0.17, 0.2}) {
      double axial = 0.0;
      double moment = 0.0;
      for (int k = 0; k < layers; ++k) {
        const double depth = thickness * (k + 0.5) / layers;
        const double stress = depth < x ? -30e6 : tensile;
        axial += stress * thickness / layers;
        moment += stress * (depth - 0.5 * thickness) * thickness / layers;
      }
      EXPECT_NEAR(plastic_moment(section, tensile, axial), moment, 33e6 * thickness * thickness / layers);
    }
    EXPECT_EQ(plastic_moment(section, tensile, tensile * thickness), 0.0);
    EXPECT_EQ(plastic_moment(section, tensile, -30e6 * thickness), 0.0);
  }
  // Equal strengths: f t^2/4 without thrust.
  LinerSection steel;
  steel.thickness = thickness;
  steel.compressive_strength = 200e6;
  EXPECT_DOUBLE_EQ(plastic_moment(steel, 200e6, 0.0), 200e6 * thickness * thickness / 4.0);
  // No-tension material that cannot be crushed: thrust at an edge.
  steel.compressive_strength = SupportType::unlimited;
  EXPECT_DOUBLE_EQ(plastic_moment(steel, 0.0, -1e5), 1e5 * thickness / 2.0);
  EXPECT_EQ(plastic_moment(steel, SupportType::unlimited, 1e9), SupportType::unlimited);
}

// M at cracking is f_t t^2/6 = 20 kN in pure bending, and more under thrust.
TEST(LinerLink, CracksWhereAFibreReachesTheTensileStrength) {
  const LinkLaw law = brittle();
  const double at_crack = 3e6 * thickness * thickness / 6.0 / law.bending_stiffness;
  const LinkMemory whole = respond(law, {}, 0.0, 0.0, 0.999 * at_crack);
  EXPECT_FALSE(whole.cracked);
  EXPECT_FALSE(whole.yielded);
  EXPECT_DOUBLE_EQ(whole.moment, 0.999 * at_crack * law.bending_stiffness);
  const LinkMemory cracked = respond(law, whole, 0.0, 0.0, 1.001 * at_crack);
  EXPECT_TRUE(cracked.cracked);
  EXPECT_EQ(cracked.moment, 0.0); // plain concrete without thrust bears no moment
  // All that it stored just before is gone.
  EXPECT_DOUBLE_EQ(cracked.dissipated, 0.5 * law.bending_stiffness * std::pow(1.001 * at_crack, 2));
  EXPECT_EQ(stored_energy(law, cracked), 0.0);
  // It closes under thrust and bears a moment by its excentricity, but never tension again.
  const double thrust = 1e6;
  const LinkMemory pressed = respond(law, cracked, -thrust / law.axial_stiffness, 0.0, 10.0 * at_crack);
  EXPECT_NEAR(pressed.axial, -thrust, 1e-6);
  EXPECT_DOUBLE_EQ(pressed.moment, plastic_moment(law.section, 0.0, pressed.axial));
  EXPECT_EQ(respond(law, pressed, 1e-3, 0.0, 0.0).axial, 0.0);
  // By shear: the moment at the ends is Q L/2.
  const double slide = 3e6 * thickness * thickness / 6.0 / (0.5 * length * law.shear_stiffness);
  EXPECT_FALSE(respond(law, {}, 0.0, 0.999 * slide, 0.0).cracked);
  EXPECT_TRUE(respond(law, {}, 0.0, 1.001 * slide, 0.0).cracked);
  // A uniform thrust of 3 MPa doubles the moment.
  const double squeeze = -3e6 * thickness / law.axial_stiffness;
  EXPECT_FALSE(respond(law, {}, squeeze, 0.0, 1.999 * at_crack).cracked);
  EXPECT_TRUE(respond(law, {}, squeeze, 0.0, 2.001 * at_crack).cracked);
}

TEST(LinerLink, FibresBearTheResidualStrength) {
  const LinkLaw law = brittle(1e6);
  LinkMemory memory = respond(law, {}, 1e-3, 0.0, 0.0);
  EXPECT_TRUE(memory.cracked);
  EXPECT_DOUBLE_EQ(memory.axial, 1e6 * thickness);
  EXPECT_NEAR(memory.axial_slip, 1e-3 - 1e6 * thickness / law.axial_stiffness, 1e-15);
  memory = respond(law, {}, 0.0, 0.0, 0.1);
  EXPECT_DOUBLE_EQ(memory.moment, plastic_moment(law.section, 1e6, 0.0));
}

// Thrust first, then the constant moment, then the shear by what is left at the ends.
TEST(LinerLink, HoldsThrustMomentAndShearTogether) {
  const LinkLaw law = brittle(1e6);
  const LinkMemory crushed = respond(law, {}, -1.0, 0.0, 0.0);
  EXPECT_DOUBLE_EQ(crushed.axial, -30e6 * thickness);
  EXPECT_FALSE(crushed.cracked);
  LinkMemory memory = respond(law, {}, -1e-4, 1.0, 1e-3);
  const double capacity = plastic_moment(law.section, 1e6, memory.axial);
  EXPECT_NEAR(std::abs(memory.moment) + 0.5 * length * std::abs(memory.shear), capacity, 1e-9 * capacity);
  memory = respond(law, {}, -1e-4, 1.0, 1.0);
  EXPECT_DOUBLE_EQ(memory.moment, capacity);
  EXPECT_EQ(memory.shear, 0.0);
}

TEST(LinerLink, PeelsOffForGood) {
  SupportType support = concrete();
  support.adhesion = 0.5e6;
  support.bond_width = 0.04;
  support.shear_strength = 3e6;
  const LinkLaw law = law_of(support, element());
  const double at_peeling = 0.5e6 * 0.04 / law.shear_stiffness;
  LinkMemory memory = respond(law, {}, -1e-5, 0.999 * at_peeling, 1e-5);
  EXPECT_FALSE(memory.broken);
  memory = respond(law, memory, -1e-5, 1.001 * at_peeling, 1e-5);
  EXPECT_TRUE(memory.broken);
  EXPECT_EQ(stored_energy(law, memory), 0.0);
  const auto half_square = [](double stiffness, double x) { return 0.5 * stiffness * x * x; };
  EXPECT_NEAR(memory.dissipated,
              half_square(law.axial_stiffness, 1e-5) + half_square(law.bending_stiffness, 1e-5) +
                  half_square(law.shear_stiffness, 1.001 * at_peeling),
              1e-12);
  memory = respond(law, memory, 0.0, 0.0, 0.0);
  EXPECT_EQ(memory.axial, 0.0);
  support.adhesion = SupportType::unlimited; // then the block punches through
  const LinkLaw bonded = law_of(support, element());
  EXPECT_DOUBLE_EQ(bonded.section.shear_limit, 3e6 * thickness);
}

// Where the liner turns away from the rock, thrust presses it on: half of -2 a N beside either joint, at the
// end that is pulled by Q.
TEST(LinerLink, ThrustHoldsALinerThatTurnsAgainstTheRock) {
  constexpr double bond = 0.5e6 * 0.04;
  constexpr double away = 0.1;
  SupportType support = concrete();
  support.adhesion = 0.5e6;
  support.bond_width = 0.04;
  for (const bool head_first : {true, false}) {
    BoltLink link = element();
    link.head_first = head_first;
    link.end[head_first ? 0 : 1].away = away; // the first end on the face, which Q > 0 draws off
    const LinkLaw law = law_of(support, link);
    for (const double thrust : {0.0, 1e5}) {
      const double extension = -thrust / law.axial_stiffness;
      const auto breaks = [&](double shear) {
        return respond(law, {}, extension, shear / law.shear_stiffness).broken;
      };
      EXPECT_FALSE(breaks(0.999 * (bond + away * thrust)));
      EXPECT_TRUE(breaks(1.001 * (bond + away * thrust)));
      EXPECT_FALSE(breaks(-0.999 * bond));
      EXPECT_TRUE(breaks(-1.001 * bond)) << "the other end goes straight on";
    }
    EXPECT_TRUE(respond(law, {}, 1.001 * bond / (away * law.axial_stiffness), 0.0).broken)
        << "tension peels it";
  }
}

// Plain shotcrete that has opened bears no thrust before its crack has closed, and all of it then.
TEST(LinerLink, ACrackClosesWithoutThrust) {
  for (const double residual : {0.0, 0.5e6}) {
    SupportType support = concrete();
    support.tensile_strength = 1e6;
    support.residual_tensile_strength = residual;
    const LinkLaw law = law_of(support, element());
    constexpr double width = 1e-3;
    LinkMemory memory = respond(law, {}, width, 0.0);
    ASSERT_TRUE(memory.cracked);
    EXPECT_DOUBLE_EQ(memory.axial, residual * thickness);
    for (const double share : {0.8, 0.5, 0.0}) {
      memory = respond(law, memory, share * width, 0.0);
      EXPECT_NEAR(memory.axial, 0.0, 1e-6) << share;
    }
    memory = respond(law, memory, -1e-5, 0.0);
    EXPECT_DOUBLE_EQ(memory.axial, -1e-5 * law.axial_stiffness);
    EXPECT_NEAR(respond(law, respond(law, {}, width, 0.0), -1e-5, 0.0).axial, -1e-5 * law.axial_stiffness,
                1e-6)
        << "in one step";
  }
}

// Work along a random path is what is stored and what is gone. The trapezoid of the work is wrong by
// k step^2/2 for each of the three forces in a step in which one of them begins or ends yielding, or in which
// the capacity of one changes with another; where a crack takes a force at once the work is that of the step.
TEST(LinerLink, LosesWhatItDissipates) {
  const LinkLaw law = brittle(1e6);
  std::mt19937 random(7);
  const auto draw = [&] { return static_cast<double>(random()) / 2147483648.0 - 1.0; };
  const std::array<double, 3> step{5e-8, 5e-8, 1e-6};
  for (int path = 0; path < 5; ++path) {
    LinkMemory memory;
    double work = 0.0;
    std::array<double, 3> heading{};
    for (int k = 0; k < 40000; ++k) {
      if (k % 4000 == 0) {
        heading = {draw(), draw(), draw()};
      }
      const LinkMemory next =
          respond(law, memory, memory.extension + step[0] * heading[0], memory.slide + step[1] * heading[1],
                  memory.turn + step[2] * heading[2]);
      const bool cracks = next.cracked && !memory.cracked;
      const double share = cracks ? 0.0 : 0.5; // of the force after it in the work of a step
      work += step[0] * heading[0] * ((1.0 - share) * memory.axial + share * next.axial) +
              step[1] * heading[1] * ((1.0 - share) * memory.shear + share * next.shear) +
              step[2] * heading[2] * ((1.0 - share) * memory.moment + share * next.moment);
      memory = next;
    }
    EXPECT_TRUE(memory.cracked);
    EXPECT_GT(memory.dissipated, 1.0);
    EXPECT_NEAR((stored_energy(law, memory) + memory.dissipated) / work, 1.0, 1e-3) << path;
  }
}

TEST(LinerLink, RemembersItsLargestForces) {
  const LinkLaw law = brittle();
  LinkMemory memory;
  for (const auto &[extension, slide, turn] :
       {std::array{2e-5, 0.0, 0.0}, {0.0, -1e-5, 2e-5}, {-1e-5, 0.0, 0.0}}) {
    memory = respond(law, memory, extension, slide, turn);
    memory.largest = with_last(law, memory);
  }
  ASSERT_FALSE(memory.cracked || memory.yielded);
  EXPECT_EQ(memory.largest.tension, 2e-5 * law.axial_stiffness);
  EXPECT_EQ(memory.largest.compression, 1e-5 * law.axial_stiffness);
  EXPECT_EQ(memory.largest.shear, 1e-5 * law.shear_stiffness);
  EXPECT_DOUBLE_EQ(memory.largest.moment,
                   2e-5 * law.bending_stiffness + 0.5 * length * 1e-5 * law.shear_stiffness);
  EXPECT_LT(memory.largest.strength_used, 1.0);
  memory.broken = true;
  EXPECT_EQ(with_last(law, memory).strength_used, 1.0);
}

TEST(LinerSection, SaysHowMuchOfItsStrengthIsUsed) {
  const LinerSection section = brittle().section;
  const auto used = [&](const LinerForces &forces) { return strength_used(section, false, length, forces); };
  EXPECT_EQ(used({}), 0.0);
  EXPECT_DOUBLE_EQ(used({-3e6, 0.0, 0.0}), 0.5);
  EXPECT_DOUBLE_EQ(used({0.3e6, 0.0, 0.0}), 0.5); // half of f_t
  EXPECT_DOUBLE_EQ(used({0.0, 0.0, 0.5 * 3e6 * thickness * thickness / 6.0}), 0.5);
  EXPECT_EQ(strength_used(law_of(concrete(), element()).section, false, length, {-1e9, 1e9, 1e9}), 0.0);
}

} // namespace
} // namespace gcpdda::testing::liner_link_test
