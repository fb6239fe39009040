#pragma once

#include "model/contact_history.hpp"

#include <vector>

namespace gcpdda::testing {

/// All that is remembered, in the order of the pairs.
inline std::vector<RegionMemory> memories(const ContactHistory &history) {
  std::vector<RegionMemory> all;
  for (std::size_t pair = 0; pair < history.overlaps.size(); ++pair) {
    const std::vector<RegionMemory> known = history.of_pair(pair);
    all.insert(all.end(), known.begin(), known.end());
  }
  return all;
}

} // namespace gcpdda::testing
