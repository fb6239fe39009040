// Contact springs against the forces that they linearise.

#include "statics/spring_products.hpp"
#include "statics/springs.hpp"
#include "support/blocks.hpp"
#include "support/touching_pairs.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

namespace gcpdda::testing::springs_test {
namespace {

constexpr double k_n = 1e9;

/// Forces of the contacts on the freedoms of all rows (statics/field.hpp), the state of the bench moved by v.
/// The memory of friction stays what it is.
std::vector<double> forces_at(const ContactBench &base, ContactForces &forces, const statics::Field &v) {
  BlockSystem system = base.system;
  ContactHistory history = base.history;
  for (std::size_t row = 0; row < system.num_owned; ++row) {
    const double *const by = v.of(row);
    TrialConfiguration trial{system.trial[row], {}};
    trial.motion.u += Vec2{by[0], by[1]};
    if (system.is_deformable(row)) {
      const Mat2 &gradient = system.deformation_of(row).trial;
      trial.gradient = gradient + Mat2{by[2], by[3], by[4], by[5]} * gradient;
    } else {
      trial.motion.r += by[2];
    }
    set_trial(system, row, trial);
  }
  pose(system, 0, system.num_rows());
  forces.evaluate(system, base.candidates, history);
  forces.finish_sums(system, base.candidates);
  std::vector<double> sums;
  for (std::size_t row = 0; row < system.num_owned; ++row) {
    const RigidDof &force = system.contact[row].force;
    sums.insert(sums.end(), {force.u.x, force.u.y});
    if (system.is_deformable(row)) { // the sums of contacts are still int (x - x_c) df^T
      const Mat2 dyad = transposed(system.deformation_of(row).contact.force);
      sums.insert(sums.end(), {dyad.xx, dyad.xy, dyad.yx, dyad.yy});
    } else {
      sums.insert(sums.end(), {force.r, 0.0, 0.0, 0.0});
    }
  }
  return sums;
}

constexpr double depth = 1e-5;
constexpr double strong = 10.0; ///< friction that no motion here overcomes

/// Two blocks with a flush joint, each deformable in some of the benches.
ContactBench flush_joint(unsigned seed) {
  std::mt19937 engine(seed);
  const TouchingPair shapes = touching_pair(engine, Touch::face_on_face, depth, 0.3);
  const bool lower_deforms = seed % 2 == 1;
  const bool higher_deforms = seed % 3 == 1;
  ContactBench bench(
      strained_blocks(engine, {shapes.lower, shapes.higher}, {lower_deforms, higher_deforms}, 1e10, 1e-4),
      one_law(k_n, strong));
  bench.forces.keep_details(true);
  bench.evaluate();
  return bench;
}

/// For so many freedoms a row.
statics::LeanField lean_field(const BlockSystem &system, std::size_t width) {
  return {system.num_rows(), statics::lean_width(width)};
}

/// K p of a field of so many freedoms a row.
statics::LeanField product_of(const BlockSystem &system, const statics::ContactSprings &springs,
                              std::size_t width, const statics::LeanField &p,
                              statics::SlipSprings of_slip = statics::SlipSprings::all) {
  statics::SpringProducts products;
  products.take(system, springs, of_slip, width);
  statics::LeanField product = lean_field(system, width);
  products.add(p, product);
  return product;
}

/// The higher block turns about its centroid.
void tilt(ContactBench &bench, double angle) {
  constexpr std::size_t row = 1;
  if (bench.system.is_deformable(row)) {
    Mat2 &gradient = bench.system.deformation_of(row).trial;
    gradient = gradient + Mat2{0.0, -angle, angle, 0.0} * gradient;
  } else {
    bench.system.trial[row].r += angle;
  }
}

/// Largest difference of K from the derivative of the forces over the largest element of that.
double error_of_springs(const ContactBench &bench) {
  statics::ContactSprings springs;
  springs.update(bench.system, bench.candidates, bench.history, bench.forces, {});
  EXPECT_EQ(springs.springs().size(), 1U);
  ContactForces forces({one_law(k_n, strong), 0.0, PotentialKind::exact});
  const double step = 1e-2 * depth;
  double largest = 0.0;
  double error = 0.0;
  for (std::size_t row = 0; row < 2; ++row) {
    for (std::size_t i = 0; i < statics::num_freedoms(bench.system, row); ++i) {
      statics::Field motion(2, 6);
      motion.of(row)[i] = step;
      const std::vector<double> ahead = forces_at(bench, forces, motion);
      motion.of(row)[i] = -step;
      const std::vector<double> behind = forces_at(bench, forces, motion);
      statics::LeanField unit = lean_field(bench.system, 6);
      unit.of(row)[i] = 1.0F;
      const statics::LeanField product = product_of(bench.system, springs, 6, unit);
      for (std::size_t k = 0; k < ahead.size(); ++k) {
        const double stiffness = -(ahead[k] - behind[k]) / (2.0 * step);
        largest = std::max(largest, std::abs(stiffness));
        error = std::max(error, std::abs(stiffness - product.of(k / 6)[k % 6]));
      }
    }
  }
  return error / largest;
}

// What K leaves out is of the order of the depth over the length, 1e-5, and differences of forces leave as
// much.
TEST(ContactSprings, OfAFlushJointAreTheDerivativeOfItsForces) {
  for (unsigned seed = 0; seed < 24; ++seed) {
    ContactBench bench = flush_joint(seed);
    bench.evaluate(); // the spring is there now
    EXPECT_LT(error_of_springs(bench), 1e-3) << "seed " << seed;
  }
}

// One end has opened: friction acts where it did when all of the joint was closed. The end of what is closed
// moves with the blocks, which differences of forces see over their step of a hundredth of the depth.
TEST(ContactSprings, OfAJointThatGapesAreTheDerivativeOfItsForces) {
  double farthest = 0.0;
  for (unsigned seed = 0; seed < 24; ++seed) {
    ContactBench bench = flush_joint(seed);
    tilt(bench, seed % 4 < 2 ? 4.0 * depth : -4.0 * depth);
    const RegionForce region = bench.evaluate();
    const double middle = 0.5 * (region.extent_begin + region.extent_end);
    farthest = std::max(farthest, std::abs(dot(region.grip - region.point, perp(region.normal)) - middle));
    EXPECT_LT(error_of_springs(bench), 1e-2) << "seed " << seed;
  }
  EXPECT_GT(farthest, 0.1) << "m";
}

TEST(ContactSprings, LeaveRigidMotionsAlone) {
  std::mt19937 engine(7);
  const TouchingPair shapes = touching_pair(engine, Touch::face_on_face, 1e-3);
  ContactBench bench(strained_blocks(engine, {shapes.lower, shapes.higher}, {false, false}, 1e10),
                     one_law(k_n, 1.0));
  bench.forces.keep_details(true);
  bench.evaluate();
  statics::ContactSprings springs;
  springs.update(bench.system, bench.candidates, bench.history, bench.forces, {});
  const Vec2 shift{0.3, -0.7};
  const double turn = 0.4;
  for (const std::size_t width : {3U, 6U}) {
    statics::LeanField motion = lean_field(bench.system, width);
    for (std::size_t row = 0; row < 2; ++row) {
      const Vec2 u = shift + turn * perp(bench.system.motion[row].centroid);
      motion.of(row)[0] = static_cast<float>(u.x);
      motion.of(row)[1] = static_cast<float>(u.y);
      motion.of(row)[2] = static_cast<float>(turn);
    }
    const statics::LeanField product = product_of(bench.system, springs, width, motion);
    for (const float force : product.values()) {
      EXPECT_NEAR(force, 0.0, 1e-6 * k_n); // arms of a metre in single precision
    }
  }
}

// Rows of a floor and of so many squares on it, side by side: three springs, five, and so on, in which the
// floor comes again and again.
TEST(ContactSprings, OfRigidBlocksHaveTheSameProductFourAtATime) {
  for (int num_squares = 1; num_squares < 6; ++num_squares) {
    std::vector<std::vector<Vec2>> squares;
    for (int k = 0; k < num_squares; ++k) {
      const double x = 0.999 * k;
      squares.push_back({{x, 0.999}, {x + 1.0, 0.999}, {x + 1.0, 1.999}, {x, 1.999}});
    }
    squares.push_back({{-1.0, 0.0}, {7.0, 0.0}, {7.0, 1.0}, {-1.0, 1.0}});
    ContactBench bench(system_of(squares, {}), one_law(k_n, 0.5));
    bench.forces.keep_details(true);
    bench.evaluate();
    statics::ContactSprings springs;
    springs.update(bench.system, bench.candidates, bench.history, bench.forces, {});
    EXPECT_EQ(springs.springs().size(), static_cast<std::size_t>(2 * num_squares - 1));
    statics::LeanField three = lean_field(bench.system, 3);
    statics::LeanField six = lean_field(bench.system, 6);
    std::mt19937 engine(11);
    for (std::size_t row = 0; row < bench.system.num_rows(); ++row) {
      for (std::size_t i = 0; i < 3; ++i) {
        three.of(row)[i] = six.of(row)[i] = static_cast<float>(uniform(engine, -1.0, 1.0));
      }
    }
    const statics::LeanField narrow = product_of(bench.system, springs, 3, three);
    const statics::LeanField wide = product_of(bench.system, springs, 6, six);
    for (std::size_t row = 0; row < bench.system.num_rows(); ++row) {
      for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_NEAR(narrow.of(row)[i], wide.of(row)[i], 1e-5 * k_n); // sums of ten in single precision
      }
    }
  }
}

/// Two unit squares, the higher one sunk into the lower one, which is fixed.
ContactBench stacked_squares(const JointLaws &joints) {
  ContactBench bench(system_of({{{0.0, 0.999}, {1.0, 0.999}, {1.0, 1.999}, {0.0, 1.999}}},
                               {{{-1.0, 0.0}, {2.0, 0.0}, {2.0, 1.0}, {-1.0, 1.0}}}),
                     joints);
  bench.forces.keep_details(true);
  return bench;
}
ContactBench stacked_squares(double tan_friction) {
  return stacked_squares(one_law(k_n, tan_friction));
}

TEST(ContactSprings, SlipTakesMostOfTheTangentialStiffness) {
  ContactBench bench = stacked_squares(0.1);
  statics::ContactSprings springs;
  const statics::SpringRules rules;
  bench.evaluate();
  bench.evaluate();
  springs.update(bench.system, bench.candidates, bench.history, bench.forces, rules);
  const double whole = springs.springs()[0].tangential;
  EXPECT_NEAR(whole, 0.5 * k_n, 1e-9 * k_n); // ratio k_n l
  bench.move(0, {{1e-3, 0.0}, 0.0});
  springs.update(bench.system, bench.candidates, bench.history, bench.forces, rules);
  EXPECT_NEAR(springs.springs()[0].tangential, rules.slip_share * whole, 1e-9 * whole);
  bench.move(0, {{-3e-3, 0.0}, 0.0}); // the other way: slip has turned
  for (int k = 0; k < 20; ++k) {
    springs.update(bench.system, bench.candidates, bench.history, bench.forces, rules);
    EXPECT_NEAR(springs.springs()[0].tangential, whole, 1e-9 * whole) << k;
    bench.move(0, {{-1e-3, 0.0}, 0.0});
  }
  springs.update(bench.system, bench.candidates, bench.history, bench.forces, rules);
  EXPECT_NEAR(springs.springs()[0].tangential, rules.slip_share * whole, 1e-9 * whole);
}

// Without slip: all of the springs of a joint that sticks, the normal ones alone of one that slips.
TEST(ContactSprings, ASlideIsFreeWithoutSlip) {
  ContactBench bench = stacked_squares(0.1);
  statics::ContactSprings springs;
  bench.evaluate();
  bench.evaluate();
  const auto products = [&](const std::array<float, 3> &motion) {
    springs.update(bench.system, bench.candidates, bench.history, bench.forces, {});
    statics::LeanField p = lean_field(bench.system, 3);
    std::copy(motion.begin(), motion.end(), p.of(0));
    return std::array{product_of(bench.system, springs, 3, p),
                      product_of(bench.system, springs, 3, p, statics::SlipSprings::none_tangential)};
  };
  const auto [sticking, also_sticking] = products({0.3F, -0.2F, 0.1F});
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(also_sticking.of(0)[i], sticking.of(0)[i]);
  }
  bench.move(0, {{1e-3, 0.0}, 0.0});
  const auto [slide, free_slide] = products({1.0F, 0.0F, 0.0F});
  EXPECT_GT(slide.of(0)[0], 1e-3 * k_n);
  EXPECT_EQ(free_slide.of(0)[0], 0.0F);
  const auto [closing, also_closing] = products({0.0F, 1.0F, 0.0F});
  EXPECT_GT(closing.of(0)[1], 0.9 * k_n);
  EXPECT_EQ(also_closing.of(0)[1], closing.of(0)[1]);
}

