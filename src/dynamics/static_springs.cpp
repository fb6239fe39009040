#include "dynamics/static_springs.hpp"

#include "dynamics/deformable.hpp"
#include "dynamics/half_works.hpp"
#include "dynamics/own_springs.hpp"

namespace gcpdda {

void take_own_springs(BlockSystem &system) {
  for (std::size_t row = 0; row < system.num_owned; ++row) {
    if (system.properties[row].keeps_its_velocity()) {
      continue;
    }
    const bool is_deformable = system.is_deformable(row);
    if (is_deformable) {
      Deformation &d = system.deformation_of(row);
      d.internal = elastic_force(d, d.trial);
    }
    const std::span<const Anchor> anchors = system.anchors_of(row);
    if (anchors.empty()) {
      continue;
    }
    AppliedForces &applied = *system.applied_to(row);
    if (is_deformable) {
      Deformation &d = system.deformation_of(row);
      const AnchorForce sum = anchor_force(anchors, system.trial[row].u, d.trial);
      applied.anchor = {sum.u, 0.0};
      d.anchor_force = sum.gradient;
    } else {
      const Rotation angle = Rotation::of(system.trial[row].r);
      const Mat2 turn{angle.c, -angle.s, angle.s, angle.c};
      const AnchorForce sum = anchor_force(anchors, system.trial[row].u, turn);
      applied.anchor = {sum.u, force_dof(transposed(turn) * sum.gradient).r};
    }
    system.ledger[row].load += anchor_half_work(system, row);
  }
}

} // namespace gcpdda
