#pragma once

// What bolts, liners and fixed points may bear beyond what they bear at a settled state, for limit analysis.
//
// Their forces follow from the motion. While blocks move by no more than some share of their size, a link
// between two of them stretches and slides by no more than the sum of these motions and bends by no more than
// both turn, so that none of its forces changes by more than its stiffness times that; nor does it leave what
// the support bears at most. The forces of a link are taken as if each had the whole strength for itself. A
// fixed point takes any force.

#include "limit_analysis/limit_analysis.hpp"
#include "simulation/simulation.hpp"

#include <vector>

namespace gcpdda {

/// Of all ranks, in an order that does not depend on their number; ids of blocks in place of their numbers.
/// Collective.
/// @param slip  how far each block moves, in sizes of it, sqrt(area)
std::vector<LimitForce> support_reserves(const Simulation &settled, double slip);

/// Sort forces by what they are: the order does not depend on the one in which they come.
void put_in_order(std::vector<LimitForce> &forces);

} // namespace gcpdda
