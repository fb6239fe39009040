// What blocks get of their contacts, group by group, against the same regions one block after the other.

#include "support/scenes.hpp"

#include "gcpdda/simulation/simulation.hpp"

#include <gtest/gtest.h>

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

void expect_same_sums(const std::string &fidelity) {
  Simulation simulation(Communicator::self(), scene_of(pyramid_with_hook(fidelity)));
  for (int step = 0; step < 60; ++step) {
    simulation.step();
  }
  const BlockSystem &blocks = simulation.blocks();
  const Candidates &candidates = simulation.candidates();
  const ContactForces &contacts = simulation.contacts();
  ASSERT_GT(candidates.plain.back().group(), 1U);
  ASSERT_FALSE(candidates.waiting.empty());
  ASSERT_LT(candidates.waiting.size(), candidates.pairs.size() / 10);
  double largest = 0.0;
  int waiting = 0;
  for (std::size_t row = 0; row < blocks.num_owned; ++row) {
    SCOPED_TRACE(row);
    const BlockContactSum sum = contacts.sums().of_blocks()[row];
    const BlockContactSum wanted = sum_contacts(candidates, contacts, row);
    EXPECT_EQ(sum.force, wanted.force);
    EXPECT_EQ(sum.shear, wanted.shear);
    EXPECT_EQ(sum.damping, wanted.damping);
    waiting += candidates.is_added[row] == 0 && norm(sum.force.u) > 0.0 ? 1 : 0;
    Mat2 dyad;
    double size = 0.0; // of what may cancel
    for (std::uint32_t c = candidates.contact_begin[row]; c < candidates.contact_begin[row + 1]; ++c) {
      const BlockContact contact = candidates.block_contacts[c];
      for (const RegionForce &force : contacts.of_pair(contact.pair)) {
        dyad += contact_part(force, contact.is_lower, blocks.trial_centroid[row]).dyad;
        size += norm(force.force);
        largest = std::max(largest, norm(force.force));
      }
    }
    if (blocks.is_deformable(row)) {
      expect_near(contacts.sums().of_gradients()[blocks.deformation_begin[row]].force, dyad,
                  64.0 * std::numeric_limits<double>::epsilon() * size); // arms are shorter than a metre
    }
  }
  EXPECT_GT(waiting, 1);
  EXPECT_EQ(contacts.sums().largest_force(), largest);
}

TEST(BlockSums, AreThoseOfOneBlockAfterTheOther) {
  expect_same_sums("rigid");
}

TEST(BlockSums, AreThoseOfDeformableBlocks) {
  expect_same_sums("deformable");
}

} // namespace
} // namespace gcpdda::block_sums_test
