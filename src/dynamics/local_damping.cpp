#include "gcpdda/dynamics/deformable.hpp"
#include "gcpdda/dynamics/integrate.hpp"

#include <cmath>

namespace gcpdda {

namespace {

/// -|f| sign(v).
double against(double force, double velocity) {
  return velocity == 0.0 ? 0.0 : -std::copysign(force, velocity);
}

/// On a deformable block's F, in its turning axes: there an eigenmode of a block at rest is one component or
/// a few, whatever way it lies.
Mat2 damp_gradient(const Deformation &d, double share) {
  const Mat2 turn = rotation_of(d.trial);
  const Mat2 back = transposed(turn);
  const GradientDof f = force_dof(back * unbalanced_on_gradient(d));
  const GradientDof v = motion_dof(back * d.rate);
  return share * (turn * force_matrix({against(f.r, v.r), against(f.ex, v.ex), against(f.ey, v.ey),
                                       against(f.gxy, v.gxy)}));
}

} // namespace

// What the block's own springs do is known only after the step, so theirs of the step before counts. Without
// the anchors' a block that hangs at rest would count its whole weight as out of balance, and be held
// wherever it is like by friction. The elastic force of x* instead would be far off in a block too stiff for
// the step, and damping it would drive it.
void apply_local_damping(BlockSystem &system, std::size_t row, double share) {
  if (share == 0.0 || system.properties[row].keeps_its_velocity()) {
    return;
  }
  BlockContactSum &sum = system.contact[row];
  const RigidDof f = sum.force + system.anchor_force(row);
  const RigidDof &v = system.velocity[row];
  RigidDof taken = share * RigidDof{{against(f.u.x, v.u.x), against(f.u.y, v.u.y)}, against(f.r, v.r)};
  if (system.is_deformable(row)) {
    taken.r = 0.0;
    Deformation &d = system.deformation_of(row);
    const Mat2 taken_gradient = damp_gradient(d, share);
    d.contact.force += taken_gradient;
    d.contact.damping += taken_gradient;
  }
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