TEST(ContactSprings, ThatSlipHaveAllOfTheirStiffnessWhereTheMotionBeginsAnew) {
  ContactBench bench = stacked_squares(0.1);
  statics::ContactSprings springs;
  bench.evaluate();
  bench.evaluate();
  springs.update(bench.system, bench.candidates, bench.history, bench.forces, {});
  const double whole = springs.springs()[0].tangential;
  bench.move(0, {{1e-3, 0.0}, 0.0});
  springs.update(bench.system, bench.candidates, bench.history, bench.forces, {});
  EXPECT_LT(springs.springs()[0].tangential, 0.1 * whole);
  springs.hold_slip();
  EXPECT_NEAR(springs.springs()[0].tangential, whole, 1e-9 * whole);
  springs.update(bench.system, bench.candidates, bench.history, bench.forces, {});
  EXPECT_LT(springs.springs()[0].tangential, 0.1 * whole) << "for one step";
}

// Under a load that grows friction takes the path of slow loading: a region keeps its share for as long as it
// slips, and all of k_t for half as long where it has turned, so that blocks lag less.
TEST(ContactSprings, UnderALoadThatGrowsDoNotFadeAndForgetATurnSooner) {
  ContactBench bench = stacked_squares(0.1);
  statics::ContactSprings springs;
  const statics::SpringRules rules;
  const auto slip = [&](double way) {
    bench.move(0, {{way, 0.0}, 0.0});
    springs.update(bench.system, bench.candidates, bench.history, bench.forces, under_load(rules));
    return springs.springs()[0].tangential / (0.5 * k_n); // over k_t l
  };
  bench.evaluate();
  bench.evaluate();
  for (int k = 0; k < 2 * rules.slide_memory; ++k) {
    EXPECT_NEAR(slip(1e-3), rules.slip_share, 1e-9) << k;
  }
  for (int k = 0; k < rules.turn_memory / 2; ++k) {
    EXPECT_NEAR(slip(-3e-3), 1.0, 1e-9) << k;
  }
  EXPECT_NEAR(slip(-3e-3), rules.slip_share, 1e-9);
}

