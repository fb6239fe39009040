// What blocks get of their contacts, group by group, against the same regions one block after the other.

#include "contact/contact_sums.hpp"
#include "simulation/simulation.hpp"
#include "support/contact_regions.hpp"
#include "support/scenes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

namespace gcpdda::block_sums_test {
namespace {

using namespace testing;

/// A pyramid of several groups of pairs, with a hook on the end of its lowest row: the blocks that touch the
/// hook wait for it.
std::string pyramid_with_hook(const std::string &fidelity) {
  return settling_pyramid_toml(45, 1.0, fidelity) +
         block_toml("hook", {{-0.4, 1.0}, {0.5, 1.0}, {0.5, 1.8}, {0.2, 1.8}, {0.2, 1.3}, {-0.4, 1.3}});
}

void expect_near(const Mat2 &a, const Mat2 &b, double tolerance) {
  EXPECT_NEAR(a.xx, b.xx, tolerance);
  EXPECT_NEAR(a.xy, b.xy, tolerance);
  EXPECT_NEAR(a.yx, b.yx, tolerance);
  EXPECT_NEAR(a.yy, b.yy, tolerance);
}

struct OneBlock {
  Mat2 dyad;            ///< about its trial centroid
  double size = 0.0;    ///< of forces that may cancel
  double largest = 0.0; ///< of them
};

OneBlock contacts_of(const Simulation &simulation, const Regions &regions, std::size_t row) {
  OneBlock block;
  regions.for_block(simulation.candidates(), row, [&](const RegionForce &force, bool is_lower) {
    block.dyad += contact_part(force, is_lower, simulation.blocks().motion[row].centroid).dyad;
    block.size += norm(force.force);
    block.largest = std::max(block.largest, norm(force.force));
  });
  return block;
}

/// @return largest force on the block
double expect_same_sums(const Simulation &simulation, const Regions &regions, std::size_t row) {
  SCOPED_TRACE(row);
  const BlockSystem &blocks = simulation.blocks();
  const BlockContactSum wanted = regions.sum_contacts(simulation.candidates(), row);
  const AppliedForces applied = applied_forces(blocks, row);
  EXPECT_EQ(blocks.contact[row].force.u, wanted.force.u + applied.load.u + applied.gravity);
  EXPECT_EQ(blocks.contact[row].force.r, wanted.force.r);
  EXPECT_EQ(blocks.contact[row].shear.u, wanted.shear.u);
  EXPECT_EQ(blocks.contact[row].damping.u, wanted.damping.u);
  if (!blocks.is_deformable(row)) { // else it stands in the deformation
    EXPECT_EQ(blocks.contact[row].shear.r, wanted.shear.r);
    EXPECT_EQ(blocks.contact[row].damping.r, wanted.damping.r);
  }
  const OneBlock one = contacts_of(simulation, regions, row);
  if (blocks.is_deformable(row)) {
    const Mat2 &to_reference = blocks.trial_inverse[blocks.deformation_begin[row]];
    expect_near(blocks.deformation_of(row).contact.force, transposed(to_reference * one.dyad),
                64.0 * std::numeric_limits<double>::epsilon() * one.size); // arms are shorter than a metre
  }
  return one.largest;
}

void expect_same_sums(const std::string &fidelity) {
  Simulation simulation(Communicator::self(), scene_of(pyramid_with_hook(fidelity), {"run.local_damping=0"}));
  for (int step = 0; step < 60; ++step) {
    simulation.step();
  }
  const Candidates &candidates = simulation.candidates();
  ASSERT_GT(candidates.plain.back().group(), 1U);
  ASSERT_LT(candidates.waiting.size(), candidates.pairs.size() / 10);
  const Regions regions(simulation);
  double largest = 0.0;
  int waiting = 0;
  for (std::size_t row = 0; row < simulation.blocks().num_owned; ++row) {
    const double on_block = expect_same_sums(simulation, regions, row);
    largest = std::max(largest, on_block);
    waiting += candidates.is_added[row] == 0 && on_block > 0.0 ? 1 : 0;
  }
  EXPECT_GT(waiting, 1);
  EXPECT_EQ(simulation.contacts().sums().largest_force(), largest);
}

TEST(BlockSums, AreThoseOfOneBlockAfterTheOther) {
  expect_same_sums("rigid");
}

TEST(BlockSums, AreThoseOfDeformableBlocks) {
  expect_same_sums("deformable");
}

} // namespace
} // namespace gcpdda::block_sums_test
