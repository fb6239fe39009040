#include "simulation/loose_blocks.hpp"

#include "base/exact_sum.hpp"
#include "model/generators.hpp"
#include "simulation/stages.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>

namespace gcpdda {

bool is_loose(const BlockLook &block, const Stage &stage, const StageLook &look) {
  return block.unbalanced > stage.tolerance * block.yardstick || block.motion > motion_at_rest * look.overlap;
}

// One reduction of integers: sums of them are exact.
void look_for_loose_blocks(RunState &run, StageLook &look) {
  const Stage &stage = run.clock.stage();
  std::int64_t num_mobile = 0;
  std::int64_t num_loose = 0;
  ExactSum load;
  ExactSum unbalanced;
  ExactSum kinetic;
  for (std::size_t row = 0; row < run.blocks.num_owned; ++row) {
    const BlockLook &block = run.looks[row];
    if (run.blocks.properties[row].keeps_its_velocity()) {
      continue;
    }
    ++num_mobile;
    load.add(block.load);
    if (is_loose(block, stage, look)) {
      ++num_loose;
      unbalanced.add(block.unbalanced);
    } else {
      kinetic.add(block.kinetic);
    }
  }
  std::vector<std::int64_t> &sums = run.look_sums;
  sums.clear();
  for (ExactSum *sum : {&load, &unbalanced, &kinetic}) {
    sums.insert(sums.end(), sum->limbs().begin(), sum->limbs().end());
  }
  sums.insert(sums.end(), {num_mobile, num_loose});
  run.communicator.sum(std::span(sums));
  const std::int64_t *next = sums.data();
  for (ExactSum *sum : {&load, &unbalanced, &kinetic}) {
    std::copy_n(next, ExactSum::num_limbs, sum->limbs().begin());
    next += ExactSum::num_limbs;
  }
  const double all = std::max(load.value(), look.force);
  look.loose_share = next[0] > 0 ? static_cast<double>(next[1]) / static_cast<double>(next[0]) : 0.0;
  look.loose_load = all > 0.0 ? unbalanced.value() / all : 0.0;
  look.resting_kinetic = kinetic.value();
}

namespace {

/// Ids of the loose blocks of the last look, ascending, of all ranks. Collective.
std::vector<std::int64_t> loose_blocks(const RunState &run) {
  std::vector<std::int64_t> mine;
  for (std::size_t row = 0; row < run.blocks.num_owned; ++row) {
    if (!run.blocks.properties[row].keeps_its_velocity() &&
        is_loose(run.looks[row], run.clock.stage(), run.clock.state.memory.last)) {
      mine.push_back(run.blocks.properties[row].id.value);
    }
  }
  std::vector<std::int64_t> ids;
  for (const std::vector<std::int64_t> &of_rank : run.communicator.all_gather(mine)) {
    ids.insert(ids.end(), of_rank.begin(), of_rank.end());
  }
  std::sort(ids.begin(), ids.end());
  return ids;
}

} // namespace

void note_loose_blocks(RunState &run) {
  const std::vector<std::int64_t> ids = loose_blocks(run);
  run.clock.state.memory.num_loose = std::ssize(ids);
  if (ids.empty()) { // those that were loose in a look before are at rest in this one
    return;
  }
  constexpr std::size_t most_named = 8;
  std::string names;
  for (std::size_t k = 0; k < std::min(ids.size(), most_named); ++k) {
    names += fmt::format("{}'{}'", k == 0 ? "" : ", ", block_name(run.scene, ids[k]));
  }
  run.notes.push_back(
      {Severity::info, run.clock.stage().where,
       fmt::format("stage '{}' has settled but for {} loose block{}: {}{}", run.clock.stage().name,
                   ids.size(), ids.size() == 1 ? "" : "s", names, ids.size() > most_named ? ", ..." : ""),
       "they keep moving while all others are at rest, and carry too little to hold up the stage",
       "look at them in the frames; they go on moving in the next stage"});
}

void note_loose_blocks_at_end(RunState &run) {
  const StageState &state = run.clock.state;
  if (state.ended && state.verdict == Verdict::settled && !run.clock.stage().is_trial() &&
      state.memory.settled_looks < 2) {
    note_loose_blocks(run);
  }
}

} // namespace gcpdda
