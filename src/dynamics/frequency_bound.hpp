#pragma once

// An upper bound of the contact frequencies of a block, from which the time step follows.

#include "model/block_system.hpp"

#include <span>

namespace gcpdda {

/// A spring to another block that holds a material point (reference axes) in every direction.
struct PointSpring {
  Vec2 point;
  double stiffness = 0.0; ///< Pa
};

/// Upper bound of the square of the largest contact frequency (1/s2) that one block can take part in,
///
///     omega^2 <= 2 lambda_max(M^-1 K),   K = sum over its whole boundary of
///                                            int (k_n b_n b_n^T + k_t b_t b_t^T) ds,
///
/// b_n = T^T n, b_t = T^T t the generalised forces of unit tractions. The factor 2 is the neighbour's share:
/// a two-body spring satisfies K_pair <= 2 blockdiag(K). It holds before the first contact and for every
/// later one.
/// A deformable block has six columns; where its elasticity is explicit its own stiffness joins,
/// omega^2 <= lambda_max(M^-1 (2 K + K_e)). The block is taken in its reference configuration.
///
/// Implicit elasticity K_e takes nothing from the limit. What swings fastest alternates with the step, x* ->
/// -x*; there q_{n+1-af} = (1 - 4 t) x* with t = ((1 - af) b - [(1 - af)(1/2 - b) - c2])/(1 - 2 am) = 1/4 +
/// ((1 - r)/(1 + r))^2/12, so that K_e pulls with 1 - 4 t <= 0 of its stiffness: dt^2 (K_c + (1 - 4 t) K_e)
/// <= dt^2 K_c <= 4 M up to dt omega = 2, K_c the stiffness of the contacts.
///
/// Contacts that open and close keep K_c <= 2 blockdiag(K), but what the leapfrog keeps of their energy U, w
/// M w/2 + (U(x*) + U(x*'))/2 - dx K_c dx/4, changes where a step dx of the depth passes the surface, by at
/// most k dx^2/4 and with either sign. That is an error of the step and not a growth: of an impact it is
/// W^2/2 of its energy at most. Undamped scenes of blocks that hop on one another must resolve it, by their
/// safety.
///
/// A fixed or driven block sets no limit: 0.
///
/// @param normal_stiffness, tangential_stiffness  Pa/m
/// @param elasticity  where it is taken indeed, see elasticity_of()
/// @param springs  of bolts; they join K
double contact_frequency_bound(const BlockSystem &system, std::size_t row, double normal_stiffness,
                               double tangential_stiffness, Elasticity elasticity = Elasticity::implicit,
                               std::span<const PointSpring> springs = {});

} // namespace gcpdda
