// What the contacts of one block add up to, in the order of the other blocks' ids.

#include "gcpdda/contact/contact_forces.hpp"

#include <algorithm>

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

bool counts_here(const BlockSystem &system, BlockIndex lower) {
  return lower.value < system.num_owned || system.is_fixed(lower.value);
}

namespace {

/// What both blocks get of a region, if they are owned.
void add_region(const RegionSums &f, std::size_t num_owned, std::span<BlockContactSum> sums) {
  if (f.lower.value < num_owned) {
    BlockContactSum &sum = sums[f.lower.value];
    sum.force += {f.force, f.torque[0]};
    sum.shear += {f.shear_force, f.shear_torque[0]};
    sum.damping += {f.damping_force, f.damping_torque[0]};
  }
  if (f.higher.value < num_owned) {
    BlockContactSum &sum = sums[f.higher.value];
    sum.force += {-f.force, f.torque[1]};
    sum.shear += {-f.shear_force, f.shear_torque[1]};
    sum.damping += {-f.damping_force, f.damping_torque[1]};
  }
}

/// What one of them gets on F, if it is owned and deforms.
void add_dyads(const BlockSystem &system, std::size_t row, std::span<const RegionDyads> regions,
               std::size_t side, std::span<BlockGradientSum> sums) {
  if (row >= system.num_owned || !system.is_deformable(row)) {
    return;
  }
  BlockGradientSum &sum = sums[system.deformation_begin[row]];
  for (const RegionDyads &region : regions) {
    sum.force += region[side].force;
    sum.shear += region[side].shear;
    sum.damping += region[side].damping;
  }
}

} // namespace

// Pairs ascend by (lower, higher): a block meets its partners in the order of their ids here too.
ContactCount add_contacts(const Candidates &candidates, const ContactForces &contacts,
                          const BlockSystem &system, std::span<BlockContactSum> sums,
                          std::span<BlockGradientSum> gradient_sums) {
  ContactCount count;
  constexpr std::size_t ahead = 8; // regions stand in the order of their evaluation
  const std::size_t num_pairs = candidates.pairs.size();
  for (std::size_t k = 0; k < num_pairs; ++k) {
    if (k + ahead < num_pairs) {
      contacts.fetch_sums(k + ahead);
    }
    const std::span<const RegionSums> regions = contacts.sums_of_pair(k);
    if (regions.empty()) {
      continue;
    }
    const std::size_t lower = regions.front().lower.value;
    const std::size_t higher = regions.front().higher.value;
    if (counts_here(system, regions.front().lower)) {
      const bool crosses = higher >= system.num_owned && !system.is_fixed(higher);
      ++count.touching;
      count.crossing += crosses ? 1 : 0;
      count.crossing_formed += crosses && regions.front().born ? 1 : 0;
    }
    for (const RegionSums &f : regions) {
      add_region(f, system.num_owned, sums);
    }
    if (!gradient_sums.empty()) {
      add_dyads(system, lower, contacts.dyads_of_pair(k), 0, gradient_sums);
      add_dyads(system, higher, contacts.dyads_of_pair(k), 1, gradient_sums);
    }
  }
  return count;
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
