#pragma once

#include "gcpdda/model/block_system.hpp"

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
/// A fixed or driven block sets no limit: 0.
///
/// @param normal_stiffness, tangential_stiffness  Pa/m
/// @param elasticity  where it is taken indeed, see elasticity_of()
/// @param springs  of bolts; they join K
double contact_frequency_bound(const BlockSystem &system, std::size_t row, double normal_stiffness,
                               double tangential_stiffness, Elasticity elasticity = Elasticity::implicit,
                               std::span<const PointSpring> springs = {});

} // namespace gcpdda
