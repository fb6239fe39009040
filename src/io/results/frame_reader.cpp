
#include "io/results/frame_reader.hpp"

#include "io/hdf5/hdf5_input.hpp"
#include "io/results/frame_fields.hpp"

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
  for_each_field(block_fields, [&](const auto &field) {
    file.read(std::string("CellData/") + field.name, content.*field.column);
  });
  return content;
}

ContactFrameContent read_contact_frame(const std::filesystem::path &path) {
  const FrameFile file(path);
  ContactFrameContent content;
  content.time = file.time();
  file.read("Points", content.points);
  for_each_field(contact_fields, [&](const auto &field) {
    file.read(std::string("CellData/") + field.name, content.*field.column);
  });
  return content;
}

} // namespace gcpdda
