#pragma once

// Stages of a run: where it stands in them, and when one has come to its end.
//
// A stage is looked at every so many steps (a number that depends on the number of blocks alone). What is
// seen is made of maxima and of an exact sum, so that every number of ranks sees the same:
//     r   largest net force on a block over what it is measured by (unbalanced.hpp), local damping left out,
//     D   largest distance a point of a block has moved since the look before,
//     d   largest overlap of a contact, the length by which contacts carry what they carry,
//     T   kinetic energy,
//     M   largest motion of a block since the stage began, in sizes of that block; for failure of those only
//         that have moved farther than the pile may sag (largest_sag()): no failure, however small they are.
// settled: at two looks in a row r <= tolerance, D <= 1e-3 d, and T does not grow. (A block that creeps
// because its friction misses the slope by less than the tolerance still gains speed: that it is told from
// rest is what T is for. Below 1e-12 of f d, the energy in the largest contact, motion is rounding.)
// A settle stage does not wait for a few loose blocks (loose_blocks.hpp), and has not failed where only they
// move. Nor does a trial by the static solver whose motion would not go far if it went on as it does; where
// one of the blocks goes on nevertheless, the dynamic step that confirms the trial sees it.
// The dynamic step that confirms a trial of the static solver (Stage::begins_at_rest) would start a swing of
// the whole pile by the little that was left unbalanced. The static solver therefore goes on first, until all
// but one in 100,000 blocks are balanced so well that the dynamic step holds them (held_blocks.hpp), for
// 1,500 evaluations, or until a block has moved by failure_motion. (A few in motion set free those around
// them, and 100 in 100,000 all of a slope: after 300 evaluations one of 100,290 blocks was still undecided
// after 6,300 steps of motion, because a loose block slid on by a fiftieth of its size. After 583 it took 881
// steps.) The swing of the few needs not end: D does not grow there either, in place of being small. A block
// that goes on under a force moves farther from look to look. Nor is there much of a force where all blocks,
// from rest, have moved less than a share e = 2e-4 of their weight would move them. In the n-th look of the
// dynamic step, of the length t, that is (n - 1/2) e g t^2; it is asked from the fourth on, so that a swing
// with a period of several looks has been seen as well. A block on a plane with the dip b whose trial is
// beyond its limit by the share h of the factor has e = h sin(b): what may pass is beyond it by some
// ten-thousandths. Without this rule a pile near its limit, in which friction feeds a swing of a micrometre,
// rested by chance after up to 40 looks.
//
// failed: M has reached failure_motion, D is at least half of what it was, and T at least a quarter of the
// most it was: the blocks are not about to come to rest.
//
// The strengths of a trial of gcpdda fos by the dynamic step fall in increments of 2 %, one at each look
// (Stage::weakening); no trial has settled before they have fallen. Taken away at once, strength leaves
// forces unbalanced that set blocks in motion, and a structure that softens when it slips fails in that
// motion though it would hold: a roof wedge between abutments with inertia at 1.21 in place of 1.40.
//
// A trial of gcpdda fos that is still undecided after Stage::drag_limit goes on without local damping, which
// acts as drag on blocks that creep, and is judged by windows of its motion as well. Each window is twice as
// long as the one before. With g the growth of M over the length of a window and m the mean of log10 r in it,
//     failed: g >= 0.8 of the window before, m >= that of the window before - 0.05, and some block has moved
//     farther than a pile sags.
// Motion of blocks that come to rest is bounded: g then falls by half from one window to the next, or faster.
// At a constant speed g stays, and under a constant force, as that of a block on a plane beyond its limit, g
// doubles at least. The threshold lies between the first and the other two. The term in m refuses blocks
// that slide on while what drives them fades.
//
// The same rule decides when a trial fails under the static solver, with windows of equal
// length: in pseudo-time motion is damped, and a constant force gives a constant speed. A block must have
// moved by failure_motion and beyond the sag, and gone on as above or for two windows in a row, and a series
//     M + g (q + q^2 + ...)     with q, g over that of the window before, but at most 1
// that reaches five times failure_motion within 60 windows, twice those of a trial. Where M is as much as
// that already and a block has moved beyond the sag, the trial fails at once. The series is asked from the
// fourth window on, since the first ones have the motion that the loads have caused: just below the limits of
// two slopes M grew for one or two of them as fast as before or faster, by a twentieth to a tenth a window,
// and then hardly at all; whether a trial there failed hung on last bits. Near the limit blocks creep to rest
// for a thousand evaluations, in each window a little less. Where a trial that fails is an end of the
// bracket, the dynamic step goes on from there and judges from its second look on: the first has nothing to
// be compared with.

