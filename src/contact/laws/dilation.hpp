#pragma once

// Dilation: slip on a rough joint pushes its sides apart.
//
// Plastic slip dl of a region, what the stick spring loses when it is cut at the cap, opens its joint by
// tan(psi) dl along n_r until it has slipped by the limit of its law. The opening D is a vector of the
// region's memory (|D| = tan(psi) min(slip, limit) where n_r does not turn in the axes it is kept in). The
// contact of the region is that of both blocks moved towards each other, the lower one by -D/2, the higher
// one by +D/2: the surface on which they touch without overlap lies higher by D, whatever their shapes.
//
// Energy. Between two slips D is a constant in axes that turn with the mean of both rotations, for the reason
// given in bonds.hpp: the overlap of the moved blocks then is a potential of the configuration alone, and its
// force, taken at the same point on both blocks, has just the power that this potential loses. (The moved
// point of the lower block is x_A - D/2, D' = perp(D)(w_A + w_B)/2; on both blocks together f does f.(v_A -
// v_B) at the common point.) Deformable blocks: up to D times their rate of strain. Slip adds N tan(psi) dl
// to the potential. Friction takes cap dl from the motion meanwhile, so N (tan(phi) - tan(psi)) dl + c l dl
// of it is lost: never less than nothing, since the reader refuses psi > phi. The ledger counts this
// difference as lost by friction.
//
// Which angle the user sees. n_r is normal to the plane of the joint, not to its asperities: the shear force
// at which a joint slips is N tan(phi) + c l, and lifting is paid for out of it. phi is so the angle of a
// direct shear test, dilation included; smooth asperities of slope psi (Patton) with friction phi_b have phi
// = phi_b + psi, and the same loss.
//
// Stability. Slip and pressure depend on each other, N(D) and D(N). With D from the evaluation before, the
// pressure by which slip lifts the block comes one step late, which is a negative dashpot (a growth of (omega
// dt)^2 tan(phi) tan(psi)/2 a step), and a block that rises by more than its overlap in a step would leave
// its joint again and again. So the slip of an evaluation is found together with its opening. The contact is
// taken at a guess dl_0 (how far the blocks have slid, if the region slipped before), and from the linear law
// N = N_0 + k_n l tan(psi) (dl - dl_0)
//     dl = (|F_trial| - cap_0 + k_n l tan(psi) tan(phi) dl_0)/(k_t + k_n l tan(psi) tan(phi)),
// at which it is evaluated once more. What the cut then takes instead of dl (k_n l is only about dN/dD of a
// tilted contact) counts as slip, and its opening comes a step late. On flush faces D, and all forces with
// it, are then functions of the configuration: F_t = N tan(phi), slip = x - F_t/k_t, so
//     N = k_n l (tan(psi) x - y)/(1 + (k_n l/k_t) tan(psi) tan(phi)),
// and m x'' = P - N tan(phi), m y'' = N - W swing with omega^2 = (k_n l/m)(1 + a)/(1 + a k_n l/k_t), a =
// tan(phi) tan(psi): for k_t <= k_n l no faster than k_n l/m, otherwise than k_t/m, which the bound of the
// time step covers (dynamics/frequency_bound.hpp). The leapfrog is neutral for it.
//
// The dashpot along the normal sees the velocities without the opening, tan(psi) times the sliding: it damps
// how the surfaces push on each other, and does not hold a block down that its joint lifts.
//
// The first opening of a region is taken one step late, and a region of several on a re-entrant block keeps
// one of its own: it is found among those of the moved blocks by its stretches and its place.
//
// A block that lifts is thrown off its joint where the slip stops, if only by some overlaps, and comes to lie
// on the same asperities. So a region without overlap is kept (longest = 0, no force, no stick spring) until
// the moved blocks are farther apart than |D|; what closes after that is a fresh joint.

#include "contact/candidates.hpp"
#include "contact/geometry/overlap.hpp"

#include <array>
#include <vector>

namespace gcpdda {

/// Both blocks of a pair, moved towards each other by what slip has opened.
class ClosedPair {
public:
  /// @param dilation  as in RegionMemory, m
  void move(const BlockSystem &system, const CandidatePair &pair, Vec2 dilation);
  [[nodiscard]] const BlockView &lower() const { return view_[0]; }
  [[nodiscard]] const BlockView &higher() const { return view_[1]; }

private:
  std::array<BlockView, 2> view_;
  std::array<TrialOutline, 2> outline_;
};

/// The region of the moved blocks that goes on with a dilated memory; null if there is none.
const Region *region_of(const BlockSystem &system, const CandidatePair &pair, const Overlap &overlap,
                        const RegionMemory &memory);

/// int d^2 ds of a region (m3), times 8: its energy relative to that of others between the same blocks.
double energy_weight(const Overlap &overlap, const Region &region);

} // namespace gcpdda
