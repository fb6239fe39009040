#pragma once

// In-situ stress put into blocks and contacts in equilibrium: nothing moves when the run begins.
//
// What must be there at t = 0. A stress with div sigma + rho g = 0 (model/in_situ.hpp) acts across every edge
// with the traction sigma n. On one block, by the divergence theorem,
//     sum of int sigma n ds + weight = 0,    moment about the centroid 0,    int sigma n x^T ds = A
//     sigma(x_c)
// (sigma is linear, and its first moments about the centroid vanish). So blocks are in balance if every
// contact has the traction sigma n, every block its weight, and every deformable block the mean stress
// sigma(x_c).
//
// Normal traction. Two edges that overlap by d push each other with k_n d, so the edges of a joint must
// overlap by sigma_n(x)/k_n, k_n of the law under which just these two meet. Each edge is moved out of its
// block by its share: half of it, or all of it where the other block is fixed (that one stands on many ranks,
// which would have to agree on its shape). sigma_n is linear along an edge, so an edge stays straight and
// tilts. A vertex goes where its two moved edges meet,
//     u = (a + b) (n_1 + n_2)/|n_1 + n_2|^2 + (b - a) (n_2 - n_1)/|n_2 - n_1|^2
// with u.n_1 = a, u.n_2 = b. Edges that touch nothing stay: an outline, a surface, the wall of an opening.
// Mass, inertia, area and centroid stay those of the block as the scene draws it.
//
// Shear. The stick spring of each region, or the bond on it, is born with the resultant of the tangential
// traction, cut at the strength. Deformable blocks get the strain under which their elastic force is
// A sigma(x_c), with the shape they have (Deformation::initial_strain).
//
// What is left out of balance:
// - At the ends of a joint the overlap force falls off over a length d: d/l of a contact of length l. This is
//   the whole of it in a regular wall, d/l = sigma_n/(k_n l): as much as allowed_overlap allows.
// - An edge under several laws of different stiffness, or partly on a fixed block, moves by the mean of what
//   they ask for. `spread` says by how much they differ.
// - Shear beyond the strength of a joint slips, traction on an edge that touches nothing is not borne.
// The run says all three.

#include "contact/contact_forces.hpp"
#include "gcpdda/model/in_situ.hpp"

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace gcpdda {

/// What is known of a swelling besides the shapes.
struct SwellReport {
  double widest = 0.0;  ///< overlap asked for, m
  double spread = 0.0;  ///< of what several contacts of one edge ask for, over their mean
  double largest = 0.0; ///< traction of all edges of mobile blocks, Pa
  double unheld = 0.0;  ///< largest on an edge that touches nothing, Pa
  std::int64_t at = -1; ///< id of that block
};

/// How far the vertices of every owned row move, flat as BlockSystem::reference_vertex up to the last owned
/// one (m). What a row gets depends on it and its neighbours alone.
///
/// @param system  at t = 0, its ghosts among the rows
/// @param pairs  whose boxes meet, sorted by ids
/// @param joints  with their stiffness
std::vector<Vec2> find_swelling(const BlockSystem &system,
                                std::span<const std::pair<BlockIndex, BlockIndex>> pairs,
                                const JointLaws &joints, const InSituStress &stress, SwellReport &report);

/// Move the vertices of a row, and let what follows from the shape follow; its mass and area stay.
void swell(BlockSystem &system, std::size_t row, std::span<const Vec2> by);

/// Put the shear of the in-situ stress into all regions with friction and all bonds of the evaluated pairs;
/// sums of contacts are to be finished after that.
///
/// @return largest share of such a shear that its strength cuts off, and 0 where none is cut
double put_in_situ_shear(const BlockSystem &system, const Candidates &candidates, const InSituStress &stress,
                         ContactForces &forces, ContactHistory &history);

} // namespace gcpdda
