// The block-local update: a broken block keeps its last state, the others go on.

#include "gcpdda/dynamics/integrate.hpp"
#include "support/scenes.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace gcpdda {
namespace {

BlockSystem two_blocks() {
  const Scene scene = testing::scene_of(
      testing::rock_toml(1.0, 0.5, "a") +
      testing::block_toml("a", testing::rectangle({0.0, 0.0}, {1.0, 1.0})) +
      testing::block_toml("b", testing::rectangle({5.0, 0.0}, {6.0, 2.0}), "velocity = [1.0, 2.0, 3.0]"));
  BlockSystem system;
  for (std::size_t k = 0; k < scene.blocks.size(); ++k) {
    append_block(system, BlockId{static_cast<std::int64_t>(k)}, scene.blocks[k], scene.materials[0]);
    ++system.num_owned;
  }
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
      const std::vector<RigidDof> forces{{{2600.0, 0.0}, 0.0}, force};
      EXPECT_EQ(solve_and_update(system, forces, scheme, 0.1), std::optional<std::size_t>(1));
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
  EXPECT_FALSE(solve_and_update(system, std::vector<RigidDof>(2), scheme, 0.1).has_value());
}

// No vertex moves farther in a step than the bound says, free flight with spin included.
TEST(MotionBound, HoldsForEveryVertex) {
  const Scheme scheme = make_scheme(SchemeKind::generalized_alpha, 0.8, ContactTime::leapfrog);
  const double time_step = 0.01;
  BlockSystem system = two_blocks();
  const double bound = motion_bound(system, 1, time_step);
  const std::vector<Vec2> before = current_vertices(system, 1);
  ASSERT_FALSE(solve_and_update(system, std::vector<RigidDof>(2), scheme, time_step).has_value());
  const std::vector<Vec2> after = current_vertices(system, 1);
  double farthest = 0.0;
  for (std::size_t k = 0; k < before.size(); ++k) {
    farthest = std::max(farthest, norm(after[k] - before[k]));
  }
  EXPECT_LE(farthest, bound);
  EXPECT_GT(farthest, 0.5 * bound); // not a bound that never bites
}

} // namespace
} // namespace gcpdda
