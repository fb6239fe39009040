#pragma once

// The stiffest contact that a block can have.

#include "gcpdda/model/joint_law.hpp"
#include "model/fidelity.hpp"

#include <cstdint>
#include <span>

namespace gcpdda {

/// Largest normal stiffness (Pa/m) and tangential stiffness that a block of this material with these laws of
/// edges (none: all by the materials) can meet.
struct StiffnessBound {
  double normal = 0.0;
  double tangential = 0.0;
};
StiffnessBound stiffness_bound(const JointLaws &joints, std::int32_t material,
                               std::span<const std::int32_t> edge_joint = {});

/// Whether a block is rigid or deformable, by the stiffest contact that it can meet.
/// @param scene  its materials and settings
FidelityChoice choose_fidelity(const Scene &scene, const JointLaws &joints, const SceneBlock &block);

/// Largest normal stiffness of all laws, Pa/m.
double stiffest_joint(const JointLaws &joints);

} // namespace gcpdda
