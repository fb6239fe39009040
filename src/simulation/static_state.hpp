#pragma once

// What a checkpoint holds of a stage with the static solver, besides StageState::iteration: the motions of
// the blocks and the springs of their contacts, as numbers of all ranks. There are none while no stage has
// that solver.

#include "gcpdda/parallel/communicator.hpp"
#include "statics/springs.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace gcpdda {

struct StaticState {
  std::vector<std::int64_t> blocks; ///< ids, ascending
  std::vector<PseudoMotion> motions;
  std::vector<statics::SpringRecord> springs; ///< by the ids of their blocks
};

struct StaticNumbers {
  std::vector<std::int64_t> counts;
  std::vector<double> reals;
};

/// The state of all ranks. Collective.
StaticState gathered_state(const Communicator &communicator, const BlockSystem &blocks,
                           const statics::ContactSprings &springs);
StaticNumbers to_numbers(const StaticState &state);
/// @throws FileError where the numbers are not those of a state
StaticState to_static_state(std::span<const std::int64_t> counts, std::span<const double> reals);

} // namespace gcpdda
