#pragma once

// What summary.json says of a run, and the rows of energies, bolts and liners that it takes from the
// histories.

#include "gcpdda/geometry/vec2.hpp"
#include "gcpdda/model/scene.hpp"

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace gcpdda {

/// Columns of history/energy.csv after the time.
struct EnergyRow {
  double kinetic = 0.0;
  double strain = 0.0;
  double contact_normal = 0.0;
  double contact_stick = 0.0;
  double gravity = 0.0;
  double friction_loss = 0.0;
  double damping_loss = 0.0;
  double boundary_work = 0.0;
  double residual = 0.0;
  double unbalanced_ratio = 0.0;
  double max_speed = 0.0;
  double support = 0.0; ///< this and the next in scenes with bolts or liners only
  double support_loss = 0.0;
  double excess = 0.0; ///< at least so much is in contact_normal only because it is a mean; not written
};

/// One row of history/bolts.csv: largest values over the joints that one bolt crosses.
struct BoltHistoryRow {
  std::string name;
  Vec2 head; ///< m
  Vec2 tip;
  double axial = 0.0;     ///< N, tension
  double shear = 0.0;     ///< N
  double extension = 0.0; ///< m
  double slide = 0.0;     ///< m
  std::int64_t links = 0;
  std::int64_t yielded = 0;
  std::int64_t broken = 0;
  double largest_axial = -std::numeric_limits<double>::max(); ///< of the steps so far, N, as the next one
  double largest_shear = 0.0;
};

/// What one bolt has borne, for summary.json.
struct BoltLoad {
  BoltHistoryRow last;    ///< its last row
  double time = 0.0;      ///< of it, s
  double axial = 0.0;     ///< largest tension so far, N
  double shear = 0.0;     ///< N
  double installed = 0.0; ///< when it was put in last, s; the next two are not known to the history
  bool in_place = false;
  std::string support;
};

/// A largest value and the middle of the element that has it.
struct LinerPeak {
  double value = 0.0;
  Vec2 where; ///< m
};

/// One row of history/liners.csv: largest values over the elements of one liner, per metre of tunnel.
struct LinerHistoryRow {
  std::string name;
  std::int64_t elements = 0;
  LinerPeak compression;      ///< thrust, N/m
  LinerPeak tension;          ///< N/m
  LinerPeak moment;           ///< absolute value at the ends of elements, N
  LinerPeak shear;            ///< absolute value, N/m
  double strength_used = 0.0; ///< largest share
  std::int64_t cracked = 0;   ///< elements
  std::int64_t yielded = 0;
  std::int64_t broken = 0;
  /// Of the steps so far.
  double largest_compression = 0.0; ///< N/m
  double largest_tension = 0.0;     ///< N/m
  double largest_moment = 0.0;      ///< N
  double largest_shear = 0.0;       ///< N/m
  double largest_strength_used = 0.0;
};

/// What one liner has borne, for summary.json.
struct LinerLoad {
  LinerHistoryRow last;     ///< its last row
  double time = 0.0;        ///< of it, s
  double compression = 0.0; ///< largest so far, as the next ones
  double tension = 0.0;
  double moment = 0.0;
  double shear = 0.0;
  double strength_used = 0.0;
  double installed = 0.0; ///< when it was put in last, s; the next two are not known to the history
  bool in_place = false;
  std::string support;
};

/// What a joint set of the region asks and what it has drawn.
struct JointSetSummary {
  std::string name;
  JointSetMeasures asked;
  std::optional<JointSetMeasures> drawn; ///< none where a set has too many joints to measure
  std::int64_t joints = 0;               ///< with a part in the region
  std::int64_t lines = 0;                ///< lines of joints that cross the region
};

/// Everything summary.json holds.
struct RunSummary {
  std::string version; ///< of the program that has written the last part of the run
  std::string command; ///< its command line, as a shell reads it
  int ranks = 1;
  std::int64_t blocks = 0;
  std::int64_t fixed_blocks = 0;
  std::int64_t steps = 0;
  double time = 0.0;
  double time_step = 0.0;
  double time_step_min = 0.0;
  std::int64_t contacts = 0;
  std::int64_t contact_steps = 0;
  std::vector<std::int64_t> evaluations_per_rank;
  std::vector<std::int64_t> work_per_rank;   ///< evaluations and blocks, summed over steps
  std::vector<std::int64_t> ghosts_per_rank; ///< at the end
  double wall_s = 0.0;
  double cpu_s = 0.0;
  double setup_wall_s = 0.0;
  double output_wall_s = 0.0;
  double total_wall_s = 0.0;
  double max_overlap = 0.0;
  double permanent_displacement = -1.0; ///< m, largest since the ground began to shake; negative: it did not
  std::string permanent_block;          ///< the one that has moved so far
  EnergyRow energy;
  double imbalance = 1.0;
  double bytes_sent_per_step = 0.0;
  double messages_per_step = 0.0;
  /// name, {min, mean, max over ranks} in wall seconds
  std::vector<std::pair<std::string, std::array<double, 3>>> phases;
  /// name, count: extra facts a test or a person may want (migrations, refreshes, cross_rank_contacts, ...)
  std::vector<std::pair<std::string, double>> counters;
  double restarted_at = -1.0; ///< s, negative for a run from t = 0; times and counters "of the run" then are
                              ///< of all of it, wall and CPU times, evaluations and messages of this part
  /// A stage that has begun.
  struct StageLine {
    std::string name;
    std::string verdict;
    StageResult result;
    std::string slid_block; ///< name of the one of StageResult::slid_block
  };
  std::vector<JointSetSummary> joint_sets;
  std::vector<BoltLoad> bolts;   ///< those that have been in place
  std::vector<LinerLoad> liners; ///< those that have been in place
  std::vector<StageLine> stages; ///< those that have begun; none in a scene without stages
  std::string verdict;
  std::string message;
};

} // namespace gcpdda
