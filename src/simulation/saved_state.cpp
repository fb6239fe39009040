// What a Simulation gives to a checkpoint and takes from one. Physics does not depend on when the
// neighbourhood was refreshed (a candidate that does not touch adds nothing, sums go in the order of ids), so
// a run goes on from its blocks and the memory of its contacts alone: a restart begins with a refresh.

#include "base/check.hpp"
#include "gcpdda/io/result_files.hpp"
#include "model/fingerprint.hpp"
#include "simulation/simulation.hpp"

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

} // namespace

void Simulation::take_prints(const Beginning &beginning) {
  prints_ = prints_by_stage(scene_, stages_);
  if (beginning.computed_with == nullptr) {
    prints_before_ = prints_;
    return;
  }
  Scene before = *beginning.computed_with;
  before.earthquake.record = scene_.earthquake.record; // another one of this name is another earthquake
  const std::vector<Stage> stages = std::exchange(before.stages, {});
  prints_before_ = prints_by_stage(before, stages.empty() ? std::vector<Stage>(1) : stages);
}

std::vector<std::uint64_t> Simulation::changed_from() const {
  std::vector<std::uint64_t> prints;
  if (prints_before_ != prints_) {
    std::transform(prints_before_.begin(), prints_before_.end(), std::back_inserter(prints),
                   [](const ScenePrints &parts) { return fingerprint(parts); });
  }
  return prints;
}

void Simulation::expect_own_state(const ScenePrints &saved, std::int64_t stage,
                                  std::span<const std::uint64_t> past) const {
  if (std::find(past.begin(), past.end(), fingerprint(saved)) != past.end()) {
    return;
  }
  if (stage >= std::min(std::ssize(prints_), std::ssize(prints_before_))) {
    throw FileError("its stage is not in the scene");
  }
  const ScenePrints &own = prints_before_[static_cast<std::size_t>(stage)];
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

void Simulation::restore(const Beginning &beginning, ContactMemory &memory) {
  std::vector<std::uint64_t> past;
  if (communicator_.is_root()) {
    past = past_scenes(beginning.folder);
  }
  past = communicator_.all_gather(past).front();
  const Scene start = scene_;
  const BlockSystem begin = blocks_;
  const auto prepare = [&](const RunFacts &facts) {
    const StageState saved = to_state({facts.stage_counts, facts.stage_numbers});
    expect_own_state(facts.scene.parts, saved.index, past);
    begin_as_restored(start, begin, saved, facts);
  };
  restored_ = restore_newest_checkpoint(communicator_, beginning.folder, identity_, blocks_, prepare,
                                        beginning.results);
  memory.others = std::move(restored_->memory);
}

void Simulation::identify(std::span<const SceneBlock> slab) {
  const std::int64_t first = slab_begin(num_blocks(), communicator_.size(), communicator_.rank());
  std::uint64_t sum = 0;
  for (std::size_t k = 0; k < slab.size(); ++k) {
    sum += fingerprint(first + static_cast<std::int64_t>(k), slab[k]);
  }
  // Modulo 2^64, in halves that cannot overflow.
  std::array<std::int64_t, 3> parts{
      static_cast<std::int64_t>(sum & 0xffffffffU), static_cast<std::int64_t>(sum >> 32),
      std::count_if(slab.begin(), slab.end(), [](const SceneBlock &block) { return !block.fixed; })};
  communicator_.sum(parts);
  identity_ = {num_blocks(),
               parts[2],
               static_cast<std::uint64_t>(parts[0]) + (static_cast<std::uint64_t>(parts[1]) << 32),
               fingerprint(scene_.materials),
               {}};
}

void Simulation::go_on() {
  const RunFacts &facts = restored_->facts;
  step_count_ = stage_.ended ? facts.step : stage_.first_step;
  if (!stage_.ended) {
    step_count_ += step_to_go_on_from(plan_, facts.time - stage_.start_time - stage_.iteration.skipped,
                                      facts.time_step, notes_);
  }
  load_time_ = stage_step() == 0 ? time()
                                 : stage_.start_time + stage_.iteration.skipped +
                                       plan_.time(stage_step() - 1) + scheme_.load_time * plan_.time_step;
  counters_.contact_steps = communicator_.is_root() ? facts.contact_steps : 0;
  counters_.max_overlap = facts.max_overlap;
  counters_.max_overlap_share = facts.max_overlap_share;
  counters_.fastest_turn = facts.fastest_turn;
}

RunFacts Simulation::facts() const {
  RunFacts facts;
  facts.scene = identity_;
  facts.scene.parts = prints_[static_cast<std::size_t>(stage_.index)];
  facts.more_mobile = stage_.more_mobile;
  facts.step = step_count_;
  StageNumbers numbers = to_numbers(stage_);
  facts.stage_counts = std::move(numbers.counts);
  facts.stage_numbers = std::move(numbers.reals);
  Bolts::to_numbers(bolts_.shared(communicator_), facts.bolt_counts, facts.bolt_numbers);
  if (is_static() && statics_) {
    StaticNumbers state = gcpdda::to_numbers(gathered_state(communicator_, blocks_, statics_->springs()));
    facts.static_counts = std::move(state.counts);
    facts.static_numbers = std::move(state.reals);
  }
  facts.time = time();
  facts.time_step = plan_.time_step;
  facts.contact_steps = counters_.contact_steps;
  communicator_.sum(std::span(&facts.contact_steps, 1));
  std::array<double, 3> largest{counters_.max_overlap, counters_.max_overlap_share, counters_.fastest_turn};
  communicator_.max(largest);
  facts.max_overlap = largest[0];
  facts.max_overlap_share = largest[1];
  facts.fastest_turn = largest[2];
  facts.gravity_x = blocks_.body.gravity.x;
  facts.gravity_y = blocks_.body.gravity.y;
  facts.shaking_x = blocks_.body.shaking.x;
  facts.shaking_y = blocks_.body.shaking.y;
  return facts;
}

RegionRecord Simulation::record_of(std::size_t pair, const RegionMemory &region) const {
  return {blocks_.properties[candidates_.pairs[pair].lower.value].id,
          blocks_.properties[candidates_.pairs[pair].higher.value].id, region};
}

ContactMemory Simulation::remembered_contacts() const {
  ContactMemory memory;
  memory.plain.reserve(history_.num_plain());
  for (std::size_t k = 0; k < candidates_.pairs.size(); ++k) {
    const CandidatePair &pair = candidates_.pairs[k];
    const bool deforms = blocks_.is_deformable(pair.lower.value) ||
                         blocks_.is_deformable(pair.higher.value); // has a grip, too
    if (history_.has_plain(k) && !deforms) {
      memory.plain.push_back({blocks_.properties[pair.lower.value].id,
                              blocks_.properties[pair.higher.value].id, history_.plain[k]});
    } else {
      history_.for_pair(k,
                        [&](const RegionMemory &region) { memory.others.push_back(record_of(k, region)); });
    }
  }
  return memory;
}

} // namespace gcpdda
