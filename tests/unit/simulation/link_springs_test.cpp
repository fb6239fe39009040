// Bolts and liners as springs of the static solver.

#include "simulation/link_springs.hpp"

#include "statics/spring_products.hpp"
#include "support/blocks.hpp"
#include "support/setting.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace gcpdda::testing::link_springs_test {
namespace {

SupportType steel(SupportType::Kind kind) {
  SupportType support;
  support.kind = kind;
  support.axial_stiffness = 3e7;
  support.shear_stiffness = 1e7;
  support.axial_yield = 1e4;
  support.shear_yield = 1e4;
  return support;
}

SupportType concrete() {
  SupportType support;
  support.kind = SupportType::Kind::liner;
  support.thickness = 0.2;
  support.youngs_modulus = 24e9;
  support.poissons_ratio = 0.2;
  return support;
}

/// A rigid block and a deformable one beside it, with a link from one to the other.
struct Linked {
  BlockSystem system = system_of({rectangle({0.0, 0.0}, {1.0, 1.0}), rectangle({1.0, 0.0}, {2.0, 1.0})}, {},
                                 1000.0, [](std::size_t row) { return row == 1; });
  std::array<std::size_t, 2> rows{0, 1};
  BoltLink link;
  LinkLaw law;

  Linked(const SupportType &support, Vec2 from, Vec2 to) {
    const double distance = norm(to - from);
    const Vec2 along = (1.0 / distance) * (to - from);
    link.length = distance;
    link.liner = support.kind == SupportType::Kind::liner ? 0 : -1;
    link.end[0] = {0, from - system.properties[0].centroid, along};
    link.end[1] = {1, to - system.properties[1].centroid, along};
    law = law_of(support, link);
    move(std::vector<double>(12, 0.0));
  }

  /// Both blocks by u and H from where they were put in; the link is evaluated there.
  void move(const std::vector<double> &by) {
    set_trial(system, 0, {{{by[0], by[1]}, by[2]}, {}});
    const Mat2 gradient{1.0 + by[8], by[9], by[10], 1.0 + by[11]};
    system.deformation_of(1).trial = gradient;
    set_trial(system, 1, {{{by[6], by[7]}, 0.0}, gradient});
    const LinkPose pose = pose_of(system, link, rows);
    link.memory = respond(law, {}, pose.extension, pose.slide, pose.turn);
  }

  /// On u and H of both blocks; their axes of reference are those of the world.
  [[nodiscard]] std::vector<double> forces() const {
    const LinkForce force = force_of(system, link, rows, pose_of(system, link, rows), link.memory);
    const Mat2 &dyad = force.gradient[1];
    return {force.rigid[0].u.x, force.rigid[0].u.y, force.rigid[0].r, 0.0,     0.0,     0.0,
            force.rigid[1].u.x, force.rigid[1].u.y, dyad.xx,          dyad.xy, dyad.yx, dyad.yy};
  }

  [[nodiscard]] std::vector<statics::ContactSpring> springs() const {
    std::vector<statics::ContactSpring> all;
    append_springs(system, link, rows, law, share, all);
    return all;
  }
  static constexpr double share = 0.05;
};

/// Largest difference of K from the derivative of the forces over the largest element of that.
double error_of_springs(Linked linked) {
  statics::ContactSprings springs;
  springs.set_links(linked.springs());
  statics::SpringProducts products;
  products.take(linked.system, springs, statics::SlipSprings::all, 6);
  double largest = 0.0;
  double error = 0.0;
  for (const std::size_t i : std::array<std::size_t, 9>{0, 1, 2, 6, 7, 8, 9, 10, 11}) {
    const double step = 1e-6;
    std::vector<double> motion(12, 0.0);
    motion[i] = step;
    linked.move(motion);
    const std::vector<double> ahead = linked.forces();
    motion[i] = -step;
    linked.move(motion);
    const std::vector<double> behind = linked.forces();
    statics::LeanField unit(2, statics::lean_width(6));
    statics::LeanField product = unit;
    unit.of(i / 6)[i % 6] = 1.0F;
    products.add(unit, product);
    for (std::size_t k = 0; k < 12; ++k) {
      const double stiffness = -(ahead[k] - behind[k]) / (2.0 * step);
      largest = std::max(largest, std::abs(stiffness));
      error = std::max(error, std::abs(stiffness - product.of(k / 6)[k % 6]));
    }
  }
  return error / largest;
}

// Springs are in single precision. A cable is pulled a little, so that it is not slack on one side: 1e-4 of
// its length.
TEST(LinkSprings, AreTheDerivativeOfElasticLinks) {
  SupportType cable = steel(SupportType::Kind::anchored);
  cable.pretension = 100.0;
  EXPECT_LT(error_of_springs(Linked(cable, {0.2, 0.3}, {1.9, 0.8})), 1e-5);
  EXPECT_LT(error_of_springs(Linked(steel(SupportType::Kind::grouted), {0.9, 0.4}, {1.1, 0.5})), 1e-5);
  EXPECT_LT(error_of_springs(Linked(concrete(), {0.6, 0.0}, {1.4, 0.0})), 1e-5);
}

/// What is left of the springs along the link and across it when block 1 has moved by so much.
std::array<double, 2> shares_after(const SupportType &support, Vec2 by) {
  Linked linked(support, {0.9, 0.5}, {1.1, 0.5});
  linked.move({0.0, 0.0, 0.0, 0.0, 0.0, 0.0, by.x, by.y, 0.0, 0.0, 0.0, 0.0});
  std::array<double, 2> shares{};
  const std::vector<statics::ContactSpring> springs = linked.springs();
  for (std::size_t k = 0; k < springs.size(); ++k) {
    shares[k] = springs[k].tangential / springs[k].sticking;
  }
  return shares;
}

TEST(LinkSprings, KeepAShareOfWhatGives) {
  const SupportType bar = steel(SupportType::Kind::grouted); // yields at 1/3 and at 1 mm
  EXPECT_EQ(shares_after(bar, {2e-4, 5e-4}), (std::array{1.0, 1.0}));
  EXPECT_EQ(shares_after(bar, {1e-3, 5e-4}), (std::array{Linked::share, 1.0}));
  EXPECT_EQ(shares_after(bar, {0.0, 2e-3}), (std::array{1.0, Linked::share}));
  const SupportType cable = steel(SupportType::Kind::anchored);
  EXPECT_EQ(shares_after(cable, {2e-4, 0.0})[0], 1.0);
  EXPECT_EQ(shares_after(cable, {-2e-4, 0.0})[0], Linked::share) << "slack";
  SupportType weak = concrete();
  weak.compressive_strength = 1e5;
  weak.tensile_strength = 1e5;
  weak.residual_tensile_strength = 1e5;
  EXPECT_EQ(shares_after(weak, {-1e-3, 0.0})[0], Linked::share);
}

} // namespace
} // namespace gcpdda::testing::link_springs_test
