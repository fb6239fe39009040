#pragma once

#include "gcpdda/base/ids.hpp"
#include "gcpdda/geometry/aabb.hpp"
#include "gcpdda/geometry/vec2.hpp"
#include "gcpdda/model/scene.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <tuple>
#include <vector>

namespace gcpdda {

enum class BlockKind : std::uint8_t { fixed = 0, rigid = 1, deformable = 2 };

/// Three degrees of freedom of a rigid block: translation of the centroid and rotation (m, rad), or their
/// rates, or the forces that work on them (N/m, N).
struct RigidDof {
  Vec2 u;
  double r = 0.0;

  RigidDof &operator+=(const RigidDof &b) { return u += b.u, r += b.r, *this; }
  friend bool operator==(const RigidDof &, const RigidDof &) = default;
};

inline RigidDof operator+(const RigidDof &a, const RigidDof &b) {
  return {a.u + b.u, a.r + b.r};
}
inline RigidDof operator-(const RigidDof &a, const RigidDof &b) {
  return {a.u - b.u, a.r - b.r};
}
inline RigidDof operator*(double s, const RigidDof &a) {
  return {s * a.u, s * a.r};
}
/// Work of a force over a motion.
inline double work(const RigidDof &force, const RigidDof &motion) {
  return dot(force.u, motion.u) + force.r * motion.r;
}

/// Constants of one block.
struct BlockProperties {
  BlockId id;
  std::int32_t material = 0;
  BlockKind kind = BlockKind::rigid;
  double area = 0.0;    ///< m2
  double mass = 0.0;    ///< kg per metre; infinite for a fixed block
  double inertia = 0.0; ///< about the centroid, kg m2 per metre; infinite for a fixed block
  double radius = 0.0;  ///< largest centroid-to-vertex distance, m
  double width = 0.0;   ///< narrowest width, m
  Vec2 centroid;        ///< at t = 0, m
};

/// What the energy ledger carries for one block: forces of the last evaluation and their work so far over
/// increments of the trial configuration.
struct BlockLedger {
  RigidDof shear_force;   ///< elastic part of friction
  RigidDof damping_force; ///< dashpots
  Vec2 gravity_force;
  double shear_work = 0.0;
  double damping_work = 0.0;
  double gravity_work = 0.0;
};

/// The state of all blocks this rank sees, as arrays by field.
///
/// Rows: [0, num_owned) owned, then num_ghosts ghosts (exact copies of other ranks' blocks), then num_fixed
/// fixed blocks (the same on every rank, never exchanged). Each range is sorted by BlockId. Positions are
/// kept as displacements from the centroid at t = 0, so that a distant origin costs no digits of the motion.
struct BlockSystem {
  std::size_t num_owned = 0;
  std::size_t num_ghosts = 0;
  std::size_t num_fixed = 0;

  // State, one entry a row. What stands here migrates, makes a ghost, and is all that a restart needs.
  std::vector<BlockProperties> properties;
  std::vector<RigidDof> displacement;   ///< x_n - x_0
  std::vector<RigidDof> velocity;       ///< v_n
  std::vector<RigidDof> acceleration;   ///< a_n
  std::vector<RigidDof> trial;          ///< x*_n - x_0, where the contact forces are taken
  std::vector<RigidDof> trial_previous; ///< x*_{n-1} - x_0
  std::vector<RigidDof> refreshed;      ///< x - x_0 at the last refresh of the neighbourhood
  std::vector<BlockLedger> ledger;

  // Shape in the block's own axes, flat; row i owns [vertex_begin[i], vertex_begin[i + 1]). Edge k runs from
  // vertex k to the next one; its outward unit normal is stored, never recomputed from cut edges.
  std::vector<std::uint32_t> vertex_begin{0};
  std::vector<Vec2> reference_vertex; ///< relative to the centroid
  std::vector<Vec2> reference_normal;
  std::vector<double> edge_length;

  // Derived from the trial configuration, see pose().
  std::vector<Vec2> trial_centroid;
  std::vector<Vec2> vertex;
  std::vector<Vec2> normal;
  std::vector<Aabb> box;

  [[nodiscard]] std::size_t num_rows() const { return properties.size(); }
  [[nodiscard]] std::size_t num_mobile() const { return num_owned + num_ghosts; }
  [[nodiscard]] std::size_t first_fixed() const { return num_owned + num_ghosts; }
  [[nodiscard]] bool is_fixed(std::size_t row) const { return row >= first_fixed(); }
  [[nodiscard]] std::size_t num_vertices(std::size_t row) const {
    return vertex_begin[row + 1] - vertex_begin[row];
  }

  template <class T>
  [[nodiscard]] std::span<const T> of_row(const std::vector<T> &per_vertex, std::size_t row) const {
    return {per_vertex.data() + vertex_begin[row], num_vertices(row)};
  }

  /// Position of the centroid at t_n.
  [[nodiscard]] Vec2 centroid(std::size_t row) const {
    return properties[row].centroid + displacement[row].u;
  }

  /// Every field with one entry a row: the one list that packing, migration and reordering share.
  static constexpr auto row_fields() {
    return std::make_tuple(&BlockSystem::properties, &BlockSystem::displacement, &BlockSystem::velocity,
                           &BlockSystem::acceleration, &BlockSystem::trial, &BlockSystem::trial_previous,
                           &BlockSystem::refreshed, &BlockSystem::ledger);
  }
  /// Every field with one entry a vertex that cannot be derived.
  static constexpr auto shape_fields() {
    return std::make_tuple(&BlockSystem::reference_vertex, &BlockSystem::reference_normal,
                           &BlockSystem::edge_length);
  }
};

/// Append the row of a scene's block at rest in its initial configuration. The ranges' counts are the
/// caller's.
void append_block(BlockSystem &system, BlockId id, const SceneBlock &block, const Material &material);

/// Append a copy of another system's row. The ranges' counts are the caller's.
void append_row(BlockSystem &to, const BlockSystem &from, std::size_t row);

/// World vertices, normals and boxes of rows [first, last) at their trial configuration.
void pose(BlockSystem &system, std::size_t first, std::size_t last);

/// World vertices of one row at t_n.
std::vector<Vec2> current_vertices(const BlockSystem &system, std::size_t row);

} // namespace gcpdda
