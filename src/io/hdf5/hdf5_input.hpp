#pragma once

// Reading HDF5 files on one rank.

#include "gcpdda/parallel/communicator.hpp"
#include "io/hdf5/hdf5_handle.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace gcpdda::hdf5 {

// By one process alone.

File open_to_read(const std::filesystem::path &path, hid_t access = H5P_DEFAULT);
/// Access to a file of anybody, which may be damaged: by the MPI driver, which does without the accumulator
/// of metadata, in which an address of such a file makes HDF5 1.10 crash (CVE-2018-13867). Needs MPI.
Properties foreign_access();

/// A dataset or an attribute as it is in the file.
struct Content {
  std::string path; ///< "/group/dataset" or "/group@attribute"; groups end with "/" and have no bytes
  std::string type; ///< class, size, sign and byte order in words
  std::vector<hsize_t> shape;
  std::vector<std::byte> bytes;
};

/// Everything in the file by its path, links into other files followed. Throws FileError.
std::vector<std::string> list_contents(const File &file);
Content read_content(const File &file, const std::string &path);

/// A dataset (or "object@attribute") of any number of dimensions, flat; its type must be that of T.
template <class T> std::vector<T> read_numbers(const File &file, const std::string &path);

/// A file that all ranks read together, each its own rows. Members are collective; they throw FileError on
/// all ranks where one of them has trouble.
class CollectiveInput {
public:
  CollectiveInput(const Communicator &communicator, std::filesystem::path path);
  CollectiveInput(const CollectiveInput &) = delete;
  CollectiveInput &operator=(const CollectiveInput &) = delete;

  /// 0 where there is no such dataset.
  std::int64_t num_rows(const std::string &name);

  /// Rows [first, first + count) of a dataset with that many columns, row by row. They must exist; count may
  /// be 0 on some ranks or all.
  template <class T>
  std::vector<T> rows(const std::string &name, std::int64_t first, std::int64_t count, hsize_t columns = 1);

private:
  struct Slab;
  void read_piece(const Dataset &dataset, const std::string &what, const Slab &slab);

  const QuietErrors quiet_;
  const Communicator communicator_;
  const std::filesystem::path path_;
  File file_;
};

} // namespace gcpdda::hdf5
