// frame_writes FOLDER [BLOCKS]: frames of quadrilaterals against one dataset of as many bytes written by
// parallel HDF5 alone, both synced to the disk, by turns. Run by mpirun; prints medians of 7 and their
// ratios.

#include "gcpdda/io/frame_rows.hpp"
#include "gcpdda/io/frame_writer.hpp"

#include <fmt/format.h>
#include <hdf5.h>
#include <mpi.h>

#include <algorithm>
#include <chrono>
#include <ctime>
#include <fcntl.h>
#include <iostream>
#include <iterator>
#include <unistd.h>
#include <vector>

namespace gcpdda {
namespace {

constexpr int repeats = 7;

/// Of quadrilaterals that lie on this rank in patches, as a partition leaves them.
class Patches : public FrameSource {
public:
  Patches(const Communicator &world, std::int64_t num_blocks) {
    constexpr std::int64_t patch = 512;
    for (std::int64_t id = 0; id < num_blocks; ++id) {
      if (id / patch % world.size() != world.rank()) {
        continue;
      }
      FrameRow row;
      row.block = id;
      row.num_vertices = 4;
      row.rotation = 1e-3 * static_cast<double>(id);
      rows_.push_back(row);
      const std::int64_t line = id / 1000;
      const Vec2 corner{static_cast<double>(id % 1000), static_cast<double>(line)};
      for (const Vec2 offset : {Vec2{0.0, 0.0}, Vec2{1.0, 0.0}, Vec2{1.0, 1.0}, Vec2{0.0, 1.0}}) {
        vertices_.push_back(corner + offset);
      }
    }
  }
  [[nodiscard]] std::int64_t num_rows() const override { return std::ssize(rows_); }
  void append(std::int64_t first, std::int64_t last, std::vector<FrameRow> &rows,
              std::vector<Vec2> &vertices) const override {
    const auto begin = at(first);
    const auto end = at(last);
    rows.insert(rows.end(), begin, end);
    vertices.insert(vertices.end(), vertices_.begin() + 4 * (begin - rows_.begin()),
                    vertices_.begin() + 4 * (end - rows_.begin()));
  }

private:
  [[nodiscard]] std::vector<FrameRow>::const_iterator at(std::int64_t block) const {
    return std::lower_bound(rows_.begin(), rows_.end(), block,
                            [](const FrameRow &row, std::int64_t id) { return row.block < id; });
  }

  std::vector<FrameRow> rows_;
  std::vector<Vec2> vertices_;
};

void write_plain(const Communicator &world, const std::filesystem::path &path,
                 const std::vector<double> &mine) {
  const MPI_Comm native = *static_cast<const MPI_Comm *>(world.native());
  const hid_t access = H5Pcreate(H5P_FILE_ACCESS);
  H5Pset_fapl_mpio(access, native, MPI_INFO_NULL);
  const hid_t file = H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access);
  const hsize_t count = mine.size();
  const hsize_t total = count * static_cast<hsize_t>(world.size());
  const hsize_t first = count * static_cast<hsize_t>(world.rank());
  const hid_t file_space = H5Screate_simple(1, &total, nullptr);
  const hid_t memory_space = H5Screate_simple(1, &count, nullptr);
  H5Sselect_hyperslab(file_space, H5S_SELECT_SET, &first, nullptr, &count, nullptr);
  const hid_t dataset =
      H5Dcreate2(file, "values", H5T_NATIVE_DOUBLE, file_space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  const hid_t transfer = H5Pcreate(H5P_DATASET_XFER);
  H5Pset_dxpl_mpio(transfer, H5FD_MPIO_COLLECTIVE);
  const bool written =
      H5Dwrite(dataset, H5T_NATIVE_DOUBLE, memory_space, file_space, transfer, mine.data()) >= 0;
  for (const hid_t space : {file_space, memory_space}) {
    H5Sclose(space);
  }
  H5Pclose(transfer);
  H5Pclose(access);
  H5Dclose(dataset);
  H5Fclose(file);
  if (!written) {
    throw std::runtime_error("cannot write " + path.string());
  }
  if (world.is_root()) {
    const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
    ::fsync(descriptor);
    ::close(descriptor);
  }
  world.barrier();
}

struct Cost {
  double wall = 0.0; ///< s, of the slowest rank
  double cpu = 0.0;  ///< s, of all ranks: says more than the wall where others use the machine, too
};

template <class Act> Cost cost_of(const Communicator &world, Act &&act) {
  world.barrier();
  const auto start = std::chrono::steady_clock::now();
  const std::clock_t cpu_start = std::clock();
  act();
  Cost cost{std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(), 0.0};
  const double cpu = static_cast<double>(std::clock() - cpu_start) / CLOCKS_PER_SEC;
  world.max(std::span(&cost.wall, 1));
  for (const auto &of_rank : world.all_gather(std::vector<double>{cpu})) {
    cost.cpu += of_rank[0];
  }
  return cost;
}

double median(const std::vector<Cost> &costs, double Cost::*kind) {
  std::vector<double> values;
  std::transform(costs.begin(), costs.end(), std::back_inserter(values),
                 [kind](const Cost &cost) { return cost.*kind; });
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

int compare(const Communicator &world, const std::filesystem::path &folder, std::int64_t num_blocks) {
  const Patches patches(world, num_blocks);
  FrameWriter writer(world, folder, num_blocks);
  writer.write(0, 0.0, patches); // the topology is written once in a run
  writer.finish();
  const std::filesystem::path frame = folder / "frames" / "frame_000000.hdf";
  const std::uintmax_t bytes = std::filesystem::file_size(frame);
  const std::vector<double> mine(bytes / sizeof(double) / static_cast<std::size_t>(world.size()), 1.5);
  std::vector<Cost> frames;
  std::vector<Cost> plain;
  for (int k = 1; k <= repeats; ++k) {
    frames.push_back(cost_of(world, [&] {
      writer.write(k, k, patches);
      writer.finish();
    }));
    plain.push_back(
        cost_of(world, [&] { write_plain(world, folder / fmt::format("plain_{}.h5", k), mine); }));
    if (world.is_root()) { // or the memory that holds files grows from round to round
      std::filesystem::remove(folder / "frames" / fmt::format("frame_{:06}.hdf", k));
      std::filesystem::remove(folder / fmt::format("plain_{}.h5", k));
    }
  }
  if (world.is_root()) {
    std::cout << fmt::format(
        "{} blocks, {} ranks, {} bytes a frame: frame {:.4f} s, plain {:.4f} s, share of its "
        "rate {:.3f}; CPU {:.4f} s and {:.4f} s, {:.3f}\n",
        num_blocks, world.size(), bytes, median(frames, &Cost::wall), median(plain, &Cost::wall),
        median(plain, &Cost::wall) / median(frames, &Cost::wall), median(frames, &Cost::cpu),
        median(plain, &Cost::cpu), median(plain, &Cost::cpu) / median(frames, &Cost::cpu));
  }
  return 0;
}

} // namespace
} // namespace gcpdda

int main(int argc, char **argv) {
  const gcpdda::MpiScope mpi(argc, argv);
  if (argc < 2 || argc > 3) {
    std::cerr << "frame_writes FOLDER [BLOCKS]\n";
    return 2;
  }
  return gcpdda::compare(gcpdda::Communicator::world(), argv[1], argc > 2 ? std::stoll(argv[2]) : 100000);
}
