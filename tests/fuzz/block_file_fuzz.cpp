// Any HDF5 file is a block file or gets faults. The bytes say how a good file is changed: which datasets it
// has, their types, shapes and values, what stands in their place, and what is broken in the written file.

#include "base/check.hpp"
#include "io/blocks/block_file.hpp"
#include "scene_checks.hpp"
#include "support/block_file_writer.hpp"

#include <fuzzer/FuzzedDataProvider.h>

#include <unistd.h>

#include <array>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <memory>
#include <string>
#include <vector>

namespace gcpdda::fuzz {
namespace {

using testing::BlockFileWriter;
using Bytes = FuzzedDataProvider;

/// Of a file; the types of the changes stay open for all files.
constexpr unsigned open_kinds = H5F_OBJ_FILE | H5F_OBJ_DATASET | H5F_OBJ_GROUP | H5F_OBJ_ATTR;

const std::array<std::string, 5> names{"points", "offsets", "material", "fixed", "velocity"};

std::vector<SceneBlock> good_blocks(std::size_t count) {
  std::vector<SceneBlock> blocks(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double x = 3.0 * static_cast<double>(i);
    blocks[i].vertices = {{x, 0}, {x + 2, 0}, {x + 2, 2}};
    if (i % 2 == 1) {
      blocks[i].vertices.insert(blocks[i].vertices.end(), {{x + 1, 0.5}, {x, 2}});
    }
    blocks[i].fixed = i % 3 == 0;
    if (!blocks[i].fixed) {
      blocks[i].velocity = {0, -1, 0.5};
    }
  }
  return blocks;
}

/// Made once: HDF5 keeps them until the end.
const std::vector<hid_t> &types() {
  static const std::vector<hid_t> all = [] {
    const hid_t text = H5Tcopy(H5T_C_S1);
    H5Tset_size(text, 8);
    const hid_t endless_text = H5Tcopy(H5T_C_S1);
    H5Tset_size(endless_text, H5T_VARIABLE);
    const hid_t pair = H5Tcreate(H5T_COMPOUND, 16);
    H5Tinsert(pair, "r", 0, H5T_NATIVE_DOUBLE);
    H5Tinsert(pair, "i", 8, H5T_NATIVE_DOUBLE);
    const hid_t boolean = H5Tenum_create(H5T_NATIVE_INT8);
    for (const std::int8_t value : {std::int8_t{0}, std::int8_t{1}}) {
      H5Tenum_insert(boolean, value == 0 ? "FALSE" : "TRUE", &value);
    }
    const hsize_t two = 2;
    const hid_t half = H5Tcopy(H5T_IEEE_F32LE);
    H5Tset_fields(half, 15, 10, 5, 0, 10);
    H5Tset_size(half, 2);
    const hid_t narrow = H5Tcopy(H5T_STD_I64LE);
    H5Tset_precision(narrow, 5);
    return std::vector<hid_t>{H5T_IEEE_F64LE, H5T_IEEE_F64BE, H5T_IEEE_F32LE, H5T_STD_I64LE, H5T_STD_I64BE,
                              H5T_STD_U64LE, H5T_STD_I32LE, H5T_STD_I32BE, H5T_STD_U32LE, H5T_STD_I16LE,
                              H5T_STD_U8LE, H5T_STD_I8LE, H5T_STD_B8LE, H5T_UNIX_D32LE, text, pair, boolean,
                              half, narrow, H5Tarray_create2(H5T_NATIVE_DOUBLE, 1, &two),
                              // Values of these point elsewhere: never written.
                              endless_text, H5Tvlen_create(H5T_NATIVE_DOUBLE), H5T_STD_REF_OBJ};
  }();
  return all;
}

bool holds_pointers(hid_t type) {
  const H5T_class_t kind = H5Tget_class(type);
  return kind == H5T_VLEN || kind == H5T_REFERENCE || H5Tis_variable_str(type) > 0;
}

/// As many bytes as type and shape need; none where that is too much for a test.
void fit(BlockFileWriter::Dataset &dataset) {
  constexpr double most = 1 << 20;
  double size = static_cast<double>(H5Tget_size(dataset.type));
  for (const hsize_t extent : dataset.shape) {
    size *= static_cast<double>(extent);
    dataset.chunked = dataset.chunked && extent >= 2; // a chunk is 2 long
  }
  dataset.bytes.resize(size > most || holds_pointers(dataset.type) ? 0 : static_cast<std::size_t>(size));
  // Many small chunks cost much time.
  dataset.chunked = dataset.chunked && !dataset.shape.empty() && dataset.bytes.size() <= 4096;
}

hsize_t any_extent(Bytes &bytes) {
  constexpr hsize_t most = std::numeric_limits<hsize_t>::max();
  switch (bytes.ConsumeIntegralInRange<int>(0, 4)) {
  case 0:
    return bytes.PickValueInArray<hsize_t>({1ULL << 31, 1ULL << 32, 1ULL << 40, 1ULL << 60, 1ULL << 61,
                                            1ULL << 62, 1ULL << 63, (1ULL << 63) + 1, most - 1,
                                            most / 16 + 1});
  case 1:
    return bytes.ConsumeIntegralInRange<hsize_t>(0, 100'000);
  default:
    return bytes.ConsumeIntegralInRange<hsize_t>(0, 30);
  }
}

/// One value of the dataset, by its size.
void change_value(Bytes &bytes, BlockFileWriter::Dataset &dataset) {
  const std::size_t size = H5Tget_size(dataset.type);
  if (dataset.bytes.size() < size) {
    return;
  }
  std::array<char, 8> value{};
  const auto put = [&](auto x) { std::memcpy(value.data(), &x, sizeof x); };
  switch (bytes.ConsumeIntegralInRange<int>(0, 3)) {
  case 0:
    put(bytes.PickValueInArray({std::numeric_limits<double>::quiet_NaN(), 1e308, -1e9, 1e9, 1e-320,
                                -std::numeric_limits<double>::infinity(), 0.0, 1.0, 2.0}));
    break;
  case 1:
    put(bytes.PickValueInArray<std::int64_t>({-1, 1LL << 31, 1LL << 62,
                                              std::numeric_limits<std::int64_t>::min(),
                                              std::numeric_limits<std::int64_t>::max()}));
    break;
  case 2:
    put(bytes.ConsumeIntegralInRange<std::int64_t>(-2, 40));
    break;
  default:
    put(bytes.ConsumeIntegral<std::int64_t>());
  }
  const std::size_t index = bytes.ConsumeIntegralInRange<std::size_t>(0, dataset.bytes.size() / size - 1);
  std::memcpy(dataset.bytes.data() + index * size, value.data(), std::min(size, value.size()));
}

void change(Bytes &bytes, BlockFileWriter &file, std::vector<std::string> &replaced) {
  const std::string &name = bytes.PickValueInArray(names);
  BlockFileWriter::Dataset &dataset = file[name];
  if (dataset.type < 0) { // taken away before
    dataset.type = H5T_NATIVE_DOUBLE;
    dataset.shape = {0};
  }
  switch (bytes.ConsumeIntegralInRange<int>(0, 7)) {
  case 7:
    file.remove(name);
    return;
  case 1:
    file.rename(name, bytes.PickValueInArray({"point", "offset", "materials", "Fixed", "velocities", "x"}));
    return;
  case 2:
    file.remove(name);
    replaced.push_back(name);
    return;
  case 3:
    dataset.type = types()[bytes.ConsumeIntegralInRange<std::size_t>(0, types().size() - 1)];
    break;
  case 4:
    dataset.shape.resize(bytes.ConsumeIntegralInRange<std::size_t>(0, 4));
    for (hsize_t &extent : dataset.shape) {
      extent = any_extent(bytes);
    }
    break;
  case 5:
    dataset.chunked = !dataset.chunked;
    break;
  case 6:
    dataset.bytes.clear();
    return;
  default:
    change_value(bytes, dataset);
  }
  fit(dataset);
}

/// Puts something else where a dataset stood.
void replace(Bytes &bytes, const std::string &path, const std::string &name) {
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  const char *at = name.c_str();
  switch (bytes.ConsumeIntegralInRange<int>(0, 5)) {
  case 0:
    H5Gclose(H5Gcreate2(file, at, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
    break;
  case 1:
    H5Lcreate_soft(bytes.PickValueInArray(names).c_str(), file, at, H5P_DEFAULT, H5P_DEFAULT);
    break;
  case 2:
    H5Lcreate_external(path.c_str(), bytes.PickValueInArray(names).c_str(), file, at, H5P_DEFAULT,
                       H5P_DEFAULT);
    break;
  case 3:
    H5Lcreate_hard(file, bytes.PickValueInArray(names).c_str(), file, at, H5P_DEFAULT, H5P_DEFAULT);
    break;
  case 4: {
    const hid_t type = H5Tcopy(H5T_NATIVE_DOUBLE);
    H5Tcommit2(file, at, type, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    H5Tclose(type);
    break;
  }
  default: {
    const hid_t nothing = H5Screate(H5S_NULL);
    H5Dclose(H5Dcreate2(file, at, H5T_NATIVE_DOUBLE, nothing, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
    H5Sclose(nothing);
  }
  }
  H5Fclose(file);
}

/// Closes what a writer leaves open that meets what HDF5 refuses to write.
void close_all() {
  for (const unsigned kind : {H5F_OBJ_DATASET | H5F_OBJ_GROUP | H5F_OBJ_ATTR, H5F_OBJ_FILE}) {
    std::vector<hid_t> ids(static_cast<std::size_t>(H5Fget_obj_count(H5F_OBJ_ALL, kind)));
    H5Fget_obj_ids(H5F_OBJ_ALL, kind, ids.size(), ids.data());
    for (const hid_t id : ids) {
      H5Idec_ref(id);
    }
  }
}

/// Cuts the file short or changes bytes of it; true if it does.
bool damage(Bytes &bytes, const std::string &path) {
  const int kind = bytes.ConsumeIntegralInRange<int>(0, 7);
  if (kind < 6) {
    return false;
  }
  const auto size = std::filesystem::file_size(path);
  if (kind == 6) {
    std::filesystem::resize_file(path, bytes.ConsumeIntegralInRange<std::uintmax_t>(0, size));
    return true;
  }
  std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
  for (int i = bytes.ConsumeIntegralInRange<int>(1, 4); i > 0; --i) {
    file.seekp(static_cast<std::streamoff>(bytes.ConsumeIntegralInRange<std::uintmax_t>(0, size - 1)));
    file.put(bytes.ConsumeIntegral<char>());
  }
  return true;
}

void check_faults(const Diagnostics &faults) {
  require(faults.size() <= 64, "a file does not make endless faults");
  for (const Diagnostic &d : faults) {
    require(d.severity == Severity::error && !d.where.file.empty(), "a fault is in a file");
    check_message(d);
  }
}

/// All blocks in one piece or as two ranks would.
void read(Bytes &bytes, const Communicator &self, const Scene &scene) {
  const std::int64_t count = scene.block_file.num_blocks;
  require(count >= 1, "a file without faults has blocks");
  std::vector<SceneBlock> all;
  const Diagnostics faults = read_block_file(self, scene, 0, count, all);
  check_faults(faults);
  const std::int64_t cut = bytes.ConsumeIntegralInRange<std::int64_t>(0, count);
  std::vector<SceneBlock> parts;
  Diagnostics faults_of_parts = read_block_file(self, scene, 0, cut, parts);
  for (const Diagnostic &d : read_block_file(self, scene, cut, count, parts)) {
    faults_of_parts.push_back(d);
  }
  check_faults(faults_of_parts);
  require(faults.empty() == faults_of_parts.empty(), "parts have the faults of the whole",
          to_string((faults.empty() ? faults_of_parts : faults).empty()
                        ? Diagnostic{}
                        : (faults.empty() ? faults_of_parts : faults).front()));
  if (!faults.empty()) {
    return;
  }
  require(static_cast<std::int64_t>(all.size()) == count && parts.size() == all.size(),
          "all blocks are read");
  for (std::size_t i = 0; i < all.size(); ++i) {
    check_block(all[i], scene.materials.size());
    require(all[i].vertices == parts[i].vertices && all[i].velocity == parts[i].velocity &&
                all[i].material == parts[i].material && all[i].fixed == parts[i].fixed,
            "parts have the blocks of the whole");
  }
}

/// False where HDF5 refuses to write such a file.
bool write(Bytes &bytes, const std::string &path) {
  BlockFileWriter writer(good_blocks(bytes.ConsumeIntegralInRange<std::size_t>(0, 8)));
  std::vector<std::string> replaced;
  for (int i = bytes.ConsumeIntegralInRange<int>(0, 8); i > 0; --i) {
    change(bytes, writer, replaced);
  }
  try {
    writer.write(path);
  } catch (const std::runtime_error &) {
    close_all();
    return false;
  }
  for (const std::string &name : replaced) {
    replace(bytes, path, name);
  }
  return true;
}

const std::unique_ptr<MpiScope> &mpi(int *argc = nullptr, char ***argv = nullptr) {
  static const auto scope = std::make_unique<MpiScope>(*argc, *argv);
  return scope;
}

void run(Bytes bytes) {
  static const Communicator self = Communicator::self();
  static const std::string path =
      std::filesystem::temp_directory_path() / ("gcpdda_fuzz_" + std::to_string(getpid()) + ".h5");
  if (!write(bytes, path)) {
    return;
  }
  const bool damaged = damage(bytes, path);
  Scene scene;
  scene.materials.resize(1);
  scene.block_file.path = path;
  try {
    const Diagnostics faults = open_block_file(self, scene);
    check_faults(faults);
    if (faults.empty()) {
      read(bytes, self, scene);
    }
  } catch (const FileError &error) {
    require(damaged, "a file that can be written can be read", error.what());
  }
  require(H5Fget_obj_count(H5F_OBJ_ALL, open_kinds) == 0 || damaged, "nothing stays open");
}

} // namespace
} // namespace gcpdda::fuzz

/// The leak checker stumbles over the threads of MPI. A damaged header may ask HDF5 for gigabytes: its malloc
/// gets none, as on a small machine, and HDF5 gives the file up. Where our own code asks for as much,
/// operator new ends the run.
extern "C" const char *__asan_default_options() {
  return "detect_leaks=0:max_allocation_size_mb=256:allocator_may_return_null=1";
}

extern "C" int LLVMFuzzerInitialize(int *argc, char ***argv) {
  setenv("OMPI_MCA_opal_signal", "", 1); // else Open MPI takes the crashes that libFuzzer keeps inputs of
  gcpdda::fuzz::mpi(argc, argv);
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
  gcpdda::fuzz::run(FuzzedDataProvider(data, size));
  return 0;
}
