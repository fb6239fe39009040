#include "partition/ranks_of_parts.hpp"

#include <algorithm>
#include <tuple>

namespace gcpdda {

std::vector<std::int32_t> ranks_of_parts(std::span<const PartOnRank> held, int num_parts) {
  std::vector<PartOnRank> order(held.begin(), held.end());
  std::sort(order.begin(), order.end(), [](const PartOnRank &a, const PartOnRank &b) {
    return std::tuple(-a.work, a.part, a.rank) < std::tuple(-b.work, b.part, b.rank);
  });
  constexpr std::int32_t none = -1;
  std::vector<std::int32_t> rank_of(static_cast<std::size_t>(num_parts), none);
  std::vector<char> taken(static_cast<std::size_t>(num_parts), 0);
  for (const PartOnRank &share : order) {
    std::int32_t &rank = rank_of[static_cast<std::size_t>(share.part)];
    char &is_taken = taken[static_cast<std::size_t>(share.rank)];
    if (rank == none && is_taken == 0) {
      rank = share.rank;
      is_taken = 1;
    }
  }
  std::int32_t next = 0;
  for (std::int32_t &rank : rank_of) {
    if (rank == none) {
      while (taken[static_cast<std::size_t>(next)] != 0) {
        ++next;
      }
      rank = next++;
    }
  }
  return rank_of;
}

void give_parts_to_ranks(DomainMap &map, std::span<const std::int32_t> rank_of_part) {
  for (std::int32_t &owner : map.owner) {
    owner = rank_of_part[static_cast<std::size_t>(owner)];
  }
}

} // namespace gcpdda
