#include "statics/unbalanced_forces.hpp"

#include "dynamics/deformable.hpp"

namespace gcpdda::statics {

std::array<double, 6> unbalanced_forces(const BlockSystem &system, std::size_t row) {
  std::array<double, 6> force{};
  const RigidDof sum = system.contact[row].force + system.anchor_force(row);
  force[0] = sum.u.x;
  force[1] = sum.u.y;
  if (system.is_deformable(row)) {
    const Deformation &d = system.deformation_of(row);
    const Mat2 dyad = unbalanced_on_gradient(d) * transposed(d.trial);
    force[2] = dyad.xx, force[3] = dyad.xy, force[4] = dyad.yx, force[5] = dyad.yy;
  } else {
    force[2] = sum.r;
  }
  return force;
}

} // namespace gcpdda::statics
