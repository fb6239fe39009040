#pragma once

// Forces of elasticity and of fixed points outside of a step, for the static solver.

#include "model/block_system.hpp"

namespace gcpdda {

/// Forces of elasticity and of fixed points in the trial configuration, as solve_and_update() notes them:
/// Deformation::internal and AppliedForces::anchor of owned rows. The work of fixed points over the increment
/// that ends there goes to the ledger.
void take_own_springs(BlockSystem &system);

} // namespace gcpdda
