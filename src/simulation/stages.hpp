#pragma once

// Stages of a run: where it stands in them, and when one has come to its end.
//
// A stage is looked at every so many steps (a number that depends on the number of blocks alone). What is
// seen is made of maxima and of an exact sum, so that every number of ranks sees the same:
//     r   largest net force on a block over the largest force anywhere, local damping left out,
//     D   largest distance a point of a block has moved since the look before,
//     d   largest overlap of a contact, the length by which contacts carry what they carry,
//     T   kinetic energy,
//     M   largest motion of a block since the stage began, in sizes of that block; for failure of those only
//         that have moved farther than the pile may sag (largest_sag()): no failure, however small they are.
// settled: at two looks in a row r <= tolerance, D <= 1e-3 d, and T does not grow. (A block that creeps
// because its friction misses the slope by less than the tolerance still gains speed: that it is told from
// rest is what T is for. Below 1e-12 of f d, the energy in the largest contact, motion is rounding.)
// failed: M has reached failure_motion, D is at least half of what it was, and T at least a quarter of the
// most it was: the blocks are not about to come to rest.

#include "gcpdda/geometry/mat2.hpp"
#include "gcpdda/model/stage.hpp"
#include "model/block_system.hpp"
#include "statics/iteration_state.hpp"

#include <cstdint>
#include <vector>

namespace gcpdda {

/// One look at a stage.
struct StageLook {
  double unbalanced_ratio = 0.0; ///< r
  double motion = 0.0;           ///< D, m
  double overlap = 0.0;          ///< d, m
  double force = 0.0;            ///< largest force anywhere, N/m
  double kinetic = 0.0;          ///< T, J/m
  double moved = 0.0;            ///< M of all blocks
  double moved_beyond_sag = 0.0; ///< M of those that have moved farther than a pile sags
};

/// What is remembered from one look to the next.
struct LookMemory {
  StageLook last;
  double most_kinetic = 0.0;
  double kinetic_before = 0.0; ///< one step ago, of a stage with kinetic damping
  std::int64_t settled_looks = 0;
};

/// Verdict of a look; the memory moves on.
Verdict judge(const Stage &stage, const StageLook &look, LookMemory &memory);

/// Steps between two verdicts on a stage.
std::int64_t steps_between_verdicts(std::int64_t num_blocks);

/// The forces of excavated blocks on one that stays. They keep their direction and fall linearly to zero.
struct Unloading {
  std::int64_t block = 0;
  RigidDof rigid;        ///< N/m, and N about the centroid
  Mat2 gradient;         ///< int t X^T (N), of a deformable block
  double begin = 0.0;    ///< s
  double duration = 0.0; ///< s
};

/// Where a run stands in its stages.
struct StageState {
  std::int64_t index = 0;
  std::int64_t first_step = 0; ///< steps before the stage
  double start_time = 0.0;     ///< s
  bool ended = false;          ///< its result is the last of `results`
  double end_time = 0.0;       ///< s, of a stage that has ended
  std::int64_t contact_steps_before = 0;
  std::int64_t more_mobile = 0; ///< mobile blocks now, beyond those of the scene
  Verdict verdict = Verdict::undecided;
  LookMemory memory;
  statics::IterationState iteration; ///< of a stage with the static solver
  std::vector<StageResult> results;
  std::vector<std::int64_t> removed; ///< ids, ascending
  std::vector<Unloading> unloading;  ///< by block, each once for every excavation
};

/// An earlier stage has excavated it.
[[nodiscard]] bool is_removed(const StageState &state, std::int64_t block);
/// s; the state is in that stage or a later one.
[[nodiscard]] double start_of_stage(std::int64_t stage, const StageState &state);

/// The state as numbers for a checkpoint, and back.
struct StageNumbers {
  std::vector<std::int64_t> counts;
  std::vector<double> reals;
};
StageNumbers to_numbers(const StageState &state);
/// @throws FileError where the numbers are not those of a state
StageState to_state(const StageNumbers &numbers);

} // namespace gcpdda
