#include "dynamics/local_damping.hpp"

#include "dynamics/deformable.hpp"

#include <cmath>

namespace gcpdda {

namespace {

/// -|f| sign(v).
double against(double force, double velocity) {
  return velocity == 0.0 ? 0.0 : -std::copysign(force, velocity);
}

} // namespace

// What a block's anchors do is known only after the step, so their force of the step before counts. Without
// it a block that hangs at rest would count its whole weight as out of balance, and be held wherever it is
// like by friction.
void apply_local_damping(BlockSystem &system, std::size_t row, double share) {
  if (share == 0.0 || system.properties[row].keeps_its_velocity() || system.is_deformable(row)) {
    return;
  }
  BlockContactSum &sum = system.contact[row];
  const RigidDof f = sum.force + system.anchor_force(row);
  const RigidDof &v = system.velocity[row];
  const RigidDof taken = share * RigidDof{{against(f.u.x, v.u.x), against(f.u.y, v.u.y)}, against(f.r, v.r)};
  sum.force += taken;
  sum.damping += taken;
}

void apply_mass_damping(BlockSystem &system, std::size_t row, double mass_damping) {
  const BlockProperties &block = system.properties[row];
  if (mass_damping == 0.0 || block.keeps_its_velocity()) {
    return;
  }
  const RigidDof &v = system.velocity[row];
  RigidDof taken{(-mass_damping * block.mass) * v.u, -mass_damping * block.inertia * v.r};
  if (system.is_deformable(row)) {
    taken.r = 0.0;
    Deformation &d = system.deformation_of(row);
    const Mat2 taken_gradient = -mass_damping * (d.rate * d.second_moment);
    d.contact.force += taken_gradient;
    d.contact.damping += taken_gradient;
  }
  system.contact[row].force += taken;
  system.contact[row].damping += taken;
}

} // namespace gcpdda
