#pragma once

// The ground motion of a run and the sides through which it comes and goes (dynamics/ground_motion.hpp,
// dynamics/viscous_sides.hpp).

#include "simulation/run_state.hpp"
#include "simulation/side_rock.hpp"

#include <cstdint>
#include <optional>
#include <vector>

namespace gcpdda {

/// The time from its first row at which the record has ceased to move the ground otherwise than evenly, s.
[[nodiscard]] double end_of_shaking(const Earthquake &earthquake);
/// Reads the record; faults and remarks become notes. Collective.
void open_earthquake(RunState &run);
/// At the time of the loads; zero before the shaking.
[[nodiscard]] Vec2 ground_acceleration(const RunState &run);
[[nodiscard]] Vec2 incoming_wave(const RunState &run);

/// Of the row that was appended last, as the scene draws it.
void add_dashpot(RunState &run, const SceneBlock &block, const SideRock &rock);
/// Matrices of all rows for the stage that begins, in which dashpots are awake or not.
void prepare_matrices(RunState &run);

/// The stage that begins lets waves out.
[[nodiscard]] bool opens_viscous_sides(const RunState &run);
/// Fixed blocks beyond a viscous side held it so far; what they held with stays (Unloading).
[[nodiscard]] std::vector<std::int64_t> held_beyond_viscous_sides(const RunState &run);

/// How far the block is that has gone farthest; of several the one with the smallest id.
struct FarthestBlock {
  double distance = 0.0; ///< of its centroid, m
  std::int64_t block = 0;
};
/// Before the marks of the stage that has just begun: remembers where blocks were when the stage before it
/// began, if the ground has begun to shake in that stage.
void keep_unshaken(RunState &run);
[[nodiscard]] bool has_begun_to_shake(const RunState &run);
/// Whether the ground shakes, or will in the stage at hand, which is a run: blocks at rest have not settled.
[[nodiscard]] bool is_to_shake(const RunState &run);
/// At the end of a run, of a record that `start` sets to go on longer.
[[nodiscard]] std::optional<Diagnostic> warning_of_cut_record(const RunState &run);
/// Motion against the ground since the stage began in which the ground began to shake, or since t = 0 in a
/// scene without stages; nothing before the shaking. Collective.
[[nodiscard]] std::optional<FarthestBlock> permanent_displacement(const RunState &run);

} // namespace gcpdda
