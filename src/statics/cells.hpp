#pragma once

// Squares of a plane that all ranks know by the same numbers.

#include "gcpdda/parallel/communicator.hpp"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace gcpdda::statics {

inline void make_unique(std::vector<std::int64_t> &list) {
  std::sort(list.begin(), list.end());
  list.erase(std::unique(list.begin(), list.end()), list.end());
}

/// The list of all ranks, ascending and each number once. Collective.
inline std::vector<std::int64_t> united(const Communicator &communicator, std::vector<std::int64_t> mine) {
  make_unique(mine);
  if (communicator.size() == 1) {
    return mine;
  }
  std::vector<std::int64_t> all;
  for (const auto &theirs : communicator.all_gather(mine)) {
    all.insert(all.end(), theirs.begin(), theirs.end());
  }
  make_unique(all);
  return all;
}

} // namespace gcpdda::statics
