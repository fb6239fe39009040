#pragma once

// Deformable blocks: six degrees of freedom, no drift in size, no centrifugal terms.
//
// Kinematics. x = x_c + F X, X in reference axes with the origin at the centroid. F has a polar decomposition
// F = R U: R = R(theta) with theta = atan2(F21 - F12, F11 + F22), U = R^T F symmetric, strain E = U - I. The
// rates that are integrated are those of F, not of theta and E: with S = rho int X X^T dA the kinetic energy
// is
//     m |v|^2/2 + tr(F' S F'^T)/2,
// its mass constant and without a centrifugal or Coriolis term. The area is det F; the linear DDA update,
// which adds r J X to X, grows it by 1 + r^2 a step.
//
// Forces. A traction t does the work G : dF with G = int t X^T ds. Strain energy W(E) = E . K E/2, with K =
// area D over (eps_x, eps_y, gamma_xy), gives
//     P = R (A sigma + a J),   A sigma = dW/dE,   J = [0 -1; 1 0],   a = tr(J A sigma U)/tr U:
// with F' = R (w J U + U'), P : F' = W' for every spin w if and only if A sigma + a J does no work on J U,
// and tr(J^T J U) = tr U. An isotropic sigma commutes with U, so that a is zero but for rounding; the formula
// removes that too. (A block born under stress has E + E_0 in place of E, E_0 the initial strain of its
// Deformation; its reference axes are those of the shape it is born with.) The equation of motion of F is
//     F'' S = G - P,
// and d/dt tr(J^T F' S F^T) = tr(J^T (G - P) F^T) has no elastic part: elasticity has no torque.
//
// Components. In the turning axes R* = R(F*) of the trial configuration a motion g = R*^T F'' is written
// (r, ex, ey, gxy) = ((g21 - g12)/2, g11, g22, g12 + g21), the unknowns of DDA, and a force H = R*^T G that
// works on it (H21 - H12, H11, H22, (H12 + H21)/2). S becomes the mass matrix of DDA's simplex integrals,
// constant for a block, and so is K. Where nothing holds the block, (u, v) and (r, ex, ey, gxy) are apart,
// and the factors of the latter's four rows are found in every step from S and K, which it reads anyway; else
// one factorisation of all six serves the whole run.
//
// Time. All forces but K are taken at F*, so that F obeys the leapfrog of scheme.hpp. K may be taken
// implicitly at F_{n+1-af} = F_n + (1 - af)[dt F' + dt^2 ((1/2 - b) F'' + b F''_{n+1})]:
//     P = P* + R* (K e + a J),   e = R*^T (F_{n+1-af} - F*),
//     [(1 - am) M + (1 - af) b dt^2 K] g_{n+1} = R*^T (G - P*) - K e_0 - a J - am M R*^T F'',
// e_0 being e with F''_{n+1} = 0. K e alone has the torque tr(J K e U*), of second order in the strain, and L
// would drift. g depends on a linearly, so one more solution, for a unit force on r, gives the a that removes
// the torque of all of P: the angular momentum of the trial sequence is then exact for implicit elasticity
// too. P is the stress to look at: sigma(E*) differs from it by K e, which in a stiff spinning block is many
// times the stress itself. Where elasticity is explicit K e is left out.
//
// K e is linear about E*: it holds while the strain that passes within a step, about strain (omega dt)^2, is
// small, omega the block's own frequency. Loads that the step resolves keep it so, whatever the stiffness;
// an initial strain does not.

#include "dynamics/scheme.hpp"
#include "model/block_system.hpp"

#include <array>

namespace gcpdda {

/// A rate of F in turning axes, or the forces that work on it, as DDA writes them.
struct GradientDof {
  double r = 0.0;
  double ex = 0.0;
  double ey = 0.0;
  double gxy = 0.0;
};

constexpr GradientDof motion_dof(const Mat2 &g) {
  return {0.5 * (g.yx - g.xy), g.xx, g.yy, g.xy + g.yx};
}
constexpr Mat2 motion_matrix(const GradientDof &g) {
  return {g.ex, 0.5 * g.gxy - g.r, 0.5 * g.gxy + g.r, g.ey};
}
constexpr GradientDof force_dof(const Mat2 &h) {
  return {h.yx - h.xy, h.xx, h.yy, 0.5 * (h.xy + h.yx)};
}
constexpr Mat2 force_matrix(const GradientDof &h) {
  return {h.ex, h.gxy - 0.5 * h.r, h.gxy + 0.5 * h.r, h.ey};
}

/// Factorised matrices of rows [0, num_rows) with anchors or dashpots, after stiffen_anchors(); to be made
/// before the first step and whenever the time step changes. A driven block gets none: it heeds no force.
/// Those of other deformable blocks are found in every step.
///
/// @param normal_stiffness  largest k_n of the scene (Pa/m), for anchors that have no stiffness yet
/// @param stiffness_damping  beta of Rayleigh damping (s)
void make_block_matrices(BlockSystem &system, const Scheme &scheme, double time_step, Elasticity elasticity,
                         double normal_stiffness, double stiffness_damping = 0.0);

/// R of F = R U.
Mat2 rotation_of(const Mat2 &gradient);

/// Rotation angle of a gradient, in (-pi, pi].
double angle_of(const Mat2 &gradient);

/// Blocks turn little in a step: up to this tangent a series to full precision takes a tenth of the time.
constexpr double largest_ratio_of_series = 1.0 / 64.0;

/// Angle from one gradient's rotation to another's, in (-pi, pi].
double angle_between(const Mat2 &from, const Mat2 &to);

/// Mean spin of the block (1/s), the antisymmetric part of rate gradient^-1.
double spin_of(const Mat2 &gradient, const Mat2 &rate);

/// Of a row, whether it deforms or not, at t_n.
double spin_of(const BlockSystem &system, std::size_t row);

/// K e (N) on the symmetric part of e, in the axes of e.
Mat2 elastic_stress(const Deformation &deformation, const Mat2 &strain);

/// The symmetric strain e with K e = force (N), which is symmetric.
Mat2 strain_under(const Deformation &deformation, const Mat2 &force);

/// Elastic force P* (N) on F = R U at the given gradient, without torque.
Mat2 elastic_force(const Deformation &deformation, const Mat2 &gradient);

/// What works on F once the forces of a step are gathered, less the springs of the step before (N).
inline Mat2 unbalanced_on_gradient(const Deformation &d) {
  return d.contact.force - d.internal + d.anchor_force;
}

/// Strain energy (J/m) at the given gradient.
double strain_energy(const Deformation &deformation, const Mat2 &gradient);

/// Strain energy (J/m) of the elastic force last applied. In a stiff block that spins or shakes faster than
/// its own period the energy at E* is as wrong as sigma(E*), squared.
double applied_strain_energy(const Deformation &deformation);

/// tr(rate S rate^T)/2 (J/m).
double kinetic_energy(const Deformation &deformation, const Mat2 &rate);

/// Mean Cauchy stress (Pa) of the elastic force last applied, global axes: xx, yy, xy.
///
/// The mean of the stress over the block is (1/(area det F)) int t x^T ds less the inertia, and that is P
/// F^T; P was applied in the trial configuration.
std::array<double, 3> mean_cauchy_stress(const Deformation &deformation, double area);

} // namespace gcpdda
