// Straight sides with laws of their own on parts of them: rock bridges, bonds beside open joints, patches of
// another strength or stiffness.

#include "safety_limits.hpp"

#include "geometry/polygon.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

namespace gcpdda::testing::parted_sides_test {
namespace {

constexpr double dip = 20.0 * degree;
constexpr double base_length = 4.0; ///< m

struct Strength {
  double friction_deg = 20.0;
  double cohesion = 0.0;         ///< Pa
  double normal_stiffness = 1e9; ///< Pa/m
  bool is_bond = false;          ///< whose cohesion is lost as it breaks
};

/// A part of the base of the slab.
struct Part {
  double begin = 0.0; ///< m
  double end = 0.0;
  Strength strength;
};

/// A slab of 4 m by 1 m on a plane, with parts of other laws on its own edges or on those of the plane.
struct PartedSlab {
  std::vector<Part> parts; ///< the rest of the base has the default strength
  bool on_plane = false;   ///< the plane has the vertices
  bool is_notched = false;

  [[nodiscard]] std::vector<Vec2> slab() const {
    std::vector<Vec2> vertices = bottom(0.0, base_length);
    if (on_plane) {
      vertices = {{0.0, 0.0}};
    }
    vertices.push_back({base_length, 0.0});
    vertices.push_back({base_length, 1.0});
    if (is_notched) {
      vertices.insert(vertices.end(), {{2.5, 1.0}, {2.5, 0.5}, {1.5, 0.5}, {1.5, 1.0}});
    }
    vertices.push_back({0.0, 1.0});
    return vertices;
  }

  [[nodiscard]] Scene scene(bool deforms, bool is_static) const {
    std::string laws;
    for (std::size_t k = 0; k < parts.size(); ++k) {
      const Strength &own = parts[k].strength;
      laws += fmt::format("[joint.part{}]\nfriction_angle_deg = {}\ncohesion = {}\nnormal_stiffness = {}\n",
                          k, own.friction_deg, own.cohesion, own.normal_stiffness);
      laws += own.is_bond ? "tension = 5e3\nresidual_cohesion = 0.0\n" : "";
    }
    const std::vector<Vec2> shape = slab();
    std::vector<Vec2> plane = rectangle({-2.0, -1.0}, {10.0, 0.0});
    if (on_plane) { // its upper side runs the other way
      const std::vector<Vec2> along = bottom(-2.0, 10.0);
      plane = {{-2.0, -1.0}, {10.0, -1.0}, {10.0, 0.0}};
      plane.insert(plane.end(), along.rbegin(), along.rend());
    }
    return scene_of(
        without_duration(
            head({.gravity = {earth_gravity * std::sin(dip), -earth_gravity * std::cos(dip)},
                  .friction_deg = 20.0,
                  // The dynamic step gives a bond all the shear at t = 0, before the joint beside it is
                  // pressed.
                  .run_keys = is_static ? "" : "initial_friction = \"zero\"",
                  .fidelity = deforms ? "deformable" : "rigid",
                  .youngs_modulus = 20e9,
                  .poissons_ratio = 0.2}) +
            laws +
            block_toml("plane", plane, fmt::format("fixed = true\n{}", on_plane ? edge_joints(plane) : "")) +
            block_toml("slab", shape, on_plane ? "" : edge_joints(shape))) +
        fmt::format("[[stage]]\nkind = \"settle\"\nlimit = 10.0\nsolver = \"{}\"\n",
                    is_static ? "static" : "dynamic"));
  }

  /// F = sum (c l + N tan(phi))/S. On a base of stiffness k(x) a slab that sinks by a + b x has the pressure
  /// k (a + b x), whose resultant N passes through the centroid's weight.
  [[nodiscard]] double factor() const {
    const Moments shape = polygon_moments(slab());
    const double weight = rock_density * earth_gravity * shape.area;
    const double push = weight * std::cos(dip);
    const double place = shape.centroid.x + shape.centroid.y * std::tan(dip);
    std::array<double, 3> all = moments(0.0, base_length, 1e9);
    for (const Part &part : parts) {
      const auto more = moments_of(part, part.strength.normal_stiffness - 1e9);
      for (std::size_t power = 0; power < 3; ++power) {
        all[power] += more[power];
      }
    }
    const double determinant = all[0] * all[2] - all[1] * all[1];
    const double a = push * (all[2] - place * all[1]) / determinant;
    const double b = push * (place * all[0] - all[1]) / determinant;
    double rest = push;
    double strength = 0.0;
    for (const Part &part : parts) {
      const auto own = moments_of(part, part.strength.normal_stiffness);
      const double pressed = a * own[0] + b * own[1];
      rest -= pressed;
      strength += part.strength.cohesion * moments_of(part, 1.0)[0] +
                  pressed * std::tan(part.strength.friction_deg * degree);
    }
    return (strength + rest * std::tan(20.0 * degree)) / (weight * std::sin(dip));
  }

private:
  /// k int x^n dx, n = 0, 1, 2.
  static std::array<double, 3> moments(double begin, double end, double stiffness) {
    return {stiffness * (end - begin), stiffness * (end * end - begin * begin) / 2.0,
            stiffness * (end * end * end - begin * begin * begin) / 3.0};
  }

