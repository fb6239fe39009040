// Pairs of rows at rest are left out of an evaluation: nothing that it finds may change by that.

#include "support/blocks.hpp"
#include "support/scenes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

namespace gcpdda::resting_rows_test {
namespace {

using namespace testing;

enum class Shape { square, notched };

/// Blocks in a grid that overlap by a thousandth, on a fixed floor.
/// @param deforms  every third one does
/// @param num_ghosts  the last rows
BlockSystem grid(int side, Shape shape, bool deforms, std::size_t num_ghosts) {
  std::vector<std::vector<Vec2>> blocks;
  for (int k = 0; k < side * side; ++k) {
    const Vec2 low{0.999 * (k % side), 0.999 * (k / side)};
    std::vector<Vec2> outline = rectangle(low, low + Vec2{1.0, 1.0});
    if (shape == Shape::notched) {
      outline.push_back(low + Vec2{0.0, 0.6});
      outline.push_back(low + Vec2{0.2, 0.5});
      outline.push_back(low + Vec2{0.0, 0.4});
    }
    blocks.push_back(outline);
  }
  BlockSystem system = system_of(
      blocks, {rectangle({-1.0, -1.0}, {side + 1.0, 1e-3})}, 1000.0,
      deforms ? [](std::size_t row) { return row % 3 == 0; } : [](std::size_t) { return false; });
  system.num_ghosts = num_ghosts;
  system.num_owned -= num_ghosts;
  return system;
}

struct Totals {
  std::int64_t evaluated = 0;
  std::int64_t left_out = 0;
  std::int64_t slipped = 0;
};

void expect_same(const ContactBench &a, const ContactBench &b) {
  EXPECT_EQ(a.report.max_overlap, b.report.max_overlap);
  EXPECT_EQ(a.report.normals_undefined, b.report.normals_undefined);
  EXPECT_EQ(a.forces.sums().largest_force(), b.forces.sums().largest_force());
  for (std::size_t row = 0; row < a.system.num_owned; ++row) {
    EXPECT_EQ(a.system.contact[row].force, b.system.contact[row].force);
    EXPECT_EQ(a.system.contact[row].shear, b.system.contact[row].shear);
    EXPECT_EQ(a.system.contact[row].damping, b.system.contact[row].damping);
  }
  for (std::size_t k = 0; k < a.system.deformation.size(); ++k) {
    EXPECT_EQ(a.system.deformation[k].contact.force, b.system.deformation[k].contact.force);
    EXPECT_EQ(a.system.deformation[k].contact.shear, b.system.deformation[k].contact.shear);
  }
  ASSERT_EQ(a.regions.all().size(), b.regions.all().size());
  for (std::size_t k = 0; k < a.regions.all().size(); ++k) {
    expect_same_bits(a.regions.all()[k], b.regions.all()[k]);
  }
  for (std::size_t pair = 0; pair < a.candidates.pairs.size(); ++pair) {
    const std::vector<RegionMemory> of_a = a.history.of_pair(pair);
    const std::vector<RegionMemory> of_b = b.history.of_pair(pair);
    ASSERT_EQ(of_a.size(), of_b.size());
    for (std::size_t k = 0; k < of_a.size(); ++k) {
      EXPECT_EQ(of_a[k].shear, of_b[k].shear);
      EXPECT_EQ(of_a[k].slip, of_b[k].slip);
      EXPECT_EQ(of_a[k].opening, of_b[k].opening);
      EXPECT_EQ(of_a[k].state, of_b[k].state);
      EXPECT_EQ(of_a[k].grip, of_b[k].grip);
    }
  }
}

/// Some rows move for some evaluations, then others; two benches see the same, and one leaves out what rests.
/// @param part  of all rows, which follow one another, of which ...
/// @param one_in  ... every so many-th one moves
Totals move_some(const BlockSystem &system, const JointLaws &laws, double part, std::size_t one_in) {
  constexpr double reach = 0.1;
  ContactBench all(system, laws, 0.0, Instructions::widest, reach);
  ContactBench some(system, laws, 0.0, Instructions::widest, reach);
  std::mt19937 random(5);
  const auto number = [&](double size) {
    return size * (2.0 * static_cast<double>(random()) / static_cast<double>(std::mt19937::max()) - 1.0);
  };
  Totals totals;
  const std::size_t num_mobile = system.first_fixed(); // ghosts too
  std::vector<std::uint8_t> moves(num_mobile, 1);
  for (int k = 0; k < 60; ++k) {
    if (k == 5) {
      some.forces.leave_out_resting(true);
    } else if (k == 40) { // as after a refresh
      some.forces.forget_resting();
    }
    if (k % 6 == 3) {
      const auto count = static_cast<std::size_t>(part * static_cast<double>(num_mobile));
      const std::size_t last_place = num_mobile - count;
      const bool ghosts_alone = k > 50 && system.num_ghosts >= count;
      const std::size_t first = ghosts_alone ? system.num_owned : random() % (last_place + 1);
      for (std::size_t row = 0; row < num_mobile; ++row) {
        const bool may_move = first <= row && row < first + count;
        moves[row] = may_move && random() % one_in == 0 ? 1 : 0;
      }
    }
    for (std::size_t row = 0; row < num_mobile; ++row) {
      if (moves[row] != 0) {
        const RigidDof step{{number(2e-3), number(2e-3)}, number(5e-4)};
        all.system.trial[row] += step;
        some.system.trial[row] += step;
        if (system.is_deformable(row)) {
          const Mat2 strain{number(5e-4), number(5e-4), number(5e-4), number(5e-4)};
          for (ContactBench *bench : {&all, &some}) {
            Mat2 &trial = bench->system.deformation_of(row).trial;
            trial = trial + strain * trial;
          }
        }
      }
    }
    all.evaluate();
    some.evaluate();
    expect_same(all, some);
    totals.evaluated += some.report.evaluations;
    totals.left_out += all.report.evaluations - some.report.evaluations;
    for (const RegionForce &force : all.regions.all()) {
      totals.slipped += std::abs(force.shear) == force.cap ? 1 : 0;
    }
  }
  return totals;
}

JointLaws dilating_law() {
  JointLaws laws = one_law(1e6, 0.3);
  laws.laws.front().tan_dilation = 0.1;
  laws.laws.front().dilation_limit = 0.01;
  return laws;
}

TEST(RestingRows, KeepWhatTheirPairsDid) {
  for (const JointLaws &laws : {one_law(1e6, 0.3), dilating_law()}) {
    for (const Shape shape : {Shape::square, Shape::notched}) {
      for (const bool deforms : {false, true}) {
        for (const std::size_t num_ghosts : {0U, 10U}) {
          const Totals totals = move_some(grid(8, shape, deforms, num_ghosts), laws, 1.0, 8);
          EXPECT_GT(totals.left_out, 1000);
          EXPECT_GT(totals.evaluated, 1000);
          EXPECT_GT(totals.slipped, 100);
        }
      }
    }
  }
}

// Several groups of pairs, and some of them wholly at rest but for pairs with a ghost or a notch.
TEST(RestingRows, KeepWhatWholeGroupsDid) {
  for (const Shape shape : {Shape::square, Shape::notched}) {
    for (const bool deforms : {false, true}) {
      for (const std::size_t num_ghosts : {0U, 100U}) {
        const Totals totals = move_some(grid(30, shape, deforms, num_ghosts), one_law(1e6, 0.3), 0.05, 2);
        EXPECT_GT(totals.left_out, 10000);
      }
    }
  }
}

} // namespace
} // namespace gcpdda::resting_rows_test
