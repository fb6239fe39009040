#include "simulation/saved_state.hpp"

#include "base/check.hpp"
#include "io/checkpoint/checkpoint_reader.hpp"
#include "io/checkpoint/past_scenes.hpp"
#include "io/results/id_slabs.hpp"
#include "model/fingerprint.hpp"
#include "simulation/stage_changes.hpp"
#include "simulation/static_stage.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

namespace gcpdda {

namespace {

/// By the number of the stage that a state is in.
std::vector<ScenePrints> prints_by_stage(const Scene &start, std::span<const Stage> stages) {
  std::vector<ScenePrints> prints;
  for (std::size_t k = 0; k < stages.size(); ++k) {
    prints.push_back(fingerprints(start, stages.first(k + 1)));
  }
  return prints;
}

void expect_own_state(const RunState &run, const ScenePrints &saved, std::int64_t stage,
                      std::span<const std::uint64_t> past) {
  if (std::find(past.begin(), past.end(), fingerprint(saved)) != past.end()) {
    return;
  }
  if (stage >= std::min(std::ssize(run.prints), std::ssize(run.prints_before))) {
    throw FileError("its stage is not in the scene");
  }
  const ScenePrints &own = run.prints_before[static_cast<std::size_t>(stage)];
  std::string different;
  for (std::size_t part = 0; part < own.size(); ++part) {
    if (saved[part] != own[part]) {
      different += (different.empty() ? "" : ", ") + std::string(scene_parts[part]);
    }
  }
  if (!different.empty()) {
    throw FileError("it is of another scene: " + different +
                    " had other values when it was computed; a change that is meant goes into gcpdda restart "
                    "--set, not into scene.toml");
  }
}

void begin_as_restored(RunState &run, const Scene &start, const BlockSystem &rows, const StageState &saved,
                       const RunFacts &facts) {
  run.scene = start;
  run.loads.list_courses(run.scene, run.clock.stages);
  run.blocks = rows;
  run.clock.state = {};
  if (saved.index >= std::ssize(run.clock.stages)) {
    throw FileError("its stage is not in the scene");
  }
  for (std::int64_t k = 0; k <= saved.index; ++k) {
    adopt(run, run.clock.stages[static_cast<std::size_t>(k)], start_of_stage(k, saved));
  }
  remove_blocks(run, saved.removed);
  run.clock.state = saved;
  run.bolts = Bolts::from_numbers(facts.bolt_counts, facts.bolt_numbers);
  run.saved_statics = to_static_state(facts.static_counts, facts.static_numbers);
  for (const BoltLink &link : run.bolts.links()) {
    const bool is_known = link.liner < 0 ? link.bolt >= 0 && link.bolt < std::ssize(run.scene.bolts)
                                         : link.bolt == -1 && link.liner < std::ssize(run.scene.liners);
    if (!is_known) {
      throw FileError("a bolt or liner of it is not in the scene");
    }
  }
  list_applied(run.blocks, !run.scene.water.empty() || !run.clock.state.unloading.empty());
  run.blocks.body = {{facts.gravity_x, facts.gravity_y}, {facts.shaking_x, facts.shaking_y}};
}

} // namespace

void take_prints(RunState &run, const Beginning &beginning) {
  run.prints = prints_by_stage(run.scene, run.clock.stages);
  if (beginning.computed_with == nullptr) {
    run.prints_before = run.prints;
    return;
  }
  Scene before = *beginning.computed_with;
  before.earthquake.record = run.scene.earthquake.record; // another one of this name is another earthquake
  const std::vector<Stage> stages = std::exchange(before.stages, {});
  run.prints_before = prints_by_stage(before, stages.empty() ? std::vector<Stage>(1) : stages);
}

std::vector<std::uint64_t> changed_from(const RunState &run) {
  std::vector<std::uint64_t> prints;
  if (run.prints_before != run.prints) {
    std::transform(run.prints_before.begin(), run.prints_before.end(), std::back_inserter(prints),
                   [](const ScenePrints &parts) { return fingerprint(parts); });
  }
  return prints;
}

void restore(RunState &run, const Beginning &beginning, ContactMemory &memory) {
  std::vector<std::uint64_t> past;
  if (run.communicator.is_root()) {
    past = past_scenes(beginning.folder);
  }
  past = run.communicator.all_gather(past).front();
  const Scene start = run.scene;
  const BlockSystem begin = run.blocks;
  const auto prepare = [&](const RunFacts &facts) {
    const StageState saved = to_state({facts.stage_counts, facts.stage_numbers});
    expect_own_state(run, facts.scene.parts, saved.index, past);
    begin_as_restored(run, start, begin, saved, facts);
  };
  run.restored = restore_newest_checkpoint(run.communicator, beginning.folder, run.identity, run.blocks,
                                           prepare, beginning.results);
  memory.others = std::move(run.restored->memory);
}

void identify(RunState &run, std::span<const SceneBlock> slab) {
  const std::int64_t first =
      slab_begin(num_blocks(run.scene), run.communicator.size(), run.communicator.rank());
  std::uint64_t sum = 0;
  for (std::size_t k = 0; k < slab.size(); ++k) {
    sum += fingerprint(first + static_cast<std::int64_t>(k), slab[k]);
  }
  // Modulo 2^64, in halves that cannot overflow.
  std::array<std::int64_t, 3> parts{
      static_cast<std::int64_t>(sum & 0xffffffffU), static_cast<std::int64_t>(sum >> 32),
      std::count_if(slab.begin(), slab.end(), [](const SceneBlock &block) { return !block.fixed; })};
  run.communicator.sum(parts);
  run.identity = {num_blocks(run.scene),
                  parts[2],
                  static_cast<std::uint64_t>(parts[0]) + (static_cast<std::uint64_t>(parts[1]) << 32),
                  fingerprint(run.scene.materials),
                  {}};
}

void go_on(RunState &run) {
  const RunFacts &facts = run.restored->facts;
  run.clock.step_count = run.clock.state.ended ? facts.step : run.clock.state.first_step;
  if (!run.clock.state.ended) {
    run.clock.step_count += step_to_go_on_from(
        run.clock.plan, facts.time - run.clock.state.start_time - run.clock.state.iteration.skipped,
        facts.time_step, run.notes);
  }
  run.loads.time = run.clock.stage_step() == 0
                       ? run.clock.time()
                       : run.clock.state.start_time + run.clock.state.iteration.skipped +
                             run.clock.plan.time(run.clock.stage_step() - 1) +
                             run.scheme.load_time * run.clock.plan.time_step;
  run.counters.contact_steps = run.communicator.is_root() ? facts.contact_steps : 0;
  run.counters.max_overlap = facts.max_overlap;
  run.counters.max_overlap_share = facts.max_overlap_share;
  run.counters.fastest_turn = facts.fastest_turn;
}

RunFacts facts_of(const RunState &run) {
  RunFacts facts;
  facts.scene = run.identity;
  facts.scene.parts = run.prints[static_cast<std::size_t>(run.clock.state.index)];
  facts.more_mobile = run.clock.state.more_mobile;
  facts.step = run.clock.step_count;
  StageNumbers numbers = to_numbers(run.clock.state);
  facts.stage_counts = std::move(numbers.counts);
  facts.stage_numbers = std::move(numbers.reals);
  Bolts::to_numbers(run.bolts.shared(run.communicator), facts.bolt_counts, facts.bolt_numbers);
  if (is_static(run) && run.statics) {
    StaticNumbers state = to_numbers(gathered_state(run.communicator, run.blocks, run.statics->springs()));
    facts.static_counts = std::move(state.counts);
    facts.static_numbers = std::move(state.reals);
  }
  facts.time = run.clock.time();
  facts.time_step = run.clock.plan.time_step;
  facts.contact_steps = run.counters.contact_steps;
  run.communicator.sum(std::span(&facts.contact_steps, 1));
  std::array<double, 3> largest{run.counters.max_overlap, run.counters.max_overlap_share,
                                run.counters.fastest_turn};
  run.communicator.max(largest);
  facts.max_overlap = largest[0];
  facts.max_overlap_share = largest[1];
  facts.fastest_turn = largest[2];
  facts.gravity_x = run.blocks.body.gravity.x;
  facts.gravity_y = run.blocks.body.gravity.y;
  facts.shaking_x = run.blocks.body.shaking.x;
  facts.shaking_y = run.blocks.body.shaking.y;
  return facts;
}

} // namespace gcpdda
