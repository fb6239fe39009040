#pragma once

// Rows on which only contacts and gravity act, in lanes.

#include "dynamics/integrate.hpp"

#include <cstddef>
#include <limits>

namespace gcpdda {

/// What acts on free rows: those without an entry of BlockSystem::applied in a run without Rayleigh damping,
/// deformable ones in a scene without bolts.
struct FreeRows {
  BodyForces body; ///< now
  double local_damping = 0.0;
  double safe_motion = std::numeric_limits<double>::infinity(); ///< as of solve_and_update(), m
  bool have_deformable = true;                                  ///< or only rigid ones are free
};

/// Advances free rows from `first` on, several at a time, as far as rigid or deformable ones come one behind
/// the other: the forces on them, local damping, the half of the works of the ledger that goes with these
/// forces, and the step, to the bits that one after the other would have.
///
/// @return the first row that is left
std::size_t advance_free_rows(BlockSystem &system, const FreeRows &rows, const Scheme &scheme,
                              double time_step, Elasticity elasticity, std::size_t first, std::size_t last,
                              AdvanceReport &report, Instructions instructions = Instructions::widest);

} // namespace gcpdda
