#pragma once

// Rows of the frames of a result folder: blocks, contacts, bolts, liners.

#include "gcpdda/geometry/vec2.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace gcpdda {

/// One block's row of a frame, in plain data so that it can travel to the rank that writes its slab.
struct FrameRow {
  std::int64_t block = 0;
  std::int32_t material = 0;
  std::uint8_t kind = 0; ///< 0 fixed, 1 rigid, 2 deformable
  std::int32_t num_vertices = 0;
  Vec2 centroid; ///< current, m; not written
  Vec2 displacement;
  double rotation = 0.0;
  std::array<double, 3> velocity{};
  std::array<double, 3> stress{};        ///< xx, yy, xy, Pa, tension positive
  std::array<double, 3> contact_force{}; ///< N/m, N/m, N
};

/// One touching region: a line from `begin` to `end` (its extent along the contact).
struct ContactRow {
  std::int64_t lower = 0;
  std::int64_t higher = 0;
  std::int32_t position = 0; ///< order of the region within its pair
  std::int32_t joint = 0;    ///< index of its law
  std::uint8_t state = 0;    ///< 1 stick, 2 slip, 3 a bond, whose normal_force is minus its tension
  Vec2 begin;
  Vec2 end;
  double normal_force = 0.0; ///< N/m
  double shear_force = 0.0;
  double overlap = 0.0; ///< m
  double slip = 0.0;    ///< m, accumulated
};

/// A bolt where it crosses a joint, or all of a cable: a line of `num_points` from the side of its head to
/// that of its tip. Forces are those of one bolt.
struct BoltRow {
  std::int64_t bolt = 0; ///< in the order of the scene
  std::int32_t support = 0;
  std::int32_t num_points = 0;
  std::uint8_t state = 0;   ///< 0 elastic, 1 has yielded, 2 broken
  double axial_force = 0.0; ///< N, tension positive
  double shear_force = 0.0; ///< N, positive where the rock towards the tip has moved to the left
  double extension = 0.0;   ///< m
  double slide = 0.0;       ///< m, with the sign of the shear force
};

/// An element of a liner between two neighbouring blocks: a line from node to node, with the rock on its
/// right. Forces are per metre of tunnel.
struct LinerRow {
  std::int64_t liner = 0; ///< in the order of the scene
  std::int32_t support = 0;
  std::uint8_t state = 0;      ///< 0 elastic, 1 has yielded, 2 broken
  std::uint8_t cracked = 0;    ///< 1 where it has cracked
  double axial_force = 0.0;    ///< N/m, tension positive
  double shear_force = 0.0;    ///< N/m, positive where the block further along has moved into the void
  double moment_begin = 0.0;   ///< N, at the first node, positive where the side of the rock is in tension
  double moment_end = 0.0;     ///< N
  double extension = 0.0;      ///< m
  double slide = 0.0;          ///< m, with the sign of the shear force
  double turn = 0.0;           ///< rad, with the sign of the moments
  double thickness = 0.0;      ///< m
  double strength_used = 0.0;  ///< largest share, 0 to 1
  std::array<Vec2, 2> nodes{}; ///< m
};

/// All bolts, the same on every rank; points concatenated in the order of `rows`.
struct BoltFrame {
  std::vector<BoltRow> rows;
  std::vector<Vec2> points;
};

} // namespace gcpdda
