#include "model/stiffness.hpp"

#include "geometry/polygon.hpp"

#include <algorithm>
#include <cmath>

namespace gcpdda {

SizeSurvey survey_sizes(const Scene &scene, std::span<const SceneBlock> blocks, bool fixed) {
  const double gravity = norm(scene.run.gravity);
  SizeSurvey survey;
  for (const SceneBlock &block : blocks) {
    if (block.fixed != fixed) {
      continue;
    }
    survey.densest =
        std::max(survey.densest, scene.materials[static_cast<std::size_t>(block.material)].density);
    survey.sizes.push_back(std::sqrt(signed_area(block.vertices)));
    survey.widths.push_back(narrowest_width(block.vertices));
    for (const Vec2 p : block.vertices) {
      const double head = dot(p, scene.run.gravity) / gravity;
      survey.low = std::min(survey.low, head);
      survey.high = std::max(survey.high, head);
    }
  }
  return survey;
}

void resolve_stiffness(Scene &scene, const SizeSurvey &survey, double median_size) {
  double pressure = survey.densest * norm(scene.run.gravity) * (survey.high - survey.low);
  if (scene.in_situ.present) {
    for (const double head : {survey.low, survey.high}) {
      const Mat2 stress = scene.in_situ.compression_at(head * scene.in_situ.down);
      pressure = std::max(pressure, principal_values(stress).largest);
    }
  }
  for (JointLaw &law : scene.joints.laws) {
    if (law.allowed_overlap > 0.0) {
      law.normal_stiffness = pressure / (law.allowed_overlap * median_size);
    }
  }
}

double largest_sag(const Scene &scene, const SizeSurvey &survey, double median_width) {
  const double height = survey.high - survey.low;
  if (!(height > 0.0)) {
    return 0.0;
  }
  double of_joints = 0.0;
  for (const JointLaw &law : scene.joints.laws) {
    of_joints = std::max(of_joints, law.normal_stiffness > 0.0
                                        ? (height + median_width) / (law.normal_stiffness * median_width)
                                        : 0.0);
  }
  double of_rock = 0.0;
  for (const Material &material : scene.materials) {
    of_rock = std::max(of_rock, material.youngs_modulus > 0.0 ? height / material.youngs_modulus : 0.0);
  }
  return survey.densest * norm(scene.run.gravity) * height * (of_joints + of_rock);
}

double corner_sinking(double load, double normal_stiffness, double tilt) {
  const double nearer_edge = 1.0 / (std::sin(tilt) + std::cos(tilt));
  return std::sqrt(2.0 * load * std::sin(2.0 * tilt) / (normal_stiffness * (1.0 + nearer_edge)));
}

} // namespace gcpdda
