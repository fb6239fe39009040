#pragma once

#include "gcpdda/parallel/communicator.hpp"

#include "hdf5_handle.hpp"

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

/// An HDF5 file written by all ranks together; every member is collective. It grows under a temporary name;
/// without `publish` it vanishes with the object. What it holds does not depend on the number of ranks.
class CollectiveFile {
public:
  CollectiveFile(const Communicator &communicator, std::filesystem::path path);
  ~CollectiveFile();
  CollectiveFile(const CollectiveFile &) = delete;
  CollectiveFile &operator=(const CollectiveFile &) = delete;

  void group(const std::string &name);
  /// A dataset of shape (total), or (total, columns) where `columns` > 1.
  template <class T>
  void dataset(const std::string &name, RowRange rows, const std::vector<T> &values, hsize_t columns = 1) {
    expect(values.size() == static_cast<std::size_t>(rows.count) * columns,
           "a value for each row and column");
    write_dataset(name, rows, columns, {NumberType<T>::file(), NumberType<T>::memory(), values.data()});
  }
  /// A dataset of shape (1); every rank gives the same value.
  void number(const std::string &name, std::int64_t value);
  void attribute(const std::string &object, const std::string &name, double value);
  void attribute(const std::string &object, const std::string &name,
                 const std::array<std::int64_t, 2> &value);
  void attribute(const std::string &object, const std::string &name, const std::string &ascii);
  /// `name` here stands for `name` in the file `file` of the same folder.
  void link(const std::string &name, const std::string &file);
  /// Close, sync, rename.
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
  void write_dataset(const std::string &name, RowRange rows, hsize_t columns, Values values);
  void reserve_space(const hdf5::Dataset &dataset);
  void write_attribute(const std::string &object, const std::string &name, hid_t space, Values value);

  const hdf5::QuietErrors quiet_;
  const Communicator communicator_;
  const std::filesystem::path path_;
  hdf5::File file_;
  std::int64_t reserved_ = 0; ///< bytes of the file that have their place on the disk
  bool published_ = false;
  bool all_writes_collective_ = true;
};

} // namespace gcpdda
