#include "gcpdda/model/stiffness.hpp"

#include "gcpdda/geometry/polygon.hpp"

#include <algorithm>
#include <limits>

namespace gcpdda {

void resolve_stiffness(Scene &scene) {
  const double gravity = norm(scene.run.gravity);
  const bool any_mobile =
      std::any_of(scene.blocks.begin(), scene.blocks.end(), [](const SceneBlock &b) { return !b.fixed; });
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  double densest = 0.0;
  std::vector<double> sizes;
  for (const SceneBlock &block : scene.blocks) {
    if (block.fixed && any_mobile) {
      continue;
    }
    densest = std::max(densest, scene.materials[static_cast<std::size_t>(block.material)].density);
    sizes.push_back(std::sqrt(signed_area(block.vertices)));
    for (const Vec2 p : block.vertices) {
      const double head = dot(p, scene.run.gravity) / gravity;
      low = std::min(low, head);
      high = std::max(high, head);
    }
  }
  const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
  std::nth_element(sizes.begin(), middle, sizes.end());
  for (JointLaw &law : scene.joints.laws) {
    if (law.allowed_overlap > 0.0) {
      law.normal_stiffness = densest * gravity * (high - low) / (law.allowed_overlap * *middle);
    }
  }
}

} // namespace gcpdda
