#include "io/hdf5/hdf5_collective_file.hpp"

#include "io/hdf5/durable_file.hpp"
#include "io/hdf5/unclosed_files.hpp"

#include <mpi.h>

#include <algorithm>
#include <utility>

namespace gcpdda {

namespace {

// HDF5 takes blocks of 2 KiB for its own data and for short datasets, and leaves of each less than what comes
// next. These are bounds, several times what it needs: bytes for all groups, links and attributes of a file,
// and what a dataset takes besides its rows.
constexpr std::int64_t room_for_file = 16384;
constexpr std::int64_t room_for_dataset = 4096;

bool close_failed = false;

bool close(hdf5::File &file) {
  const bool closed = file.close();
  close_failed = close_failed || !closed;
  return closed;
}

std::string file_name(const std::filesystem::path &path, const std::string &object) {
  return path.string() + (object.empty() ? "" : " at " + object);
}

hdf5::Properties parallel_access(const Communicator &communicator) {
  hdf5::Properties access(hdf5::checked(H5Pcreate(H5P_FILE_ACCESS), "set up parallel file access"));
  const MPI_Comm native = *static_cast<const MPI_Comm *>(communicator.native());
  hdf5::checked(H5Pset_fapl_mpio(access.get(), native, MPI_INFO_NULL), "set up parallel file access");
  hdf5::checked(H5Pset_coll_metadata_write(access.get(), true), "set up collective metadata");
  hdf5::checked(H5Pset_all_coll_metadata_ops(access.get(), true), "set up collective metadata");
  return access;
}

// No time stamps (files of two runs are equal), no fill values (every row is written).
hdf5::Properties plain_dataset() {
  hdf5::Properties creation(hdf5::checked(H5Pcreate(H5P_DATASET_CREATE), "describe a dataset"));
  hdf5::checked(H5Pset_obj_track_times(creation.get(), false), "describe a dataset");
  hdf5::checked(H5Pset_alloc_time(creation.get(), H5D_ALLOC_TIME_EARLY), "describe a dataset");
  hdf5::checked(H5Pset_fill_time(creation.get(), H5D_FILL_TIME_NEVER), "describe a dataset");
  return creation;
}

hdf5::Dataspace simple_space(hsize_t rows, hsize_t columns) {
  const std::array<hsize_t, 2> shape{rows, columns};
  return hdf5::Dataspace(
      hdf5::checked(H5Screate_simple(columns > 1 ? 2 : 1, shape.data(), nullptr), "describe a shape"));
}

} // namespace

bool has_unclosed_files() {
  return close_failed;
}

void on_all_ranks(const Communicator &communicator, const std::function<void()> &action) {
  std::string trouble;
  try {
    action();
  } catch (const std::exception &error) {
    trouble = error.what();
  }
  std::int64_t any = trouble.empty() ? 0 : 1;
  communicator.max(std::span(&any, 1));
  if (any == 0) {
    return;
  }
  const std::vector<std::vector<char>> texts =
      communicator.all_gather(std::vector<char>(trouble.begin(), trouble.end()));
  const auto first = std::find_if(texts.begin(), texts.end(), [](const auto &text) { return !text.empty(); });
  throw FileError(std::string(first->begin(), first->end()));
}

void on_root(const Communicator &communicator, const std::function<void()> &action) {
  on_all_ranks(communicator, [&] {
    if (communicator.is_root()) {
      action();
    }
  });
}

void expect_on_all_ranks(const Communicator &communicator, bool condition, const char *what) {
  std::int64_t broken = condition ? 0 : 1;
  communicator.max(std::span(&broken, 1));
  expect(broken == 0, what);
}

RowRange rows_in_rank_order(const Communicator &communicator, std::int64_t count) {
  RowRange range{0, count, 0};
  const auto counts = communicator.all_gather(std::vector<std::int64_t>{count});
  for (std::size_t rank = 0; rank < counts.size(); ++rank) {
    range.first += rank < static_cast<std::size_t>(communicator.rank()) ? counts[rank][0] : 0;
    range.total += counts[rank][0];
  }
  return range;
}

CollectiveFile::CollectiveFile(const Communicator &communicator, std::filesystem::path path,
                               std::int64_t user_block)
    : communicator_(communicator), path_(std::move(path)) {
  on_root(communicator_, [&] {
    if (std::filesystem::exists(path_) && !std::filesystem::is_regular_file(path_)) {
      throw FileError("cannot write " + path_.string() + ": there is something of this name that is no file");
    }
    // MPI-IO would truncate what is there, but keep its size on some file systems.
    std::filesystem::remove(unfinished_name(path_));
  });
  on_all_ranks(communicator_, [&] {
    const hdf5::Properties access = parallel_access(communicator_);
    const hdf5::Properties creation(hdf5::checked(H5Pcreate(H5P_FILE_CREATE), "describe a file"));
    hdf5::checked(H5Pset_userblock(creation.get(), static_cast<hsize_t>(user_block)), "describe a file");
    file_ = hdf5::File(
        hdf5::checked(H5Fcreate(unfinished_name(path_).c_str(), H5F_ACC_TRUNC, creation.get(), access.get()),
                      "create " + unfinished_name(path_).string()));
  });
}

CollectiveFile::~CollectiveFile() {
  close(file_);
  if (!is_complete_ && communicator_.is_root()) {
    std::error_code ignored;
    std::filesystem::remove(unfinished_name(path_), ignored);
  }
}

void CollectiveFile::group(const std::string &name) {
  on_all_ranks(communicator_, [&] {
    const hdf5::Properties creation(hdf5::checked(H5Pcreate(H5P_GROUP_CREATE), "describe a group"));
    hdf5::checked(H5Pset_obj_track_times(creation.get(), false), "describe a group");
    const hdf5::Group group(
        hdf5::checked(H5Gcreate2(file_.get(), name.c_str(), H5P_DEFAULT, creation.get(), H5P_DEFAULT),
                      "create " + file_name(path_, name)));
  });
}

// Open MPI's collective write returns success when the disk is full (4.1, fcoll/vulcan): the file would be
// published with holes. And where HDF5 cannot write its own data on one rank, the others wait for it, in
// closing the file too. So the place of every byte is taken before anything asks for it.
//
// The file is that long from then on, too, until HDF5 cuts it at its end in closing. MPI-IO writes pieces
// with gaps between them, such as HDF5's own data, as one stretch: what it reads from the file with the
// pieces put in. Behind the end it reads nothing, and the gaps would take what its buffer holds, memory of
// the program (Open MPI 4.1 fbtl/posix and ROMIO). Within the file they take zeros.
void CollectiveFile::reserve_space(std::int64_t rows_size) {
  const std::int64_t before =
      std::exchange(reserved_, std::max(reserved_, room_for_file) + rows_size + room_for_dataset);
  if (communicator_.is_root()) {
    reserve(path_, before, reserved_);
  }
}

CollectiveFile::Table CollectiveFile::make_table(const std::string &name, std::int64_t rows, hsize_t columns,
                                                 hid_t file_type, hid_t memory_type) {
  Table table{{}, memory_type, columns, rows};
  on_all_ranks(communicator_,
               [&] { reserve_space(rows * static_cast<std::int64_t>(columns * H5Tget_size(file_type))); });
  on_all_ranks(communicator_, [&] {
    const hdf5::Dataspace space = simple_space(static_cast<hsize_t>(rows), columns);
    const hdf5::Properties creation = plain_dataset();
    table.dataset = hdf5::Dataset(hdf5::checked(H5Dcreate2(file_.get(), name.c_str(), file_type, space.get(),
                                                           H5P_DEFAULT, creation.get(), H5P_DEFAULT),
                                                "write " + file_name(path_, name)));
  });
  return table;
}

void CollectiveFile::write_rows(const Table &table, std::int64_t first, hsize_t count, const void *values) {
  if (table.rows == 0) {
    return; // nothing is allocated then, and a collective write of nothing fails for want of an address
  }
  const std::string what = "write " + path_.string();
  const hdf5::Properties transfer(H5Pcreate(H5P_DATASET_XFER));
  try {
    const hdf5::Dataspace file_space = simple_space(static_cast<hsize_t>(table.rows), table.columns);
    const hdf5::Dataspace memory_space = simple_space(std::max<hsize_t>(count, 1), table.columns);
    if (count == 0) {
      hdf5::checked(H5Sselect_none(file_space.get()), what);
      hdf5::checked(H5Sselect_none(memory_space.get()), what);
    } else {
      const std::array<hsize_t, 2> start{static_cast<hsize_t>(first), 0};
      const std::array<hsize_t, 2> extent{count, table.columns};
      hdf5::checked(H5Sselect_hyperslab(file_space.get(), H5S_SELECT_SET, start.data(), nullptr,
                                        extent.data(), nullptr),
                    what);
    }
    hdf5::checked(H5Pset_dxpl_mpio(transfer.get(), H5FD_MPIO_COLLECTIVE), what);
    // A rank without rows still takes part; HDF5 refuses a null pointer from it.
    static constexpr double nothing = 0.0;
    hdf5::checked(H5Dwrite(table.dataset.get(), table.memory_type, memory_space.get(), file_space.get(),
                           transfer.get(), count == 0 ? &nothing : values),
                  what);
  } catch (const FileError &error) {
    failed_write_ = failed_write_.empty() ? error.what() : failed_write_;
  }
  H5D_mpio_actual_io_mode_t mode = H5D_MPIO_NO_COLLECTIVE;
  H5Pget_mpio_actual_io_mode(transfer.get(), &mode);
  all_writes_collective_ = all_writes_collective_ && mode != H5D_MPIO_NO_COLLECTIVE;
}

void CollectiveFile::agree_on_writes() {
  on_all_ranks(communicator_, [&] {
    if (!failed_write_.empty()) {
      throw FileError(failed_write_);
    }
  });
}

void CollectiveFile::number(const std::string &name, std::int64_t value) {
  const std::int64_t mine = communicator_.is_root() ? 1 : 0;
  dataset(name, {0, mine, 1}, std::vector<std::int64_t>(static_cast<std::size_t>(mine), value));
}

void CollectiveFile::write_attribute(const std::string &object, const std::string &name, hid_t space,
                                     Values value) {
  const std::string what = "write " + file_name(path_, object + "@" + name);
  on_all_ranks(communicator_, [&] {
    const hdf5::Attribute attribute(
        hdf5::checked(H5Acreate_by_name(file_.get(), object.c_str(), name.c_str(), value.file_type, space,
                                        H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                      what));
    hdf5::checked(H5Awrite(attribute.get(), value.memory_type, value.first), what);
  });
}

void CollectiveFile::attribute(const std::string &object, const std::string &name, double value) {
  const hdf5::Dataspace space(H5Screate(H5S_SCALAR));
  write_attribute(object, name, space.get(),
                  {NumberType<double>::file(), NumberType<double>::memory(), &value});
}

void CollectiveFile::attribute(const std::string &object, const std::string &name,
                               const std::array<std::int64_t, 2> &value) {
  const hdf5::Dataspace space = simple_space(value.size(), 1);
  write_attribute(object, name, space.get(),
                  {NumberType<std::int64_t>::file(), NumberType<std::int64_t>::memory(), value.data()});
}

void CollectiveFile::attribute(const std::string &object, const std::string &name, const std::string &ascii) {
  const hdf5::Dataspace space(H5Screate(H5S_SCALAR));
  const hdf5::Datatype type(H5Tcopy(H5T_C_S1));
  on_all_ranks(communicator_, [&] {
    hdf5::checked(H5Tset_size(type.get(), ascii.size()), "describe a text");
    hdf5::checked(H5Tset_strpad(type.get(), H5T_STR_NULLPAD), "describe a text");
  });
  write_attribute(object, name, space.get(), {type.get(), type.get(), ascii.data()});
}

void CollectiveFile::link(const std::string &name, const std::string &file) {
  on_all_ranks(communicator_, [&] {
    hdf5::checked(
        H5Lcreate_external(file.c_str(), name.c_str(), file_.get(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT),
        "link " + file_name(path_, name) + " to " + file);
  });
}

void CollectiveFile::start_to_sync() {
  gcpdda::start_to_sync(path_);
}

void CollectiveFile::complete() {
  agree_on_writes();
  on_all_ranks(communicator_, [&] {
    if (!close(file_)) {
      throw FileError("cannot close " + unfinished_name(path_).string() + ": " + hdf5::last_error());
    }
  });
  is_complete_ = true;
}

void CollectiveFile::publish() {
  complete();
  on_root(communicator_, [&] { gcpdda::publish(path_); });
}

} // namespace gcpdda
