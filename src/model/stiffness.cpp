#include "gcpdda/model/stiffness.hpp"

#include "gcpdda/geometry/polygon.hpp"

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

} // namespace gcpdda
