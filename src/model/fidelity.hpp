#pragma once

// Model no more than a scene needs. A bar of blocks of size L and modulus E whose joints have the stiffness
// k_n is as compliant as 1/E_eff = 1/E + 1/(k_n L). Taking its blocks as rigid leaves out 1/E, a share
//     k_n L / (E + k_n L)
// of that. Fidelity "auto" computes a block as rigid where this share does not exceed the accepted error.

#include "gcpdda/model/scene.hpp"
#include "model/block_system.hpp"

namespace gcpdda {

struct FidelityChoice {
  BlockKind kind = BlockKind::rigid;
  double rigid_error = 0.0; ///< the share above; 0 where the material has no Young's modulus
};

/// @param area  m2; L = sqrt(area)
/// @param normal_stiffness  largest k_n a block of this material can meet, Pa/m
FidelityChoice choose_fidelity(const SceneBlock &block, double area, const Material &material,
                               double normal_stiffness, const RunSettings &run);

} // namespace gcpdda
