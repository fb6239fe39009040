#pragma once

// Bolts that an excavation takes away or leaves with less hold: warnings.

#include "simulation/run_state.hpp"

#include <cstdint>
#include <functional>
#include <set>
#include <vector>

namespace gcpdda {

/// What an excavation does to bolts, by index into Scene::bolts.
struct CutBolts {
  std::set<std::int32_t> taken_away;    ///< their last link goes
  std::set<std::int32_t> without_plate; ///< the block at their face plate goes
  std::set<std::int32_t> crossed;       ///< cables through the opening, both ends of which stay

  /// Leave out the bolts for which it holds.
  void forget(const std::function<bool(std::int32_t)> &is_known);
};

/// Of the run's bolts, in the posed trial configuration. Collective.
/// @param ids  of the excavated blocks, ascending
[[nodiscard]] CutBolts cut_bolts(const RunState &run, const std::vector<std::int64_t> &ids);
/// Of bolts that hold the blocks where the scene draws both. Collective.
/// @param scene  of the stage
[[nodiscard]] CutBolts cut_bolts(const RunState &run, const Scene &scene, const Bolts &bolts,
                                 const std::vector<std::int64_t> &ids);

/// One warning for each kind, unless it has been given.
void warn_of_cuts(RunState &run, const Stage &stage, const CutBolts &cut);

} // namespace gcpdda
