#include "gcpdda/simulation/half_works.hpp"

namespace gcpdda {

HalfWorks half_works(const BlockSystem &system, std::size_t row) {
  const BlockLedger &ledger = system.ledger[row];
  const RigidDof increment = system.trial[row] - system.trial_previous[row];
  HalfWorks half{0.5 * work(ledger.shear_force, increment), 0.5 * work(ledger.damping_force, increment),
                 0.5 * work(ledger.load_force, increment), 0.5 * dot(ledger.gravity_force, increment.u)};
  if (system.is_deformable(row)) {
    const Deformation &d = system.deformation_of(row);
    const Mat2 stretch = d.trial - d.trial_previous;
    half.shear += 0.5 * contract(d.shear_force, stretch);
    half.damping += 0.5 * contract(d.damping_force, stretch);
    half.load += 0.5 * contract(d.load_force, stretch);
  }
  return half;
}

double anchor_half_work(const BlockSystem &system, std::size_t row) {
  if (system.anchors_of(row).empty()) {
    return 0.0;
  }
  double half = 0.5 * work(system.ledger[row].anchor_force, system.trial[row] - system.trial_previous[row]);
  if (system.is_deformable(row)) {
    const Deformation &d = system.deformation_of(row);
    half += 0.5 * contract(d.anchor_force, d.trial - d.trial_previous);
  }
  return half;
}

} // namespace gcpdda