TEST(ContactSprings, OfARegionThatSlidesOnFadeToTwoFloors) {
  ContactBench bench = stacked_squares(0.1);
  statics::ContactSprings springs;
  const statics::SpringRules rules;
  bench.evaluate();
  bench.evaluate();
  springs.update(bench.system, bench.candidates, bench.history, bench.forces, rules);
  const double slipping = rules.slip_share * springs.springs()[0].tangential;
  const auto slide = [&](double distance) {
    bench.move(0, {{distance, 0.0}, 0.0});
    springs.update(bench.system, bench.candidates, bench.history, bench.forces, rules);
    return springs.springs()[0].tangential / slipping;
  };
  for (int k = 1; k <= 300; ++k) { // counts stay at 255
    const double faded = std::max(0.3, std::pow(0.9, std::max(0, k - 10)));
    const double further = std::pow(0.95, std::max(0, k - 60));
    EXPECT_NEAR(slide(1e-3), std::max(0.03, faded * further), 1e-12) << k;
  }
  bench.move(0, {{-1e-5, 0.0}, 0.0}); // back a little, it sticks
  springs.update(bench.system, bench.candidates, bench.history, bench.forces, rules);
  EXPECT_NEAR(slide(1e-3), 1.0, 1e-12);
}

// The square rides up on its joint: its pressure stays what it is, in the spring as in the forces.
TEST(ContactSprings, OfARegionThatDilatesLeanToItsSlip) {
  constexpr double psi = 0.1; // tangent
  JointLaws joints = one_law(k_n, 0.5);
  joints.laws[0].tan_dilation = psi;
  joints.laws[0].dilation_limit = 0.02;
  for (const double side : {1.0, -1.0}) {
    ContactBench bench = stacked_squares(joints);
    statics::ContactSprings springs;
    bench.evaluate();
    const auto ride = [&](double distance, double rise) {
      const double force = bench.move(0, {{side * distance, rise}, 0.0}).force.y;
      springs.update(bench.system, bench.candidates, bench.history, bench.forces, {});
      return force;
    };
    for (int k = 0; k < 6; ++k) {
      ride(1e-3, psi * 1e-3);
    }
    const double before = ride(1e-4, psi * 1e-4);
    const Vec2 leaning = springs.springs()[0].normal;
    EXPECT_NEAR(leaning.x, -side * psi * leaning.y, 1e-12);
    EXPECT_NEAR(norm(leaning), 1.0, 1e-12);
    EXPECT_NEAR(springs.springs()[0].normal_stiffness, k_n * (1.0 + psi * psi), 1e-9 * k_n);
    EXPECT_NEAR(ride(1e-4, psi * 1e-4), before, 1e-6 * before);
    EXPECT_GT(ride(1e-4, 0.0), before + 0.8 * k_n * psi * 1e-4) << "it does not rise";
    ride(0.02, 0.002); // it opens no further
    ride(1e-3, 0.0);
    EXPECT_NEAR(springs.springs()[0].normal.x, 0.0, 1e-12);
  }
}

