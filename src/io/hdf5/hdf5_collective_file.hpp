#pragma once

// HDF5 files that all ranks write together.

#include "gcpdda/parallel/communicator.hpp"
#include "io/hdf5/hdf5_handle.hpp"

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace gcpdda {

/// Runs `action` on this rank and throws FileError on all ranks, with one text, if it threw on any.
/// A collective call in `action` must be reached by all ranks or by none.
void on_all_ranks(const Communicator &communicator, const std::function<void()> &action);
/// The same for work of the root alone.
void on_root(const Communicator &communicator, const std::function<void()> &action);

/// `expect` for what one rank alone may see broken: throws on all ranks.
void expect_on_all_ranks(const Communicator &communicator, bool condition, const char *what);

/// This rank's rows of a dataset: `count` of them from `first` on, of `total` over all ranks.
struct RowRange {
  std::int64_t first = 0;
  std::int64_t count = 0;
  std::int64_t total = 0;
};

/// Rows in rank order: where mine begin, and how many there are in all. Collective.
RowRange rows_in_rank_order(const Communicator &communicator, std::int64_t count);

/// An HDF5 file written by all ranks together; every member is collective that does not say
/// otherwise. It grows under a temporary name;
/// unless completed it vanishes with the object. What it holds does not depend on the number of ranks.
class CollectiveFile {
public:
  /// @param user_block  bytes at its begin that HDF5 leaves alone: 0, 512 or more by powers of 2
  CollectiveFile(const Communicator &communicator, std::filesystem::path path, std::int64_t user_block = 0);
  ~CollectiveFile();
  CollectiveFile(const CollectiveFile &) = delete;
  CollectiveFile &operator=(const CollectiveFile &) = delete;

  void group(const std::string &name);
  /// A dataset of shape (total), or (total, columns) where `columns` > 1.
  template <class T>
  void dataset(const std::string &name, RowRange rows, const std::vector<T> &values, hsize_t columns = 1) {
    expect(values.size() == static_cast<std::size_t>(rows.count) * columns,
           "a value for each row and column");
    write(table<T>(name, rows.total, columns), rows.first, std::span(values));
    agree_on_writes();
  }
  /// A dataset whose rows are written piece by piece.
  struct Table {
    hdf5::Dataset dataset;
    hid_t memory_type;
    hsize_t columns;
    std::int64_t rows;
  };
  /// @param rows  of all ranks; shape as above
  template <class T> Table table(const std::string &name, std::int64_t rows, hsize_t columns = 1) {
    return make_table(name, rows, columns, NumberType<T>::file(), NumberType<T>::memory());
  }
  /// This rank's rows from `first` on, which nobody else writes; other ranks take part with theirs or with
  /// none. What fails is told by `complete`.
  template <class T> void write(const Table &table, std::int64_t first, std::span<const T> values) {
    write_rows(table, first, values.size() / table.columns, values.data());
  }
  /// A dataset of shape (1); every rank gives the same value.
  void number(const std::string &name, std::int64_t value);
  void attribute(const std::string &object, const std::string &name, double value);
  void attribute(const std::string &object, const std::string &name,
                 const std::array<std::int64_t, 2> &value);
  void attribute(const std::string &object, const std::string &name, const std::string &ascii);
  /// `name` here stands for `name` in the file `file` of the same folder.
  void link(const std::string &name, const std::string &file);
  /// What has been written so far may go to the disk while the rest is made. Not collective.
  void start_to_sync();
  /// Close. No table lives any more; the file still has its temporary name and waits to be published.
  void complete();
  /// The same, then sync and rename.
  void publish();

  [[nodiscard]] bool is_root() const { return communicator_.is_root(); }
  /// False once HDF5 has broken a non-empty collective write into independent ones.
  [[nodiscard]] bool all_writes_collective() const { return all_writes_collective_; }

private:
  template <class T> using NumberType = hdf5::NumberType<T>;
  struct Values {
    hid_t file_type;
    hid_t memory_type;
    const void *first;
  };
  Table make_table(const std::string &name, std::int64_t rows, hsize_t columns, hid_t file_type,
                   hid_t memory_type);
  void write_rows(const Table &table, std::int64_t first, hsize_t count, const void *values);
  void agree_on_writes();
  /// For one more dataset whose rows take so many bytes. Not collective.
  void reserve_space(std::int64_t rows_size);
  void write_attribute(const std::string &object, const std::string &name, hid_t space, Values value);

  const hdf5::QuietErrors quiet_;
  const Communicator communicator_;
  const std::filesystem::path path_;
  hdf5::File file_;
  std::int64_t reserved_ = 0; ///< bytes of the file on the disk; it takes no more
  std::string failed_write_;  ///< the first one of this rank
  bool is_complete_ = false;
  bool all_writes_collective_ = true;
};

} // namespace gcpdda
