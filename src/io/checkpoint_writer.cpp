#include "checkpoint_layout.hpp"
#include "durable_file.hpp"
#include "hdf5_collective_file.hpp"

#include "gcpdda/io/result_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <tuple>
#include <utility>

namespace gcpdda {

namespace {

namespace fs = std::filesystem;

/// Sends rows to the ranks whose slabs they are in; there they stand in BlockId order.
class SlabRoute {
public:
  /// @param ids  of this rank's rows
  SlabRoute(const Communicator &communicator, std::int64_t num_blocks, const std::vector<std::int64_t> &ids)
      : communicator_(communicator) {
    for (const std::int64_t id : ids) {
      owner_.push_back(static_cast<std::size_t>(slab_owner(num_blocks, communicator.size(), id)));
    }
    const std::vector<std::int64_t> arrived = exchanged(ids, 1);
    order_.resize(arrived.size());
    std::iota(order_.begin(), order_.end(), std::size_t{0});
    std::sort(order_.begin(), order_.end(),
              [&](std::size_t a, std::size_t b) { return arrived[a] < arrived[b]; });
    range_ = rows_in_rank_order(communicator, std::ssize(arrived));
    ids_ = sorted(arrived, 1);
  }

  [[nodiscard]] RowRange range() const { return range_; }
  [[nodiscard]] const std::vector<std::int64_t> &ids() const { return ids_; }

  /// Collective.
  template <class T>
  [[nodiscard]] std::vector<T> route(const std::vector<T> &values, std::size_t columns) const {
    return sorted(exchanged(values, columns), columns);
  }

private:
  template <class T> std::vector<T> exchanged(const std::vector<T> &values, std::size_t columns) const {
    std::vector<std::vector<T>> leaving(static_cast<std::size_t>(communicator_.size()));
    for (std::size_t row = 0; row < owner_.size(); ++row) {
      const auto first = values.begin() + static_cast<std::ptrdiff_t>(row * columns);
      leaving[owner_[row]].insert(leaving[owner_[row]].end(), first,
                                  first + static_cast<std::ptrdiff_t>(columns));
    }
    std::vector<T> arrived;
    for (const std::vector<T> &message : communicator_.all_to_all(leaving)) {
      arrived.insert(arrived.end(), message.begin(), message.end());
    }
    return arrived;
  }
  template <class T> std::vector<T> sorted(const std::vector<T> &values, std::size_t columns) const {
    std::vector<T> in_order;
    in_order.reserve(values.size());
    for (const std::size_t row : order_) {
      const auto first = values.begin() + static_cast<std::ptrdiff_t>(row * columns);
      in_order.insert(in_order.end(), first, first + static_cast<std::ptrdiff_t>(columns));
    }
    return in_order;
  }

  Communicator communicator_;
  std::vector<std::size_t> owner_;
  std::vector<std::size_t> order_;
  std::vector<std::int64_t> ids_;
  RowRange range_;
};

/// One checkpoint on its way to the disk.
class Draft {
public:
  Draft(const Communicator &communicator, const fs::path &path)
      : communicator_(communicator), file_(communicator, path) {}

  void write(const RunFacts &facts, const BlockSystem &blocks, std::span<const RegionRecord> memory) {
    file_.attribute("/", "format", checkpoint::format);
    file_.number("/version", checkpoint::version);
    for (const char *group : checkpoint::groups) {
      file_.group(group);
    }
    write_facts(facts);
    write_blocks(facts, blocks);
    write_deformations(facts.scene.num_blocks, blocks);
    write_regions(facts.scene.num_blocks, memory);
    file_.number(checkpoint::checksum, static_cast<std::int64_t>(sum_.total(communicator_)));
    file_.publish();
  }

private:
  template <class T>
  void dataset(const char *name, RowRange rows, const std::vector<T> &values, hsize_t columns = 1) {
    sum_.add(name, rows.first * static_cast<std::int64_t>(columns), std::span<const T>(values));
    file_.dataset(name, rows, values, columns);
    file_.start_to_sync();
  }

  /// The root's values.
  template <class T> void list(const char *name, const std::vector<T> &values) {
    const std::int64_t total = std::ssize(values);
    const bool mine = communicator_.is_root();
    dataset(name, {0, mine ? total : 0, total}, mine ? values : std::vector<T>());
  }

  void write_facts(const RunFacts &facts) {
    for (const auto &[name, value] : checkpoint::whole_facts(facts)) {
      list(name, std::vector{value});
    }
    for (const auto &[name, member] : checkpoint::real_facts) {
      list(name, std::vector{facts.*member});
    }
    list(checkpoint::frame_times, facts.frame_times);
    list(checkpoint::ledger, facts.ledger);
    list(checkpoint::stage_counts, facts.stage_counts);
    list(checkpoint::stage_numbers, facts.stage_numbers);
    list(checkpoint::bolt_counts, facts.bolt_counts);
    list(checkpoint::bolt_numbers, facts.bolt_numbers);
  }

