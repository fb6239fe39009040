#include "simulation/excavation_doubts.hpp"

#include "model/generators.hpp"
#include "simulation/cut_bolts.hpp"
#include "simulation/loads.hpp"
#include "simulation/stage_changes.hpp"

#include <algorithm>
#include <cstdint>
#include <fmt/format.h>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace gcpdda {

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
