#include "dynamics/half_works.hpp"

#include "dynamics/lanes/block_lanes.hpp"

namespace gcpdda {

HalfWorks half_works(const BlockSystem &system, std::size_t row, const AppliedForces &applied) {
  const BlockContactSum &sum = system.contact[row];
  const RigidDof half_increment = 0.5 * system.motion[row].increment();
  HalfWorks half{work(sum.shear, half_increment), work(sum.damping, half_increment),
                 work(applied.load, half_increment), dot(applied.gravity, half_increment.u)};
  if (system.is_deformable(row)) {
    const Deformation &d = system.deformation_of(row);
    const Mat2 increment = system.gradient_increment(row);
    half.shear += 0.5 * contract(d.contact.shear, increment);
    half.damping += 0.5 * contract(d.contact.damping, increment);
    if (system.applied_to(row) != nullptr) {
      half.load += 0.5 * contract(d.load_force, increment);
    }
  }
  return half;
}

double anchor_half_work(const BlockSystem &system, std::size_t row) {
  if (system.anchors_of(row).empty() && system.dashpot_of(row) == nullptr) {
    return 0.0;
  }
  double half = 0.5 * work(system.anchor_force(row), system.motion[row].increment());
  if (system.is_deformable(row)) {
    half += 0.5 * contract(system.deformation_of(row).anchor_force, system.gradient_increment(row));
  }
  return half;
}

void add_to_ledger(BlockSystem &system, std::size_t row, const HalfWorks &half) {
  BlockLedger &ledger = system.ledger[row];
  ledger.shear += half.shear;
  ledger.damping += half.damping;
  ledger.load += half.load;
  ledger.gravity += half.gravity;
}

void add_half_works(BlockSystem &system, std::size_t first, std::size_t last, Instructions instructions) {
  const BlockLanes &lanes = block_lanes(instructions);
  const auto in_lanes = [&](std::size_t row) { // were they?
    const std::size_t end = row + lanes.width;
    if (end > last || !are_free(system, row, end)) {
      return false;
    }
    const std::size_t num_deformable = system.deformation_begin[end] - system.deformation_begin[row];
    if (num_deformable == 0) {
      lanes.add_half_works_of_rigids(system, row);
    } else if (num_deformable == lanes.width) {
      lanes.add_half_works_of_deformables(system, row);
    }
    return num_deformable == 0 || num_deformable == lanes.width;
  };
  for (std::size_t row = first; row < last;) {
    if (in_lanes(row)) {
      row += lanes.width;
    } else {
      add_to_ledger(system, row, half_works(system, row, applied_forces(system, row)));
      system.ledger[row].load += anchor_half_work(system, row);
      ++row;
    }
  }
}

} // namespace gcpdda
