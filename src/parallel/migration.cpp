#include "gcpdda/parallel/migration.hpp"

#include "gcpdda/parallel/packing.hpp"

#include <algorithm>
#include <numeric>
#include <unordered_map>

namespace gcpdda {

namespace {

/// The system with its owned rows sorted by id, without ghosts.
BlockSystem settle_rows(const BlockSystem &system, const BlockSystem &owned) {
  std::vector<std::size_t> order(owned.num_rows());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return owned.properties[a].id < owned.properties[b].id; });
  BlockSystem sorted;
  for (const std::size_t row : order) {
    append_row(sorted, owned, row);
  }
  for (std::size_t row = system.first_fixed(); row < system.num_rows(); ++row) {
    append_row(sorted, system, row);
  }
  sorted.num_owned = order.size();
  sorted.num_fixed = system.num_fixed;
  return sorted;
}

} // namespace

std::int64_t migrate(const Communicator &communicator, const DomainMap &map, BlockSystem &system,
                     std::vector<RegionRecord> &memory) {
  std::vector<Bytes> leaving(static_cast<std::size_t>(communicator.size()));
  std::unordered_map<std::int64_t, int> destination;
  BlockSystem owned;
  for (std::size_t row = 0; row < system.num_owned; ++row) {
    const int rank = map.rank_of(system.centroid(row));
    if (rank == communicator.rank()) {
      append_row(owned, system, row);
    } else {
      pack_row(system, row, leaving[static_cast<std::size_t>(rank)]);
      destination.emplace(system.properties[row].id.value, rank);
    }
  }
  std::vector<std::vector<RegionRecord>> records(leaving.size());
  for (const RegionRecord &record : memory) {
    for (const BlockId id : {record.lower, record.higher}) {
      if (const auto found = destination.find(id.value); found != destination.end()) {
        records[static_cast<std::size_t>(found->second)].push_back(record);
      }
    }
  }
  for (const Bytes &message : communicator.all_to_all(leaving)) {
    unpack_rows(message, owned);
  }
  for (const auto &arrived : communicator.all_to_all(records)) {
    memory.insert(memory.end(), arrived.begin(), arrived.end());
  }
  system = settle_rows(system, owned);
  return static_cast<std::int64_t>(destination.size());
}

} // namespace gcpdda
