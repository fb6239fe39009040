#pragma once

// Regions whose joint a law has opened (laws/dilation.hpp): whatever the law, they are contacts of both
// blocks moved towards each other.
//
// The opening D is a vector of the region's memory. The contact of the region is that of both blocks moved,
// the lower one by -D/2, the higher one by +D/2: the surface on which they touch without overlap lies higher
// by D, whatever their shapes. While D does not change it is a constant in axes that turn with the mean of
// both rotations, for the reason given in laws/bonds.hpp: the overlap of the moved blocks then is a potential
// of the configuration alone, and its force, taken at the same point on both blocks, has just the power that
// this potential loses. (The moved point of the lower block is x_A - D/2, D' = perp(D)(w_A + w_B)/2; on both
// blocks together f does f.(v_A - v_B) at the common point.) Deformable blocks: up to D times their rate of
// strain.
//
// A region of several on a re-entrant block keeps an opening of its own: it is found among those of the moved
// blocks by its stretches and its place. Moving the blocks towards each other closes their other joints as
// well, by D along the normal of these; so its normal must also lie within 45 degrees of D. A joint that has
// parted would otherwise go on in the next one between the same blocks, which is struck at once by all that D
// closes it.
//
// A block that lifts is thrown off its joint where the opening stops, if only by some overlaps, and comes to
// lie on the same asperities. So a region without overlap is kept (longest = 0, no force, no stick spring)
// until the moved blocks are farther apart than |D|; what closes after that is a fresh joint.

#include "contact/candidates.hpp"
#include "contact/geometry/overlap.hpp"

#include <array>
#include <span>
#include <vector>

namespace gcpdda {

/// The axes that openings are kept in.
Rotation opening_axes(const BlockSystem &system, const CandidatePair &pair);

/// Both blocks of a pair, moved towards each other by an opening.
class ClosedPair {
public:
  /// @param opening  as in RegionMemory, m
  void move(const BlockSystem &system, const CandidatePair &pair, Vec2 opening);
  [[nodiscard]] const BlockView &lower() const { return view_[0]; }
  [[nodiscard]] const BlockView &higher() const { return view_[1]; }

private:
  std::array<BlockView, 2> view_;
  std::array<TrialOutline, 2> outline_;
};

/// Whether a region with this normal, or force along it, may be the one that has been opened by its memory.
bool goes_with_opening(const BlockSystem &system, const CandidatePair &pair, const RegionMemory &memory,
                       Vec2 normal);

/// The region of the moved blocks that goes on with the memory of an opened one; null if there is none.
const Region *region_of(const BlockSystem &system, const CandidatePair &pair, const Overlap &overlap,
                        const RegionMemory &memory);

/// int d^2 ds of a region (m3), times 8: its energy relative to that of others between the same blocks.
double energy_weight(const Overlap &overlap, const Region &region);

/// Energy of the contact pressure of a pair with opened regions, each with its own opening taken out, the
/// rest as the blocks lie, J/m.
/// @param half_stiffness_of_rest  k_n/2 of regions that are not opened
double opened_energy(const BlockSystem &system, const CandidatePair &pair,
                     const ContactParameters &parameters, std::span<const RegionMemory> known,
                     const BlockView &lower, const BlockView &higher, double half_stiffness_of_rest);

} // namespace gcpdda
