#pragma once

// How jointed rock as a whole strains under a stress that is uniform over many blocks, from which the speeds
// of waves follow that are long against blocks.
//
// A joint of normal n and direction t that sticks passes the traction s = sigma n on, and its sides move
// against each other by
//     w = (s.n/k_n) n + (s.t/k_t) t.
// Over an area A joints of lengths L then strain the rock by (1/A) sum L (w n^T + n w^T)/2, to which blocks
// add what they strain themselves: nothing if they are rigid. The power of sigma in that strain is s.w L, so
// that with the stresses sigma_i of one component each the compliance is
//     C_ij = C_rock,ij + (1/A) sum L ((s_i.n) (s_j.n)/k_n + (s_i.t) (s_j.t)/k_t).
// A joint belongs half to either block: over whole blocks the sum runs over their edges with L/2. A grid of
// squares of the size h has the compliance 1/(k_n h) along its joints' normals and 2/(k_t h) in shear (of
// gamma), slabs 1/(k_n h) and 1/(k_t h) across. C has an inverse where joints have two directions, as the
// edges of every polygon do.
//
// A plane wave along N strains the rock by N N^T e (compression) or by (N T^T + T N^T) g/2 (shear), and
// rho c^2 is the stress power of C^-1 in a unit of that. The small part by which joints that are oblique to N
// couple both waves is left out.

#include "gcpdda/geometry/vec2.hpp"

#include <array>

namespace gcpdda {

/// Symmetric, of stresses (xx, yy, xy) and strains (xx, yy, gamma_xy): lower triangle by rows (packed()).
using Compliance = std::array<double, 6>;

/// Compliance times area of one side of a joint along an edge, m2/Pa.
/// @param stiffness  normal and tangential, Pa/m
Compliance compliance_along(Vec2 edge, std::array<double, 2> stiffness);

/// Compliance of isotropic rock, 1/Pa.
/// @param direct, cross, shear  stresses of a unit of strain along it, across it and of gamma, Pa
Compliance compliance_of_rock(double direct, double cross, double shear);

/// Moduli of plane waves along a unit vector, of compression and of shear, Pa.
std::array<double, 2> wave_moduli(const Compliance &compliance, Vec2 direction);

} // namespace gcpdda
