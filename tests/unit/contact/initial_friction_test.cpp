// Stick forces at t = 0. Inclines are drawn level and gravity is turned instead: +x is downhill.

#include "simulation/simulation.hpp"

#include "support/blocks.hpp"
#include "support/contact_regions.hpp"
#include "support/scenes.hpp"

#include <Eigen/LU>
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace gcpdda::initial_friction_test {
namespace {

using namespace testing;

constexpr double degree = std::numbers::pi / 180.0;
constexpr double g = 9.81;
constexpr double density = 2600.0;
constexpr double stiffness = 1e8; // k_n, Pa/m
constexpr double slope = 20.0 * degree;

const std::vector<Vec2> plane = rectangle({-30.0, -5.0}, {30.0, 0.0});

std::string incline(double angle, double friction_angle, const std::string &blocks) {
  return fmt::format(R"([run]
duration = 0.1
fidelity = "rigid"
gravity = [{:.17g}, {:.17g}]
[material.rock]
density = {}
[joint.default]
normal_stiffness = {}
friction_angle_deg = {:.17g}
)",
                     g * std::sin(angle), -g * std::cos(angle), density, stiffness, friction_angle / degree) +
         blocks;
}

/// Depth of a flat unit square at rest: k_n d (1 - d/2) = m g cos(slope).
double static_depth(double angle) {
  const double wanted = density * g * std::cos(angle) / stiffness;
  return 1.0 - std::sqrt(1.0 - 2.0 * wanted);
}

std::string flat_block(double angle, const std::string &extra = "") {
  const double d = static_depth(angle);
  return block_toml("block", rectangle({0.0, -d}, {1.0, 1.0 - d}), extra) +
         block_toml("plane", plane, "fixed = true");
}

/// The remark that the sweeps were of no use.
bool starts_at_zero(Simulation &run) {
  return std::any_of(run.notes().begin(), run.notes().end(),
                     [](const Diagnostic &note) { return note.what == "friction starts at zero"; });
}

Simulation started(const std::string &toml, const std::vector<std::string> &sets = {}) {
  return {Communicator::self(), scene_of(toml, sets)};
}

// A flat block does not know its tilt: its stick force alone turns it. Zero acceleration at x_r, below the
// centroid by h: g sin = F (1/m + h^2/I).
TEST(InitialFriction, StopsTheContactPointOfAFlatBlock) {
  for (const double angle : {5.0 * degree, slope, 35.0 * degree}) {
    Simulation run = started(incline(angle, 45.0 * degree, flat_block(angle)));
    const RegionForce force = regions_of(run)[0];
    const BlockProperties &block = run.blocks().properties[0];
    const double arm = block.centroid.y - force.point.y;
    const double expected = g * std::sin(angle) / (1.0 / block.mass + arm * arm / block.inertia);
    // The normal is level to about epsilon/d.
    EXPECT_NEAR(-force.force.x, expected, 1e-11 * expected);
    EXPECT_NEAR(memories(run.history())[0].shear, force.shear, 0.0);
    EXPECT_EQ(memories(run.history())[0].state, ContactState::stick);
    EXPECT_FALSE(starts_at_zero(run));
  }
}

/// Vertices of a unit square at rest on the plane with friction: depth and tilt by Newton's method.
std::vector<Vec2> block_at_rest(double angle) {
  const std::vector<Vec2> square = rectangle({-0.5, -0.5}, {0.5, 0.5});
  const Shape ground = shape_of(plane);
  const Vec2 weight = density * g * Vec2{std::sin(angle), -std::cos(angle)};
  const auto vertices = [&](const Eigen::Vector3d &x) { return placed(square, x[1], {0.0, 0.5 - x[0]}); };
  const auto residual = [&](const Eigen::Vector3d &x) {
    const RegionIntegrals region = contact_of(shape_of(vertices(x)), ground);
    const Vec2 tangent = perp((1.0 / norm(region.force)) * region.force);
    const Vec2 point = region.origin + (1.0 / region.pressure) * region.pressure_moment;
    const Vec2 centroid{0.0, 0.5 - x[0]};
    const Vec2 sum = 0.5 * stiffness * region.force + x[2] * tangent + weight;
    const double torque =
        0.5 * stiffness * torque_about(region, centroid) + cross(point - centroid, x[2] * tangent);
    return Eigen::Vector3d(sum.x, sum.y, torque);
  };
  Eigen::Vector3d x(static_depth(angle), -1e-5, norm(weight) * std::sin(angle));
  for (int iteration = 0; iteration < 30; ++iteration) {
    const Eigen::Vector3d now = residual(x);
    Eigen::Matrix3d slopes;
    const Eigen::Vector3d h(1e-9, 1e-9, 1.0);
    for (Eigen::Index k = 0; k < 3; ++k) {
      Eigen::Vector3d moved = x;
      moved[k] += h[k];
      slopes.col(k) = (residual(moved) - now) / h[k];
    }
    x -= slopes.inverse() * now;
  }
  return vertices(x);
}

// With depth and tilt in the scene the stick force carries the weight and nothing moves: F = m g sin(slope),
// up to the direction of t_r, which is off the incline by a part of the tilt.
TEST(InitialFriction, CarriesABlockAtRest) {
  const std::string toml =
      incline(slope, 21.0 * degree,
              block_toml("block", block_at_rest(slope)) + block_toml("plane", plane, "fixed = true"));
  Simulation run = started(toml);
  const RegionForce force = regions_of(run)[0];
  const double mass = run.blocks().properties[0].mass;
  const double along = -mass * g * (std::sin(slope) * force.normal.y + std::cos(slope) * force.normal.x);
  // Newton ends at the rounding of positions over the depth: 1e-16/2.4e-4, times a few.
  constexpr double rounding = 1e-11;
  EXPECT_NEAR(force.shear, along, rounding * mass * g);
  EXPECT_NEAR(force.shear, -mass * g * std::sin(slope), 1e-3 * mass * g) << "tilt about 1e-4";
  EXPECT_LE(norm(run.blocks().acceleration[0].u), rounding * g);
  EXPECT_LE(std::abs(run.blocks().acceleration[0].r), 10.0 * rounding * g);
  const double shear = force.shear;
  for (int k = 0; k < 50; ++k) {
    run.step();
  }
  // A region present at t = 0 is not new: it goes on from its stick force.
  EXPECT_NEAR(regions_of(run)[0].shear, shear, 10.0 * rounding * mass * g);
  EXPECT_LE(norm(run.blocks().displacement[0].u), rounding * static_depth(slope) * 100.0);
}

/// Largest relative tangential acceleration over all sticking regions, m/s2.
double largest_slip_rate(Simulation &run) {
  const BlockSystem &blocks = run.blocks();
  double largest = 0.0;
  for (const RegionForce &force : regions_of(run)) {
    const auto at = [&](BlockIndex row) {
      const RigidDof &a = blocks.acceleration[row.value];
      return a.u + a.r * perp(force.point - blocks.motion[row.value].centroid);
    };
    const CandidatePair &pair = run.candidates().pairs[force.pair];
    if (std::abs(force.shear) < 0.999 * force.cap) {
      largest = std::max(largest, std::abs(dot(at(pair.lower) - at(pair.higher), perp(force.normal))));
    }
  }
  return largest;
}

std::string stack(int count) {
  std::string blocks = block_toml("plane", plane, "fixed = true");
  double top = 0.0;
  for (int k = 0; k < count; ++k) {
    const double d = 2.0 * (count - k) * static_depth(slope);
    blocks += block_toml(fmt::format("b{}", k), rectangle({0.0, top - d}, {1.0, top - d + 1.0}));
    top += 1.0 - d;
  }
  return blocks;
}

TEST(InitialFriction, StopsAllJointsOfAStack) {
  Simulation with = started(incline(slope, 60.0 * degree, stack(4)));
  Simulation without = started(incline(slope, 60.0 * degree, stack(4)), {"run.initial_friction=zero"});
  EXPECT_GT(largest_slip_rate(without), 0.3 * g * std::sin(slope));
  // What 50 damped sweeps leave.
  EXPECT_LE(largest_slip_rate(with), 1e-3 * g);
  RecordProperty("slip_rate_over_g", fmt::format("{:.3g}", largest_slip_rate(with) / g));
  for (std::size_t k = 0; k < regions_of(with).size(); ++k) {
    const RegionForce force = regions_of(with)[k];
    EXPECT_LE(std::abs(force.shear), force.cap);
  }
}

// Undamped sweeps diverge where a block has several contacts.
TEST(InitialFriction, SweepsConvergeOnAPyramid) {
  const double d = 1e-3;
  std::string blocks = block_toml("plane", plane, "fixed = true");
  for (int row = 0; row < 5; ++row) {
    for (int k = 0; k + row < 5; ++k) {
      const Vec2 low{1.0 * k + 0.5 * row, row * (1.0 - d) - d};
      blocks += block_toml(fmt::format("b{}-{}", row, k), rectangle(low, low + Vec2{0.999, 1.0}));
    }
  }
  Simulation with = started(incline(10.0 * degree, 60.0 * degree, blocks));
  Simulation without = started(incline(10.0 * degree, 60.0 * degree, blocks), {"run.initial_friction=zero"});
  EXPECT_FALSE(starts_at_zero(with));
  EXPECT_LE(largest_slip_rate(with), 0.05 * largest_slip_rate(without));
  RecordProperty("remaining_share",
                 fmt::format("{:.3g}", largest_slip_rate(with) / largest_slip_rate(without)));
}

TEST(InitialFriction, IsCutAtTheCap) {
  Simulation run = started(incline(slope, 5.0 * degree, flat_block(slope)));
  const RegionForce force = regions_of(run)[0];
  const double cap = force.normal_force * std::tan(5.0 * degree);
  EXPECT_NEAR(-force.force.x, cap, 1e-11 * cap);
  // Downhill acceleration of a sliding block: g (sin - tan(phi) cos), at the static depth.
  const double expected = g * (std::sin(slope) - std::tan(5.0 * degree) * std::cos(slope));
  EXPECT_NEAR(run.blocks().acceleration[0].u.x, expected, 1e-10 * g);
}

TEST(InitialFriction, SlidingBlockStartsOnTheCapAgainstItsMotion) {
  for (const double speed : {-0.5, 1e-6, 3.0}) {
    const std::string extra = fmt::format("velocity = [{}, 0.0, 0.0]", speed);
    Simulation run = started(incline(slope, 30.0 * degree, flat_block(slope, extra)));
    const RegionForce force = regions_of(run)[0];
    const double cap = force.normal_force * std::tan(30.0 * degree);
    EXPECT_NEAR(force.force.x, -std::copysign(cap, speed), 1e-11 * cap);
    EXPECT_EQ(memories(run.history())[0].state, ContactState::slip);
  }
}

// Blocks that move together do not slide on each other.
TEST(InitialFriction, CommonMotionIsNoSliding) {
  const std::string toml =
      incline(slope, 30.0 * degree,
              block_toml("lower", rectangle({0.0, 0.0}, {1.0, 1.0}), "velocity = [7.3, -2.1, 0.0]") +
                  block_toml("upper", rectangle({0.0, 0.999}, {1.0, 2.0}), "velocity = [7.3, -2.1, 0.0]"));
  Simulation run = started(toml);
  ASSERT_TRUE(!regions_of(run).empty());
  EXPECT_EQ(memories(run.history())[0].state, ContactState::stick);
  EXPECT_NEAR(regions_of(run)[0].shear, 0.0, 1e-11 * density * g) << "both fall the same";
}

// Without the tangential dashpot, which would drag on a sliding block.
TEST(InitialFriction, ZeroLeavesZero) {
  for (const char *velocity : {"", "velocity = [1.0, 0.0, 0.0]"}) {
    Simulation run = started(incline(slope, 30.0 * degree, flat_block(slope, velocity)),
                             {"run.initial_friction=zero", "run.contact_damping=0"});
    EXPECT_EQ(regions_of(run)[0].shear, 0.0);
    EXPECT_EQ(memories(run.history())[0].shear, 0.0);
    EXPECT_NEAR(run.blocks().acceleration[0].u.x, g * std::sin(slope), 1e-11 * g);
  }
}

} // namespace
} // namespace gcpdda::initial_friction_test
