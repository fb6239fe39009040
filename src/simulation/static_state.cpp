#include "simulation/static_state.hpp"

#include "base/check.hpp"
#include "contact/block_sums.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

namespace gcpdda {

namespace {

constexpr std::size_t reals_per_block = 20;
constexpr std::size_t counts_per_spring = 6;
constexpr std::size_t reals_per_spring = 11;

struct BlockRecord {
  std::int64_t block = 0;
  PseudoMotion motion;
};

/// The same list of fields for both ways.
template <class Record, class Count, class Real>
void visit_spring(Record &record, Count &&count, Real &&real) {
  auto &[spring, memory] = record;
  count(memory.lower.value), count(memory.higher.value), count(memory.side), count(memory.turned);
  count(memory.open_for), count(memory.slid_for);
  real(spring.normal.x), real(spring.normal.y), real(spring.lower_arm.x), real(spring.lower_arm.y);
  real(spring.higher_arm.x), real(spring.higher_arm.y), real(spring.normal_stiffness), real(spring.bending);
  real(spring.tangential), real(spring.sticking), real(spring.grip);
}

template <class Motion, class Real> void visit_motion(Motion &motion, Real &&real) {
  for (auto *list : {&motion.velocity, &motion.momentum, &motion.held}) {
    for (auto &value : *list) {
      real(value);
    }
  }
  real(motion.is_free);
  real(motion.rests);
}

} // namespace

StaticState gathered_state(const Communicator &communicator, const BlockSystem &blocks,
                           const statics::ContactSprings &springs) {
  std::vector<BlockRecord> rows;
  for (std::size_t row = 0; row < blocks.num_owned; ++row) {
    rows.push_back({blocks.properties[row].id.value, blocks.pseudo[row]});
  }
  std::vector<BlockRecord> all_rows;
  for (const auto &theirs : communicator.all_gather(rows)) {
    all_rows.insert(all_rows.end(), theirs.begin(), theirs.end());
  }
  std::sort(all_rows.begin(), all_rows.end(),
            [](const BlockRecord &a, const BlockRecord &b) { return a.block < b.block; });
  StaticState state;
  for (const BlockRecord &record : all_rows) {
    state.blocks.push_back(record.block);
    state.motions.push_back(record.motion);
  }
  std::vector<statics::SpringRecord> mine = springs.records();
  std::erase_if(mine, [&](const statics::SpringRecord &record) {
    return !counts_here(blocks, BlockIndex{record.spring.lower});
  });
  for (const auto &theirs : communicator.all_gather(mine)) {
    state.springs.insert(state.springs.end(), theirs.begin(), theirs.end());
  }
  // Those of one pair come from one rank and keep their order.
  std::stable_sort(state.springs.begin(), state.springs.end(),
                   [](const statics::SpringRecord &a, const statics::SpringRecord &b) {
                     return std::tie(a.memory.lower, a.memory.higher) <
                            std::tie(b.memory.lower, b.memory.higher);
                   });
  return state;
}

StaticNumbers to_numbers(const StaticState &state) {
  StaticNumbers numbers;
  numbers.counts = {std::ssize(state.blocks), std::ssize(state.springs)};
  numbers.counts.insert(numbers.counts.end(), state.blocks.begin(), state.blocks.end());
  const auto real = [&](double value) { numbers.reals.push_back(value); };
  for (const PseudoMotion &motion : state.motions) {
    visit_motion(motion, real);
  }
  for (const statics::SpringRecord &record : state.springs) {
    visit_spring(
        record, [&](auto value) { numbers.counts.push_back(static_cast<std::int64_t>(value)); }, real);
  }
  return numbers;
}

StaticState to_static_state(std::span<const std::int64_t> counts, std::span<const double> reals) {
  StaticState state;
  if (counts.empty() && reals.empty()) {
    return state;
  }
  // A list cannot be longer than what holds it.
  const auto length = [&](std::size_t list) {
    const std::int64_t count = list < counts.size() ? counts[list] : -1;
    if (count < 0 || count > std::ssize(counts)) {
      throw FileError("it is damaged: the state of its static solver is not whole");
    }
    return static_cast<std::size_t>(count);
  };
  const std::size_t num_blocks = length(0);
  const std::size_t num_springs = length(1);
  if (counts.size() != 2 + num_blocks + counts_per_spring * num_springs ||
      reals.size() != reals_per_block * num_blocks + reals_per_spring * num_springs) {
    throw FileError("it is damaged: the state of its static solver is not whole");
  }
  const auto blocks = counts.subspan(2, num_blocks);
  state.blocks.assign(blocks.begin(), blocks.end());
  state.motions.resize(num_blocks);
  state.springs.resize(num_springs);
  std::size_t next_count = 2 + num_blocks;
  std::size_t next_real = 0;
  const auto real = [&](double &value) { value = reals[next_real++]; };
  for (PseudoMotion &motion : state.motions) {
    visit_motion(motion, real);
  }
  for (statics::SpringRecord &record : state.springs) {
    visit_spring(
        record,
        [&](auto &value) {
          value = static_cast<std::remove_reference_t<decltype(value)>>(counts[next_count++]);
        },
        real);
  }
  if (!std::is_sorted(state.blocks.begin(), state.blocks.end()) ||
      !std::all_of(reals.begin(), reals.end(), [](double value) { return std::isfinite(value); })) {
    throw FileError("it is damaged: the state of its static solver does not follow from its numbers");
  }
  return state;
}

} // namespace gcpdda
