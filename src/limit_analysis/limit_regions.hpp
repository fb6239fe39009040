#pragma once

// The joints of a settled state for limit analysis (limit_analysis/limit_analysis.hpp): where its blocks
// touch, and where they may touch when blocks slide on.

#include "limit_analysis/limit_analysis.hpp"
#include "simulation/simulation.hpp"

#include <array>
#include <vector>

namespace gcpdda {

/// A joint and what it does to its blocks as they lie; ids of blocks in place of their numbers.
struct LimitRegion {
  LimitJoint joint;
  double cohesion = 0.0; ///< Pa
  std::int32_t law = 0;  ///< number among the laws that have names
  bool is_bond = false;
  bool is_open = false; ///< it may close
  double bonded = 0.0;  ///< length of it on which bonds are whole, that have joints of their own, m
  std::array<Vec2, 2> force{};
  std::array<double, 2> torque{};
};

/// Size of a block that moves, m; 0 of the others.
double size_of_mobile(const BlockProperties &block);

/// The joints that this rank counts.
/// @param settled  the state; its contact forces are evaluated
/// @param slip  of each block, in sizes of it
std::vector<LimitRegion> limit_regions(Simulation &settled, double slip);

/// Sort the joints of all ranks by what they are: the order does not depend on the one in which they come.
void put_in_order(std::vector<LimitRegion> &regions);

} // namespace gcpdda
