// The block-local update: a broken block keeps its last state, the others go on.

#include "dynamics/integrate.hpp"

#include "dynamics/deformable.hpp"
#include "dynamics/local_damping.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace gcpdda::integrate_test {
namespace {

SceneBlock block_of(Vec2 low, Vec2 high, std::array<double, 3> velocity = {}) {
  SceneBlock block;
  block.vertices = {low, {high.x, low.y}, high, {low.x, high.y}};
  block.velocity = velocity;
  return block;
}

BlockSystem two_blocks() {
  BlockSystem system;
  const Material rock{"rock", 2600.0, 0.0, 0.0};
  append_block(system, BlockId{0}, block_of({0.0, 0.0}, {1.0, 1.0}), rock);
  append_block(system, BlockId{1}, block_of({5.0, 0.0}, {6.0, 2.0}, {1.0, 2.0, 3.0}), rock);
  system.num_owned = 2;
  pose(system, 0, 2);
  return system;
}

TEST(SolveAndUpdate, KeepsTheStateOfABlockWhoseForceIsNotFinite) {
  const Scheme scheme = make_scheme(SchemeKind::generalized_alpha, 0.8, ContactTime::leapfrog);
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    for (const RigidDof &force :
         {RigidDof{{bad, 0.0}, 0.0}, RigidDof{{0.0, bad}, 0.0}, RigidDof{{0.0, 0.0}, bad}}) {
      BlockSystem system = two_blocks();
      const RigidDof velocity = system.velocity[1];
      system.contact[0].force = {{2600.0, 0.0}, 0.0};
      system.contact[1].force = force;
      EXPECT_EQ(solve_and_update(system, {}, scheme, 0.1, Elasticity::implicit),
                std::optional<std::size_t>(1));
      EXPECT_EQ(system.displacement[1], RigidDof{});
      EXPECT_EQ(system.velocity[1], velocity);
      EXPECT_EQ(system.acceleration[1], RigidDof{});
      EXPECT_GT(system.velocity[0].u.x, 0.0);
    }
  }
}

TEST(SolveAndUpdate, ReportsNothingWhenAllStatesAreFinite) {
  const Scheme scheme = make_scheme(SchemeKind::generalized_alpha, 0.8, ContactTime::leapfrog);
  BlockSystem system = two_blocks();
  EXPECT_FALSE(solve_and_update(system, {}, scheme, 0.1, Elasticity::implicit).has_value());
}

// What drives it may be anything: it heeds nothing.
TEST(SolveAndUpdate, DrivenBlockKeepsItsVelocity) {
  SceneBlock block = block_of({0.0, 0.0}, {1.0, 1.0}, {1.0, -2.0, 0.5});
  block.driven = true;
  BlockSystem system;
  append_block(system, BlockId{0}, block, {"rock", 2000.0, 0.0, 0.0});
  system.num_owned = 1;
  const RigidDof force{{1e300, -1e300}, 1e300};
  system.contact[0].force = force;
  apply_local_damping(system, 0, 0.8);
  EXPECT_EQ(system.contact[0].force, force);
  accelerate(system);
  EXPECT_EQ(system.acceleration[0], RigidDof{});
  for (const SchemeKind kind : {SchemeKind::generalized_alpha, SchemeKind::newmark_dda,
                                SchemeKind::central_difference, SchemeKind::explicit_generalized_alpha}) {
    const Scheme scheme = make_scheme(kind, 0.8, ContactTime::leapfrog);
    ASSERT_FALSE(solve_and_update(system, {}, scheme, 0.125, Elasticity::implicit).has_value());
    EXPECT_EQ(system.acceleration[0], RigidDof{});
    EXPECT_EQ(system.velocity[0], (RigidDof{{1.0, -2.0}, 0.5}));
  }
  EXPECT_EQ(system.displacement[0], (RigidDof{{0.5, -1.0}, 0.25}));
}

