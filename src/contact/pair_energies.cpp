#include "contact/pair_energies.hpp"

#include "contact/lanes/plain_batch.hpp"

#include <algorithm>
#include <limits>
#include <memory>

namespace gcpdda {

namespace {

/// Have `evaluate` say the energies of those pairs, as many at a time as there are lanes.
/// @return pairs of which it could not
template <class Evaluate>
std::vector<const PlainPair *> fill(const std::vector<const PlainPair *> &pairs, std::size_t width,
                                    Evaluate evaluate, std::vector<double> &energies) {
  std::vector<const PlainPair *> left;
  PlainLanes lanes;
  for (std::size_t begin = 0; begin < pairs.size(); begin += lanes.count) {
    const std::size_t most = std::min(width, pairs.size() - begin);
    lanes.count = 0;
    while (lanes.count < most && pairs[begin + lanes.count]->is_like(*pairs[begin])) {
      lanes.pair[lanes.count] = pairs[begin + lanes.count];
      ++lanes.count;
    }
    std::fill(lanes.pair.begin() + static_cast<std::ptrdiff_t>(lanes.count), lanes.pair.end(), pairs[begin]);
    const PlainBatch::Energies found = evaluate(lanes);
    for (std::size_t i = 0; i < lanes.count; ++i) {
      if ((found.known >> i & 1U) != 0) {
        energies[lanes.pair[i]->pair % PlainPair::pairs_in_group] = found.energy[i];
      } else {
        left.push_back(lanes.pair[i]);
      }
    }
  }
  return left;
}

} // namespace

PairEnergies::PairEnergies(Instructions instructions) : batch_(make_plain_batch(instructions)) {}
PairEnergies::~PairEnergies() = default;

std::span<const double> PairEnergies::of_group(const BlockSystem &system, const Candidates &candidates,
                                               std::uint32_t group) {
  energies_.assign(PlainPair::pairs_in_group, std::numeric_limits<double>::quiet_NaN());
  corners_.clear();
  others_.clear();
  const auto is_simple = [&](BlockIndex row) { return system.num_vertices(row.value) <= most_corner_edges; };
  candidates.for_plain_of_group(group, [&](std::size_t entry) {
    const PlainPair &plain = candidates.plain[entry];
    const CandidatePair &pair = candidates.pairs[plain.pair];
    if (!plain.kind.is_deformable && is_simple(pair.lower) && is_simple(pair.higher) &&
        system.motion[pair.lower.value].box.meets(system.motion[pair.higher.value].box)) {
      (plain.kind.may_be_corners() ? corners_ : others_).push_back(&plain);
    }
  });
  const auto left = fill(
      corners_, batch_->width(),
      [&](const PlainLanes &lanes) { return batch_->find_corner_energies(system, candidates, lanes); },
      energies_);
  others_.insert(others_.end(), left.begin(), left.end());
  fill(
      others_, batch_->width(),
      [&](const PlainLanes &lanes) { return batch_->find_energies(system, candidates, lanes); }, energies_);
  return energies_;
}

} // namespace gcpdda
