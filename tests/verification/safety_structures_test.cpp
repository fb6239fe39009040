// Factors of safety of arches, roof wedges and columns, found with the default settings of gcpdda fos. All
// but the roof wedges belong to the untouched half of the known limits.

#include "safety_limits.hpp"
#include "semicircular_arch.hpp"

#include "geometry/polygon.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

namespace gcpdda::testing::safety_structures_test {
namespace {

constexpr double unit_weight = rock_density * earth_gravity;

/// A block of another material than rock.
std::string block_of(const std::string &material, const std::string &name, const std::vector<Vec2> &vertices,
                     const std::string &extra = "") {
  std::string toml = block_toml(name, vertices, extra);
  const std::string rock = "material = \"rock\"";
  return toml.replace(toml.find(rock), rock.size(), "material = \"" + material + "\"");
}
/// The head of a scene with further materials and without friction between two of them.
std::string head_with_slick_joint(const Setting &setting, const std::vector<std::string> &materials,
                                  const std::string &first, const std::string &second) {
  std::string toml = head(setting);
  std::string more;
  for (const std::string &material : materials) {
    more += fmt::format("[material.{}]\ndensity = {}\n", material, rock_density);
  }
  toml.insert(toml.find("[joint.default]"), more);
  return toml + fmt::format("[joint.slick]\nmaterials = [\"{}\", \"{}\"]\nfriction_angle_deg = 0.0\n", first,
                            second);
}

// A symmetric wedge in a roof between a fixed abutment and one that a constant force H pushes against it on a
// floor without friction. A face with the half apical angle al carries H and half of the weight, V = W/2:
// from its normal, which points down into the wedge by al, that force is turned by al + atan(V/H). Hence
//     F = tan(phi)/tan(al + atan(W/(2 H))).
// The abutment has inertia: it follows a wedge that slips, and whose faces open, too late. The increments in
// which the strengths of a dynamic trial fall were chosen with these wedges in view.
TEST(SafetyStructures, WedgeInARoof) {
  const double friction = 45.0 * degree;
  const double height = 2.0;
  const double top = 0.3; // half the width of the wedge
  for (const double apical_deg : {10.0, 20.0}) {
    const double apical = apical_deg * degree;
    const double bottom = top + height * std::tan(apical);
    const double weight = unit_weight * height * (top + bottom);
    const double turned = std::atan(std::tan(friction) / 1.4); // 1.4: about the factor
    const double force = std::round(0.5 * weight / std::tan(turned - apical) / 1000.0) * 1000.0;
    const double out = bottom + 3.0;
    const std::string toml =
        head_with_slick_joint({.friction_deg = friction / degree}, {"abutment", "floor"}, "abutment",
                              "floor") +
        block_toml("left", {{-out, 0.0}, {-bottom, 0.0}, {-top, height}, {-out, height}}, "fixed = true") +
        block_of("floor", "floor", rectangle({bottom + 0.5, -1.0}, {out + 5.0, 0.0}), "fixed = true") +
        block_toml("wedge", {{-bottom, 0.0}, {bottom, 0.0}, {top, height}, {-top, height}}) +
        block_of("abutment", "right", {{bottom, 0.0}, {out, 0.0}, {out, height}, {top, height}}) +
        fmt::format("[[block.load]]\npoint = [{:.17g}, {:.17g}]\nforce = [{:.17g}, 0.0]\n", out - 0.2,
                    0.5 * height, -force);
    expect_factor({fmt::format("wedge in a roof, half apical angle {:.0f} degrees", apical_deg),
                   std::tan(friction) / std::tan(apical + std::atan(0.5 * weight / force)), Half::tuned},
                  toml);
  }
}

// A three-hinged arch of two blocks that lean on each other and stand on feet held by friction. The hinges
// are narrow: at the limit the feet slide outwards, the arch sinks, and the crown is pressed at its top and a
// foot at its inner corner. There a block with the weight W, whose centroid is d from the foot, carries the
// thrust H = W d/h across the crown at the height h: F = tan(phi) h/d.
TEST(SafetyStructures, ThreeHingedArch) {
  const double friction = 40.0 * degree;
  const double span = 3.0; // half of it
  const double rise = 4.0;
  const double hinge = 0.02;
  const std::vector<Vec2> right{{0.0, rise - hinge}, {span, 0.0}, {span + hinge, 0.0},
                                {span + hinge, 0.5}, {0.6, rise}, {0.0, rise}};
  std::vector<Vec2> left;
  for (auto point = right.rbegin(); point != right.rend(); ++point) {
    left.push_back({-point->x, point->y});
  }
  const double arm = span - polygon_moments(right).centroid.x;
  const std::string toml = head({.normal_stiffness = 1e12, .friction_deg = friction / degree}) +
                           block_toml("floor", rectangle({-10.0, -1.0}, {10.0, 0.0}), "fixed = true") +
                           block_toml("left", left) + block_toml("right", right);
  expect_factor({"three-hinged arch on feet", std::tan(friction) * rise / arm}, toml);
}

/// An arch of voussoirs on its springings, by statics alone.
struct Arch : SemicircularArch {
  /// Largest shear over normal force of a joint under the thrust H, in weights of the arch; infinite where no
  /// line of thrust stays in the arch. The springing bears half of the weight, and with its moment M_0 as
  /// unknown the moment about the middle of joint k is M_k + M_0, at most N_k t/2.
  [[nodiscard]] double steepest(double thrust) const {
    double total = 0.0;
    for (int k = 0; k < num_voussoirs; ++k) {
      total += polygon_moments(voussoir(k)).area;
    }
    Vec2 force{-thrust, 0.5}; // on what lies beyond the joint
    double weight = 0.0;
    Vec2 first{};
    double least = -1e300; // of M_0
    double most = 1e300;
    double ratio = 0.0;
    for (int k = 0; k <= num_voussoirs; ++k) {
      const Vec2 middle = joint(k, radius);
      const Vec2 arm = joint(0, radius) - middle;
      const Vec2 forward = perp(joint(k, 1.0));
      const Vec2 here{force.x, force.y - weight};
      const double normal = dot(here, forward);
      ratio = std::max(ratio, std::abs(dot(here, joint(k, 1.0))) / normal);
      const double moment = arm.x * force.y - arm.y * force.x - (first.x - weight * middle.x);
      least = std::max(least, -0.5 * normal * thickness - moment);
      most = std::min(most, 0.5 * normal * thickness - moment);
      if (normal <= 0.0) {
        return 1e300;
      }
      if (k < num_voussoirs) {
        const Moments moments = polygon_moments(voussoir(k));
        weight += moments.area / total;
        first += (moments.area / total) * moments.centroid;
      }
    }
    return least <= most ? ratio : 1e300;
  }
  /// The least coefficient of friction with which some thrust is in balance.
  [[nodiscard]] double least_friction() const {
    double best = 1e300;
    for (int k = 1; k < 100000; ++k) {
      best = std::min(best, steepest(1e-5 * k));
    }
    return best;
  }
};

TEST(SafetyStructures, SemicircularArch) {
  const double friction = 35.0 * degree;
  for (const double thickness : {1.0, 1.5}) {
    const Arch arch{{9, thickness}};
    std::string toml =
        head({.normal_stiffness = 1e10, .friction_deg = friction / degree}) +
        block_toml("ground", rectangle({-2.0 * arch.radius, -2.0}, {2.0 * arch.radius, 0.0}), "fixed = true");
    for (int k = 0; k < arch.num_voussoirs; ++k) {
      toml += block_toml(fmt::format("voussoir{}", k), arch.voussoir(k));
    }
    expect_factor({fmt::format("semicircular arch, thickness {:.1f} of its radius", thickness / Arch::radius),
                   std::tan(friction) / arch.least_friction()},
                  toml);
  }
}

/// Gravity on a base that falls by `dip` (rad) towards +x and lies along x.
Vec2 gravity_on(double dip) {
  return {earth_gravity * std::sin(dip), -earth_gravity * std::cos(dip)};
}
const std::string base = block_toml("base", rectangle({-20.0, -1.0}, {40.0, 0.0}), "fixed = true");

// A column of the width b and the height h on a base that dips by th topples about its lower foot against the
// corner of a block, which slides on the base. The corner, y above the base, has no friction, because the two
// do not move along each other there. With W1 and W2 as weights,
//     P y = W1 (h sin(th) - b cos(th))/2,  F = tan(phi) W2 cos(th)/(P + W2 sin(th)).
// The column stands on a narrow foot: its pivot does not depend on how far its base has opened.
TEST(SafetyStructures, ColumnThatTopplesOnABlock) {
  const double dip = 20.0 * degree;
  const double friction = 42.0 * degree;
  const double width = 1.0;
  const double height = 6.0;
  const double foot = 0.02;
  const double corner = 2.0;
  const std::vector<Vec2> column{
      {width - foot, 0.0}, {width, 0.0}, {width, height}, {0.0, height}, {0.0, 0.3}};
  const std::vector<Vec2> block{
      {width + 0.2, 0.0}, {width + 6.0, 0.0}, {width + 6.0, corner}, {width, corner}};
  const Moments upper = polygon_moments(column);
  const double lower = unit_weight * signed_area(block);
  const double push = unit_weight * upper.area *
                      (upper.centroid.y * std::sin(dip) - (width - upper.centroid.x) * std::cos(dip)) /
                      corner;
  const std::string toml =
      head_with_slick_joint(
          {.gravity = gravity_on(dip), .normal_stiffness = 1e10, .friction_deg = friction / degree},
          {"column", "block"}, "column", "block") +
      base + block_of("column", "column", column) + block_of("block", "block", block);
  expect_factor({"column that topples on a block",
                 std::tan(friction) * lower * std::cos(dip) / (push + lower * std::sin(dip))},
                toml);
}

// Flexural toppling of a column of bonded blocks, a cantilever on a base that dips by th: its lowest joint
// opens where the bending stress reaches the tension of the bonds,
//     sigma = 6 W sin(th) (h/2)/b^2 - W cos(th)/b.
TEST(SafetyStructures, ColumnThatBendsAndTopples) {
  const double dip = 25.0 * degree;
  const int num_blocks = 4;
  const double width = 1.0;
  const double weight = unit_weight * width * num_blocks;
  const double stress =
      3.0 * weight * std::sin(dip) * num_blocks / (width * width) - weight * std::cos(dip) / width;
  std::string toml =
      head({.gravity = gravity_on(dip), .friction_deg = 30.0, .run_keys = "gravity_ramp = 0.5\n"});
  toml.insert(toml.find("friction_angle_deg"),
              fmt::format("cohesion = 1e7\ntension = {:.17g}\n", 1.8 * stress));
  toml += base;
  for (int k = 0; k < num_blocks; ++k) {
    toml += block_toml(fmt::format("block{}", k), rectangle({0.0, 1.0 * k}, {width, 1.0 + k}));
  }
  KnownLimit limit{"column of four bonded blocks that bends", 1.8};
  limit.bound_tolerance = 0.0; // bonds are brittle: what limit analysis allows goes beyond their first break
  expect_factor(limit, toml);
}

} // namespace
} // namespace gcpdda::testing::safety_structures_test
