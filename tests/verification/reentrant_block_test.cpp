// B3, B4 and A5 for blocks with re-entrant vertices, and a wedge in a re-entrant corner.

#include "dynamics/deformable.hpp"
#include "problem.hpp"
#include "support/contact_regions.hpp"
#include "support/incline.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace gcpdda::testing::reentrant_block_test {
namespace {

/// An L of 3 m2 that stands on its long leg, and a table of 3 m2 on two legs of 0.5 m.
std::vector<Vec2> ell(double depth) {
  return {{0.0, -depth},      {2.0, -depth},      {2.0, 1.0 - depth},
          {1.0, 1.0 - depth}, {1.0, 2.0 - depth}, {0.0, 2.0 - depth}};
}
std::vector<Vec2> table(double depth) {
  return {{0.0, -depth}, {0.5, -depth}, {0.5, 0.5 - depth},  {1.5, 0.5 - depth},
          {1.5, -depth}, {2.0, -depth}, {2.0, 1.75 - depth}, {0.0, 1.75 - depth}};
}

struct Reentrant {
  std::string name;
  std::vector<Vec2> (*shape)(double depth);
  double base = 0.0; ///< m
  int regions = 0;
};
const std::vector<Reentrant> reentrant{{"L", ell, 2.0, 1}, {"table", table, 1.0, 2}};
constexpr double reentrant_area = 3.0;

/// Flush at the depth that carries the weight's normal component on the whole base.
std::string on_incline(const Incline &incline, const Reentrant &block, const Setting &setting) {
  const double normal = reentrant_area * incline.weight() * std::cos(incline.slope_deg * degree);
  return incline.toml(incline.in_world(block.shape(normal / (incline.normal_stiffness * block.base))),
                      setting);
}

// B3 for blocks with re-entrant vertices. The flat start rocks into its tilt; dashpots take that out in the
// first half, as for the square, to 2e-10.
TEST(ReentrantBlock, SlidesDownAnIncline) {
  for (const Reentrant &block : reentrant) {
    for (const double friction : {0.0, 15.0}) {
      const Incline incline{.friction_deg = friction};
      Simulation simulation(Communicator::self(), scene_of(on_incline(incline, block, {.duration = 2.0})));
      run_until(simulation, 1.0);
      const Vec2 before = velocity_of(simulation, 1).u;
      run(simulation);
      EXPECT_EQ(regions_of(simulation).size(), block.regions);
      const double gained = dot(velocity_of(simulation, 1).u - before, incline.downhill());
      expect_value(fmt::format("B3 {} on th=30 phi={}: acceleration over 1..2 s", block.name, friction),
                   incline.acceleration(), gained, 1e-8);
    }
  }
}

// B4 for blocks with re-entrant vertices: friction holds.
TEST(ReentrantBlock, RestsOnAnIncline) {
  for (const Reentrant &block : reentrant) {
    const Incline incline{.friction_deg = 35.0};
    Simulation simulation(Communicator::self(), scene_of(on_incline(incline, block, {.duration = 40.0})));
    run_until(simulation, 20.0);
    const RigidDof rest = displacement_of(simulation, 1);
    double creep = 0.0;
    while (!simulation.finished()) {
      step(simulation);
      const RigidDof moved = displacement_of(simulation, 1) - rest;
      creep = std::max(creep, norm(moved.u) + std::abs(moved.r));
    }
    EXPECT_EQ(regions_of(simulation).size(), block.regions);
    expect_below(fmt::format("B4 {} on th=30 phi=35: motion from 20 to 40 s over its size", block.name),
                 1e-12, creep / std::sqrt(reentrant_area));
  }
}

/// A wedge, apex down and 1 m high, flush in a longer V-notch.
struct Notch {
  double half_angle_deg = 45.0;
  double friction_deg = 0.0;
  Vec2 gravity{0.0, -earth_gravity};

