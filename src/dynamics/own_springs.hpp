#pragma once

// What a block's own matrix holds: its elasticity and viscosity, the springs of its anchors and the dashpots
// of viscous sides, taken implicitly.

#include "dynamics/deformable.hpp"
#include "dynamics/scheme.hpp"

#include <span>

namespace gcpdda {

/// Where within the step they are taken: q_n + velocity q' + acceleration q'' + coming q''_{n+1}.
struct SpringTime {
  double velocity = 0.0;
  double acceleration = 0.0;
  double coming = 0.0;
  // And its velocity: q' + rate_acceleration q'' + rate_coming q''_{n+1}. Dashpots taken there lower no limit
  // of the step; the explicit Hulbert-Chung scheme takes them at t_n.
  double rate_acceleration = 0.0;
  double rate_coming = 0.0;
};

/// t_{n+1-af} for an implicit scheme.
///
/// An explicit one has no such place, and at its trial configuration a spring this stiff would explode. Taken
/// at q* + dt^2/2 [(1 - am) q''_{n+1} + am q''_n] it oscillates as if W^2 were W^2/(1 + W^2/2) <= 2, below
/// the limit of every scheme here.
SpringTime spring_time(const Scheme &scheme, double time_step);

/// Forces of a block's anchors at u and x - x_c = arm X: on the centroid, and the sum of force X^T.
struct AnchorForce {
  Vec2 u;
  Mat2 gradient;
};
AnchorForce anchor_force(std::span<const Anchor> anchors, Vec2 u, const Mat2 &arm);

/// M^-1 f under the condition that the anchored points do not accelerate, by a penalty: what a block held by
/// springs this stiff starts with but for the transient in which they take up their load.
///
/// @param force, gradient_force  everything but the anchors; the latter of deformable rows only
/// @return acceleration of a rigid row, of x_c only of a deformable one, and F''
struct HeldAcceleration {
  RigidDof rigid;
  Mat2 gradient;
};
HeldAcceleration accelerate_held(const BlockSystem &system, std::size_t row, const RigidDof &force,
                                 const Mat2 &gradient_force);

/// Give the anchors of rows [0, num_rows) that have no stiffness yet theirs: a hundred times that of the
/// block's joints or of its own elasticity, whatever is more. An anchor keeps it, since the force of a spring
/// that is stretched would jump with its stiffness.
///
/// @param normal_stiffness  largest k_n of the scene, Pa/m
void stiffen_anchors(BlockSystem &system, double normal_stiffness);

} // namespace gcpdda
