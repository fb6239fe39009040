#include "contact/resting_groups.hpp"

namespace gcpdda {

void RestingGroups::find_rows(const Candidates &candidates) {
  rows_.clear();
  first_row_.assign(candidates.are_added.size() + 1, 0);
  for (const PairGroup &group : candidates.groups) {
    if (group.first == group.last) {
      continue;
    }
    const std::size_t begin = rows_.size();
    first_row_[group.number] = begin;
    for (std::uint32_t entry = group.first; entry < group.last; ++entry) {
      const CandidatePair &pair = candidates.pairs[candidates.plain[entry].pair];
      rows_.insert(rows_.end(), {pair.lower.value, pair.higher.value});
    }
    const auto own = rows_.begin() + static_cast<std::ptrdiff_t>(begin);
    std::sort(own, rows_.end());
    rows_.erase(std::unique(own, rows_.end()), rows_.end());
    first_row_[group.number + 1] = rows_.size();
  }
}

} // namespace gcpdda