  [[nodiscard]] double angle() const { return half_angle_deg * degree; }
  [[nodiscard]] Vec2 weight() const { return rock_density * std::tan(angle()) * gravity; }
  [[nodiscard]] std::string toml() const {
    const double half_width = std::tan(angle());
    const Setting setting{.duration = 10.0,
                          .gravity = gravity,
                          .normal_stiffness = 1e9,
                          .friction_deg = friction_deg,
                          .damping = 0.3,
                          .run_keys = "gravity_ramp = 4.0"};
    return head(setting) +
           block_toml("notch",
                      {{-5.0, -2.0},
                       {5.0, -2.0},
                       {5.0, 2.0},
                       {2.0 * half_width, 2.0},
                       {0.0, 0.0},
                       {-2.0 * half_width, 2.0},
                       {-5.0, 2.0}},
                      "fixed = true") +
           block_toml("wedge", {{0.0, 0.0}, {half_width, 1.0}, {-half_width, 1.0}});
  }
};

/// What the right or left face of the notch does to the wedge.
struct FaceForce {
  double normal = 0.0;
  double friction = 0.0; ///< up along the face
};

/// Both faces, right one first, after the wedge has settled; checks what any wedge at rest must show.
std::array<FaceForce, 2> settle(const Notch &notch, const std::string &what) {
  Simulation simulation(Communicator::self(), scene_of(notch.toml()));
  run_until(simulation, 8.0);
  const RigidDof rest = displacement_of(simulation, 1);
  run(simulation);
  const RigidDof moved = displacement_of(simulation, 1) - rest;
  expect_below(what + "motion from 8 to 10 s, m", 1e-12, norm(moved.u) + std::abs(moved.r));

  std::array<FaceForce, 2> faces;
  Vec2 total;
  const auto regions = regions_of(simulation);
  EXPECT_EQ(regions.size(), 2U) << "one region a face";
  for (const RegionForce &region : regions) {
    const bool right = region.point.x > 0.0;
    const double side = right ? 1.0 : -1.0;
    const Vec2 normal{-side * std::cos(notch.angle()), std::sin(notch.angle())};
    const Vec2 up{side * std::sin(notch.angle()), std::cos(notch.angle())};
    const Vec2 on_wedge = dot(region.force, normal) > 0.0 ? region.force : -1.0 * region.force;
    faces[right ? 0 : 1] = {dot(on_wedge, normal), dot(on_wedge, up)};
    total += on_wedge;
  }
  expect_below(what + "sum of the reactions and the weight, over the weight", 1e-9,
               norm(total + notch.weight()) / norm(notch.weight()));
  for (const FaceForce &face : faces) {
    EXPECT_GT(face.normal, 0.0);
    // The region's direction, to which friction is at right angles, turns by O(d/L) from the face's.
    EXPECT_LE(std::abs(face.friction), face.normal * (std::tan(notch.friction_deg * degree) + 1e-5));
  }
  return faces;
}

// Sinking by u closes each joint by u sin t and shears it by u cos t: T/N = (k_t/k_n)/tan t as long as
// friction bears it, then tan phi; and 2 (N sin t + T cos t) = W. The formula leaves out what the joint's
// ends add, O(d/L) = 3e-5.
TEST(Notch, EachFaceOfAWedgeCarriesItsFriction) {
  struct Case {
    double half_angle, friction;
  };
  for (const Case c : {Case{45, 35}, Case{45, 15}, Case{30, 45}, Case{60, 30}, Case{30, 0}}) {
    const Notch notch{.half_angle_deg = c.half_angle, .friction_deg = c.friction};
    const std::string what = fmt::format("wedge of half-angle {}, phi = {}: ", c.half_angle, c.friction);
    const auto faces = settle(notch, what);
    const double share = std::min(0.5 / std::tan(notch.angle()), std::tan(c.friction * degree));
    const double normal =
        0.5 * norm(notch.weight()) / (std::sin(notch.angle()) + share * std::cos(notch.angle()));
    for (const FaceForce &face : faces) {
      expect_value(what + "normal force of a face, N/m", normal, face.normal, 2e-4);
      expect_below(what + "error of T/N", 2e-4, std::abs(face.friction / face.normal - share));
    }
  }
}

// Pulled to the right the faces differ in N and in T; by statics alone.
TEST(Notch, FacesOfAWedgePulledAsideDiffer) {
  const Notch notch{.half_angle_deg = 45.0, .friction_deg = 35.0, .gravity = {3.0, -9.0}};
  const auto [right, left] = settle(notch, "wedge pulled aside: ");
  EXPECT_GT(right.normal, 1.2 * left.normal);
  EXPECT_GT(std::abs(right.friction - left.friction), 0.05 * norm(notch.weight()));
}

/// Rigid, deformable and re-entrant blocks that fly at each other, spinning.
std::string collision_toml() {
  const Setting setting{.duration = 3.0,
                        .gravity = {},
                        .normal_stiffness = 1e8,
                        .friction_deg = 30.0,
                        .youngs_modulus = 1e9,
                        .poissons_ratio = 0.25};
  std::string toml = head(setting);
  for (int k = 0; k < 16; ++k) {
    const Vec2 at{3.1 * (k % 4) - 4.6 + 0.03 * (k % 3), 3.1 * (k / 4) - 4.7 - 0.02 * (k % 5)};
    std::vector<Vec2> shape = k % 3 == 0   ? ell(0.8)
                              : k % 3 == 1 ? table(0.9)
                                           : rectangle({0.0, -0.9}, {1.9, 0.6});
    for (Vec2 &p : shape) {
      p.x -= 0.9;
    }
    toml +=
        block_toml(fmt::format("b{}", k), placed(shape, 0.7 * k, at),
                   fmt::format("velocity = [{:.17g}, {:.17g}, {:.17g}]\nfidelity = \"{}\"",
                               -0.8 * at.x - 0.3 * at.y + 0.5, -0.8 * at.y + 0.3 * at.x,
                               0.4 * ((k * 7) % 11) - 2.0, k % 4 == 0 || k == 7 ? "deformable" : "rigid"));
  }
  return toml;
}

/// Of the blocks and, for scale, the sum of its terms' sizes; angular momentum of the last two trial
/// configurations, which the leapfrog keeps.
struct Momentum {
  Vec2 linear;
  double linear_scale = 0.0;
  double angular = 0.0;
  double angular_scale = 0.0;
};

Momentum momentum(const Simulation &simulation) {
  Momentum sum;
  const BlockSystem &blocks = simulation.blocks();
  const double rate = 1.0 / simulation.plan().time_step;
  for (std::size_t row = 0; row < blocks.num_owned; ++row) {
    const BlockProperties &p = blocks.properties[row];
    sum.linear += p.mass * blocks.velocity[row].u;
    sum.linear_scale += p.mass * norm(blocks.velocity[row].u);
    const RigidDof increment = blocks.motion[row].increment();
    const RigidDof v = rate * increment;
    const Vec2 arm = p.centroid + (blocks.trial[row] - increment).u;
    double spin = p.inertia * v.r;
    if (blocks.is_deformable(row)) {
      const Deformation &d = blocks.deformation_of(row);
      const Mat2 dyad = rate * (blocks.gradient_increment(row) * d.second_moment * transposed(d.trial));
      spin = dyad.yx - dyad.xy;
    }
    sum.angular += p.mass * cross(arm, v.u) + spin;
    sum.angular_scale += p.mass * norm(arm) * norm(v.u) + std::abs(spin);
  }
  return sum;
}

// A5 for blocks of every kind: forces of a region are opposite and act at the same points, elasticity has no
// torque. Tolerances as for rigid blocks.
TEST(Collision, OfBlocksOfAllKindsKeepsMomentum) {
  Simulation simulation(Communicator::self(), scene_of(collision_toml()));
  step(simulation);
  const Momentum before = momentum(simulation); // its angular one is not meant: x*_0 has no partner
  step(simulation);
  step(simulation);
  const Momentum start = momentum(simulation);
  double linear = 0.0;
  double angular = 0.0;
  std::size_t most_regions = 0;
  while (!simulation.finished()) {
    step(simulation);
    const Momentum now = momentum(simulation);
    linear = std::max(linear, norm(now.linear - before.linear) / before.linear_scale);
    angular = std::max(angular, std::abs(now.angular - start.angular) / start.angular_scale);
    for (std::size_t k = 0; k < simulation.candidates().pairs.size(); ++k) {
      most_regions = std::max(most_regions, simulation.history().of_pair(k).size());
    }
  }
  ASSERT_FALSE(simulation.fault().has_value());
  EXPECT_GT(simulation.counters().contact_steps, simulation.step_count()) << "a collision of many";
  EXPECT_GE(most_regions, 2U) << "some pair touched in two regions";
  expect_below(fmt::format("A5 blocks of all kinds, {} steps, {} contact steps: change of linear momentum",
                           simulation.step_count(), simulation.counters().contact_steps),
               1e-13, linear);
  expect_below("A5 blocks of all kinds: change of L*", 5e-13, angular);
}

} // namespace
} // namespace gcpdda::testing::reentrant_block_test
