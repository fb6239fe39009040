#pragma once

// A run is a list of stages: each changes something at once (removes blocks, sets parameters), takes steps
// for a while or until the blocks have come to rest or have failed, or both.

#include "gcpdda/base/diagnostic.hpp"
#include "gcpdda/geometry/vec2.hpp"
#include "gcpdda/model/joint_law.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <vector>

namespace gcpdda {

struct Scene;

enum class StageKind { run, settle, excavate, change };
inline const char *word_of(StageKind kind) {
  constexpr std::array words{"run", "settle", "excavate", "change"};
  return words.at(static_cast<std::size_t>(kind));
}

/// How a settle stage looks for equilibrium: by damped motion in time, or by the iteration of
/// statics/pseudo_time.hpp.
enum class Solver { dynamic, statics };

/// What became of a stage.
enum class Verdict : std::int64_t {
  undecided, ///< neither of the next two yet
  settled,   ///< at rest
  failed,    ///< blocks have moved far and go on moving
  done       ///< of a stage that takes no steps
};
inline const char *word_of(Verdict verdict) {
  constexpr std::array words{"undecided", "settled", "failed", "done"};
  return words.at(static_cast<std::size_t>(verdict));
}

/// By what a stage has come to its verdict.
enum class VerdictMeans : std::int64_t {
  dynamic_step, ///< of a stage with the dynamic solver, or one that the static solver has left to it
  static_solver,
  no_drag ///< the dynamic step after local damping has ended (Stage::drag_limit)
};

/// Blocks by name and by place; where both are given, those of either.
struct BlockSelection {
  std::vector<std::int64_t> blocks; ///< ids, ascending
  std::vector<Vec2> region;         ///< polygon that holds their centroids; empty for none
  std::vector<std::size_t>
      openings; ///< numbers in RockRegion::openings: all blocks cut within their outlines
};

/// What a run changes at once, and how long it then goes on.
struct Stage {
  std::string name;
  StageKind kind = StageKind::run;
  double duration = 0.0;       ///< s; of a stage with a limit, the limit
  bool until_verdict = false;  ///< ends when it has settled or failed
  double tolerance = 1e-5;     ///< unbalanced-force ratio at rest
  double failure_motion = 0.5; ///< share of its size that a block moves when it fails
  double local_damping = -1.0; ///< in place of that of the run; negative for none
  bool mass_scaling = false;
  bool kinetic_damping = false; ///< velocities are set to zero whenever the kinetic energy has passed a peak
  bool begins_at_rest = false;  ///< the dynamic step confirms that a trial has come to rest ...
  bool goes_on_failing = false; ///< ... or that it fails; how far blocks have moved in the trial counts
  Solver solver = Solver::dynamic;
  std::int64_t increments = 50; ///< of the load, of the static solver
  /// s of a trial of gcpdda fos after which it goes on without local damping and is judged by its motion in
  /// windows (simulation/stages.hpp); infinite for every other stage.
  double drag_limit = std::numeric_limits<double>::infinity();
  double ignored_area = 0.0; ///< m^2 of a trial: what fails and is smaller is no failure of the slope
  /// Polygon of a trial: only failure of blocks whose centroid lies in it when the trial begins counts; empty
  /// for all blocks.
  std::vector<Vec2> watched_region;
  BlockSelection excavated;
  double relax = 0.0;          ///< s over which the forces of excavated blocks fall to zero
  double ramp = 0.0;           ///< s over which loads and stress that the stage changes do so
  bool changes_stress = false; ///< on sides of the region: to that of `after`
  /// The scene from here on where the stage changes it; without stages of its own.
  std::shared_ptr<const Scene> after;
  /// Joint laws of a trial whose strengths fall in increments, a set from one look to the next, in place of
  /// those of `after`, which follow; empty where they are in force at once.
  std::vector<std::vector<JointLaw>> weakening;
  SourcePosition where;

  /// Whether time passes in it.
  [[nodiscard]] bool takes_steps() const { return kind == StageKind::run || kind == StageKind::settle; }
  /// A trial of gcpdda fos.
  [[nodiscard]] bool is_trial() const { return drag_limit < std::numeric_limits<double>::infinity(); }
  /// Whether the blocks come to rest where they are, or fail.
  [[nodiscard]] bool asks_for_rest() const { return kind == StageKind::settle || is_trial(); }
  /// A trial whose verdict is that of a part of the blocks (simulation/mechanism.hpp).
  [[nodiscard]] bool watches_mechanism() const { return ignored_area > 0.0 || !watched_region.empty(); }
  /// Local damping of the stage: its own, or else that of the run.
  [[nodiscard]] double local_damping_or(double of_run) const {
    return local_damping >= 0.0 ? local_damping : of_run;
  }
};

/// What is written of a stage that has ended.
struct StageResult {
  Verdict verdict = Verdict::undecided;
  double time = 0.0; ///< at its end, s
  std::int64_t steps = 0;
  std::int64_t contact_steps = 0;
  double unbalanced_ratio = 0.0;
  double kinetic = 0.0;     ///< J/m
  double moved = 0.0;       ///< largest motion of a block in the stage, in sizes of that block
  std::int64_t removed = 0; ///< blocks
  std::int64_t loose = 0;   ///< blocks that kept moving when all others were at rest
  VerdictMeans means = VerdictMeans::dynamic_step; ///< not in checkpoints: of stages of this process
  /// Verdict on all blocks where that of the trial is on a part of them, else undecided; not in checkpoints.
  Verdict first_block = Verdict::undecided;
  // Of a settle stage or a trial that has settled (simulation/slid_blocks.hpp).
  double slide = 0.0;           ///< largest slide of a block, in sizes of that block
  double slide_distance = 0.0;  ///< the same in m
  std::int64_t slid_block = -1; ///< id of that block; -1 where none has slid
  std::int64_t slid_blocks = 0; ///< number of those that have slid by telling_slide or more
  /// A slide from which on users are told, in sizes of a block.
  static constexpr double telling_slide = 0.02;
  [[nodiscard]] bool has_slid() const { return slide >= telling_slide; } ///< so far that users are told
};

} // namespace gcpdda
