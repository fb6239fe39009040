#pragma once

// What water does to a block. Below the phreatic line h(x) it presses on every edge it wets with
//     p = rho_w g (h(x) - y),
// normal to the edge, on either face of a joint and on free faces alike. It needs no coupling with contacts:
// the water in a joint pushes its two blocks apart, so the overlap between them carries what the water does
// not, which is the effective normal force, and the friction cap is that of the effective force by itself.
// A block with water all around has its buoyancy, by Gauss' theorem.
//
// The head along a joint is that of the phreatic line above it, not that of a flow through the joint: a line
// that falls straight from the level in a tension crack to the toe of a slide gives the triangle of uplift
// that Hoek and Bray assume on its plane.
//
// A trial of a search for the factor of safety asks whether the blocks hold under the water that presses them
// where they are. There p is that of where each point of a block was when the trial began, normal to the edge
// as it lies: a block that slides keeps its pressure, as in limit equilibrium, and finds no hold by leaving
// the line behind.
//
// Along an edge p is linear between the points of the line and where it vanishes; the integrals are exact for
// the edges as they lie in the trial configuration.

#include "gcpdda/model/water.hpp"
#include "model/block_system.hpp"

#include <cstddef>
#include <span>

namespace gcpdda {

/// Resultant of the water around one block.
struct WaterLoad {
  Vec2 force; ///< N/m
  Mat2 dyad;  ///< int t (x - x_c)^T ds about the trial centroid, t the traction, N

  [[nodiscard]] double torque() const { return dyad.yx - dyad.xy; }
};

/// @param gravity  downwards acceleration, m/s2
/// @param from  displacement of the row (m, and its angle) where the line is looked up; null: where it is
/// @param outline  place for the row's outline
WaterLoad water_load(const BlockSystem &system, std::size_t row, std::span<const Water> water, double gravity,
                     const RigidDof *from, TrialOutline &outline);

} // namespace gcpdda
