#include "simulation/excavation_doubts.hpp"

#include "geometry/holds_point.hpp"
#include "model/generators.hpp"
#include "simulation/cut_bolts.hpp"
#include "simulation/loads.hpp"
#include "simulation/stage_changes.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fmt/format.h>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace gcpdda {

namespace {

/// Blocks whose centroids lie on the outline of an excavation, but for a hair's breadth.
struct OnOutline {
  std::int64_t count = 0;
  std::int64_t first = std::numeric_limits<std::int64_t>::max(); ///< least id
};

/// Collective.
OnOutline blocks_on_outline(const RunState &run, const Stage &stage) {
  constexpr double hair = 1e-3; // of a block's size
  OnOutline mine;
  for (std::size_t row = 0; row < run.blocks.num_rows(); ++row) {
    const BlockProperties &block = run.blocks.properties[row];
    const bool counts = row < run.blocks.num_owned ||
                        (run.blocks.is_fixed(row) && run.communicator.is_root()); // all ranks have them
    if (counts &&
        !std::binary_search(stage.excavated.blocks.begin(), stage.excavated.blocks.end(), block.id.value) &&
        distance_to_boundary(stage.excavated.region, run.blocks.centroid(row)) <
            hair * std::sqrt(block.area)) {
      ++mine.count;
      mine.first = std::min(mine.first, block.id.value);
    }
  }
  OnOutline all;
  for (const auto &theirs : run.communicator.all_gather(std::vector<OnOutline>{mine})) {
    all.count += theirs.front().count;
    all.first = std::min(all.first, theirs.front().first);
  }
  return all;
}

} // namespace

void doubt_outlines(RunState &run) {
  for (const Stage &stage : run.clock.stages) {
    if (stage.excavated.region.empty()) {
      continue;
    }
    const OnOutline found = blocks_on_outline(run, stage);
    if (found.count > 0) {
      run.notes.push_back(
          {Severity::warning, stage.where,
           fmt::format(
               "the outline of 'region' in stage '{}' passes through the centroids of {} block{}, the "
               "first is '{}'",
               stage.name, found.count, found.count == 1 ? "" : "s", block_name(run.scene, found.first)),
           "a region removes the blocks whose centroids lie in it, so that it depends on hair's breadths "
           "which of these go",
           "move the outline away from the centroids, or name the blocks in 'blocks'"});
    }
  }
}

void doubt_monitors(RunState &run) {
  std::vector<bool> has_ended(run.scene.monitors.size(), false); // by an earlier stage
  for (const Stage &stage : run.clock.stages) {
    const std::vector<std::int64_t> ids = select_blocks(run, stage.excavated);
    for (std::size_t m = 0; m < run.scene.monitors.size(); ++m) {
      const Monitor &monitor = run.scene.monitors[m];
      if (!monitor.is_on_profile && !has_ended[m] &&
          std::binary_search(ids.begin(), ids.end(), monitor.block)) {
        has_ended[m] = true;
        run.notes.push_back({Severity::warning, monitor.where,
                             fmt::format("monitor '{}' follows block '{}', which stage '{}' excavates",
                                         monitor.name, block_name(run.scene, monitor.block), stage.name),
                             "its history ends there",
                             "monitor a block that stays, or move the point out of the opening"});
      }
    }
  }
}

void doubt_loads(RunState &run) {
  std::map<std::int64_t, std::string> excavated_by; // names of the stages, by block
  const std::vector<SceneBlock> *before = &run.scene.blocks;
  for (const Stage &stage : run.clock.stages) {
    for (const std::int64_t id : select_blocks(run, stage.excavated)) {
      excavated_by.emplace(id, stage.name);
    }
    if (!stage.after) {
      continue;
    }
    const std::vector<SceneBlock> &blocks = stage.after->blocks;
    for (std::size_t i = 0; i < blocks.size(); ++i) {
      const auto gone = excavated_by.find(static_cast<std::int64_t>(i));
      if (gone != excavated_by.end() && !blocks[i].loads.empty() &&
          !same_loads((*before)[i].loads, blocks[i].loads)) {
        run.notes.push_back({Severity::warning, stage.where,
                             fmt::format("stage '{}' sets 'load' of block '{}', which stage '{}' excavates",
                                         stage.name, blocks[i].name, gone->second),
                             "the load acts on no block",
                             "load a block that stays, or set the load in a stage before the excavation"});
      }
    }
    before = &blocks;
  }
}

// Bolts and rock as the stages leave them, on blocks that have not moved.
void doubt_bolts(RunState &run) {
  const auto excavates = [](const Stage &stage) { return stage.kind == StageKind::excavate; };
  if (run.scene.bolts.empty() || std::none_of(run.clock.stages.begin(), run.clock.stages.end(), excavates)) {
    return;
  }
  Bolts bolts = run.bolts;
  std::set<std::int64_t> gone;
  const auto is_gone = [&](std::int64_t id) { return gone.contains(id); };
  const Scene *before = &run.scene;
  for (const Stage &stage : run.clock.stages) {
    const Scene &scene = stage.after ? *stage.after : *before;
    if (excavates(stage)) {
      std::vector<std::int64_t> ids = select_blocks(run, stage.excavated);
      std::erase_if(ids, is_gone);
      CutBolts cut = cut_bolts(run, *before, bolts, ids);
      cut.forget([&](std::int32_t bolt) { return !scene.bolts[static_cast<std::size_t>(bolt)].active; });
      warn_of_cuts(run, stage, cut);
      gone.insert(ids.begin(), ids.end());
      bolts.end_at_voids(is_gone);
    }
    Diagnostics said_later; // when the stage puts bolts in
    change_bolts(run, scene, before->bolts, is_gone, bolts, said_later);
    before = &scene;
  }
}

} // namespace gcpdda