#include "gcpdda/geometry/mat2.hpp"
#include "gcpdda/model/stage.hpp"
#include "model/block_system.hpp"
#include "statics/iteration_state.hpp"

#include <cstdint>
#include <optional>
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
  double fall = 0.0; ///< (n - 1/2) g t^2 where the dynamic step confirms a state of rest, else 0; m
  // Of a settle stage or a static trial (loose_blocks.hpp); 1 where nobody has looked.
  double loose_share = 1.0;     ///< of the mobile blocks, those that are loose
  double loose_load = 1.0;      ///< their net forces together over the load
  double resting_kinetic = 0.0; ///< T of the others, J/m
};

/// D of a block at rest over d.
inline constexpr double motion_at_rest = 1e-3;

/// Motion of a trial in windows.
struct MotionWindows {
  double begin = 0.0;  ///< of the window at hand, in s or evaluations
  double length = 0.0; ///< of it; 0: none has begun
  double moved = 0.0;  ///< M at its begin
  double sum_of_logs = 0.0;
  std::int64_t looks = 0;
  std::int64_t closed = 0;       ///< windows before
  double last_rate = 0.0;        ///< g of the one before ...
  double last_log = 0.0;         ///< ... and m
  std::int64_t undiminished = 0; ///< windows in a row that motion has gone on in at an undiminished rate
  double farthest = 1e300;       ///< by which M of a single block has grown in the one before, in pseudo-time
};
/// Take a look at a trial into its window.
/// @param growth  of the length from one window to the next
/// @return where this look has closed a window: its growth over that of the one before, 0 of the first
std::optional<double> note_motion(const StageLook &look, double now, double first_length, double growth,
                                  MotionWindows &windows);

/// What is remembered from one look to the next.
struct LookMemory {
  StageLook last;
  double most_kinetic = 0.0;
  double kinetic_before = 0.0; ///< one step ago, of a stage with kinetic damping
  std::int64_t settled_looks = 0;
  std::int64_t loose_looks = 0; ///< in a row at which all but loose blocks were at rest
  std::int64_t num_loose = 0;   ///< blocks that the stage has not waited for
  std::int64_t confirming =
      0;                 ///< looks of the dynamic step that confirms a state of rest, not in checkpoints
  MotionWindows windows; ///< not in checkpoints, because nothing goes on with a trial
};

/// Looks in a row after which a stage waits no longer for loose blocks: longer than it takes one that bounces
/// to come back, 20 to 30 evaluations of the static solver, of which each is a look.
std::int64_t looks_at_loose_blocks(bool is_static);

/// Verdict of a look; the memory moves on.
Verdict judge(const Stage &stage, const StageLook &look, std::int64_t looks_at_loose, LookMemory &memory);

/// Verdict by windows on a trial without local damping.
/// @param time  since the stage began, s
Verdict judge_without_drag(const Stage &stage, const StageLook &look, double time, LookMemory &memory);

/// Steps between two verdicts on a stage.
std::int64_t steps_between_verdicts(std::int64_t num_blocks);

/// The forces of excavated blocks on one that stays. They keep their direction and fall linearly to zero.
struct Unloading {
  std::int64_t block = 0;
  RigidDof rigid;        ///< N/m, and N about the centroid
  Mat2 gradient;         ///< int t X^T, N; in the stress of a rigid block alone
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
  LookMemory mechanism;                     ///< of the part of the blocks that a trial watches ...
  Verdict first_block = Verdict::undecided; ///< ... and the verdict on all; neither is in checkpoints
  statics::IterationState iteration;        ///< of a stage with the static solver
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