  template <class Table, class Owner>
  void fields(const Table &table, const Owner &owner, std::size_t num_rows, const SlabRoute &route) {
    for (const checkpoint::Field<Owner> &field : table) {
      std::vector<double> values(num_rows * field.columns);
      for (std::size_t row = 0; row < num_rows; ++row) {
        field.get(owner, row, values.data() + row * field.columns);
      }
      dataset(field.name, route.range(), route.route(values, field.columns), field.columns);
    }
  }

  void write_blocks(const RunFacts &facts, const BlockSystem &blocks) {
    std::vector<std::int64_t> ids;
    std::vector<std::uint8_t> kinds;
    for (std::size_t row = 0; row < blocks.num_owned; ++row) {
      ids.push_back(blocks.properties[row].id.value);
      kinds.push_back(static_cast<std::uint8_t>(blocks.properties[row].kind));
    }
    SlabRoute route(communicator_, facts.scene.num_blocks, ids);
    expect_on_all_ranks(communicator_, route.range().total == facts.scene.num_mobile + facts.more_mobile,
                        "each mobile block on one rank of a checkpoint");
    dataset(checkpoint::block_ids, route.range(), route.ids());
    dataset(checkpoint::block_kinds, route.range(), route.route(kinds, 1));
    fields(checkpoint::block_fields, blocks, blocks.num_owned, route);
  }

  void write_deformations(std::int64_t num_blocks, const BlockSystem &blocks) {
    std::vector<std::int64_t> ids;
    for (std::size_t row = 0; row < blocks.num_owned; ++row) {
      if (blocks.is_deformable(row)) {
        ids.push_back(blocks.properties[row].id.value);
      }
    }
    SlabRoute route(communicator_, num_blocks, ids);
    dataset(checkpoint::deformation_ids, route.range(), route.ids());
    fields(checkpoint::deformation_fields, blocks.deformation, ids.size(), route);
  }

  // By (lower, higher); those of a pair come from one rank and keep their order.
  void write_regions(std::int64_t num_blocks, std::span<const RegionRecord> memory) {
    std::vector<std::vector<RegionRecord>> leaving(static_cast<std::size_t>(communicator_.size()));
    for (const RegionRecord &record : memory) {
      const int owner = slab_owner(num_blocks, communicator_.size(), record.lower.value);
      leaving[static_cast<std::size_t>(owner)].push_back(record);
    }
    std::vector<RegionRecord> records;
    for (const std::vector<RegionRecord> &message : communicator_.all_to_all(leaving)) {
      records.insert(records.end(), message.begin(), message.end());
    }
    std::stable_sort(records.begin(), records.end(), [](const RegionRecord &a, const RegionRecord &b) {
      return std::tie(a.lower, a.higher) < std::tie(b.lower, b.higher);
    });
    std::vector<std::int64_t> blocks;
    std::vector<std::int32_t> stretches;
    std::vector<std::uint8_t> states;
    std::vector<std::int32_t> laws;
    for (const RegionRecord &record : records) {
      blocks.insert(blocks.end(), {record.lower.value, record.higher.value});
      stretches.insert(stretches.end(), {record.memory.lower_stretch, record.memory.higher_stretch});
      states.push_back(static_cast<std::uint8_t>(record.memory.state));
      laws.push_back(record.memory.law);
    }
    const RowRange rows = rows_in_rank_order(communicator_, std::ssize(records));
    dataset(checkpoint::region_blocks, rows, blocks, 2);
    dataset(checkpoint::region_stretches, rows, stretches, 2);
    dataset(checkpoint::region_states, rows, states);
    dataset(checkpoint::region_laws, rows, laws);
    for (const auto &field : checkpoint::region_fields) {
      std::vector<double> values(records.size() * field.columns);
      for (std::size_t row = 0; row < records.size(); ++row) {
        field.get(records, row, values.data() + row * field.columns);
      }
      dataset(field.name, rows, values, field.columns);
    }
  }

  Communicator communicator_;
  CollectiveFile file_;
  checkpoint::ContentSum sum_;
};

} // namespace

CheckpointWriter::CheckpointWriter(const Communicator &communicator, fs::path directory, fs::path last)
    : communicator_(communicator), directory_(std::move(directory)), last_(std::move(last)) {}

void CheckpointWriter::write(const RunFacts &facts, const BlockSystem &blocks,
                             std::span<const RegionRecord> memory) {
  const fs::path path = checkpoint::folder(directory_) / fmt::format("checkpoint_{:09}.h5", facts.step);
  on_root(communicator_, [&] { make_directory(path.parent_path()); });
  Draft(communicator_, path).write(facts, blocks, memory);
  try {
    expect_readable_checkpoint(communicator_, path);
  } catch (const FileError &error) { // on all ranks
    on_root(communicator_, [&] { fs::remove(path); });
    throw FileError("cannot write " + path.string() + ": read again, " + error.what());
  }
  on_root(communicator_, [&] {
    sync_directory(path.parent_path()); // the new name is on the disk before an old one goes
    for (const fs::path &other : checkpoint_files(directory_)) {
      if (other != path && other != last_) {
        fs::remove(other);
      }
    }
  });
  last_ = path;
}

} // namespace gcpdda
