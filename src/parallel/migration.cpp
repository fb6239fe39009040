#include "gcpdda/parallel/migration.hpp"

#include "gcpdda/parallel/packing.hpp"

#include <algorithm>
#include <numeric>
#include <unordered_map>
#include <utility>

namespace gcpdda {

namespace {

/// Owned rows are `staying` and all of `arrived`, sorted by id; ghosts are dropped. Where nothing changes
/// owned rows are not touched.
void settle_rows(BlockSystem &system, const std::vector<std::size_t> &staying, const BlockSystem &arrived) {
  BlockSystem fixed;
  append_rows(fixed, system, system.first_fixed(), system.num_rows());
  if (staying.size() == system.num_owned && arrived.num_rows() == 0) {
    keep_rows(system, system.num_owned);
  } else {
    std::vector<std::pair<std::int64_t, std::size_t>>
        order; // id and row, arrived ones behind all of the system
    order.reserve(staying.size() + arrived.num_rows());
    for (const std::size_t row : staying) {
      order.emplace_back(system.properties[row].id.value, row);
    }
    for (std::size_t row = 0; row < arrived.num_rows(); ++row) {
      order.emplace_back(arrived.properties[row].id.value, system.num_rows() + row);
    }
    const auto first_arrived = order.begin() + std::ssize(staying);
    std::sort(first_arrived, order.end());
    std::inplace_merge(order.begin(), first_arrived, order.end());
    BlockSystem sorted;
    const std::size_t ghosts = system.num_ghosts + system.num_ghosts / 8 + 16; // about as many will come
    reserve_rows(sorted, order.size() + ghosts + fixed.num_rows(),
                 system.reference_vertex.size() + arrived.reference_vertex.size() + 4 * ghosts);
    for (std::size_t begin = 0, end = 0; begin < order.size(); begin = end) { // rows that stay together
      const std::size_t first = order[begin].second;
      const bool is_new = first >= system.num_rows();
      end = begin + 1;
      while (end < order.size() && order[end].second == first + (end - begin) &&
             (order[end].second >= system.num_rows()) == is_new) {
        ++end;
      }
      const std::size_t from = is_new ? first - system.num_rows() : first;
      append_rows(sorted, is_new ? arrived : system, from, from + (end - begin));
    }
    sorted.num_owned = order.size();
    sorted.num_fixed = system.num_fixed;
    sorted.body = system.body;
    system = std::move(sorted);
  }
  system.num_ghosts = 0;
  append_rows(system, fixed, 0, fixed.num_rows());
}

/// Those of blocks that leave go to their new owners as well.
template <class Record>
void share_records(const Communicator &communicator, const std::unordered_map<std::int64_t, int> &destination,
                   std::vector<Record> &records) {
  std::vector<std::vector<Record>> leaving(static_cast<std::size_t>(communicator.size()));
  for (const Record &record : records) {
    for (const BlockId id : {record.lower, record.higher}) {
      if (const auto found = destination.find(id.value); found != destination.end()) {
        leaving[static_cast<std::size_t>(found->second)].push_back(record);
      }
    }
  }
  for (const auto &brought : communicator.all_to_all(leaving)) {
    records.insert(records.end(), brought.begin(), brought.end());
  }
}

} // namespace

std::int64_t migrate(const Communicator &communicator, const DomainMap &map, BlockSystem &system,
                     ContactMemory &memory) {
  std::vector<Bytes> leaving(static_cast<std::size_t>(communicator.size()));
  std::unordered_map<std::int64_t, int> destination;
  std::vector<std::size_t> staying;
  for (std::size_t row = 0; row < system.num_owned; ++row) {
    const int rank = map.rank_of(system.centroid(row));
    if (rank == communicator.rank()) {
      staying.push_back(row);
    } else {
      pack_row(system, row, leaving[static_cast<std::size_t>(rank)]);
      destination.emplace(system.properties[row].id.value, rank);
    }
  }
  BlockSystem arrived;
  for (const Bytes &message : communicator.all_to_all(std::move(leaving))) {
    unpack_rows(message, arrived);
  }
  share_records(communicator, destination, memory.plain);
  share_records(communicator, destination, memory.others);
  settle_rows(system, staying, arrived);
  return static_cast<std::int64_t>(destination.size());
}

} // namespace gcpdda
