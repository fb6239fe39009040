#include "io/checkpoint/checkpoint_writer.hpp"

#include "io/checkpoint/checkpoint_layout.hpp"
#include "io/checkpoint/checkpoint_reader.hpp"
#include "io/checkpoint/checkpoint_seal.hpp"
#include "io/hdf5/durable_file.hpp"
#include "io/hdf5/hdf5_collective_file.hpp"
#include "io/results/frame_strips.hpp"
#include "io/results/id_slabs.hpp"
#include "model/find_row.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

namespace gcpdda {

namespace {

namespace fs = std::filesystem;

/// Rows of one strip of each rank on their way to that rank; there they stand in the order of their keys.
template <class Key> class StripRoute {
public:
  struct Row {
    Key key;
    std::size_t index; ///< on the rank it comes from
  };

  /// Collective.
  /// @param leaving  for each rank; rows of one key are on one rank and keep their order
  StripRoute(const Communicator &communicator, std::vector<std::vector<Row>> leaving)
      : communicator_(communicator), leaving_(std::move(leaving)) {
    const std::vector<Key> arrived = exchanged<Key>(1, [](const Row &row, Key *to) { *to = row.key; });
    order_.resize(arrived.size());
    std::iota(order_.begin(), order_.end(), std::size_t{0});
    std::stable_sort(order_.begin(), order_.end(),
                     [&](std::size_t a, std::size_t b) { return arrived[a] < arrived[b]; });
    keys_ = sorted(arrived, 1);
  }

  [[nodiscard]] const std::vector<Key> &keys() const { return keys_; }

  /// Collective.
  /// @param get  get(index, to) gives `columns` values of a row
  template <class T, class Get> [[nodiscard]] std::vector<T> route(std::size_t columns, Get get) const {
    return sorted(exchanged<T>(columns, [&](const Row &row, T *to) { get(row.index, to); }), columns);
  }

private:
  template <class T, class Get> std::vector<T> exchanged(std::size_t columns, Get get) const {
    std::vector<std::vector<T>> messages(leaving_.size());
    for (std::size_t rank = 0; rank < leaving_.size(); ++rank) {
      messages[rank].resize(leaving_[rank].size() * columns);
      T *to = messages[rank].data();
      for (const Row &row : leaving_[rank]) {
        get(row, to);
        to += columns;
      }
    }
    std::vector<T> arrived;
    for (const std::vector<T> &message : communicator_.all_to_all(std::move(messages))) {
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
  std::vector<std::vector<Row>> leaving_; ///< by rank
  std::vector<std::size_t> order_;
  std::vector<Key> keys_;
};

using BlockRoute = StripRoute<std::int64_t>;
using RegionRoute = StripRoute<std::array<std::int64_t, 2>>; ///< lower, higher

/// Owned rows of blocks [begin, end).
struct OwnedRows {
  std::size_t begin;
  std::size_t end;
};
OwnedRows owned_rows(const BlockSystem &blocks, IdRange ids) {
  return {first_row_from(blocks, 0, blocks.num_owned, ids.first),
          first_row_from(blocks, 0, blocks.num_owned, ids.last)};
}

/// One checkpoint on its way to the disk. Its rows travel and are written strip by strip: nobody holds more
/// than a strip of them.
class Draft {
public:
  Draft(const Communicator &communicator, const fs::path &path, std::int64_t num_blocks,
        std::int64_t ids_per_strip)
      : communicator_(communicator), path_(path),
        file_(communicator, path, checkpoint::seal_size), strips_{num_blocks, communicator.size(),
                                                                  ids_per_strip} {}

  void write(const RunFacts &facts, const BlockSystem &blocks, const RegionSource &regions) {
    for (const char *group : checkpoint::groups) {
      file_.group(group);
    }
    write_facts(facts);
    write_blocks(facts.scene.num_mobile + facts.more_mobile, blocks);
    write_deformations(blocks);
    write_regions(regions);
    file_.number(checkpoint::checksum, static_cast<std::int64_t>(sum_.total(communicator_)));
    file_.complete();
    checkpoint::put_seal(communicator_, unfinished_name(path_), facts.step);
    on_root(communicator_, [&] { publish(path_); });
  }

private:
  /// The root's values.
  template <class T> void list(const char *name, const std::vector<T> &values) {
    rows_of_root(name, communicator_.is_root() ? values : std::vector<T>(), std::ssize(values));
  }
  template <class T> void rows_of_root(const char *name, const std::vector<T> &mine, std::int64_t total) {
    sum_.add(name, 0, std::span<const T>(mine));
    file_.dataset(name, {0, std::ssize(mine), total}, mine);
  }

  /// A dataset that is written strip by strip.
  template <class T> struct Column {
    const char *name;
    CollectiveFile::Table table;
  };
  template <class T> Column<T> column(const char *name, std::int64_t num_rows, hsize_t columns = 1) {
    return {name, file_.table<T>(name, num_rows, columns)};
  }
  template <class Fields>
  std::vector<Column<double>> columns_of(const Fields &fields, std::int64_t num_rows) {
    std::vector<Column<double>> columns;
    for (const auto &field : fields) {
      columns.push_back(column<double>(field.name, num_rows, field.columns));
    }
    return columns;
  }
  template <class T>
  void write(const Column<T> &column, std::int64_t first_row, const std::vector<T> &values) {
    sum_.add(column.name, first_row * static_cast<std::int64_t>(column.table.columns),
             std::span<const T>(values));
    file_.write(column.table, first_row, std::span<const T>(values));
  }
  template <class T, class Route, class Get>
  void write(const Column<T> &column, std::int64_t first_row, const Route &route, Get get) {
    write(column, first_row, route.template route<T>(column.table.columns, get));
  }
  template <class Fields, class Route, class Owner>
  void write(const std::vector<Column<double>> &columns, std::int64_t first_row, const Route &route,
             const Fields &fields, const Owner &owner) {
    for (std::size_t f = 0; f < columns.size(); ++f) {
      write(columns[f], first_row, route,
            [&](std::size_t index, double *to) { fields[f].get(owner, index, to); });
    }
  }

  /// Rows of this rank's slab.
  /// @param count  count(ids) of the rows that this rank has
  template <class Count> RowRange rows_of_slab(Count count) const {
    const int num_ranks = communicator_.size();
    std::vector<std::vector<std::int64_t>> counts;
    for (int rank = 0; rank < num_ranks; ++rank) {
      counts.push_back({count(IdRange{slab_begin(strips_.num_blocks, num_ranks, rank),
                                      slab_begin(strips_.num_blocks, num_ranks, rank + 1)})});
    }
    std::int64_t rows = 0;
    for (const std::vector<std::int64_t> &theirs : communicator_.all_to_all(std::move(counts))) {
      rows += theirs.front();
    }
    return rows_in_rank_order(communicator_, rows);
  }

  /// @param append  append(ids, rows) puts the rows that this rank has behind `rows`
  /// @param write  write(route, row) of a strip whose first row is `row`
  template <class Route, class Append, class Write>
  void write_strips(RowRange slab, Append append, Write write) {
    std::int64_t row = slab.first;
    for (int number = 0; number < strips_.size(); ++number) {
      std::vector<std::vector<typename Route::Row>> leaving(static_cast<std::size_t>(communicator_.size()));
      for (std::size_t rank = 0; rank < leaving.size(); ++rank) {
        append(strips_.of(static_cast<int>(rank), number), leaving[rank]);
      }
      const Route route(communicator_, std::move(leaving));
      const std::int64_t next = row + std::ssize(route.keys());
      expect_on_all_ranks(communicator_, next <= slab.first + slab.count,
                          "no more rows in a checkpoint than were counted");
      write(route, row);
      file_.start_to_sync();
      row = next;
    }
    expect_on_all_ranks(communicator_, row == slab.first + slab.count,
                        "all rows in a checkpoint that were counted");
  }

  void write_facts(const RunFacts &facts) {
    for (const auto &[name, value] : checkpoint::whole_facts(facts)) {
      list(name, std::vector{value});
    }
    for (const auto &[name, member] : checkpoint::real_facts) {
      list(name, std::vector{facts.*member});
    }
    const ScenePrints &parts = facts.scene.parts;
    list(checkpoint::scene_parts, std::vector<std::int64_t>(parts.begin(), parts.end()));
    write_results(facts);
    for (const auto &[name, member] : checkpoint::real_lists) {
      list(name, facts.*member);
    }
    for (const auto &[name, member] : checkpoint::whole_lists) {
      list(name, facts.*member);
    }
  }

  /// The root alone knows how long they are.
  void write_results(const RunFacts &facts) {
    const checkpoint::ResultLists mine =
        checkpoint::to_lists(communicator_.is_root() ? facts.results : std::vector<ResultFile>());
    std::array<std::int64_t, 2> lengths{std::ssize(mine.names), std::ssize(mine.bytes)};
    communicator_.max(std::span<std::int64_t>(lengths));
    rows_of_root(checkpoint::result_names, mine.names, lengths[0]);
    rows_of_root(checkpoint::result_bytes, mine.bytes, lengths[1]);
    rows_of_root(checkpoint::result_rows, mine.rows, lengths[1]);
  }

  void write_blocks(std::int64_t num_mobile, const BlockSystem &blocks) {
    const RowRange slab = rows_of_slab([&](IdRange ids) {
      const OwnedRows rows = owned_rows(blocks, ids);
      return static_cast<std::int64_t>(rows.end - rows.begin);
    });
    expect_on_all_ranks(communicator_, slab.total == num_mobile,
                        "each mobile block on one rank of a checkpoint");
    const auto block_ids = column<std::int64_t>(checkpoint::block_ids, slab.total);
    const auto kinds = column<std::uint8_t>(checkpoint::block_kinds, slab.total);
    const auto fields = columns_of(checkpoint::block_fields, slab.total);
    const bool has_shaken = communicator_.max(blocks.unshaken.empty() ? 0.0 : 1.0) > 0.0;
    const auto unshaken =
        has_shaken ? columns_of(checkpoint::unshaken_fields, slab.total) : std::vector<Column<double>>();
    const auto append = [&](IdRange ids, std::vector<BlockRoute::Row> &leaving) {
      const OwnedRows rows = owned_rows(blocks, ids);
      for (std::size_t row = rows.begin; row < rows.end; ++row) {
        leaving.push_back({blocks.properties[row].id.value, row});
      }
    };
    write_strips<BlockRoute>(slab, append, [&](const BlockRoute &route, std::int64_t row) {
      write(block_ids, row, route.keys());
      write(kinds, row, route, [&](std::size_t index, std::uint8_t *to) {
        *to = static_cast<std::uint8_t>(blocks.properties[index].kind);
      });
      write(fields, row, route, checkpoint::block_fields, blocks);
      write(unshaken, row, route, checkpoint::unshaken_fields, blocks);
    });
  }

  void write_deformations(const BlockSystem &blocks) {
    const RowRange slab = rows_of_slab([&](IdRange ids) {
      const OwnedRows rows = owned_rows(blocks, ids);
      return std::int64_t{blocks.deformation_begin[rows.end]} - blocks.deformation_begin[rows.begin];
    });
    const auto block_ids = column<std::int64_t>(checkpoint::deformation_ids, slab.total);
    const auto fields = columns_of(checkpoint::deformation_fields, slab.total);
    const auto append = [&](IdRange ids, std::vector<BlockRoute::Row> &leaving) {
      const OwnedRows rows = owned_rows(blocks, ids);
      for (std::size_t row = rows.begin; row < rows.end; ++row) {
        if (blocks.is_deformable(row)) {
          leaving.push_back({blocks.properties[row].id.value, blocks.deformation_begin[row]});
        }
      }
    };
    write_strips<BlockRoute>(slab, append, [&](const BlockRoute &route, std::int64_t row) {
      write(block_ids, row, route.keys());
      write(fields, row, route, checkpoint::deformation_fields, blocks.deformation);
    });
  }

  // By (lower, higher); those of a pair come from one rank and keep their order.
  void write_regions(const RegionSource &source) {
    const RowRange slab = rows_of_slab([&](IdRange ids) { return source.count(ids.first, ids.last); });
    const auto blocks = column<std::int64_t>(checkpoint::region_blocks, slab.total, 2);
    const auto stretches = column<std::int32_t>(checkpoint::region_stretches, slab.total, 2);
    const auto states = column<std::uint8_t>(checkpoint::region_states, slab.total);
    const auto laws = column<std::int32_t>(checkpoint::region_laws, slab.total);
    const auto seen_at = column<std::int32_t>(checkpoint::region_seen_at, slab.total);
    const auto fields = columns_of(checkpoint::region_fields, slab.total);
    std::vector<RegionRecord> records; // that leave this rank for one strip of each
    const auto append = [&](IdRange ids, std::vector<RegionRoute::Row> &leaving) {
      std::size_t index = records.size();
      source.append(ids.first, ids.last, records);
      for (; index < records.size(); ++index) {
        leaving.push_back({{records[index].lower.value, records[index].higher.value}, index});
      }
    };
    write_strips<RegionRoute>(slab, append, [&](const RegionRoute &route, std::int64_t row) {
      write(blocks, row, route, [&](std::size_t index, std::int64_t *to) {
        to[0] = records[index].lower.value;
        to[1] = records[index].higher.value;
      });
      write(stretches, row, route, [&](std::size_t index, std::int32_t *to) {
        to[0] = records[index].memory.lower_stretch;
        to[1] = records[index].memory.higher_stretch;
      });
      write(states, row, route, [&](std::size_t index, std::uint8_t *to) {
        *to = static_cast<std::uint8_t>(records[index].memory.state);
      });
      write(laws, row, route, [&](std::size_t index, std::int32_t *to) { *to = records[index].memory.law; });
      write(seen_at, row, route,
            [&](std::size_t index, std::int32_t *to) { *to = records[index].memory.seen_at; });
      write(fields, row, route, checkpoint::region_fields, records);
      records.clear();
    });
  }

  Communicator communicator_;
  fs::path path_;
  CollectiveFile file_;
  Strips strips_;
  checkpoint::ContentSum sum_;
};

} // namespace

CheckpointWriter::CheckpointWriter(const Communicator &communicator, fs::path directory, fs::path last,
                                   std::int64_t ids_per_strip)
    : communicator_(communicator), directory_(std::move(directory)), last_(std::move(last)),
      ids_per_strip_(ids_per_strip > 0 ? ids_per_strip : usual_ids_per_strip) {}

void CheckpointWriter::write(const RunFacts &facts, const BlockSystem &blocks, const RegionSource &regions) {
  const fs::path path = checkpoint::folder(directory_) / fmt::format("checkpoint_{:09}.h5", facts.step);
  on_root(communicator_, [&] { make_directory(path.parent_path()); });
  const auto give_up = [&](const std::string &why) { // on all ranks
    on_root(communicator_, [&] {
      fs::remove(path);
      fs::remove(unfinished_name(path));
    });
    throw FileError(why);
  };
  try {
    Draft(communicator_, path, facts.scene.num_blocks, ids_per_strip_).write(facts, blocks, regions);
  } catch (const FileError &error) {
    give_up(error.what());
  }
  try {
    expect_readable_checkpoint(communicator_, path);
  } catch (const FileError &error) {
    give_up("cannot write " + path.string() + ": read again, " + error.what());
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
