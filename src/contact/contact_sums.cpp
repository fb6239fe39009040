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
    for (const RegionForce &force : contacts.of_pair(contact.pair())) {
      visit(force, contact.is_lower());
    }
  }
}

} // namespace

BlockContactSum sum_contacts(const Candidates &candidates, const ContactForces &contacts, std::size_t row) {
  BlockContactSum sum;
  for_regions(candidates, contacts, row, [&](const RegionForce &f, bool is_lower) {
    const double sign = is_lower ? 1.0 : -1.0;
    const std::size_t k = is_lower ? 0 : 1;
    sum.force += RigidDof{sign * f.force, f.torque[k]};
    sum.shear += RigidDof{sign * f.shear_force, f.shear_torque[k]};
    sum.damping += RigidDof{sign * f.damping_force, f.damping_torque[k]};
  });
  return sum;
}

BlockGradientSum in_reference_axes(const BlockGradientSum &sum, const Mat2 &to_reference) {
  const auto work_on_gradient = [&](const Mat2 &dyad) { return transposed(to_reference * dyad); };
  return {work_on_gradient(sum.force), work_on_gradient(sum.shear), work_on_gradient(sum.damping)};
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
