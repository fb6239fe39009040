#pragma once

#include "gcpdda/model/block_system.hpp"

namespace gcpdda {

/// Half the work of the forces a block's ledger holds, over the last increment of its trial configuration
/// (J/m): what the trapezoid takes from one end.
struct HalfWorks {
  double shear = 0.0;
  double damping = 0.0;
  double load = 0.0;
  double gravity = 0.0;
};

inline HalfWorks half_works(const BlockSystem &system, std::size_t row) {
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

/// Onto the works of the ledger.
inline void add_half_works(BlockSystem &system, std::size_t row) {
  BlockLedger &ledger = system.ledger[row];
  const HalfWorks half = half_works(system, row);
  ledger.shear_work += half.shear;
  ledger.damping_work += half.damping;
  ledger.load_work += half.load;
  ledger.gravity_work += half.gravity;
}

/// The same for fixed points and viscous sides, whose force is known only after the step it acts in.
inline double anchor_half_work(const BlockSystem &system, std::size_t row) {
  if (system.anchors_of(row).empty() && system.dashpot_of(row) == nullptr) {
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
