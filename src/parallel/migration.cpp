#include "parallel/migration.hpp"

#include "parallel/packing.hpp"

#include <algorithm>
#include <numeric>
#include <unordered_map>
#include <utility>

namespace gcpdda {

namespace {

/// Owned rows are `staying` and all of `arrived`, sorted by id; ghosts are dropped. Where nothing changes
/// owned rows are not touched.
void settle_rows(BlockSystem &system, const std::vector<std::size_t> &staying, const BlockSystem &arrived) {
  if (staying.size() == system.num_owned && arrived.num_rows() == 0) {
    BlockSystem fixed;
    append_rows(fixed, system, system.first_fixed(), system.num_rows());
    keep_rows(system, system.num_owned);
    append_rows(system, fixed, 0, fixed.num_rows());
    system.num_ghosts = 0;
    return;
  }
  std::vector<std::size_t> arriving(arrived.num_rows());
  std::iota(arriving.begin(), arriving.end(), std::size_t{0});
  std::sort(arriving.begin(), arriving.end(), [&](std::size_t a, std::size_t b) {
    return arrived.properties[a].id < arrived.properties[b].id;
  });
  std::vector<RowRun> runs; // of rows that stay together
  const auto add = [&](std::size_t row, bool joins) {
    if (runs.empty() || runs.back().joins != joins || runs.back().last != row) {
      runs.push_back({row, row, joins});
    }
    ++runs.back().last;
  };
  auto next = arriving.begin();
  for (const std::size_t row : staying) {
    for (; next != arriving.end() && arrived.properties[*next].id < system.properties[row].id; ++next) {
      add(*next, true);
    }
    add(row, false);
  }
  for (; next != arriving.end(); ++next) {
    add(*next, true);
  }
  for (std::size_t row = system.first_fixed(); row < system.num_rows(); ++row) {
    add(row, false);
  }
  const std::size_t about_as_many = system.num_ghosts + system.num_ghosts / 8 + 16; // ghosts will come
  take_rows(system, arrived, runs, about_as_many);
  system.num_owned = staying.size() + arrived.num_rows();
  system.num_ghosts = 0;
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
