#pragma once

// What a region does to each of its two blocks.

#include "contact/region_sums.hpp"

namespace gcpdda {

/// int t X^T with X = F^-1 (x - x_c) of what BlockSums has added.
BlockGradientSum in_reference_axes(const BlockGradientSum &sum, const Mat2 &to_reference);

/// One region's part of a block's force and dyad about the block's trial centroid.
struct ContactPart {
  Vec2 force;
  Mat2 dyad;
};
ContactPart contact_part(const RegionForce &force, bool is_lower, Vec2 centroid);

} // namespace gcpdda
