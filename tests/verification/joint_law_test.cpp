// Laws of joints: direct shear, pull apart, a glued block on a slope, and bonds that keep energy and
// momentum.

#include "problem.hpp"

#include "gcpdda/contact/bonds.hpp"
#include "gcpdda/simulation/energy_ledger.hpp"
#include "support/blocks.hpp"

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

/// A block of the joint's length on a base that is wider and held, with a prescribed motion.
Simulation sheared(const std::string &law, double friction_deg, double duration, const std::string &motion) {
  const std::string toml =
      with_law(head({.duration = duration,
                     .time_step = 1e-4,
                     .gravity = {},
                     .normal_stiffness = stiffness,
                     .friction_deg = friction_deg,
                     .damping = 0.05}),
               law) +
      block_toml("base", rectangle({-2.0, -1.0}, {4.0, 0.0}), "fixed_points = [[-2, -1], [4, -1]]") +
      block_toml("top", rectangle({0.0, 0.0}, {length, 1.0}), motion);
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
    for (const RegionForce &force : simulation.contacts().regions()) {
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
  ASSERT_EQ(simulation.history().regions.size(), 1U) << "the bond is gone";
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

// Up at 2 mm/s, back into touch, and up again. Truncation: what a step opens over what breaks the bond, 4e-4.
TEST(PullApart, TensionOnceAndThenNothing) {
  const double tension = 5e5;
  Simulation simulation = sheared(fmt::format("cohesion = 1e6\ntension = {}", tension), 40.0, 1.0,
                                  "velocity_table = [[0, 0, 0, 0], [0.1, 0, 2e-3, 0], [0.4, 0, 2e-3, 0], "
                                  "[0.5, 0, -4e-3, 0], [0.7, 0, -4e-3, 0], [0.8, 0, 4e-3, 0]]");
  EnergyLedger ledger(simulation);
  double peak = 0.0;
  double later = 0.0;
  double lost = 0.0;
  double worst = 0.0;
  bool whole = true;
  while (!simulation.finished()) {
    step(simulation);
    double pull = 0.0;
    bool bonded = false;
    for (const RegionForce &force : simulation.contacts().regions()) {
      pull += force.force.y;
      bonded = bonded || force.bonded;
    }
    (whole ? peak : later) = std::max(whole ? peak : later, pull);
    whole = bonded;
    if (simulation.step_count() % 500 == 0 || simulation.finished()) {
      const EnergyRow row = ledger.row(simulation);
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
  for (std::size_t k = 0; k < simulation.contacts().regions().size(); ++k) {
    const CandidatePair &pair = simulation.candidates().pairs[simulation.contacts().regions()[k].pair];
    if (simulation.history().regions[k].is_bond() && simulation.blocks().is_fixed(pair.lower.value)) {
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
      const BlockContactSum contact = sum_contacts(pair.candidates, pair.forces, row);
      if (k > 0) {
        const double work_done =
            0.5 * work(contact.force + last_force[b], pair.system.trial[row] - before[b]);
        net += work_done;
        total += std::abs(work_done);
      }
      last_force[b] = contact.force;
      sum += contact.force.u;
      moment += contact.force.r + cross(pair.system.trial_centroid[row], contact.force.u);
    }
    ASSERT_NEAR(norm(sum), 0.0, 1e-8) << "momentum";
    ASSERT_NEAR(moment, 0.0, 1e-7) << "moment of momentum: forces of 3e5 N/m at arms of 5 m, rounded";
  }
  ASSERT_TRUE(pair.history.regions.back().is_bond());
  expect_below("bond: net work on a closed path over all work", 1e-6, std::abs(net) / total);
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
    for (const RegionForce &force : pair.forces.regions()) {
      EXPECT_NEAR(norm(force.force), 0.0, 1e6 * 64.0 * 1e-14)
          << "displacements of 50 m, rounded, times k_n l";
    }
  }
}

} // namespace
} // namespace gcpdda::testing::joint_law_test
