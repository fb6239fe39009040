#include "simulation/slid_blocks.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace gcpdda {

namespace {

/// The largest slip of a contact on each owned row, m. Contacts with blocks of other ranks are known to both.
std::vector<double> largest_slips(const RunState &run) {
  std::vector<double> slips(run.blocks.num_owned, 0.0);
  const std::vector<CandidatePair> &pairs = run.neighbours.candidates.pairs;
  for (std::size_t number = 0; number < pairs.size(); ++number) {
    run.neighbours.history.for_pair(number, [&](const RegionMemory &memory) {
      for (const BlockIndex row : {pairs[number].lower, pairs[number].higher}) {
        if (row.value < slips.size()) {
          slips[row.value] = std::max(slips[row.value], memory.slip);
        }
      }
    });
  }
  return slips;
}

/// The largest slide by the size of its block, and how many blocks have slid so far that users are told.
struct LargestSlide {
  double share = 0.0;      ///< in sizes of the block, the root of its area
  double distance = 0.0;   ///< m
  std::int64_t block = -1; ///< its id; -1 where none has slid
  std::int64_t number = 0;

  void see(const LargestSlide &other) {
    const bool is_larger = other.share > share || (other.share == share && other.block < block);
    if (other.block >= 0 && (block < 0 || is_larger)) {
      share = other.share;
      distance = other.distance;
      block = other.block;
    }
    number += other.number;
  }
};

} // namespace

void note_slide(const RunState &run, StageResult &result) {
  constexpr double far = 0.1; // in sizes: motion that is a slide without slip
  const std::vector<double> slips = largest_slips(run);
  LargestSlide mine;
  for (std::size_t row = 0; row < run.blocks.num_owned; ++row) {
    const BlockProperties &block = run.blocks.properties[row];
    if (block.keeps_its_velocity()) {
      continue;
    }
    const double size = std::sqrt(block.area);
    const double way = motion_between(block, run.blocks.mark_of(row).stage, run.blocks.displacement[row]);
    const double slide = way >= far * size ? way : std::min(way, slips[row]);
    if (way > run.sag && slide > 0.0) {
      mine.see({slide / size, slide, block.id.value, slide >= StageResult::telling_slide * size ? 1 : 0});
    }
  }
  LargestSlide largest;
  for (const auto &theirs : run.communicator.all_gather(std::vector<LargestSlide>{mine})) {
    largest.see(theirs[0]);
  }
  result.slide = largest.share;
  result.slide_distance = largest.distance;
  result.slid_block = largest.block;
  result.slid_blocks = largest.number;
}

} // namespace gcpdda