// Linear velocity, so a parabola between rows; beyond the table its last velocity.
TEST(PrescribedMotion, IsTheIntegralOfItsTable) {
  const std::vector<VelocityRow> table{
      {0.0, {1.0, -2.0, 0.5}}, {0.5, {3.0, -2.0, 0.0}}, {2.0, {0.0, 1.0, 0.0}}};
  const PrescribedMotion motion(table);
  EXPECT_EQ(motion.velocity(0.0), (RigidDof{{1.0, -2.0}, 0.5}));
  EXPECT_EQ(motion.velocity(0.25), (RigidDof{{2.0, -2.0}, 0.25}));
  EXPECT_EQ(motion.velocity(0.5), (RigidDof{{3.0, -2.0}, 0.0}));
  EXPECT_EQ(motion.velocity(1.25), (RigidDof{{1.5, -0.5}, 0.0}));
  EXPECT_EQ(motion.velocity(7.0), (RigidDof{{0.0, 1.0}, 0.0}));
  EXPECT_EQ(motion.displacement(0.0), RigidDof{});
  EXPECT_EQ(motion.displacement(0.25), (RigidDof{{0.375, -0.5}, 0.09375}));
  EXPECT_EQ(motion.displacement(0.5), (RigidDof{{1.0, -1.0}, 0.125}));
  EXPECT_EQ(motion.displacement(2.0), (RigidDof{{3.25, -1.75}, 0.125}));
  EXPECT_EQ(motion.displacement(4.0), (RigidDof{{3.25, 0.25}, 0.125}));
  const PrescribedMotion constant({table.data(), 1});
  EXPECT_EQ(constant.velocity(9.0), (RigidDof{{1.0, -2.0}, 0.5}));
  EXPECT_EQ(constant.displacement(2.0), (RigidDof{{2.0, -4.0}, 1.0}));
}

// A square on one anchor starts like a compound pendulum, on two it does not start at all.
TEST(Accelerate, AnchoredPointsStay) {
  constexpr double arm = 0.3;
  for (const BlockKind kind : {BlockKind::rigid, BlockKind::deformable}) {
    for (const bool two : {false, true}) {
      SceneBlock block = block_of({-0.5, -0.5}, {0.5, 0.5});
      block.fixed_points = {{arm, 0.0}};
      if (two) {
        block.fixed_points.push_back({-arm, 0.0});
      }
      BlockSystem system;
      append_block(system, BlockId{0}, block, {"rock", 1000.0, 1e9, 0.0}, kind);
      system.num_owned = 1;
      pose(system, 0, 1);
      const Scheme scheme = make_scheme(SchemeKind::generalized_alpha, 0.8, ContactTime::leapfrog);
      make_block_matrices(system, scheme, 1e-3, Elasticity::implicit, 1e9);
      system.contact[0].force = {{0.0, -1000.0}, 0.0};
      accelerate(system);
      // m (1/6 + arm^2) alpha = m g arm; a deformable block bends, so only its anchor is sure.
      const Mat2 turning = kind == BlockKind::rigid
                               ? Mat2{0.0, -system.acceleration[0].r, system.acceleration[0].r, 0.0}
                               : system.deformation[0].acceleration;
      for (const Anchor &anchor : system.anchor) {
        EXPECT_LE(norm(system.acceleration[0].u + turning(anchor.point)), 1e-5);
      }
      if (kind == BlockKind::rigid) {
        EXPECT_NEAR(system.acceleration[0].r, two ? 0.0 : arm / (1.0 / 6.0 + arm * arm), 1e-5);
      }
    }
  }
}

// A block that falls loses a share of its weight, one that is thrown up gains it.
TEST(LocalDamping, OfARigidBlock) {
  BlockSystem system = two_blocks();
  system.velocity[0] = {{-1.0, 1.0}, 0.0};
  system.contact[0].force = {{4.0, -8.0}, 2.0};
  apply_local_damping(system, 0, 0.5);
  EXPECT_EQ(system.contact[0].force, (RigidDof{{6.0, -12.0}, 2.0}));
  EXPECT_EQ(system.contact[0].damping, (RigidDof{{2.0, -4.0}, 0.0}));
  EXPECT_EQ(system.contact[1].force, RigidDof{});
}

// No vertex moves farther in a step than the bound says, free flight with spin included.
TEST(MotionBound, HoldsForEveryVertex) {
  const Scheme scheme = make_scheme(SchemeKind::generalized_alpha, 0.8, ContactTime::leapfrog);
  const double time_step = 0.01;
  BlockSystem system = two_blocks();
  const double bound = motion_bound(system, 1, time_step);
  const std::vector<Vec2> before = current_vertices(system, 1);
  ASSERT_FALSE(solve_and_update(system, {}, scheme, time_step, Elasticity::implicit).has_value());
  const std::vector<Vec2> after = current_vertices(system, 1);
  double farthest = 0.0;
  for (std::size_t k = 0; k < before.size(); ++k) {
    farthest = std::max(farthest, norm(after[k] - before[k]));
  }
  EXPECT_LE(farthest, bound);
  EXPECT_GT(farthest, 0.5 * bound); // not a bound that never bites
}

} // namespace
} // namespace gcpdda::integrate_test
