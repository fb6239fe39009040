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
HalfWorks half_works(const BlockSystem &system, std::size_t row);

/// The same for fixed points, whose force is known only after the step it acts in.
double anchor_half_work(const BlockSystem &system, std::size_t row);

} // namespace gcpdda
