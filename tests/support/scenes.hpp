#pragma once

#include "gcpdda/model/scene.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace gcpdda::testing {

/// The scene of a TOML text; throws with all diagnostics if it is bad.
Scene scene_of(const std::string &toml, const std::vector<std::string> &sets = {});

/// The text of run/scenes/NAME.toml.
std::string shipped_toml(const std::string &name);
/// A scene that ships with the program, run/scenes/NAME.toml.
Scene shipped_scene(const std::string &name, const std::vector<std::string> &sets = {});

/// The slope of run/guide/walk_1_your_slope.md, 95 blocks with water, and its settle stage.
std::string walked_slope_toml();

/// All of a scene but its blocks: rigid rock with friction 30 degrees, one monitored block.
std::string rock_toml(double duration, double interval, const std::string &monitored);

/// One [[block]] of material "rock"; `extra` holds more lines of its table.
std::string block_toml(const std::string &name, const std::vector<Vec2> &vertices,
                       const std::string &extra = "");

/// Points turned about the origin and moved.
std::vector<Vec2> placed(const std::vector<Vec2> &points, double angle, Vec2 offset);

/// An axis-parallel rectangle, counter-clockwise from its lower left corner.
std::vector<Vec2> rectangle(Vec2 low, Vec2 high);

/// A convex polygon of `num_vertices` on a circle, angles jittered; the same for the same seed on every
/// machine.
std::vector<Vec2> random_polygon(unsigned seed, int num_vertices, double radius, Vec2 centre);

/// Random convex blocks (3 to 8 vertices) loosely stacked in a box of fixed walls, falling and spinning:
/// touches, slides and crosses subdomain corners.
std::string falling_pile_toml(int num_blocks, double duration);

/// A wall of bricks at rest, and a block that loses the shelf it lies on in the second stage: it hits the
/// corner of the wall and falls beside it. The third stage settles by the dynamic step.
/// @param fidelity  of all blocks
/// @param keys  lines of [output] and of the last stage
std::string falling_block_toml(const std::string &fidelity, int rows, int columns, const std::string &output,
                               const std::string &stage);
/// A wall of bricks at rest to 1e-10, and a block that falls 0.4 m from a shelf beside it when that is taken
/// away, all with the static solver.
std::string fall_from_shelf_toml(const std::string &fidelity, int rows, int columns,
                                 const std::string &output);

/// A wall of cells of an L and a brick in its notch, each rigid or deformable by turns, on a floor that
/// shakes it; two outputs, a monitored block and point.
std::string mixed_wall_toml(int rows, int columns, double duration);

/// Unit squares on a fixed floor, friction 0.6. Gravity acts at once; joints hardly damp the slow modes of a
/// pile, so local damping settles it, and stays on.
std::string settling_pyramid_toml(std::int64_t rows, double duration, const std::string &fidelity = "rigid");

} // namespace gcpdda::testing
