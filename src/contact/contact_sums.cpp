// What the contacts of one block add up to, in the order of the other blocks' ids.

#include "gcpdda/contact/contact_forces.hpp"

namespace gcpdda {

ContactPart contact_part(const RegionForce &force, bool is_lower, Vec2 centroid) {
  const double sign = is_lower ? 1.0 : -1.0;
  return {sign * force.force, sign * (force.dyad + outer(force.origin - centroid, force.force))};
}

namespace {

/// Visit the regions of a block with their sign, in the order of the other blocks' ids.
template <class Visit>
void for_regions(const Candidates &candidates, const ContactForces &contacts, std::size_t row,
                 Visit &&visit) {
  for (std::uint32_t c = candidates.contact_begin[row]; c < candidates.contact_begin[row + 1]; ++c) {
    const BlockContact contact = candidates.block_contacts[c];
    for (const RegionForce &force : contacts.of_pair(contact.pair)) {
      visit(force, contact.is_lower);
    }
  }
}

} // namespace

BlockContactSum sum_contacts(const BlockSystem &system, const Candidates &candidates,
                             const ContactForces &contacts, std::size_t row) {
  BlockContactSum sum;
  const Vec2 centroid = system.trial_centroid[row];
  for_regions(candidates, contacts, row, [&](const RegionForce &f, bool is_lower) {
    const double sign = is_lower ? 1.0 : -1.0;
    const Vec2 arm = f.origin - centroid;
    const auto torque = [&](const Mat2 &dyad, Vec2 force) { return dyad.xy - dyad.yx + cross(arm, force); };
    sum.force += sign * RigidDof{f.force, torque(f.dyad, f.force)};
    sum.shear += sign * RigidDof{f.shear_force, cross(f.point - centroid, f.shear_force)};
    sum.damping += sign * RigidDof{f.damping_force, torque(f.damping_dyad, f.damping_force)};
  });
  return sum;
}

BlockGradientSum sum_gradient_forces(const BlockSystem &system, const Candidates &candidates,
                                     const ContactForces &contacts, std::size_t row) {
  BlockGradientSum dyads;
  const Vec2 centroid = system.trial_centroid[row];
  for_regions(candidates, contacts, row, [&](const RegionForce &f, bool is_lower) {
    const double sign = is_lower ? 1.0 : -1.0;
    const Vec2 arm = f.origin - centroid;
    dyads.force += sign * (f.dyad + outer(arm, f.force));
    dyads.shear += sign * outer(f.point - centroid, f.shear_force);
    dyads.damping += sign * (f.damping_dyad + outer(arm, f.damping_force));
  });
  // int t X^T with X = F^-1 (x - x_c).
  const Mat2 &to_reference = system.trial_inverse[system.deformation_begin[row]];
  const auto work_on_gradient = [&](const Mat2 &dyad) { return transposed(to_reference * dyad); };
  return {work_on_gradient(dyads.force), work_on_gradient(dyads.shear), work_on_gradient(dyads.damping)};
}

std::array<double, 3> mean_stress(const BlockSystem &system, const Candidates &candidates,
                                  const ContactForces &contacts, std::size_t row) {
  Mat2 dyad;
  for_regions(candidates, contacts, row, [&](const RegionForce &force, bool is_lower) {
    dyad += contact_part(force, is_lower, system.trial_centroid[row]).dyad;
  });
  const double area = system.properties[row].area;
  return {dyad.xx / area, dyad.yy / area, 0.5 * (dyad.xy + dyad.yx) / area};
}

} // namespace gcpdda
