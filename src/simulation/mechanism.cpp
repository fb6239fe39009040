#include "simulation/mechanism.hpp"

#include "base/exact_sum.hpp"
#include "geometry/holds_point.hpp"
#include "simulation/loose_blocks.hpp"
#include "simulation/stage_runner.hpp"
#include "simulation/stages.hpp"

#include <algorithm>
#include <array>
#include <limits>

namespace gcpdda {

namespace {

/// A watched block that has moved farther than a pile sags.
struct Mover {
  double moved = 0.0; ///< in sizes of the block
  std::int64_t block = 0;
  double area = 0.0; ///< m^2
};

bool is_before(const Mover &a, const Mover &b) {
  return a.moved != b.moved ? a.moved > b.moved : a.block < b.block;
}

/// Movers in order up to and with the one with which their area reaches `area`.
void cut_at(double area, std::vector<Mover> &movers) {
  std::sort(movers.begin(), movers.end(), is_before);
  double sum = 0.0;
  const auto reaches = [&](const Mover &mover) { return (sum += mover.area) >= area; };
  const auto last = std::find_if(movers.begin(), movers.end(), reaches);
  movers.erase(last == movers.end() ? last : std::next(last), movers.end());
}

bool is_watched(const RunState &run, std::size_t row) {
  const std::vector<Vec2> &region = run.clock.stage().watched_region;
  return !run.blocks.properties[row].keeps_its_velocity() &&
         (region.empty() ||
          holds_point(region, run.blocks.properties[row].centroid + run.blocks.mark_of(row).stage.u));
}

/// Which blocks are left out.
struct LeftOut {
  Mover first_kept; ///< the first one in order that is not
  double area = 0.0;

  [[nodiscard]] bool has(const Mover &mover) const { return is_before(mover, first_kept); }
};

// Each rank's first movers hold all that come first of all ranks; their areas are added in that order.
LeftOut find_left_out(const RunState &run, const std::vector<char> &watched) {
  const double ignored = run.clock.stage().ignored_area;
  std::vector<Mover> mine;
  for (std::size_t row = 0; row < run.blocks.num_owned; ++row) {
    if (watched[row] != 0 && run.looks[row].beyond_sag) {
      mine.push_back(
          {run.looks[row].moved, run.blocks.properties[row].id.value, run.blocks.properties[row].area});
    }
  }
  cut_at(ignored, mine);
  std::vector<Mover> all;
  for (const std::vector<Mover> &of_rank : run.communicator.all_gather(mine)) {
    all.insert(all.end(), of_rank.begin(), of_rank.end());
  }
  std::sort(all.begin(), all.end(), is_before);
  LeftOut left_out{{-1.0, std::numeric_limits<std::int64_t>::max(), 0.0}, 0.0};
  for (const Mover &mover : all) {
    if (left_out.area + mover.area >= ignored) {
      left_out.first_kept = mover;
      break;
    }
    left_out.area += mover.area;
  }
  return left_out;
}

StageLook look_at_others(const RunState &run, const StageLook &of_all) {
  std::vector<char> watched(run.blocks.num_owned);
  for (std::size_t row = 0; row < run.blocks.num_owned; ++row) {
    watched[row] = is_watched(run, row) ? 1 : 0;
  }
  const LeftOut left_out = find_left_out(run, watched);
  std::array<double, 4> largest{};
  auto &[ratio, motion, moved, moved_beyond_sag] = largest;
  ExactSum kinetic;
  ExactSum resting;
  ExactSum loose;
  for (std::size_t row = 0; row < run.blocks.num_owned; ++row) {
    const BlockLook &block = run.looks[row];
    const BlockProperties &properties = run.blocks.properties[row];
    if (watched[row] == 0 ||
        (block.beyond_sag && left_out.has({block.moved, properties.id.value, properties.area}))) {
      continue;
    }
    ratio = std::max(ratio, block.yardstick > 0.0 ? block.unbalanced / block.yardstick : 0.0);
    motion = std::max(motion, block.motion);
    moved = std::max(moved, block.moved);
    moved_beyond_sag = std::max(moved_beyond_sag, block.beyond_sag ? block.moved : 0.0);
    kinetic.add(block.kinetic);
    if (is_loose(block, run.clock.stage(), of_all)) {
      loose.add(properties.area);
    } else {
      resting.add(block.kinetic);
    }
  }
  run.communicator.max(largest);
  for (ExactSum *sum : {&kinetic, &resting, &loose}) {
    run.communicator.sum(sum->limbs());
  }
  StageLook look = of_all;
  look.unbalanced_ratio = ratio;
  look.motion = motion;
  look.kinetic = kinetic.value();
  look.moved = moved;
  look.moved_beyond_sag = moved_beyond_sag;
  look.loose_share = left_out.area + loose.value() < run.clock.stage().ignored_area ? 0.0 : 1.0;
  look.loose_load = 0.0;
  look.resting_kinetic = resting.value();
  return look;
}

} // namespace

Verdict judge_mechanism(RunState &run, const StageLook &look, Verdict of_any) {
  const Stage &stage = run.clock.stage();
  StageState &state = run.clock.state;
  if (state.first_block == Verdict::undecided) {
    state.first_block = of_any;
  }
  const StageLook of_others = look_at_others(run, look);
  Verdict verdict = judge(stage, of_others, looks_at_loose_blocks(false), state.mechanism);
  if (verdict == Verdict::undecided) {
    verdict = judge_without_drag(stage, of_others, time_of_trial(run), state.mechanism);
  }
  if (verdict == Verdict::failed) {
    state.first_block = Verdict::failed;
  }
  if (of_any == Verdict::settled) {
    return Verdict::settled;
  }
  return verdict == Verdict::settled && state.first_block == Verdict::undecided ? Verdict::undecided
                                                                                : verdict;
}

} // namespace gcpdda
