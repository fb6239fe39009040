#pragma once

#include "gcpdda/dynamics/scheme.hpp"
#include "gcpdda/model/block_system.hpp"

#include <optional>
#include <span>

namespace gcpdda {

/// Trial configuration of rows [0, num_owned); the one before becomes trial_previous. Vertices are posed.
void predict(BlockSystem &system, const Scheme &scheme, double time_step);

/// a = M^-1 f of one block.
inline RigidDof accelerate(const BlockProperties &block, const RigidDof &force) {
  return {(1.0 / block.mass) * force.u, force.r / block.inertia};
}

/// Largest distance (m) a point of the block may move before the next trial configuration has been left
/// behind.
inline double motion_bound(const BlockSystem &system, std::size_t row, double time_step) {
  const double radius = system.properties[row].radius;
  const RigidDof &v = system.velocity[row];
  const RigidDof &a = system.acceleration[row];
  return time_step * (norm(v.u) + radius * std::abs(v.r)) +
         time_step * time_step * (norm(a.u) + radius * std::abs(a.r));
}

/// Advance rows [0, num_owned) from t_n to t_{n+1} under their total forces: one 3x3 system each, diagonal
/// about the centroid. A block whose new state is not finite keeps its old one.
///
/// @param forces  (num_owned) contact forces and loads at the trial configuration
/// @return first row whose new state is not finite
std::optional<std::size_t> solve_and_update(BlockSystem &system, std::span<const RigidDof> forces,
                                            const Scheme &scheme, double time_step);

} // namespace gcpdda
