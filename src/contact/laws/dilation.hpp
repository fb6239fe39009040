#pragma once

// Dilation: slip on a rough joint pushes its sides apart.
//
// Plastic slip dl of a region, what the stick spring loses when it is cut at the cap, opens its joint by
// tan(psi) dl along n_r until it has slipped by the limit of its law: |D| = tan(psi) min(slip, limit) where
// n_r does not turn in the axes that D is kept in. What an opening D does is in opened_regions.hpp.
//
// Energy. Slip adds N tan(psi) dl to the potential of the contact. Friction takes cap dl from the motion
// meanwhile, so N (tan(phi) - tan(psi)) dl + c l dl of it is lost: never less than nothing, since the reader
// refuses psi > phi. The ledger counts this difference as lost by friction.
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
// The first opening of a region is taken one step late.

#include "contact/opened_regions.hpp"
#include "gcpdda/model/joint_law.hpp"

namespace gcpdda {

struct RegionForce;

/// How far the blocks slide on each other about where they meet, off the direction in which they open, m.
/// @param closed  is moved to the opening that is known
double guessed_slip(const BlockSystem &system, const CandidatePair &pair, const RegionMemory &known,
                    ClosedPair &closed);

/// Slip that is consistent with what it opens, to first order from a contact in which `guess` has been opened
/// already, m.
/// @param force  of that contact, for k_n/2 = 1
double consistent_slip(const BlockSystem &system, const CandidatePair &pair, const JointLaw &law,
                       const RegionMemory &known, const RegionForce &force, double guess);

/// Open a region that has slipped.
/// @return the work against its pressure, J/m
double dilate(const BlockSystem &system, const CandidatePair &pair, const JointLaw &law, double slip_before,
              const RegionForce &force, RegionMemory &memory);

} // namespace gcpdda
