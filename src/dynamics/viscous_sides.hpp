#pragma once

// Sides of the model that let waves out: the rock beyond an edge answers a motion of the edge with the
// tractions of the plane waves that carry it away [Lysmer and Kuhlemeyer 1969, doi:10.1061/JMCEA3.0001144],
//     t = -rho c_p (v . n) n - rho c_s (v . s) s,
// n the normal of the edge and s its direction, and a wave that comes in through it with velocity w pushes
// with twice what it carries [Joyner and Chen 1975, doi:10.1785/BSSA0650051315]:
//     t = rho c_p ((2 w - v) . n) n + rho c_s ((2 w - v) . s) s,
// so that a model that does nothing but let it through moves with w. (Half a space whose surface is free then
// moves with 2 w there.)
//
// v is linear along an edge, and in axes that turn with the block its values are v(X) = T(X) q', T the
// columns of DDA for a material point X. So D = int T^T (rho c_p n n^T + rho c_s s s^T) T ds is a constant of
// the block; two Gauss points integrate it exactly. The force -D q' + 2 D (w, 0) is taken at t_{n+1-af}, with
// its D in the block's own matrix: the dashpots lower no limit of the step, however stiff the rock beyond.
//
// What is absorbed. A chain of rigid blocks (mass m, joints k) ends in a dashpot at the middle of its last
// block, half a block early: of a wave of length l it reflects pi h/(2 l), h the size of a block along it.
// Waves that come at an angle of less than 30 degrees with the edge's normal are absorbed well, surface waves
// less so. There is no free field: sides on the left and on the right absorb what comes to them as if the
// rock beyond were at rest against the base, and so take from an upward wave along them; put them far away.

#include "model/block_system.hpp"

#include <array>
#include <span>

namespace gcpdda {

/// Density times speed of the rock beyond an edge, Pa s/m.
struct Impedance {
  double normal = 0.0;
  double tangential = 0.0;
};

/// Impedances of a stack of blocks along the side (for joints of other directions see jointed_rock.hpp): long
/// waves run through it with rho c^2 = 1/(1/M + 1/(k h)), M the modulus of the rock, infinite of a rigid
/// block, k the stiffness of the joints (Pa/m), h their distance: that of a block, area over length of the
/// edge.
/// @param modulus  Pa, of confined compression and of shear; zero for a rigid block
Impedance impedance_of(double density, std::array<double, 2> modulus, std::array<double, 2> joint_stiffness,
                       double height);

/// An edge on a viscous side, in the block's reference axes.
struct ViscousEdge {
  Vec2 begin; ///< m
  Vec2 end;
  Impedance impedance;
  bool lets_wave_in = false;
};

/// The dashpot of the block that has these edges.
Dashpot dashpot_of(std::span<const ViscousEdge> edges);

/// Force over the degrees of freedom, in the block's axes, of rates in them.
/// @param wave  velocity of the wave that comes in, in the same axes
std::array<double, 6> dashpot_force(const Dashpot &dashpot, const std::array<double, 6> &rate, Vec2 wave);

} // namespace gcpdda