  /// On what of a part lies below the slab.
  static std::array<double, 3> moments_of(const Part &part, double stiffness) {
    const double begin = std::max(0.0, part.begin);
    return moments(begin, std::max(begin, std::min(base_length, part.end)), stiffness);
  }

  /// Vertices on y = 0 from left to right, without the last one.
  [[nodiscard]] std::vector<Vec2> bottom(double from, double to) const {
    std::vector<Vec2> vertices{{from, 0.0}};
    for (const Part &part : parts) {
      for (const double x : {part.begin, part.end}) {
        if (x > vertices.back().x && x < to) {
          vertices.push_back({x, 0.0});
        }
      }
    }
    return vertices;
  }

  /// Laws of edges that lie on a part.
  [[nodiscard]] std::string edge_joints(const std::vector<Vec2> &vertices) const {
    std::string names;
    for (std::size_t e = 0; e < vertices.size(); ++e) {
      const Vec2 middle = 0.5 * (vertices[e] + vertices[(e + 1) % vertices.size()]);
      std::string name;
      for (std::size_t k = 0; k < parts.size(); ++k) {
        const bool is_on = middle.y == 0.0 && middle.x > parts[k].begin && middle.x < parts[k].end;
        name = is_on ? fmt::format("part{}", k) : name;
      }
      names += fmt::format("{}\"{}\"", names.empty() ? "" : ", ", name);
    }
    return fmt::format("edge_joints = [{}]", names);
  }
};

void expect_factor_of(const PartedSlab &slab, const std::string &problem) {
  const double exact = slab.factor();
  for (const bool deforms : {false, true}) {
    for (const bool is_static : {true, false}) {
      const SafetyReport found = search_quietly(slab.scene(deforms, is_static)).report;
      EXPECT_NEAR(0.5 * (found.holds.value_or(0.0) + found.fails.value_or(0.0)), exact, 0.01 * exact)
          << problem << (deforms ? ", deformable" : ", rigid") << (is_static ? ", static" : ", dynamic");
    }
  }
  const Scene scene = slab.scene(false, true);
  EXPECT_GE(search_quietly(scene, true).report.bound.value_or(0.0), 0.997 * exact) << problem;
}

constexpr Strength bond{.friction_deg = 20.0, .cohesion = 20e3, .is_bond = true};
constexpr Strength rough_bond{.friction_deg = 35.0, .cohesion = 20e3, .is_bond = true};

TEST(PartedSides, BondOnAHalf) {
  expect_factor_of({.parts = {{0.0, 2.0, bond}}}, "upper half");
  expect_factor_of({.parts = {{2.0, 4.0, rough_bond}}}, "lower half");
  expect_factor_of({.parts = {{0.0, 2.0, bond}}, .is_notched = true}, "notched slab");
}

TEST(PartedSides, BondInTheMiddle) {
  expect_factor_of({.parts = {{0.5, 2.5, rough_bond}}}, "on the slab");
  expect_factor_of({.parts = {{1.0, 2.0, bond}}, .on_plane = true}, "on the plane");
}

TEST(PartedSides, BondOfAnotherStiffness) {
  expect_factor_of({.parts = {{1.7, 2.7, {20.0, 20e3, 1e10, true}}}}, "stiffer");
  expect_factor_of({.parts = {{1.0, 3.0, {30.0, 20e3, 2e8, true}}}, .on_plane = true}, "softer");
}

// No bonds: a part keeps its strength as it slips.
TEST(PartedSides, PatchOfAnotherStrength) {
  expect_factor_of({.parts = {{1.0, 2.0, {20.0, 20e3, 1e9, false}}}}, "cohesion on the slab");
  expect_factor_of({.parts = {{1.0, 2.5, {35.0, 0.0, 4e9, false}}}, .on_plane = true},
                   "friction on the plane");
}

// The slab lies on one part of a plane alone, beside others that are far rougher.
TEST(PartedSides, PatchAroundTheSlab) {
  expect_factor_of({.parts = {{-2.0, -1.0, {60.0, 0.0, 1e9, false}},
                              {-1.0, 5.0, {25.0, 0.0, 1e9, false}},
                              {5.0, 10.0, {60.0, 0.0, 1e9, false}}},
                    .on_plane = true},
                   "between rough parts");
}

} // namespace
} // namespace gcpdda::testing::parted_sides_test
