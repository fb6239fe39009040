#pragma once

// Local damping takes a share a of the net force against the motion.
//
// Rigid blocks lose a |f| sign(v_n) in each of their three components. What swings as fast as the step allows
// bounds the step then (stability_limit()).
//
// Deformable blocks. That rule drives them: the net force of a step holds the elastic force, which is known
// only after the step; in a mode that the step does not resolve that of the step before alternates with the
// step, v_n differs in sign from the motion over which the force does work, and up to half of |d| |dx*| is
// gained in a step. The damping of a deformable block is therefore dry friction, found together with the
// step. Contacts see the trial configurations x* alone (scheme.hpp). Over them a force d_n does the work
//     d_n . (x*_{n+1} - x*_{n-1})/2 = dt d_n . w,    w = (w- + w+)/2,
// w- and w+ the rates behind and ahead; this is the trapezoid of the energy ledger. The step is linear in a
// force, A da' = d with the matrix A of the block's step (own mass and, implicitly, its springs), and
//     w+ = v_n + dt (P a_n + Q a_{n+1}),    so    w = y + (dt/2) Q A^-1 d,
// y being w without damping. With A = L D L^T and z = L^T w this is z_i = (L^T y)_i + (dt/2) Q b_i/D_i for d
// = L b: the components do not couple, and
//     d . w = sum b_i z_i.
// Friction b_i = -B_i sign(z_i), any |b_i| <= B_i where z_i = 0, has the closed solution
//     z_i = sign(y_i) max(0, |y_i| - (dt/2) Q B_i/D_i),    y_i short for (L^T y)_i.
// So d . w <= 0 in every step, whatever the block, its elasticity and the share: to round-off of d, dx*.
//
// Its size B is the share of the net force: f = M (w+ - w-)/dt of the undamped step, elastic forces included,
// as components L^-1 f. Then (dt/2) Q B_i/D_i = a |L^T (1 - am) A^-1 M (w+ - w-)/2|_i. In a mode that the
// step resolves A = (1 - am) M, and this is a |w+ - w-|/2 as for a rigid block; a stiff one has little net
// force. (A share of A (w+ - w-) in place of M (w+ - w-) is as passive but lets stiff blocks alternate for
// ever.)
//
// Stability. Without damping, the leapfrog of x* keeps w+ . M w+/2 + U(x*_n, x*_{n+1}) for a linear U, and
// that is positive below its limit W = 2. Implicit elasticity K resists with the impedance Z = d/w at the
// angle phi of a step, of which Re Z = K dt 2 (1 - cos phi) ((1 - r)/(1 + r))^3/|1 - am + am exp(-i phi)|^2
// >= 0: it takes energy or none. Damping takes energy, so nothing grows below the limit without damping. A
// motion that it takes nothing from has z_i = 0 always: one that alternates with the step, w+ = -w-, held
// where |w- + (dt/2) f/m| <= a (dt/2) |f|/m. With f/m = -W^2 x/dt^2, x alternating between +-dt w-/2, this is
// |1 - W^2/4| <= a W^2/4, or W >= 2/sqrt(1 + a). Below it, the limit of rigid blocks too, all comes to rest.
// (From W^2 = 2/(1 + a) on one more motion loses nothing, x* = 0, X, 0, -X. What lies beside it, x* = e in
// place of 0, takes 2 a W^2 e from X in every four steps.)

#include "model/block_system.hpp"

#include <cstddef>

namespace gcpdda {

/// Non-viscous damping of one owned rigid row, for static problems: every generalised force loses `share` of
/// its size against the velocity it works on, f - share |f| sign(v). The force of anchors of the last step
/// counts in f. What is taken is added to the damping forces. Driven blocks are left alone, and so are
/// deformable ones: they lose their share within the step (OwnForces::local_damping).
void apply_local_damping(BlockSystem &system, std::size_t row, double share);

/// Mass-proportional damping of one owned row, f - alpha M v_n; what is taken is added to the damping forces.
/// Driven blocks are left alone.
/// @param mass_damping  alpha, 1/s
void apply_mass_damping(BlockSystem &system, std::size_t row, double mass_damping);

} // namespace gcpdda
