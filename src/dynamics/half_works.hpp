#pragma once

// Works of the forces of an evaluation on the half step around it.

#include "base/instructions.hpp"
#include "model/block_system.hpp"

#include <cstddef>

namespace gcpdda {

/// Half the work of the forces of a block's last evaluation, over the last increment of its trial
/// configuration (J/m): what the trapezoid takes from one end. Of fixed points and viscous sides none.
struct HalfWorks {
  double shear = 0.0;
  double damping = 0.0;
  double load = 0.0;
  double gravity = 0.0;
};
HalfWorks half_works(const BlockSystem &system, std::size_t row, const AppliedForces &applied);
/// The same for fixed points and viscous sides, whose force is known only after the step it acts in.
double anchor_half_work(const BlockSystem &system, std::size_t row);
/// Onto the works of a row so far.
void add_to_ledger(BlockSystem &system, std::size_t row, const HalfWorks &half);

/// What the forces of the last evaluation do over the increment behind it, onto the works of owned rows
/// [first, last), which have been predicted since.
void add_half_works(BlockSystem &system, std::size_t first, std::size_t last,
                    Instructions instructions = Instructions::widest);

} // namespace gcpdda