// Turned onto its corner the square touches over millimetres; its spring falls no faster than one that opens.
TEST(ContactSprings, OfASliverFadeFromWhatTheyWere) {
  ContactBench bench = stacked_squares(0.1);
  statics::ContactSprings springs;
  const statics::SpringRules rules;
  bench.evaluate();
  springs.update(bench.system, bench.candidates, bench.history, bench.forces, rules);
  const double whole = springs.springs()[0].normal_stiffness;
  EXPECT_NEAR(whole, k_n, 1e-9 * k_n);
  bench.move(0, {{0.0, 0.089}, 0.2}); // the corner goes down by sin(0.2)/2 - (1 - cos(0.2))/2 = 0.089
  double expected = whole;
  for (int k = 0; k < 5; ++k) {
    springs.update(bench.system, bench.candidates, bench.history, bench.forces, rules);
    ASSERT_EQ(springs.springs().size(), 1U);
    ASSERT_EQ(springs.memories()[0].open_for, 0);
    expected *= rules.fade;
    EXPECT_NEAR(springs.springs()[0].normal_stiffness, expected, 1e-9 * whole) << k;
    bench.evaluate();
  }
}

TEST(ContactSprings, OfAnOpenContactFadeAndEnd) {
  ContactBench bench = stacked_squares(0.1);
  statics::ContactSprings springs;
  statics::SpringRules rules;
  rules.reach = 0.1;
  bench.evaluate();
  springs.update(bench.system, bench.candidates, bench.history, bench.forces, rules);
  const double whole = springs.springs()[0].normal_stiffness;
  bench.move(0, {{0.0, 0.01}, 0.0});
  for (int k = 1; k <= 40; ++k) {
    springs.update(bench.system, bench.candidates, bench.history, bench.forces, rules);
    ASSERT_EQ(springs.springs().size(), 1U) << k;
    EXPECT_EQ(springs.memories()[0].open_for, k);
    EXPECT_NEAR(springs.springs()[0].normal_stiffness, std::pow(0.8, k) * whole, 1e-9 * whole);
  }
  springs.update(bench.system, bench.candidates, bench.history, bench.forces, rules);
  EXPECT_TRUE(springs.springs().empty());
}

