// Laws of joints: direct shear, pull apart, a glued block on a slope, and bonds that keep energy and
// momentum.

#include "problem.hpp"

#include "contact/laws/bonds.hpp"
#include "simulation/energy_ledger.hpp"
#include "support/blocks.hpp"
#include "support/contact_regions.hpp"
#include "support/memories.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

namespace gcpdda::testing::joint_law_test {
namespace {

constexpr double stiffness = 1e9; ///< Pa/m
constexpr double length = 2.0;    ///< of the joint, m

/// @param keys  more of [joint.default]; of barton-bandis, which has no friction angle
std::string with_law(std::string toml, const std::string &keys) {
  if (keys.find("barton") != std::string::npos) {
    const std::size_t angle = toml.find("friction_angle_deg");
    toml.erase(angle, toml.find('\n', angle) + 1 - angle);
  }
  return toml.insert(toml.find("[output]"), keys + "\n");
}

/// What lies on the joint, and how the base below is computed.
struct Sides {
  std::vector<Vec2> top = rectangle({0.0, 0.0}, {length, 1.0});
  std::string base_fidelity = "rigid";
};

/// A block of the joint's length on a base that is wider and held, with a prescribed motion.
Simulation sheared(const std::string &law, double friction_deg, double duration, const std::string &motion,
                   const Sides &sides = {}) {
  const std::string toml =
      with_law(head({.duration = duration,
                     .time_step = 1e-4,
                     .gravity = {},
                     .normal_stiffness = stiffness,
                     .friction_deg = friction_deg,
                     .damping = 0.05,
                     .youngs_modulus = 2e10,
                     .poissons_ratio = 0.2}),
               law) +
      block_toml("base", rectangle({-2.0, -1.0}, {4.0, 0.0}),
                 fmt::format("fixed_points = [[-2, -1], [4, -1]]\nfidelity = \"{}\"", sides.base_fidelity)) +
      block_toml("top", sides.top, motion);
  return Simulation(Communicator::self(), scene_of(toml));
}

struct Shear {
  double peak = 0.0;
  double residual = 0.0;    ///< at the end
  double normal_peak = 0.0; ///< when the peak was reached
  double normal = 0.0;      ///< at the end
};

Shear shear_of(Simulation &simulation) {
  Shear seen;
  while (!simulation.finished()) {
    step(simulation);
    double shear = 0.0;
    double normal = 0.0;
    for (const RegionForce &force : regions_of(simulation)) {
      shear += std::abs(dot(force.shear_force, perp(force.normal)));
      normal += force.normal_force;
    }
    if (shear > seen.peak) {
      seen.peak = shear;
      seen.normal_peak = normal;
    }
    seen.residual = shear;
    seen.normal = normal;
  }
  EXPECT_FALSE(simulation.fault().has_value());
  return seen;
}

// Pressed down by 1 mm, then pushed along at 4 mm/s. Truncation: a step stretches the spring by 4e-7 m, 4e-4
// of what breaks it; the bond ends at the faces, the residual region at the sunk sides, 5e-4 of the length.
TEST(DirectShear, PeakAndResidual) {
  const double cohesion = 2e5;
  Simulation simulation = sheared(
      fmt::format("cohesion = {}\nresidual_friction_angle_deg = 20\nresidual_cohesion = 5e4", cohesion), 40.0,
      0.8, "velocity_table = [[0, 0, 0, 0], [0.1, 0, -0.01, 0], [0.2, 0, 0, 0], [0.3, 4e-3, 0, 0]]");
  const Shear seen = shear_of(simulation);
  // The springs that hold the base give by 4e-3 of the closure.
  expect_value("direct shear: normal force", stiffness * length * 1e-3, seen.normal_peak, 6e-3);
  expect_value("direct shear: peak, c l + N tan(phi)",
               cohesion * length + seen.normal_peak * std::tan(40.0 * degree), seen.peak, 1e-3);
  expect_value("direct shear: residual, c_r l + N tan(phi_r)",
               5e4 * length + seen.normal * std::tan(20.0 * degree), seen.residual, 1e-3);
  ASSERT_EQ(memories(simulation.history()).size(), 1U) << "the bond is gone";
}

/// Two feet of a quarter of the length each, a gap between them.
Sides on_two_feet() {
  return {{{0.0, 0.0}, {0.5, 0.0}, {0.5, 0.4}, {1.5, 0.4}, {1.5, 0.0}, {2.0, 0.0}, {2.0, 1.0}, {0.0, 1.0}},
          "rigid"};
}

/// What holds a bond together, on any blocks: pressed and sheared, or pulled.
void expect_strength_of_bonds(const std::string &kind, const Sides &sides, double bonded_length) {
  const double cohesion = 2e5;
  const std::string law =
      fmt::format("cohesion = {}\ntension = 1.5e5\nresidual_friction_angle_deg = 20", cohesion);
  Simulation pressed = sheared(
      law, 40.0, 0.5,
      "velocity_table = [[0, 0, 0, 0], [0.05, 0, -0.01, 0], [0.1, 0, 0, 0], [0.15, 8e-3, 0, 0]]", sides);
  const Shear seen = shear_of(pressed);
  expect_value(kind + ": shear that breaks the bonds, c l + N tan(phi)",
               cohesion * bonded_length + seen.normal_peak * std::tan(40.0 * degree), seen.peak, 2e-3);
  expect_value(kind + ": shear after that, N tan(phi_r)", seen.normal * std::tan(20.0 * degree),
               seen.residual, 1e-3);

  Simulation pulled = sheared(law, 40.0, 0.25, "velocity_table = [[0, 0, 0, 0], [0.05, 0, 2e-3, 0]]", sides);
  double pull = 0.0;
  while (!pulled.finished()) {
    step(pulled);
    double now = 0.0;
    for (const RegionForce &force : regions_of(pulled)) {
      now += force.force.y;
    }
    pull = std::max(pull, now);
  }
  ASSERT_FALSE(pulled.fault().has_value());
  // A step opens the joint by 2e-7 m, 1.3e-3 of what breaks it.
  expect_value(kind + ": largest pull, tension times length", 1.5e5 * bonded_length, pull, 3e-3);
  EXPECT_TRUE(memories(pulled.history()).empty()) << kind << ": all bonds are gone";
}

TEST(DirectShear, BondsOfADeformableBlock) {
  Sides sides;
  sides.base_fidelity = "deformable";
  expect_strength_of_bonds("bond on a deformable block", sides, length);
}

TEST(DirectShear, BondsOfABlockThatIsNotConvex) {
  expect_strength_of_bonds("bonds of two feet", on_two_feet(), 0.5 * length);
}

// phi = 25 + 10 log10(50 MPa/0.5 MPa) = 45 degrees. Truncation: the sunk sides' share of the extent.
TEST(DirectShear, BartonBandis) {
  Simulation simulation =
      sheared("law = \"barton-bandis\"\njrc = 10\njcs = 50e6\nresidual_friction_angle_deg = 25", 0.0, 0.8,
              "velocity_table = [[0, 0, 0, 0], [0.1, 0, -5e-3, 0], [0.2, 0, 0, 0], [0.3, 4e-3, 0, 0]]");
  const Shear seen = shear_of(simulation);
  expect_value("direct shear, Barton-Bandis: F/N, phi = 45 degrees at 0.5 MPa", 1.0,
               seen.residual / seen.normal, 1e-3);
}

constexpr double dilation_deg = 10.0;

std::string dilation_of(double degrees) {
  return fmt::format("dilation_angle_deg = {}\ndilation_limit = 0.01", degrees);
}

// Driven along at a constant height: what slip opens presses the joint. Truncation: the springs that hold the
// base, and the bowed edges of 1e-3 of the length.
TEST(DirectShear, DilationAtConstantHeightRaisesThePressure) {
  const double friction = std::tan(30.0 * degree);
  const double dilation = std::tan(dilation_deg * degree);
  Simulation simulation =
      sheared(dilation_of(dilation_deg), 30.0, 0.8,
              "velocity_table = [[0, 0, 0, 0], [0.1, 0, -0.01, 0], [0.2, 0, 0, 0], [0.3, 4e-3, 0, 0]]");
  const Shear seen = shear_of(simulation);
  const double slip = memories(simulation.history()).at(0).slip;
  EXPECT_GT(slip, 5e-4);
  const double driven = 4e-3 * (0.05 + 0.5); // m
  expect_value("direct shear, dilation: slip and stretch of the spring make the way driven, m", driven,
               slip + seen.residual / (0.5 * stiffness * length), 2e-2);
  expect_value("direct shear, dilation: normal force", stiffness * length * (1e-3 + dilation * slip),
               seen.normal, 1e-2);
  expect_value("direct shear, dilation: F/N, tan(phi)", friction, seen.residual / seen.normal, 1e-6);
}

struct Slide {
  Vec2 way;          ///< along the slope and off it, m
  double slip = 0.0; ///< of the contact, m
  double loss = 0.0;
  double residual = 0.0;     ///< of the energy
  double acceleration = 0.0; ///< along the slope before the limit, mean, m/s2
  double chatter = 0.0;      ///< fastest motion off the slope beyond that of the slide while it dilates, m/s
};

constexpr double slide_height = 0.25; ///< of the block, m
constexpr double slope_deg = 40.0;
constexpr double slide_friction_deg = 30.0;

/// A block slides down by its weight, beyond the limit of 10 mm.
Slide slide_down(double psi_deg, const Setting &setting, double sunk = 0.0) {
  Setting own = setting;
  own.gravity = {earth_gravity * std::sin(slope_deg * degree), -earth_gravity * std::cos(slope_deg * degree)};
  own.friction_deg = slide_friction_deg;
  own.duration = 0.2;
  const std::string toml = with_law(head(own), dilation_of(psi_deg)) +
                           block_toml("slope", rectangle({-2.0, -1.0}, {6.0, 0.0}), "fixed = true") +
                           block_toml("block", rectangle({0.0, -sunk}, {length, slide_height - sunk}));
  Simulation simulation(Communicator::self(), scene_of(toml));
  EnergyLedger ledger(simulation.state());
  Slide seen;
  while (!simulation.finished()) {
    step(simulation);
    const RigidDof &v = velocity_of(simulation, 1);
    if (const std::vector<RegionMemory> known = memories(simulation.history()); !known.empty()) {
      seen.slip = known.front().slip;
    }
    if (seen.slip < 0.009) {
      seen.acceleration = v.u.x / simulation.time();
      seen.chatter = std::max(seen.chatter, std::abs(v.u.y - std::tan(psi_deg * degree) * v.u.x));
    }
  }
  EXPECT_FALSE(simulation.fault().has_value());
  const EnergyRow row = ledger.row(simulation.state());
  seen.way = displacement_of(simulation, 1).u;
  seen.loss = row.friction_loss;
  seen.residual = row.residual;
  return seen;
}

// N = m (g cos + tan(psi) x''), m x'' = m g sin - N tan(phi). The block lands on its joint and rocks when it
// starts, by 1e-3 of the slide.
void expect_slide(const Slide &seen, const std::string &kind) {
  const double dilation = std::tan(dilation_deg * degree);
  const double friction = std::tan(slide_friction_deg * degree);
  const double push =
      earth_gravity * (std::sin(slope_deg * degree) - friction * std::cos(slope_deg * degree));
  EXPECT_GT(seen.slip, 0.015) << "beyond the limit";
  expect_value(kind + " slides with dilation: rises by tan(psi) times the limit, m", 0.01 * dilation,
               seen.way.y, 0.05);
  expect_value(kind + " slides with dilation: acceleration g (sin - cos tan(phi))/(1 + tan(phi) tan(psi))",
               push / (1.0 + friction * dilation), seen.acceleration, 0.03);
  const double weight = rock_density * slide_height * length * earth_gravity;
  const double gained =
      weight * (std::sin(slope_deg * degree) * seen.way.x - std::cos(slope_deg * degree) * seen.way.y);
  expect_below(kind + " slides with dilation: energy error over what gravity gave", 5e-3,
               std::abs(seen.residual) / gained);
  // Friction takes N tan(phi) from the slide and gives N tan(psi) of it back while it lifts, N taken as at
  // rest: it is 4 % more while the block is lifted and nothing in the hop where that ends.
  const double normal = weight * std::cos(slope_deg * degree);
  expect_value(kind + " slides with dilation: lost by friction, J/m",
               normal * friction * seen.way.x - normal * 0.01 * dilation, seen.loss, 0.06);
}

TEST(Dilation, LiftsARigidSlidingBlock) {
  expect_slide(slide_down(dilation_deg, {.normal_stiffness = stiffness, .damping = 0.05}), "rigid block");
}

TEST(Dilation, LiftsADeformableSlidingBlock) {
  expect_slide(slide_down(dilation_deg, {.normal_stiffness = stiffness,
                                         .damping = 0.05,
                                         .fidelity = "deformable",
                                         .youngs_modulus = 5e9,
                                         .poissons_ratio = 0.2}),
               "deformable block");
}

// Without any damping at the automatic step, from the overlap that carries the block: with an opening of the
// evaluation before the chatter grows by 1.3 % a step. Measured against the swing of a block put on its joint
// without overlap, g cos(th) sqrt(m/(k_n l)); friction alone lets it rock by a fifth of that.
TEST(Dilation, DoesNotMakeSlidingBlocksChatter) {
  const double weight = rock_density * slide_height * earth_gravity * std::cos(slope_deg * degree); // Pa
  const Slide seen = slide_down(25.0, {.normal_stiffness = stiffness, .damping = 0.0}, weight / stiffness);
  const double swing =
      earth_gravity * std::cos(slope_deg * degree) * std::sqrt(rock_density * slide_height / stiffness);
  expect_below("dilation without damping: chatter over the swing of a dropped block", 1.0,
               seen.chatter / swing);
}

// Up at 2 mm/s, back into touch, and up again. Truncation: what a step opens over what breaks the bond, 4e-4.
TEST(PullApart, TensionOnceAndThenNothing) {
  const double tension = 5e5;
  Simulation simulation = sheared(fmt::format("cohesion = 1e6\ntension = {}", tension), 40.0, 1.0,
                                  "velocity_table = [[0, 0, 0, 0], [0.1, 0, 2e-3, 0], [0.4, 0, 2e-3, 0], "
                                  "[0.5, 0, -4e-3, 0], [0.7, 0, -4e-3, 0], [0.8, 0, 4e-3, 0]]");
  EnergyLedger ledger(simulation.state());
  double peak = 0.0;
  double later = 0.0;
  double lost = 0.0;
  double worst = 0.0;
  bool whole = true;
  while (!simulation.finished()) {
    step(simulation);
    double pull = 0.0;
    bool bonded = false;
    for (const RegionForce &force : regions_of(simulation)) {
      pull += force.force.y;
      bonded = bonded || force.bonded;
    }
    (whole ? peak : later) = std::max(whole ? peak : later, pull);
    whole = bonded;
    if (simulation.step_count() % 500 == 0 || simulation.finished()) {
      const EnergyRow row = ledger.row(simulation.state());
      lost = row.friction_loss;
      worst = std::max(worst, std::abs(row.residual));
    }
  }
  ASSERT_FALSE(simulation.fault().has_value());
  EXPECT_FALSE(whole);
  expect_value("pull apart: largest pull, tension times length", tension * length, peak, 2e-3);
  expect_below("pull apart: pull after the bond has broken, N/m", 1e-9, later);
  const double stored = 0.5 * tension * tension * length / stiffness;
  expect_value("pull apart: energy lost with the bond, tension^2 l/(2 k_n)", stored, lost, 4e-3);
  // O(dt^2) of what the held base swings when it is let go.
  expect_below("pull apart: energy error over the energy of the bond", 1e-2, worst / stored);
}

// Gravity rises slowly. F = (c l + W cos(th) tan(phi))/(W sin(th)); the residual law alone would not hold.
bool holds_on_slope(double factor) {
  const double slope = 40.0 * degree;
  const double weight = rock_density * earth_gravity * length * 0.5;
  const double friction = std::tan(30.0 * degree);
  const double cohesion = weight * (factor * std::sin(slope) - std::cos(slope) * friction) / length;
  const std::string toml =
      with_law(head({.duration = 3.0,
                     .gravity = {earth_gravity * std::sin(slope), -earth_gravity * std::cos(slope)},
                     .normal_stiffness = 2e8,
                     .friction_deg = 30.0,
                     .damping = 0.1,
                     .run_keys = "gravity_ramp = 2.0"}),
               fmt::format("cohesion = {:.17g}\ntension = {:.17g}\n", cohesion, cohesion)) +
      block_toml("slope", rectangle({-2.0, -1.0}, {60.0, 0.0}), "fixed = true") +
      block_toml("block", rectangle({0.0, 0.0}, {length, 0.5}));
  Simulation simulation(Communicator::self(), scene_of(toml));
  run(simulation);
  return displacement_of(simulation, 1).u.x < 0.01;
}

TEST(PlaneSliding, WithCohesionHoldsAboveTheLimitAndSlidesBelow) {
  EXPECT_TRUE(holds_on_slope(1.01)) << "1 % above the limit";
  EXPECT_FALSE(holds_on_slope(0.99)) << "1 % below it";
}

// The scene that ships: two glued beams, one 10 % above the limit 3 rho g L^2/h, one below it.
TEST(Overhang, StrongHoldsAndWeakBreaksOff) {
  Simulation simulation(Communicator::self(), shipped_scene("overhang", {"run.duration=3.2"}));
  run(simulation);
  std::vector<std::int64_t> bonded;
  for (std::size_t k = 0; k < regions_of(simulation).size(); ++k) {
    const CandidatePair &pair = simulation.candidates().pairs[regions_of(simulation)[k].pair];
    if (regions_of(simulation)[k].bonded && simulation.blocks().is_fixed(pair.lower.value)) {
      bonded.push_back(simulation.blocks().properties[pair.higher.value].id.value);
    }
  }
  EXPECT_EQ(bonded, std::vector<std::int64_t>{2}) << "the pier holds the left beam alone";
  expect_below("overhang: the strong beam's end has sunk by, m", 0.1, -displacement_of(simulation, 5).u.y);
  expect_above("overhang: the weak beam's end has fallen by, m", 1.0, -displacement_of(simulation, 9).u.y);
}

/// Two blocks glued along an edge that is slanted, moved by hand.
struct Glued : ContactBench {
  explicit Glued(JointLaws joints)
      : ContactBench(system_of({{{0, 0}, {2, 0}, {2.5, 1}, {0, 1}}, {{2, 0}, {4, 0}, {4, 1}, {2.5, 1}}}, {}),
                     std::move(joints)) {
    bond_joints(system, candidates, forces.parameters().joints, 0.0, history);
  }
};

JointLaws strong() {
  JointLaws joints = one_law(1e6, 0.5, 1e9);
  joints.laws[0].has_bonds = true;
  joints.laws[0].tension = 1e9;
  return joints;
}

// A trapezoid over a whole period of smooth forces is exact to rounding but for the kinks where the joint
// closes, which the steps of 1/4000 of the path leave at their squares.
TEST(Bond, DoesNoNetWorkOnAClosedPath) {
  Glued pair(strong());
  constexpr int count = 64000;
  double net = 0.0;
  double total = 0.0;
  RigidDof last_force[2];
  for (int k = 0; k <= count; ++k) {
    const double t = 2.0 * std::numbers::pi * k / count;
    const RigidDof before[2] = {pair.system.trial[0], pair.system.trial[1]};
    // Together through most of a turn, and far apart: by up to 0.3 m and 0.1 rad.
    pair.system.trial[0] = {{3.0 * std::sin(t), 1.0 - std::cos(t)}, 2.0 * std::sin(t)};
    const Vec2 arm = pair.system.properties[1].centroid - pair.system.properties[0].centroid;
    const Vec2 carried = Rotation::of(pair.system.trial[0].r)(arm) - arm;
    pair.system.trial[1] = {pair.system.trial[0].u + carried +
                                Vec2{0.15 * (1.0 - std::cos(t)), 0.1 * std::sin(2.0 * t + 1.0)},
                            pair.system.trial[0].r + 0.1 * std::sin(t + 0.5)};
    pair.evaluate();
    Vec2 sum;
    double moment = 0.0;
    for (int b = 0; b < 2; ++b) {
      const auto row = static_cast<std::size_t>(b);
      const BlockContactSum contact = pair.regions.sum_contacts(pair.candidates, row);
      if (k > 0) {
        const double work_done =
            0.5 * work(contact.force + last_force[b], pair.system.trial[row] - before[b]);
        net += work_done;
        total += std::abs(work_done);
      }
      last_force[b] = contact.force;
      sum += contact.force.u;
      moment += contact.force.r + cross(pair.system.motion[row].centroid, contact.force.u);
    }
    ASSERT_NEAR(norm(sum), 0.0, 1e-8) << "momentum";
    ASSERT_NEAR(moment, 0.0, 1e-7) << "moment of momentum: forces of 3e5 N/m at arms of 5 m, rounded";
  }
  ASSERT_TRUE(memories(pair.history).back().is_bond());
  expect_below("bond: net work on a closed path over all work", 1e-6, std::abs(net) / total);
}

// Turned by 2 mrad two square blocks touch by a tenth of their joint, which is bonded. Slid by the strain
// that breaks it the bond hands its shear to that tenth, whose spring is ten times softer.
TEST(Bond, LeavesBehindNoMoreSlipThanItHasStretched) {
  JointLaws joints = one_law(1e6, 0.5, 2500.0);
  joints.laws[0].has_bonds = true;
  joints.laws[0].tension = 5e3;
  joints.laws[0].residual_tan_friction = 0.5;
  ContactBench pair(system_of({rectangle({0.0, 0.0}, {1.0, 1.0}), rectangle({1.0, 0.0}, {2.0, 1.0})}, {}),
                    joints);
  bond_joints(pair.system, pair.candidates, pair.forces.parameters().joints, 0.0, pair.history);
  const double turn = 2e-3;
  pair.move(1, {{0.4 * turn, 0.5 * turn}, turn}); // its upper left corner goes to the left
  ASSERT_EQ(memories(pair.history).size(), 2U) << "a bond and a region";
  const double touching = memories(pair.history).front().longest;
  EXPECT_NEAR(touching, 0.1, 2e-3);
  const double slide = 0.01;
  pair.move(1, {{0.0, slide}, 0.0});
  ASSERT_EQ(memories(pair.history).size(), 1U) << "the bond is broken";
  // What it had stretched, but for what the region's spring still holds. It slid by the turn too, to first
  // order.
  const double held = std::abs(pair.memory().shear) / (0.5 * 1e6);
  EXPECT_NEAR(pair.memory().slip, slide - held, 2e-3 * slide);
}

// Corners of two blocks of a Voronoi diagram, as it was cut: along their joint they overlap by rounding.
TEST(Bond, ThatBreaksAtOnceNeedsARegionWithAnExtentToLeaveItsShear) {
  const std::vector<Vec2> left{
      {18.19185882692689, -0.7554835435953847},  {18.514513981774293, -1.7659688394127426},
      {18.782365207808724, -2.253122449728242},  {20.182525073350547, -2.5888605707119},
      {21.524476598700865, -0.5040380989957006}, {20.654984443264187, -0.10435515718218769},
      {18.598674153768652, 0.020721162891162992}};
  const std::vector<Vec2> right{
      {20.182525073350547, -2.5888605707119},    {20.188250529628608, -2.5982130009014237},
      {22.337420166770066, -3.715084951274799},  {23.282641770949127, -1.8298287811445273},
      {21.585062790117515, -0.4830844582880238}, {21.524476598700865, -0.5040380989957005}};
  Simulation simulation(
      Communicator::self(),
      scene_of(
          with_law(head({.duration = 0.1, .time_step = 1e-3, .normal_stiffness = 6e7, .friction_deg = 23.0}),
                   "tension = 0\nresidual_friction_angle_deg = 20") +
          block_toml("left", left, "fixed = true") + block_toml("right", right)));
  ASSERT_FALSE(memories(simulation.history()).empty()) << "they touch";
  for (const RegionMemory &memory : memories(simulation.history())) {
    EXPECT_TRUE(std::isfinite(memory.slip));
  }
}

TEST(Bond, IsLeftAloneByACommonMotion) {
  Glued pair(strong());
  const Vec2 arm = pair.system.properties[1].centroid - pair.system.properties[0].centroid;
  for (int k = 0; k <= 100; ++k) {
    const double angle = 0.1 * k;
    const Vec2 along{0.5 * k, -0.2 * k};
    pair.system.trial[0] = {along, angle};
    pair.system.trial[1] = {along + Rotation::of(angle)(arm) - arm, angle};
    pair.evaluate();
    for (const RegionForce &force : pair.regions.all()) {
      EXPECT_NEAR(norm(force.force), 0.0, 1e6 * 64.0 * 1e-14)
          << "displacements of 50 m, rounded, times k_n l";
    }
  }
}

} // namespace
} // namespace gcpdda::testing::joint_law_test
