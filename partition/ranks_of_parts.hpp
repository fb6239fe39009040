#pragma once

// Which part goes to which rank.

#include "partition/domain_map.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace gcpdda {

/// Work of a part that lies with a rank before the parts are handed out.
struct PartOnRank {
  std::int32_t part = 0;
  std::int32_t rank = 0;
  std::int64_t work = 0;
};

/// Rank of each part, one each, so that most of the work stays where it is: the largest share first. The
/// order of `held` does not matter.
std::vector<std::int32_t> ranks_of_parts(std::span<const PartOnRank> held, int num_parts);

/// Owners that are parts become ranks.
void give_parts_to_ranks(DomainMap &map, std::span<const std::int32_t> rank_of_part);

} // namespace gcpdda