TEST(ContactSprings, OfBlocksThatAreFarApartEndAtOnce) {
  ContactBench bench = stacked_squares(0.1);
  statics::ContactSprings springs;
  statics::SpringRules rules;
  rules.reach = 0.1;
  bench.evaluate();
  springs.update(bench.system, bench.candidates, bench.history, bench.forces, rules);
  bench.move(0, {{0.0, 0.2}, 0.0});
  springs.update(bench.system, bench.candidates, bench.history, bench.forces, rules);
  EXPECT_TRUE(springs.springs().empty());
}

/// Four unit squares on each other, the lowest one on a fixed block.
ContactBench tower(double tan_friction) {
  std::vector<std::vector<Vec2>> squares;
  for (int k = 0; k < 4; ++k) {
    const double low = 0.999 * k;
    squares.push_back({{0.0, low}, {1.0, low}, {1.0, low + 1.0}, {0.0, low + 1.0}});
  }
  ContactBench bench(system_of(squares, {{{-1.0, -1.0}, {2.0, -1.0}, {2.0, 0.001}, {-1.0, 0.001}}}),
                     one_law(k_n, tan_friction));
  bench.forces.keep_details(true);
  bench.evaluate();
  return bench;
}

// The highest square moves. Springs of the others are neither at work nor lost, nor do they leave their
// order; that they have all of k_t for a step holds for them as well.
TEST(ContactSprings, OfBlocksAtRestStayAsTheyAre) {
  ContactBench bench = tower(0.1);
  bench.evaluate();
  for (std::size_t row = 0; row < 4; ++row) { // all joints slip
    bench.system.trial[row].u.x += 1e-3 * static_cast<double>(row + 1);
  }
  statics::ContactSprings springs;
  const auto update = [&] {
    bench.evaluate();
    springs.update(bench.system, bench.candidates, bench.history, bench.forces, {});
  };
  update();
  const std::vector<statics::SpringRecord> before = springs.records();
  ASSERT_EQ(before.size(), 4U);
  springs.set_moving({0, 0, 0, 1, 0});
  ASSERT_EQ(springs.springs().size(), 1U);
  EXPECT_EQ(springs.springs()[0].higher, 3U);
  update();
  ASSERT_EQ(springs.springs().size(), 1U);
  const auto compare = [&](bool are_held) {
    const std::vector<statics::SpringRecord> after = springs.records();
    ASSERT_EQ(after.size(), 4U);
    int slipping = 0;
    for (std::size_t k = 0; k < 4; ++k) {
      const statics::ContactSpring &spring = before[k].spring;
      EXPECT_EQ(after[k].memory.lower, before[k].memory.lower);
      EXPECT_EQ(after[k].memory.higher, before[k].memory.higher);
      if (spring.higher != 3 && spring.lower != 3) { // at rest
        slipping += spring.tangential < spring.sticking ? 1 : 0;
        EXPECT_EQ(after[k].spring.tangential, are_held ? spring.sticking : spring.tangential);
      }
    }
    EXPECT_GT(slipping, 0);
  };
  compare(false);
  springs.hold_slip();
  compare(true);
  springs.set_moving({});
  EXPECT_EQ(springs.springs().size(), 4U);
  compare(true);
}

// Travelling records find their rows again, in order, whatever the order in which they arrive.
TEST(ContactSprings, AreTakenFromRecordsInAnyOrder) {
  ContactBench bench = tower(0.5);
  statics::ContactSprings springs;
  springs.update(bench.system, bench.candidates, bench.history, bench.forces, {});
  ASSERT_EQ(springs.springs().size(), 4U);
  std::vector<statics::SpringRecord> records = springs.records();
  std::reverse(records.begin(), records.end());
  statics::ContactSprings again;
  again.take(bench.system, records);
  ASSERT_EQ(again.springs().size(), 4U);
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_EQ(again.springs()[k].lower, springs.springs()[k].lower);
    EXPECT_EQ(again.springs()[k].higher, springs.springs()[k].higher);
    EXPECT_EQ(again.springs()[k].normal_stiffness, springs.springs()[k].normal_stiffness);
  }
}

} // namespace
} // namespace gcpdda::testing::springs_test
