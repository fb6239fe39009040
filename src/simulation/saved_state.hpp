#pragma once

// What a run gives to a checkpoint and takes from one. Physics does not depend on when the
// neighbourhood was refreshed (a candidate that does not touch adds nothing, sums go in the order of ids), so
// a run goes on from its blocks and the memory of its contacts alone: a restart begins with a refresh.

#include "simulation/run_state.hpp"

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

namespace gcpdda {

/// Where a run begins.
struct Beginning {
  std::filesystem::path folder{};       ///< with whose newest checkpoint; empty: at t = 0
  const Scene *computed_with = nullptr; ///< that state, as it was read; null: the scene of the run
  EarlierResults results = EarlierResults::are_not_looked_at; ///< of that folder
};

/// Fingerprints of the scene as it was read.
void take_prints(RunState &run, const Beginning &beginning);
/// What a checkpoint must agree with, of the blocks of all slabs. Collective.
void identify(RunState &run, std::span<const SceneBlock> slab);
/// Blocks, stage and bolts as the newest checkpoint that fits has them; run.restored. Rows are those of the
/// slab. Collective.
/// @throws FileError
void restore(RunState &run, const Beginning &beginning, ContactMemory &memory);
/// Clock and counters of what has been restored.
void go_on(RunState &run);

/// The scene of the state the run began with was another one: its fingerprints by stage, else none.
[[nodiscard]] std::vector<std::uint64_t> changed_from(const RunState &run);
/// Everything a checkpoint holds besides the blocks and their contacts, but what the output knows.
/// Collective.
[[nodiscard]] RunFacts facts_of(const RunState &run);

} // namespace gcpdda
