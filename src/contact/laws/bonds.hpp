#pragma once

// Bonds: what holds two blocks together along edges that lie on each other at t = 0.
//
// An overlap force only pushes: blocks that are pulled apart have no overlap. So a joint with a tensile
// strength, or with a cohesion that is lost once and for all, has an element of its own, one for each stretch
// that two edges share at t = 0, if the law of these edges has bonds. It ends when it breaks; contacts that
// form later have none.
//
// Opening. The ends of the stretch are material points X_A, X_B of both blocks, each on its own edge. Their
// distance, in a form that subtracts displacements and no world positions (it is exactly 0 as long as nothing
// moves, and does not creep),
//     d = [u_B + (F_B - I) X_B] - [u_A + (F_A - I) X_A] + g n_0,
// with g their distance at t = 0 along the outward normal n_0 of A's edge: negative for blocks that overlap
// from the start, and taken as closed if positive (edges that coincide up to rounding). The normal turns with
// the mean of both rotations, n = R((theta_A + theta_B)/2) n_0; the opening is o = d.n, linear along the
// stretch.
//
// Tension. Where o > 0 the traction k_n o pulls both blocks together, where o <= 0 the overlap pushes them
// apart with k_n |o|, the same stiffness: the force is continuous, and so is its slope. The pull acts along n
// on both blocks at the same point, the middle of the two material points.
//     V = (k_n/2) int max(0, o)^2 ds.
// Power of the pull on rigid blocks, f = -dV/do n on B and -f on A at x_m = x_A + d/2 = x_B - d/2:
//     f.(v_B(x_m) - v_A(x_m)) = f.[d' - (omega_A + omega_B)/2 x d] = -dV/do (d.n)' = -V',
// because n turns with just (omega_A + omega_B)/2. So the pull conserves energy, momentum (equal and
// opposite) and moment of momentum (at one point), and a common rigid motion leaves it alone. (With the
// normal of either block alone, or forces at X_A and X_B, one of the three is lost.) Deformable blocks: up to
// the opening times their rate of strain.
//
// Shear. While a bond holds it carries the shear of its stretch, by a stick spring with k_t = ratio k_n times
// the length of the stretch, in the middle of the stretch: F_t follows s = -d.t_r there, t_r = -perp(n), by
// the differences of s since the last evaluation, which is the initial stick force plus k_t s. For the same
// reason as above (t_r turns with n) it conserves energy exactly, where a spring that adds up increments of
// the motion drifts with the first order of the step when an open joint turns. Regions on the same edges have
// no friction of their own meanwhile, or k_t would be there twice; parts of a straight side are regions of
// their own (part_sides(), model/block_system.hpp). The stiffness of bond and overlap together
// is never above that of a closed joint, so the bound of the time step (dynamics/frequency_bound.hpp) covers
// both.
//
// Strength. With N the push on the bonded edges and T the pull of the bond, it breaks as a whole when
//     k_n max(o) > tension              somewhere on the stretch (at one of its ends), or
//     |F_t| > cohesion length + (N - T) tan(phi).
// The scene is not accepted with tension > cohesion/tan(phi), the apex of this line. A bond that breaks is
// gone in the same evaluation. Its pull ends; its stick force goes to the region on its edges, if there is
// one, cut at the residual strength. What was stored and is not handed over is lost: the ledger counts it
// with the loss by friction (simulation/energy_ledger.hpp), since it is what the work of the bonds lacks.
//
// State. Where a stretch lies follows from the shapes of both blocks, which every rank that sees them has.
// What a bond remembers, F_t, s (as its slip) and that it is there, is a RegionMemory behind those of the
// pair's regions, named by the two edges: it migrates, becomes a ghost and is saved as they are.

#include "contact/candidates.hpp"

#include <array>

namespace gcpdda {

enum class Configuration { trial, trial_previous };

/// A bond in one of the last two trial configurations.
struct BondOpening {
  Vec2 normal;
  std::array<double, 2> opening{}; ///< at its ends, m
  double slide = 0.0;              ///< of the lower block along t_r, in the middle, m
  std::array<Vec2, 2> end;         ///< middle of the two material points; only for Configuration::trial
  double length = 0.0;
};
BondOpening opening_of(const BlockSystem &system, const CandidatePair &pair, const RegionMemory &bond,
                       Configuration configuration);

/// V for k_n = 1 (m3): at the trial configuration, or half the product of the openings in the last two, the
/// form that goes with the works of the ledger in the middle of both.
double bond_energy(const BlockSystem &system, const CandidatePair &pair, const RegionMemory &bond,
                   bool in_the_middle);

/// Bonds of all pairs whose edges lie on each other, where the law of these has bonds, put into the history
/// of a run that begins.
/// @param pressed  largest overlap that a stress in the rock has given them, m
void bond_joints(const BlockSystem &system, const Candidates &candidates, const JointLaws &joints,
                 double pressed, ContactHistory &history);

} // namespace gcpdda
