#include "model/fidelity.hpp"

namespace gcpdda {

FidelityChoice choose_fidelity(const SceneBlock &block, double area, const Material &material,
                               double normal_stiffness, const RunSettings &run) {
  const double joint = normal_stiffness * std::sqrt(area);
  const bool elastic = material.youngs_modulus > 0.0;
  FidelityChoice choice;
  choice.rigid_error = elastic ? joint / (material.youngs_modulus + joint) : 0.0;
  const Fidelity wanted = block.fidelity != Fidelity::automatic ? block.fidelity : run.fidelity;
  const bool deforms = wanted == Fidelity::deformable ||
                       (wanted == Fidelity::automatic && choice.rigid_error > run.accepted_error);
  choice.kind = block.fixed                ? BlockKind::fixed
                : deforms && !block.driven ? BlockKind::deformable
                                           : BlockKind::rigid;
  return choice;
}

} // namespace gcpdda
