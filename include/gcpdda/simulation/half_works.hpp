#pragma once

#include "gcpdda/model/block_system.hpp"

namespace gcpdda {

/// Half the work of the forces of a block's last evaluation, over the last increment of its trial
/// configuration (J/m): what the trapezoid takes from one end.
struct HalfWorks {
  double shear = 0.0;
  double damping = 0.0;
  double load = 0.0;
  double gravity = 0.0;
};

/// Of forces on F alone.
inline HalfWorks half_works_on_gradient(const Deformation &d) {
  const Mat2 stretch = d.trial - d.trial_previous;
  return {0.5 * contract(d.shear_force, stretch), 0.5 * contract(d.damping_force, stretch),
          0.5 * contract(d.load_force, stretch), 0.0};
}

inline HalfWorks half_works(const BlockSystem &system, std::size_t row) {
  const BlockLedger &ledger = system.ledger[row];
  const AppliedForces &applied = system.applied[row];
  const RigidDof increment = system.trial[row] - system.trial_previous[row];
  HalfWorks half{0.5 * work(ledger.shear_force, increment), 0.5 * work(ledger.damping_force, increment),
                 0.5 * work(applied.load, increment), 0.5 * dot(applied.gravity, increment.u)};
  if (system.is_deformable(row)) {
    const HalfWorks stretched = half_works_on_gradient(system.deformation_of(row));
    half.shear += stretched.shear;
    half.damping += stretched.damping;
    half.load += stretched.load;
  }
  return half;
}

/// Onto the works of the ledger: what goes by the trapezoid, half with forces before and half with those of
/// now.
/// @param before  the row's ledger then
/// @param applied_before  what else acted on it then
/// @param stretched  half the works of the forces then on F; nothing of a rigid row
inline void add_works(BlockSystem &system, std::size_t row, const BlockLedger &before,
                      const AppliedForces &applied_before, const HalfWorks &stretched) {
  BlockLedger &ledger = system.ledger[row];
  const AppliedForces &applied = system.applied[row];
  const RigidDof half_increment = 0.5 * (system.trial[row] - system.trial_previous[row]);
  ledger.shear_work += work(before.shear_force + ledger.shear_force, half_increment);
  ledger.damping_work += work(before.damping_force + ledger.damping_force, half_increment);
  ledger.load_work += work(applied_before.load + applied.load, half_increment);
  ledger.gravity_work += dot(applied_before.gravity + applied.gravity, half_increment.u);
  if (system.is_deformable(row)) {
    const HalfWorks now = half_works_on_gradient(system.deformation_of(row));
    ledger.shear_work += stretched.shear + now.shear;
    ledger.damping_work += stretched.damping + now.damping;
    ledger.load_work += stretched.load + now.load;
  }
}

/// The same for fixed points and viscous sides, whose force is known only after the step it acts in.
inline double anchor_half_work(const BlockSystem &system, std::size_t row) {
  if (system.anchors_of(row).empty() && system.dashpot_of(row) == nullptr) {
    return 0.0;
  }
  double half = 0.5 * work(system.applied[row].anchor, system.trial[row] - system.trial_previous[row]);
  if (system.is_deformable(row)) {
    const Deformation &d = system.deformation_of(row);
    half += 0.5 * contract(d.anchor_force, d.trial - d.trial_previous);
  }
  return half;
}

} // namespace gcpdda
