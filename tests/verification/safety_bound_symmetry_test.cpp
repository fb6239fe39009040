// The upper bound of an active and a passive block on two planes, in all orientations and orders.

#include "safety_limits.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace gcpdda::testing::safety_bound_symmetry_test {
namespace {

struct Outline {
  std::string name;
  std::vector<Vec2> vertices;
  std::vector<std::string> joints; ///< of the edges
};

constexpr double friction_deg = 40.0;

/// The active block lies on a plane of 50 degrees and pushes the passive one along a plane of 10 degrees
/// through a vertical face. The planes end at the two ends of a crack of 4 m without friction, so that the
/// tip of the active block, a corner of the base and a place within the side of the passive block coincide.
struct TwoBlocks {
  Vec2 toe{0.0, -4.0};
  Vec2 crack_foot{10.0, -4.0 + 10.0 * std::tan(10.0 * degree)};
  Vec2 tip{10.0, crack_foot.y + 4.0};
  Vec2 top{10.0, 10.0};
  Vec2 end{tip.x + (22.0 - tip.y) / std::tan(50.0 * degree), 22.0}; ///< of the plane of the active block

  [[nodiscard]] std::vector<Outline> outlines() const {
    return {{"base",
             {{-40.0, -4.0 - 40.0 * std::tan(10.0 * degree)},
              {-40.0, -60.0},
              {60.0, -60.0},
              {60.0, 22.0},
              end,
              tip,
              crack_foot},
             {"", "", "", "", "", "crack", ""}},
            {"passive", {toe, crack_foot, tip, top, {5.0, 10.0}}, {"", "crack", "face", "", ""}},
            {"active", {tip, end, {14.0, 22.0}, top}, {"", "", "", "face"}}};
  }

  /// Limit equilibrium: with the friction angle that is mobilised on all three planes, tan(phi)/F, the forces
  /// on the active block give the force on the face, and the passive block just slides.
  [[nodiscard]] double factor() const {
    const auto area = [](const std::vector<Vec2> &v) {
      double twice = 0.0;
      for (std::size_t k = 0; k < v.size(); ++k) {
        twice += cross(v[k], v[(k + 1) % v.size()]);
      }
      return 0.5 * twice;
    };
    const std::vector<Outline> blocks = outlines();
    const Vec2 passive{0.0, area(blocks[1].vertices)};
    const Vec2 active{0.0, area(blocks[2].vertices)};
    const auto slides = [&](double factor) {
      const double m = std::tan(friction_deg * degree) / factor;
      const auto up = [](double dip) { return Vec2{std::cos(dip * degree), std::sin(dip * degree)}; };
      const Vec2 plane = perp(up(50.0)) + m * up(50.0); // the reaction of the plane, for a normal force of 1
      const Vec2 face{1.0, m};                          // that of the face
      const Vec2 on_passive = passive + cross(plane, active) / cross(plane, face) * face;
      return dot(on_passive, up(10.0)) > m * dot(on_passive, perp(up(10.0)));
    };
    double holds = 0.5;
    double fails = 5.0;
    while (fails - holds > 1e-9) {
      const double middle = 0.5 * (holds + fails);
      (slides(middle) ? fails : holds) = middle;
    }
    return holds;
  }
};

struct Variant {
  std::string name;
  std::vector<std::size_t> order{0, 1, 2};
  std::size_t start = 0; ///< which vertex of an outline is its first one
  double scale = 1.0;
  std::string fidelity = "rigid";
  bool has_flat_vertices = true;
};

/// Without flat vertices the side of the passive block is one edge, whose law is that of the face.
std::vector<Outline> outlines_of(const Variant &variant) {
  std::vector<Outline> blocks = TwoBlocks().outlines();
  if (!variant.has_flat_vertices) {
    blocks[1].vertices.erase(blocks[1].vertices.begin() + 2);
    blocks[1].joints = {"", "face", "", ""};
  }
  for (Outline &block : blocks) {
    const auto shift = static_cast<std::ptrdiff_t>(variant.start % block.vertices.size());
    std::rotate(block.vertices.begin(), block.vertices.begin() + shift, block.vertices.end());
    std::rotate(block.joints.begin(), block.joints.begin() + shift, block.joints.end());
  }
  return blocks;
}

std::string scene_toml(const Variant &variant, bool is_mirrored, double turn) {
  std::string toml = fmt::format(
      "[run]\nfidelity = \"{}\"\ngravity = [{:.17g}, {:.17g}]\n[material.rock]\ndensity = 2600.0\n"
      "youngs_modulus = 5e10\npoissons_ratio = 0.2\n"
      "[joint.default]\nnormal_stiffness = 2e9\nfriction_angle_deg = {}\n[joint.face]\nfriction_angle_deg = "
      "{}\n[joint.crack]\nfriction_angle_deg = 0.0\n[fos]\nfrom = 0.1\nto = 30.0\n"
      "[[stage]]\nkind = \"settle\"\nlimit = 20.0\n",
      variant.fidelity, earth_gravity * std::sin(turn), -earth_gravity * std::cos(turn), friction_deg,
      friction_deg);
  const std::vector<Outline> blocks = outlines_of(variant);
  for (const std::size_t number : variant.order) {
    const Outline &block = blocks[number];
    std::vector<Vec2> vertices;
    for (const Vec2 v : block.vertices) {
      const Vec2 from{variant.scale * (is_mirrored ? -v.x : v.x), variant.scale * v.y};
      vertices.push_back(std::cos(turn) * from + std::sin(turn) * perp(from));
    }
    std::string joints;
    for (const std::string &joint : block.joints) {
      joints += fmt::format("{}\"{}\"", joints.empty() ? "" : ", ", joint);
    }
    toml += block_toml(block.name, vertices,
                       fmt::format("edge_joints = [{}]\n{}", joints, number == 0 ? "fixed = true" : ""));
  }
  return toml;
}

// The forces of limit equilibrium are the only ones that balance these blocks when all planes slide. The
// bound is found to 0.1 % from above, and contacts are closed by up to 1e-4 of a block's size, which turns
// planes and moves the forces by as little: 3e-3, as for other bounds.
TEST(SafetyBoundSymmetry, AnActiveAndAPassiveBlockHaveTheFactorOfLimitEquilibrium) {
  const double factor = TwoBlocks().factor();
  EXPECT_NEAR(factor, 1.4520, 1e-4);
  for (const Variant &variant :
       {Variant{.name = "as drawn"}, Variant{.name = "base last", .order = {2, 1, 0}},
        Variant{.name = "passive block first", .order = {1, 0, 2}},
        Variant{.name = "second vertex first", .start = 1}, Variant{.name = "third vertex first", .start = 2},
        Variant{.name = "fifth vertex first", .start = 4}, Variant{.name = "ten times larger", .scale = 10.0},
        Variant{.name = "deformable", .fidelity = "deformable"},
        Variant{.name = "without a flat vertex", .has_flat_vertices = false}}) {
    for (const bool is_mirrored : {false, true}) {
      for (const double turn : {0.0, 0.6}) {
        const SafetyReport found =
            search_quietly(scene_of(scene_toml(variant, is_mirrored, turn)), true).report;
        EXPECT_NEAR(found.bound.value_or(0.0), factor, 3e-3 * factor)
            << variant.name << (is_mirrored ? ", mirrored" : "") << ", turned by " << turn;
        EXPECT_GE(found.bound.value_or(0.0), (1.0 - 1e-3) * factor) << variant.name;
      }
    }
  }
}

} // namespace
} // namespace gcpdda::testing::safety_bound_symmetry_test
