#include "io/hdf5/hdf5_input.hpp"

#include "base/input_file.hpp"
#include "io/hdf5/hdf5_collective_file.hpp"

#include <fmt/format.h>
#include <mpi.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

namespace gcpdda::hdf5 {

namespace {

// Deeper than any of our files: links that lead in a circle.
constexpr int deepest_group = 32;

void append_name(const char *name, void *names) {
  static_cast<std::vector<std::string> *>(names)->emplace_back(name);
}

std::vector<std::string> attribute_names(const Object &object, const std::string &path) {
  std::vector<std::string> names;
  const auto append = [](hid_t, const char *name, const H5A_info_t *, void *data) -> herr_t {
    append_name(name, data);
    return 0;
  };
  checked(H5Aiterate2(object.get(), H5_INDEX_NAME, H5_ITER_INC, nullptr, append, &names),
          "list attributes of " + path);
  return names;
}

std::vector<std::string> member_names(const Object &group, const std::string &path) {
  std::vector<std::string> names;
  const auto append = [](hid_t, const char *name, const H5L_info_t *, void *data) -> herr_t {
    append_name(name, data);
    return 0;
  };
  checked(H5Literate(group.get(), H5_INDEX_NAME, H5_ITER_INC, nullptr, append, &names), "list " + path);
  return names;
}

// `path` is that of the object, without a slash at its end.
void list_below(const File &file, const std::string &path, int depth, std::vector<std::string> &found) {
  if (depth > deepest_group) {
    throw FileError("links of " + path + " lead in a circle");
  }
  const std::string name = path.empty() ? "/" : path;
  const Object object(checked(H5Oopen(file.get(), name.c_str(), H5P_DEFAULT), "open " + name));
  for (const std::string &attribute : attribute_names(object, name)) {
    found.push_back(name + "@" + attribute);
  }
  if (H5Iget_type(object.get()) != H5I_GROUP) {
    found.push_back(name);
    return;
  }
  found.push_back(path + "/");
  for (const std::string &member : member_names(object, name)) {
    list_below(file, path + "/" + member, depth + 1, found);
  }
}

std::string type_in_words(const Datatype &type) {
  static constexpr std::array<const char *, 11> classes{"integer",  "float",    "time",     "string",
                                                        "bitfield", "opaque",   "compound", "reference",
                                                        "enum",     "variable", "array"};
  const auto type_class = static_cast<std::size_t>(H5Tget_class(type.get()));
  const bool is_variable = type_class == H5T_VLEN || H5Tis_variable_str(type.get()) > 0;
  if (type_class >= classes.size() || is_variable) {
    throw FileError("cannot read values of variable length");
  }
  std::string words =
      std::string(classes[type_class]) + " of " + std::to_string(H5Tget_size(type.get())) + " bytes";
  if (type_class == H5T_INTEGER) {
    words += H5Tget_sign(type.get()) == H5T_SGN_NONE ? ", unsigned" : ", signed";
  }
  if (type_class == H5T_STRING) {
    words += ", padding " + std::to_string(H5Tget_strpad(type.get())) + ", character set " +
             std::to_string(H5Tget_cset(type.get()));
  }
  return words + (H5Tget_order(type.get()) == H5T_ORDER_BE ? ", big endian" : "");
}

/// That many bytes can be in the file: a damaged header may claim any number of them.
void expect_within_file(hid_t object, const std::string &path, double bytes) {
  const File file(checked(H5Iget_file_id(object), "read " + path));
  hsize_t size = 0;
  checked(H5Fget_filesize(file.get(), &size), "read " + path);
  if (bytes > static_cast<double>(size)) {
    throw FileError(fmt::format("cannot read {}: it claims {:g} bytes in a file of {}", path, bytes, size));
  }
}

double bytes_of(const Dataspace &space, const Datatype &type) {
  return static_cast<double>(H5Sget_simple_extent_npoints(space.get())) *
         static_cast<double>(H5Tget_size(type.get()));
}

// Shape and type of a dataset or attribute; room for its bytes. Our files do not compress.
Content describe(hid_t object, const std::string &path, const Dataspace &space, const Datatype &type) {
  Content content{path, type_in_words(type), {}, {}};
  const int dimensions = checked(H5Sget_simple_extent_ndims(space.get()), "read the shape of " + path);
  content.shape.resize(static_cast<std::size_t>(dimensions));
  checked(H5Sget_simple_extent_dims(space.get(), content.shape.data(), nullptr), "read the shape of " + path);
  const auto count = static_cast<std::size_t>(
      checked(H5Sget_simple_extent_npoints(space.get()), "read the shape of " + path));
  expect_within_file(object, path, bytes_of(space, type));
  content.bytes.resize(count * H5Tget_size(type.get()));
  return content;
}

} // namespace

Properties foreign_access() {
  Properties access(checked(H5Pcreate(H5P_FILE_ACCESS), "set up file access"));
  checked(H5Pset_fapl_mpio(access.get(), MPI_COMM_SELF, MPI_INFO_NULL), "set up file access");
  return access;
}

// HDF5 would wait for what a pipe gives.
File open_to_read(const std::filesystem::path &path, hid_t access) {
  if (const InputFile file = look_at_input_file(path.string()); !file.trouble.empty()) {
    throw FileError("cannot open " + path.string() + ": " + file.trouble);
  }
  return File(checked(H5Fopen(path.c_str(), H5F_ACC_RDONLY, access), "open " + path.string()));
}

std::vector<std::string> list_contents(const File &file) {
  std::vector<std::string> found;
  list_below(file, "", 0, found);
  std::sort(found.begin(), found.end());
  return found;
}

Content read_content(const File &file, const std::string &path) {
  const std::string what = "read " + path;
  if (path.ends_with('/')) {
    return {path, "group", {}, {}};
  }
  const std::size_t at = path.find('@');
  const Object object(checked(H5Oopen(file.get(), path.substr(0, at).c_str(), H5P_DEFAULT), what));
  if (at != std::string::npos) {
    const Attribute attribute(checked(H5Aopen(object.get(), path.c_str() + at + 1, H5P_DEFAULT), what));
    const Datatype type(checked(H5Aget_type(attribute.get()), what));
    Content content =
        describe(attribute.get(), path, Dataspace(checked(H5Aget_space(attribute.get()), what)), type);
    checked(H5Aread(attribute.get(), type.get(), content.bytes.data()), what);
    return content;
  }
  const Datatype type(checked(H5Dget_type(object.get()), what));
  Content content = describe(object.get(), path, Dataspace(checked(H5Dget_space(object.get()), what)), type);
  if (!content.bytes.empty()) {
    checked(H5Dread(object.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, content.bytes.data()), what);
  }
  return content;
}

template <class T> std::vector<T> read_numbers(const File &file, const std::string &path) {
  const Content content = read_content(file, path);
  const Datatype expected(H5Tcopy(NumberType<T>::file()));
  if (content.type != type_in_words(expected)) {
    throw FileError("cannot read " + path + ": it is " + content.type);
  }
  std::vector<T> values(content.bytes.size() / sizeof(T));
  if (!values.empty()) {
    std::memcpy(values.data(), content.bytes.data(), content.bytes.size());
  }
  return values;
}

template std::vector<double> read_numbers(const File &, const std::string &);
template std::vector<std::int64_t> read_numbers(const File &, const std::string &);
template std::vector<std::int32_t> read_numbers(const File &, const std::string &);
template std::vector<std::uint8_t> read_numbers(const File &, const std::string &);

struct CollectiveInput::Slab {
  hsize_t first;
  hsize_t count;
  hsize_t columns;
  hid_t type;
  void *target;
};

CollectiveInput::CollectiveInput(const Communicator &communicator, std::filesystem::path path)
    : communicator_(communicator), path_(std::move(path)) {
  on_all_ranks(communicator_, [&] {
    const Properties access(checked(H5Pcreate(H5P_FILE_ACCESS), "set up parallel file access"));
    const MPI_Comm native = *static_cast<const MPI_Comm *>(communicator_.native());
    checked(H5Pset_fapl_mpio(access.get(), native, MPI_INFO_NULL), "set up parallel file access");
    checked(H5Pset_all_coll_metadata_ops(access.get(), true), "set up collective metadata");
    file_ = File(checked(H5Fopen(path_.c_str(), H5F_ACC_RDONLY, access.get()), "open " + path_.string()));
  });
}

std::int64_t CollectiveInput::num_rows(const std::string &name) {
  const std::string what = "read " + path_.string() + " at " + name;
  std::array<hsize_t, 2> shape{};
  on_all_ranks(communicator_, [&] {
    if (H5Lexists(file_.get(), name.c_str(), H5P_DEFAULT) > 0) {
      const Dataset dataset(checked(H5Dopen2(file_.get(), name.c_str(), H5P_DEFAULT), what));
      const Dataspace space(checked(H5Dget_space(dataset.get()), what));
      if (H5Sget_simple_extent_ndims(space.get()) > 2) {
        throw FileError("cannot " + what + ": it has more than two dimensions");
      }
      checked(H5Sget_simple_extent_dims(space.get(), shape.data(), nullptr), what);
    }
  });
  return static_cast<std::int64_t>(shape[0]);
}

void CollectiveInput::read_piece(const Dataset &dataset, const std::string &what, const Slab &slab) {
  Dataspace file_space;
  Dataspace memory_space;
  const Properties transfer(H5Pcreate(H5P_DATASET_XFER));
  on_all_ranks(communicator_, [&] {
    file_space = Dataspace(checked(H5Dget_space(dataset.get()), what));
    const std::array<hsize_t, 2> extent{std::max<hsize_t>(slab.count, 1), slab.columns};
    const int dimensions = slab.columns > 1 ? 2 : 1;
    memory_space = Dataspace(checked(H5Screate_simple(dimensions, extent.data(), nullptr), what));
    if (slab.count == 0) {
      checked(H5Sselect_none(file_space.get()), what);
      checked(H5Sselect_none(memory_space.get()), what);
    } else {
      const std::array<hsize_t, 2> start{slab.first, 0};
      checked(H5Sselect_hyperslab(file_space.get(), H5S_SELECT_SET, start.data(), nullptr, extent.data(),
                                  nullptr),
              what);
    }
    checked(H5Pset_dxpl_mpio(transfer.get(), H5FD_MPIO_COLLECTIVE), what);
  });
  on_all_ranks(communicator_, [&] {
    checked(
        H5Dread(dataset.get(), slab.type, memory_space.get(), file_space.get(), transfer.get(), slab.target),
        what);
  });
}

template <class T>
std::vector<T> CollectiveInput::rows(const std::string &name, std::int64_t first, std::int64_t count,
                                     hsize_t columns) {
  const std::string what = "read " + path_.string() + " at " + name;
  Dataset dataset;
  std::vector<T> values;
  on_all_ranks(communicator_, [&] {
    dataset = Dataset(checked(H5Dopen2(file_.get(), name.c_str(), H5P_DEFAULT), what));
    values.resize(static_cast<std::size_t>(count) * columns);
  });
  // MPI-IO counts bytes in 32 bits, and buffers what it reads.
  constexpr std::size_t most_bytes = std::size_t{64} << 20;
  const auto piece = static_cast<std::int64_t>(most_bytes / (sizeof(T) * columns));
  std::int64_t num_pieces = (count + piece - 1) / piece;
  communicator_.max(std::span(&num_pieces, 1));
  for (std::int64_t k = 0; k < num_pieces; ++k) {
    const std::int64_t begin = std::min(k * piece, count);
    const std::int64_t end = std::min(begin + piece, count);
    T nothing{}; // a rank without rows still takes part; HDF5 refuses a null pointer from it
    read_piece(dataset, what,
               {static_cast<hsize_t>(first + begin), static_cast<hsize_t>(end - begin), columns,
                NumberType<T>::memory(),
                begin == end ? &nothing : values.data() + static_cast<std::size_t>(begin) * columns});
  }
  return values;
}

template std::vector<double> CollectiveInput::rows(const std::string &, std::int64_t, std::int64_t, hsize_t);
template std::vector<std::int64_t> CollectiveInput::rows(const std::string &, std::int64_t, std::int64_t,
                                                         hsize_t);
template std::vector<std::int32_t> CollectiveInput::rows(const std::string &, std::int64_t, std::int64_t,
                                                         hsize_t);
template std::vector<std::uint8_t> CollectiveInput::rows(const std::string &, std::int64_t, std::int64_t,
                                                         hsize_t);

} // namespace gcpdda::hdf5
