#pragma once

// The step of deformable blocks (deformable.hpp) and of rigid ones that are free, several at a time.

#include "base/instructions.hpp"
#include "dynamics/free_rows.hpp"
#include "dynamics/half_works.hpp"
#include "dynamics/integrate.hpp"
#include "dynamics/own_springs.hpp"

#include <array>
#include <cstddef>

namespace gcpdda {

/// Where and how long all blocks step, and where they take springs.
struct BlockSolve {
  const Scheme &scheme;
  double time_step;
  SpringTime spring;
  Vec2 wave;                ///< velocity of the one that comes in through viscous sides, m/s
  double stiffness_damping; ///< s
  double local_damping;     ///< share, of deformable blocks
  bool is_implicit;         ///< the elasticity of blocks

  // Q is Vec2, RigidDof or Mat2.
  /// At the spring's time but for the coming acceleration.
  template <class Q> [[nodiscard]] Q base(const Q &q, const Q &v, const Q &a) const {
    return q + (spring.velocity * v + spring.acceleration * a);
  }
  /// And its rate there.
  template <class Q> [[nodiscard]] Q base_rate(const Q &v, const Q &a) const {
    return v + spring.rate_acceleration * a;
  }
  template <class Q> [[nodiscard]] Q position(const Q &q, const Q &v, const Q &a, const Q &a_new) const {
    return q + (time_step * v + time_step * time_step * ((0.5 - scheme.beta) * a + scheme.beta * a_new));
  }
  template <class Q> [[nodiscard]] Q velocity(const Q &v, const Q &a, const Q &a_new) const {
    return v + time_step * ((1.0 - scheme.gamma) * a + scheme.gamma * a_new);
  }
};

/// Up to as many deformable rows as there are lanes, and what comes of them.
struct DeformableLanes {
  std::size_t count = 0;
  std::array<std::size_t, most_lanes> row;
  bool are_held = false;                      ///< by matrices of their own
  std::array<AnchorForce, most_lanes> held;   ///< what fixed points and viscous sides do, so far known
  std::array<Mat2, most_lanes> viscous;       ///< out: what beta K adds to the elastic force, N
  std::array<AnchorForce, most_lanes> damped; ///< out: what local damping does
  std::array<double, most_lanes> damped_work; ///< out: half its work over the way to the trial configuration
  std::array<double, most_lanes> turned;      ///< out: rad
  std::array<double, most_lanes> most_motion; ///< out: of the new state, m
};

/// Advances the rows under their gathered forces and notes their elastic force. A row whose new state is not
/// finite or turned inside out keeps its old one.
/// @return bit i is set where row i is such a one
using StepDeformables = unsigned (*)(BlockSystem &system, DeformableLanes &lanes, const BlockSolve &step);

/// Of row first + i in bit i.
struct FreeStep {
  unsigned broken = 0;       ///< not finite afterwards, and kept as it was
  unsigned to_check = 0;     ///< its most_motion() is above FreeRows::safe_motion
  double largest_turn = 0.0; ///< of a deformable one, rad
};

/// Does to rows [first, first + width) what advance_free_rows() says.
using StepFreeRows = FreeStep (*)(BlockSystem &system, std::size_t first, const FreeRows &rows,
                                  const Scheme &scheme, double time_step);

/// The same of deformable ones.
using StepFreeDeformables = FreeStep (*)(BlockSystem &system, std::size_t first, const FreeRows &rows,
                                         const BlockSolve &step);

/// Rows, no more than there are lanes.
using RowsAtOnce = std::span<const std::size_t>;

/// pose() of rigid or of deformable rows with four vertices, the centroids of whose motions are known.
using PoseQuads = void (*)(BlockSystem &system, const RowsAtOnce &rows);

/// Rows [first, first + width), all rigid or all deformable, at x + by_velocity x' + by_acceleration x''.
using PredictRows = void (*)(BlockSystem &system, std::size_t first, double by_velocity,
                             double by_acceleration);

/// Does to rows [first, first + width), all rigid or all deformable, what add_half_works() says.
using AddHalfWorks = void (*)(BlockSystem &system, std::size_t first);

struct BlockLanes {
  std::size_t width; ///< what is done at a time
  PoseQuads pose_rigid_quads;
  PoseQuads pose_deformable_quads;
  StepDeformables step_deformables;
  StepFreeRows step_free_rows;
  StepFreeDeformables step_free_deformables;
  PredictRows predict_rigids;
  PredictRows predict_deformables;
  AddHalfWorks add_half_works_of_rigids;
  AddHalfWorks add_half_works_of_deformables;
};

/// Does nothing act on owned rows [first, last) but contacts, weight and shaking?
inline bool are_free(const BlockSystem &system, std::size_t first, std::size_t last) {
  return system.applied_begin[first] == system.applied_begin[last];
}

/// All instructions give the same bits.
const BlockLanes &block_lanes(Instructions instructions);
// With these instructions, where GCPDDA_HAS_COPIES.
BlockLanes avx2_blocks();
BlockLanes avx512_blocks();

} // namespace gcpdda
