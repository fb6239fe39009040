// Frames read back (run_comparison.hpp).

#include "io/results/run_comparison.hpp"

#include "io/hdf5/hdf5_input.hpp"

namespace gcpdda {

namespace {

// One file under VTKHDF; what is named is read to the type of where it goes.
class FrameFile {
public:
  explicit FrameFile(const std::filesystem::path &path) : file_(hdf5::open_to_read(path)) {}

  template <class T> void read(const std::string &name, std::vector<T> &values) const {
    values = hdf5::read_numbers<T>(file_, "/VTKHDF/" + name);
  }
  template <class T, std::size_t N>
  void read(const std::string &name, std::vector<std::array<T, N>> &rows) const {
    const std::vector<T> flat = hdf5::read_numbers<T>(file_, "/VTKHDF/" + name);
    rows.resize(flat.size() / N);
    for (std::size_t i = 0; i < N * rows.size(); ++i) {
      rows[i / N][i % N] = flat[i];
    }
  }
  [[nodiscard]] double time() const { return hdf5::read_numbers<double>(file_, "/VTKHDF@time").at(0); }

private:
  hdf5::QuietErrors quiet_;
  hdf5::File file_;
};

} // namespace

FrameContent read_frame(const std::filesystem::path &path) {
  const FrameFile file(path);
  FrameContent content;
  content.time = file.time();
  file.read("Points", content.points);
  file.read("Offsets", content.offsets);
  file.read("CellData/block", content.block);
  file.read("CellData/material", content.material);
  file.read("CellData/kind", content.kind);
  file.read("CellData/displacement", content.displacement);
  file.read("CellData/rotation", content.rotation);
  file.read("CellData/velocity", content.velocity);
  file.read("CellData/stress", content.stress);
  file.read("CellData/contact_force", content.contact_force);
  return content;
}

ContactFrameContent read_contact_frame(const std::filesystem::path &path) {
  const FrameFile file(path);
  ContactFrameContent content;
  content.time = file.time();
  file.read("Points", content.points);
  file.read("CellData/blocks", content.blocks);
  file.read("CellData/joint", content.joint);
  file.read("CellData/state", content.state);
  file.read("CellData/normal_force", content.normal_force);
  file.read("CellData/shear_force", content.shear_force);
  file.read("CellData/overlap", content.overlap);
  file.read("CellData/slip", content.slip);
  return content;
}

} // namespace gcpdda
