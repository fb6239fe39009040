#include "contact/stiffness_bound.hpp"

#include "geometry/polygon.hpp"

#include <algorithm>

namespace gcpdda {

StiffnessBound stiffness_bound(const JointLaws &joints, std::int32_t material,
                               std::span<const std::int32_t> edge_joint) {
  StiffnessBound bound;
  const auto include = [&](std::int32_t index) {
    const JointLaw &law = joints.laws[static_cast<std::size_t>(index)];
    bound.normal = std::max(bound.normal, law.normal_stiffness);
    if (law.has_friction()) {
      bound.tangential = std::max(bound.tangential, law.tangential_ratio * law.normal_stiffness);
    }
  };
  const auto include_partners = [&](std::int32_t own) {
    for (std::int32_t other = 0; other < std::ssize(joints.laws); ++other) {
      if (joints.laws[static_cast<std::size_t>(other)].is_on_edges) {
        include(joints.of_edges(own, other, other));
      }
    }
  };
  for (const std::int32_t own : edge_joint) {
    if (own >= 0) {
      include(own);
      include_partners(own);
    }
  }
  if (edge_joint.empty() || std::find(edge_joint.begin(), edge_joint.end(), -1) != edge_joint.end()) {
    for (std::int32_t other = 0; other < joints.num_materials; ++other) {
      include(joints.between(material, other));
    }
    include_partners(-1);
  }
  return bound;
}

FidelityChoice choose_fidelity(const Scene &scene, const JointLaws &joints, const SceneBlock &block) {
  return choose_fidelity(block, signed_area(block.vertices),
                         scene.materials[static_cast<std::size_t>(block.material)],
                         stiffness_bound(joints, block.material, block.edge_joint).normal, scene.run);
}

double stiffest_joint(const JointLaws &joints) {
  double stiffest = 0.0;
  for (const JointLaw &law : joints.laws) {
    stiffest = std::max(stiffest, law.normal_stiffness);
  }
  return stiffest;
}

} // namespace gcpdda
