#pragma once

#include "hdf5_handle.hpp"

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

/// Reading HDF5 files by one process alone.
namespace gcpdda::hdf5 {

File open_to_read(const std::filesystem::path &path);

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

} // namespace gcpdda::hdf5
