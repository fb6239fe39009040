#include "model/stiffness.hpp"

#include "support/scenes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace gcpdda::stiffness_test {
namespace {

using testing::rectangle;

/// Squares of sides 1, 2 and 4 one above the other, 7 m together, on a fixed base of a denser material.
Scene tower() {
  Scene scene;
  scene.materials = {{"rock", 2500.0, 0.0, 0.0}, {"light", 1000.0, 0.0, 0.0}, {"lead", 11000.0, 0.0, 0.0}};
  scene.run.gravity = {0.0, -10.0};
  const auto add = [&](const std::vector<Vec2> &vertices, std::int32_t material, bool fixed) {
    SceneBlock block;
    block.vertices = vertices;
    block.material = material;
    block.fixed = fixed;
    scene.blocks.push_back(block);
  };
  add(rectangle({0.0, 0.0}, {1.0, 1.0}), 0, false);
  add(rectangle({0.0, 1.0}, {2.0, 3.0}), 1, false);
  add(rectangle({0.0, 3.0}, {4.0, 7.0}), 1, false);
  add(rectangle({-50.0, -100.0}, {50.0, 0.0}), 2, true);
  JointLaw by_overlap;
  by_overlap.allowed_overlap = 1e-3;
  JointLaw by_stiffness;
  by_stiffness.normal_stiffness = 123.0;
  JointLaw stiffer = by_overlap;
  stiffer.allowed_overlap = 1e-4;
  scene.joints.laws = {by_overlap, by_stiffness, stiffer};
  return scene;
}

/// From all blocks of the scene, as a run on one rank does it.
void resolve(Scene &scene) {
  const bool any_mobile =
      std::any_of(scene.blocks.begin(), scene.blocks.end(), [](const SceneBlock &b) { return !b.fixed; });
  SizeSurvey survey = survey_sizes(scene, scene.blocks, !any_mobile);
  std::sort(survey.sizes.begin(), survey.sizes.end());
  resolve_stiffness(scene, survey, survey.sizes[survey.sizes.size() / 2]);
}

// Products and quotients of a few numbers: some epsilon.
constexpr double rounding = 1e-14;

TEST(AllowedOverlap, IsTheWeightOfTheMobileBlocksOverTheMedianSize) {
  Scene scene = tower();
  resolve(scene);
  // rho g h/(e L): densest mobile material, h = 7, median side 2. The fixed base counts for nothing.
  const double expected = 2500.0 * 10.0 * 7.0 / (1e-3 * 2.0);
  EXPECT_NEAR(scene.joints.laws[0].normal_stiffness, expected, rounding * expected);
  EXPECT_EQ(scene.joints.laws[1].normal_stiffness, 123.0) << "a given stiffness stays";
  EXPECT_NEAR(scene.joints.laws[2].normal_stiffness, 10.0 * expected, 10.0 * rounding * expected);
}

TEST(AllowedOverlap, MeasuresTheExtentAlongGravity) {
  Scene scene = tower();
  scene.run.gravity = {10.0, 0.0};
  resolve(scene);
  double expected = 2500.0 * 10.0 * 4.0 / (1e-3 * 2.0);
  EXPECT_NEAR(scene.joints.laws[0].normal_stiffness, expected, rounding * expected);

  scene = tower();
  scene.run.gravity = {6.0, -8.0}; // along (0.6, -0.8): from (0, 7) at -5.6 to (1, 0) at 0.6
  resolve(scene);
  expected = 2500.0 * 10.0 * 6.2 / (1e-3 * 2.0);
  EXPECT_NEAR(scene.joints.laws[0].normal_stiffness, expected, rounding * expected);
}

TEST(AllowedOverlap, WithoutMobileBlocksTheFixedOnesStandIn) {
  Scene scene = tower();
  for (SceneBlock &block : scene.blocks) {
    block.fixed = true;
  }
  resolve(scene);
  EXPECT_GT(scene.joints.laws[0].normal_stiffness, 0.0);
  EXPECT_TRUE(std::isfinite(scene.joints.laws[0].normal_stiffness));
}

// "Median" of an even count has two candidates; either must lie between the middle sizes.
TEST(AllowedOverlap, MedianOfAnEvenCount) {
  Scene scene = tower();
  scene.blocks.push_back(scene.blocks[2]);
  resolve(scene);
  const double at_one = 2500.0 * 10.0 * 7.0 / 1e-3;
  EXPECT_LE(scene.joints.laws[0].normal_stiffness, at_one / 2.0 * (1.0 + rounding));
  EXPECT_GE(scene.joints.laws[0].normal_stiffness, at_one / 4.0 * (1.0 - rounding));
}

// The column is added up joint by joint and layer by layer: joint j bears the layers above it, and a layer
// bears in the mean those above it and half of its own weight.
TEST(LargestSag, IsTwiceThatOfAColumnOfAnyNumberOfLayers) {
  constexpr double thickness = 1.5;
  constexpr double normal_stiffness = 2e8;
  constexpr double youngs_modulus = 3e8;
  constexpr double layer_pressure = 2500.0 * 10.0 * thickness;
  for (const int layers : {1, 2, 3, 10, 100}) {
    Scene scene;
    scene.materials = {{"rock", 2500.0, youngs_modulus, 0.2}};
    scene.run.gravity = {0.0, -10.0};
    JointLaw law;
    law.normal_stiffness = normal_stiffness;
    scene.joints.laws = {law};
    double sag = 0.0;
    for (int k = 0; k < layers; ++k) {
      SceneBlock block;
      block.vertices = rectangle({0.0, k * thickness}, {4.0, (k + 1) * thickness});
      scene.blocks.push_back(block);
      sag += layer_pressure * (layers - k) / normal_stiffness;
      sag += layer_pressure * (layers - k - 0.5) * thickness / youngs_modulus;
    }
    const SizeSurvey survey = survey_sizes(scene, scene.blocks, false);
    EXPECT_NEAR(largest_sag(scene, survey, thickness), 2.0 * sag, 1e-13 * sag) << layers << " layers";
  }
}

} // namespace
} // namespace gcpdda::stiffness_test
