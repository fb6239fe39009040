#include "simulation/contact_digest.hpp"

#include "contact/contact_sums.hpp"

namespace gcpdda {

void ContactDigest::find(const BlockSystem &blocks, const Candidates &candidates,
                         const ContactHistory &history, ContactForces &contacts, const Look &look) {
  on_rows.assign(blocks.num_owned, {});
  on_fixed.clear();
  const auto add = [&](const CandidatePair &pair, const RegionForce &force, bool is_lower) {
    const std::uint32_t row = (is_lower ? pair.lower : pair.higher).value;
    if (row >= blocks.num_owned && !blocks.is_fixed(row)) {
      return;
    }
    const ContactPart part = contact_part(force, is_lower, blocks.motion[row].centroid);
    if (row < blocks.num_owned) {
      on_rows[row].force += RigidDof{part.force, force.torque[is_lower ? 0 : 1]};
      on_rows[row].dyad += part.dyad;
    } else {
      on_fixed.push_back({row, (is_lower ? pair.higher : pair.lower).value, part});
    }
  };
  const auto all = static_cast<std::uint32_t>(candidates.pairs.size());
  contacts.for_regions(blocks, candidates, history, 0, all,
                       [&](std::uint32_t number, std::span<const RegionForce> regions) {
                         for (std::size_t k = 0; k < regions.size(); ++k) {
                           add(candidates.pairs[number], regions[k], true);
                           add(candidates.pairs[number], regions[k], false);
                           if (look) {
                             look(number, k, regions[k]);
                           }
                         }
                       });
}

std::array<double, 3> ContactDigest::mean_stress(const BlockSystem &blocks, std::size_t row) const {
  const Mat2 &dyad = on_rows[row].dyad;
  const double area = blocks.properties[row].area;
  return {dyad.xx / area, dyad.yy / area, 0.5 * (dyad.xy + dyad.yx) / area};
}

} // namespace gcpdda
