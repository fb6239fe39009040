#pragma once

// Sides of the region that blocks may slide along but not move through or away sideways: rollers; and sides
// on which the in-situ stress acts from outside; and viscous ones.
//
// Rollers: a fixed block lies along such a side, as along a fixed one, and its edges have a law without
// friction and cohesion, which is the weaker one of any two: the side pushes along its normal and lets go
// along itself. Like every contact it only pushes, and yields by its normal stiffness, which is that of the
// default law.
//
// Viscous sides (dynamics/viscous_sides.hpp) let waves out.
//
// Stress: the traction -C n of the in-situ compression C on the edges that lie on the side at t = 0. It stays
// what it is whatever moves, as the weight of far rock does, until a stage changes C or the sides. C then
// says what the far rock does: sides under stress follow it, sides that are held bear what equilibrium asks
// of them, and what is in the blocks follows by equilibrium alone.

#include "io/scene/scene_section.hpp"

namespace gcpdda::scene_text {

/// The fixed blocks along the region's rollers, behind the blocks of the scene, and their law.
/// @param scene  with laws, blocks and region
void add_rollers(const SceneSource &source, Scene &scene);

/// The sides of the region where the in-situ stress, which has been read, acts from outside.
void read_stressed_sides(const SceneSource &source, Scene &scene);

/// What a stage makes of the stress on sides of the region, which has been read: it must push, and act
/// somewhere before or after.
/// @param where  what the stage sets of it
void check_changed_stress(const SceneSource &source, const toml::source_region &where, const Scene &scene,
                          const InSituStress &before);

/// The viscous sides of [earthquake], the rest of which has been read.
void read_viscous_sides(const SceneSource &source, Scene &scene);

} // namespace gcpdda::scene_text
