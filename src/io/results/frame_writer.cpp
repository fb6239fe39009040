// One file per frame, its rows in BlockId order whatever the number of ranks: ids are cut into one slab per
// rank, every row travels once to the owner of its slab, and all ranks write their slabs together, strip by
// strip. What never changes is in a topology file of its own, which the frames link to.

#include "gcpdda/io/frame_writer.hpp"

#include "io/hdf5/durable_file.hpp"
#include "io/hdf5/hdf5_input.hpp"
#include "io/hdf5/numbered_name.hpp"
#include "io/hdf5/write_behind.hpp"
#include "io/results/bolt_frame_writer.hpp"
#include "io/results/contact_frame_writer.hpp"
#include "io/results/frame_fields.hpp"
#include "io/results/frame_strips.hpp"
#include "io/results/hdf5_vtk_layout.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <numeric>

namespace gcpdda {

namespace {

constexpr const char *xdmf_cells = "/XdmfTopology";

std::string frame_name(int index) {
  return fmt::format("frame_{:06}.hdf", index);
}

std::string topology_name(int index) {
  return fmt::format("topology_{:06}.h5", index);
}

/// Datasets of a topology.
class TopologyTables {
public:
  TopologyTables(CollectiveFile &file, std::int64_t num_cells, std::int64_t num_points)
      : file_(file), cells_(file, num_cells, num_points, vtk::CellType::polygon),
        fields_(file, constant_block_fields, num_cells),
        xdmf_table_(file.table<std::int64_t>(xdmf_cells, num_points + 2 * num_cells)) {}

  /// Collective.
  void write(std::int64_t first_cell, std::int64_t first_point,
             const std::vector<FrameStrips::PlacedRow> &rows, std::int64_t num_points) {
    fill(rows, first_point, static_cast<std::size_t>(num_points));
    cells_.write(first_cell, first_point, sizes_);
    fields_.write(file_, first_cell);
    file_.write(xdmf_table_, first_point + 2 * first_cell, std::span<const std::int64_t>(mixed_));
  }

private:
  void fill(const std::vector<FrameStrips::PlacedRow> &rows, std::int64_t first_point,
            std::size_t num_points) {
    sizes_.clear();
    fields_.start(rows.size());
    mixed_.resize(num_points + 2 * rows.size());
    std::int64_t *mixed = mixed_.data();
    std::int64_t vertex = first_point;
    for (const auto &[row, first] : rows) {
      sizes_.push_back(row->num_vertices);
      fields_.add(*row);
      // XDMF wants its own mixture: for each cell 3 (a polygon), the number of its vertices, their numbers.
      *mixed++ = 3;
      *mixed++ = row->num_vertices;
      std::iota(mixed, mixed + row->num_vertices, vertex);
      mixed += row->num_vertices;
      vertex += row->num_vertices;
    }
  }

  CollectiveFile &file_;
  vtk::CellTables cells_;
  FieldDatasets<decltype(constant_block_fields)> fields_;
  CollectiveFile::Table xdmf_table_;
  std::vector<std::int64_t> mixed_;
  std::vector<std::int32_t> sizes_; ///< vertices of each cell
};

/// Datasets of a frame.
class FrameTables {
public:
  FrameTables(CollectiveFile &file, std::int64_t num_cells, std::int64_t num_points)
      : file_(file), points_table_(file.table<double>(vtk::at("Points"), num_points, 3)),
        fields_(file, changing_block_fields, num_cells) {}

  /// Collective.
  void write(std::int64_t first_cell, std::int64_t first_point,
             const std::vector<FrameStrips::PlacedRow> &rows, std::int64_t num_points) {
    fill(rows, static_cast<std::size_t>(num_points));
    file_.write(points_table_, first_point, std::span<const double>(points_));
    fields_.write(file_, first_cell);
  }

private:
  void fill(const std::vector<FrameStrips::PlacedRow> &rows, std::size_t num_points) {
    points_.resize(3 * num_points);
    double *point = points_.data();
    fields_.start(rows.size());
    for (const auto &[row, first] : rows) {
      for (const Vec2 *vertex = first; vertex != first + row->num_vertices; ++vertex) {
        point = FieldValue<Triple>::put(point, {vertex->x, vertex->y, 0.0});
      }
      fields_.add(*row);
    }
  }

  CollectiveFile &file_;
  CollectiveFile::Table points_table_;
  std::vector<double> points_;
  FieldDatasets<decltype(changing_block_fields)> fields_;
};

/// @param kind  of the files, "frame", "bolts" or "liners"
std::string series_index(const std::vector<std::pair<int, double>> &frames, const char *kind) {
  std::string text = "{\n  \"file-series-version\": \"1.0\",\n  \"files\": [";
  const char *separator = "\n";
  for (const auto &[index, time] : frames) {
    text += fmt::format("{}    {{\"name\": \"frames/{}_{:06}.hdf\", \"time\": {:.17g}}}", separator, kind,
                        index, time);
    separator = ",\n";
  }
  return text + "\n  ]\n}\n";
}

template <class Number> constexpr const char *xdmf_number = nullptr; ///< NumberType and Precision
template <> constexpr const char *xdmf_number<std::int64_t> = "NumberType=\"Int\" Precision=\"8\"";
template <> constexpr const char *xdmf_number<std::int32_t> = "NumberType=\"Int\" Precision=\"4\"";
template <> constexpr const char *xdmf_number<std::uint8_t> = "NumberType=\"UChar\" Precision=\"1\"";
template <> constexpr const char *xdmf_number<double> = "NumberType=\"Float\" Precision=\"8\"";

std::string xdmf_item(const std::string &dimensions, const char *number, const std::string &file,
                      const std::string &dataset) {
  return fmt::format("<DataItem Format=\"HDF\" Dimensions=\"{}\" {}>frames/{}:{}</DataItem>", dimensions,
                     number, file, dataset);
}

struct IndexedFrame {
  int index;
  double time;
  std::int64_t num_blocks;
  std::int64_t num_points;
  std::string topology; ///< file
};

template <class Value>
std::string xdmf_attribute(const BlockField<Value> &field, std::int64_t num_blocks, const std::string &file) {
  constexpr bool is_vector = FieldValue<Value>::size > 1;
  const std::string dimensions =
      is_vector ? fmt::format("{} {}", num_blocks, FieldValue<Value>::size) : fmt::format("{}", num_blocks);
  return fmt::format("        <Attribute Name=\"{}\" AttributeType=\"{}\" Center=\"Cell\">{}</Attribute>\n",
                     field.name, is_vector ? "Vector" : "Scalar",
                     xdmf_item(dimensions, xdmf_number<typename FieldValue<Value>::Number>, file,
                               vtk::cell_data(field.name)));
}

std::string xdmf_index(const std::vector<IndexedFrame> &frames) {
  std::string text = "<?xml version=\"1.0\"?>\n<Xdmf Version=\"3.0\">\n  <Domain>\n"
                     "    <Grid Name=\"run\" GridType=\"Collection\" CollectionType=\"Temporal\">\n";
  for (const IndexedFrame &indexed : frames) {
    const auto &[index, time, num_blocks, num_points, topology] = indexed;
    const std::string frame = frame_name(index);
    text += fmt::format("      <Grid Name=\"{}\" GridType=\"Uniform\">\n        <Time Value=\"{:.17g}\"/>\n",
                        frame, time);
    text += fmt::format("        <Topology TopologyType=\"Mixed\" NumberOfElements=\"{}\">{}</Topology>\n",
                        num_blocks,
                        xdmf_item(fmt::format("{}", num_points + 2 * num_blocks),
                                  "NumberType=\"Int\" Precision=\"8\"", topology, xdmf_cells));
    text += fmt::format("        <Geometry GeometryType=\"XYZ\">{}</Geometry>\n",
                        xdmf_item(fmt::format("{} 3", num_points), "NumberType=\"Float\" Precision=\"8\"",
                                  frame, vtk::at("Points")));
    for_each_field(constant_block_fields, [&](const auto &field) {
      text += xdmf_attribute(field, indexed.num_blocks, indexed.topology);
    });
    for_each_field(changing_block_fields,
                   [&](const auto &field) { text += xdmf_attribute(field, indexed.num_blocks, frame); });
    text += "      </Grid>\n";
  }
  return text + "    </Grid>\n  </Domain>\n</Xdmf>\n";
}

} // namespace

FrameWriter::FrameWriter(const Communicator &communicator, std::filesystem::path directory,
                         std::int64_t num_blocks, std::int64_t ids_per_strip)
    : communicator_(communicator), directory_(std::move(directory)), behind_(std::make_unique<WriteBehind>()),
      num_blocks_(num_blocks), ids_per_strip_(ids_per_strip > 0 ? ids_per_strip : usual_ids_per_strip) {
  on_root(communicator_, [this] { make_directory(directory_ / "frames"); });
}

FrameWriter::~FrameWriter() = default;

// The same for all frames until blocks go: whoever owns them then, a strip has its place in the file.
FrameWriter::Topology FrameWriter::survey(int index, const FrameSource &source) {
  FrameStrips strips(communicator_, {num_blocks_, communicator_.size(), ids_per_strip_}, source);
  places_.clear();
  Place place;
  for (int number = 0; number < strips.size(); ++number) {
    strips.bring(number);
    place = {place.first_cell + place.num_cells, std::ssize(strips.rows()),
             place.first_point + place.num_points, strips.num_vertices()};
    places_.push_back(place);
  }
  const RowRange cells = rows_in_rank_order(communicator_, place.first_cell + place.num_cells);
  const RowRange points = rows_in_rank_order(communicator_, place.first_point + place.num_points);
  for (Place &strip : places_) {
    strip.first_cell += cells.first;
    strip.first_point += points.first;
  }
  expect_on_all_ranks(communicator_, strips.are_sound(),
                      "each block on exactly one rank's frame data, with its vertices");
  return {index, cells.total, points.total};
}

void FrameWriter::write(int index, double time, const FrameSource &source) {
  expect(frames_.empty() || index > frames_.back().first, "frames in the order of their numbers");
  finish(); // no more than one frame is on its way
  std::int64_t num_cells = source.num_rows();
  communicator_.sum(std::span(&num_cells, 1));
  if (topologies_.empty() || topologies_.back().num_cells != num_cells) {
    // A run that begins with the state of another one has no frames of the blocks that have gone there.
    expect(num_cells <= (topologies_.empty() ? num_blocks_ : topologies_.back().num_cells),
           "blocks of the scene, none that come later");
    const Topology topology = survey(index, source);
    expect(topology.num_cells == num_cells, "as many rows as the source says");
    write_topology(topology, source);
  } else if (places_.empty()) {
    expect(survey(index, source).num_points == topologies_.back().num_points,
           "as many vertices as in the topology");
  }
  const std::string topology = topology_name(topologies_.back().first_frame);

  const std::filesystem::path path = directory_ / "frames" / frame_name(index);
  CollectiveFile file(communicator_, path);
  vtk::write_header(file, time);
  for (const char *name : vtk::cell_datasets) {
    file.link(vtk::at(name), topology);
  }
  for_each_field(constant_block_fields,
                 [&](const auto &field) { file.link(vtk::cell_data(field.name), topology); });
  write_strips<FrameTables>(file, topologies_.back(), source);
  publish_behind(file, path);
  frames_.emplace_back(index, time);
  write_indices_behind();
}

void FrameWriter::publish_behind(CollectiveFile &file, const std::filesystem::path &path) {
  file.complete();
  files_.push_back({"frames/" + path.filename().string(), -1, -1});
  all_writes_collective_ = all_writes_collective_ && file.all_writes_collective();
  if (communicator_.is_root()) {
    behind_->add([path] { publish(path); });
  }
}

template <class Tables>
void FrameWriter::write_strips(CollectiveFile &file, const Topology &topology,
                               const FrameSource &source) const {
  bool as_expected = true; // a rank whose rows are not what they should be writes none of them
  Tables tables(file, topology.num_cells, topology.num_points);
  FrameStrips strips(communicator_, {num_blocks_, communicator_.size(), ids_per_strip_}, source);
  for (int number = 0; number < strips.size(); ++number) {
    strips.bring(number);
    const Place &place = places_[static_cast<std::size_t>(number)];
    as_expected = as_expected && strips.are_sound() && std::ssize(strips.rows()) == place.num_cells &&
                  strips.num_vertices() == place.num_points;
    if (as_expected) {
      tables.write(place.first_cell, place.first_point, strips.rows(), place.num_points);
    } else {
      tables.write(0, 0, {}, 0);
    }
    file.start_to_sync();
  }
  expect_on_all_ranks(communicator_, as_expected, "each block once, with the vertices it had");
}

// Brings the strips once more: a dataset cannot be made before survey has its length.
void FrameWriter::write_topology(const Topology &topology, const FrameSource &source) {
  CollectiveFile file(communicator_, directory_ / "frames" / topology_name(topology.first_frame));
  file.group("/VTKHDF");
  file.group("/VTKHDF/CellData");
  write_strips<TopologyTables>(file, topology, source);
  file.publish();
  files_.push_back({"frames/" + topology_name(topology.first_frame), -1, -1});
  all_writes_collective_ = all_writes_collective_ && file.all_writes_collective();
  topologies_.push_back(topology);
}

const FrameWriter::Topology &FrameWriter::topology_of(int frame) const {
  const auto later = std::upper_bound(topologies_.begin(), topologies_.end(), frame,
                                      [](int index, const Topology &t) { return index < t.first_frame; });
  return *std::prev(later);
}

// Behind the frames that they tell of.
void FrameWriter::write_indices_behind() {
  if (!communicator_.is_root()) {
    return;
  }
  std::vector<std::pair<int, double>> frames;
  std::copy_if(frames_.begin(), frames_.end(), std::back_inserter(frames), [&](const auto &frame) {
    return !std::binary_search(lost_.begin(), lost_.end(), frame.first);
  });
  std::vector<std::pair<const char *, std::string>> indices{
      {"run.hdf.series", series_index(frames, "frame")}};
  std::vector<IndexedFrame> indexed;
  for (const auto &[index, time] : frames) {
    const Topology &topology = topology_of(index);
    indexed.push_back(
        {index, time, topology.num_cells, topology.num_points, topology_name(topology.first_frame)});
  }
  indices.emplace_back("run.xdmf", xdmf_index(indexed));
  behind_->add([directory = directory_, indices = std::move(indices)] {
    for (const auto &[name, text] : indices) {
      write_index(directory / name, text);
    }
  });
}

void FrameWriter::write_series_behind(const char *name, const std::vector<std::pair<int, double>> &frames,
                                      const char *kind) {
  if (communicator_.is_root() && !frames.empty()) {
    behind_->add([path = directory_ / name, text = series_index(frames, kind)] { write_index(path, text); });
  }
}

void FrameWriter::write_contacts(int index, double time, const ContactSource &source) {
  const std::filesystem::path path = directory_ / "frames" / fmt::format("contacts_{:06}.hdf", index);
  CollectiveFile file(communicator_, path);
  write_contact_frame(communicator_, file, time, {num_blocks_, communicator_.size(), ids_per_strip_}, source);
  publish_behind(file, path);
  contact_frames_.emplace_back(index, time);
  write_series_behind("contacts.hdf.series", contact_frames_, "contacts");
}

void FrameWriter::write_bolts(int index, double time, const BoltFrame &frame) {
  const std::filesystem::path path = directory_ / "frames" / fmt::format("bolts_{:06}.hdf", index);
  CollectiveFile file(communicator_, path);
  write_bolt_frame(communicator_, file, time, frame);
  publish_behind(file, path);
  bolt_frames_.emplace_back(index, time);
  write_series_behind("bolts.hdf.series", bolt_frames_, "bolts");
}

void FrameWriter::write_liners(int index, double time, const std::vector<LinerRow> &rows) {
  const std::filesystem::path path = directory_ / "frames" / fmt::format("liners_{:06}.hdf", index);
  CollectiveFile file(communicator_, path);
  write_liner_frame(communicator_, file, time, rows);
  publish_behind(file, path);
  liner_frames_.emplace_back(index, time);
  write_series_behind("liners.hdf.series", liner_frames_, "liners");
}

void FrameWriter::finish() {
  on_root(communicator_, [this] { behind_->finish(); });
}

void FrameWriter::sync() {
  finish();
  if (frames_.empty()) {
    return;
  }
  on_root(communicator_, [this] {
    sync_file(directory_ / "run.hdf.series");
    sync_file(directory_ / "run.xdmf");
    if (!contact_frames_.empty()) {
      sync_file(directory_ / "contacts.hdf.series");
    }
    if (!bolt_frames_.empty()) {
      sync_file(directory_ / "bolts.hdf.series");
    }
    if (!liner_frames_.empty()) {
      sync_file(directory_ / "liners.hdf.series");
    }
  });
}

const std::vector<ResultFile> &FrameWriter::files() {
  for (auto file = files_.rbegin(); file != files_.rend() && file->bytes < 0; ++file) {
    file->bytes = static_cast<std::int64_t>(std::filesystem::file_size(directory_ / file->name));
  }
  return files_;
}

std::vector<double> FrameWriter::times() const {
  std::vector<double> times;
  for (const auto &[index, time] : frames_) {
    times.push_back(time);
  }
  return times;
}

namespace {

/// Of each topology that begins before frame `count` its cells, points and first frame, one after the other.
std::vector<std::int64_t> list_topologies(const std::filesystem::path &folder, std::ptrdiff_t count) {
  const hdf5::QuietErrors quiet;
  const hdf5::File needed(hdf5::open_to_read(folder / topology_name(0)));
  std::vector<std::int64_t> numbers;
  for (const std::filesystem::directory_entry &entry : std::filesystem::directory_iterator(folder)) {
    const auto first = number_of(entry.path().filename().string(), "topology", ".h5");
    if (!first || *first >= count) {
      continue;
    }
    const hdf5::File file(hdf5::open_to_read(entry.path()));
    for (const char *length : {"NumberOfCells", "NumberOfPoints"}) {
      numbers.push_back(hdf5::read_numbers<std::int64_t>(file, vtk::at(length)).at(0));
    }
    numbers.push_back(*first);
  }
  return numbers;
}

/// Those from number `count` on, and all that goes with them.
void remove_frames_from(const std::filesystem::path &folder, std::ptrdiff_t count) {
  std::vector<std::filesystem::path> later;
  for (const std::filesystem::directory_entry &entry : std::filesystem::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    std::optional<std::int64_t> number = number_of(name, "topology", ".h5");
    for (const char *kind : {"frame", "contacts", "bolts", "liners"}) {
      number = number ? number : number_of(name, kind, ".hdf");
    }
    if (number.value_or(-1) >= count) {
      later.push_back(entry.path());
    }
  }
  for (const std::filesystem::path &path : later) {
    std::filesystem::remove(path);
  }
}

} // namespace

// The indices first: none ever tells of a frame that is gone.
void FrameWriter::continue_behind(const std::vector<double> &times, const std::vector<ResultFile> &files) {
  expect(!times.empty() && frames_.empty(), "frames to go on behind, before any are written");
  for (const double time : times) {
    frames_.emplace_back(static_cast<int>(frames_.size()), time);
  }
  const std::filesystem::path folder = directory_ / "frames";
  std::vector<std::int64_t> numbers;
  on_root(communicator_, [&] {
    numbers = list_topologies(folder, std::ssize(times));
    for (const ResultFile &file : files) {
      if (file.name.starts_with("frames/") && damage_of(directory_, file).empty()) {
        files_.push_back(file);
      }
    }
    for (const auto &[index, time] : frames_) {
      if (!std::filesystem::exists(folder / frame_name(index))) {
        lost_.push_back(index);
      }
      if (std::filesystem::exists(folder / fmt::format("contacts_{:06}.hdf", index))) {
        contact_frames_.emplace_back(index, time);
      }
      if (std::filesystem::exists(folder / fmt::format("bolts_{:06}.hdf", index))) {
        bolt_frames_.emplace_back(index, time);
      }
      if (std::filesystem::exists(folder / fmt::format("liners_{:06}.hdf", index))) {
        liner_frames_.emplace_back(index, time);
      }
    }
  });
  const auto told = communicator_.all_gather(numbers);
  for (std::size_t k = 0; k + 2 < told.front().size(); k += 3) {
    topologies_.push_back({static_cast<int>(told.front()[k + 2]), told.front()[k], told.front()[k + 1]});
  }
  std::sort(topologies_.begin(), topologies_.end(),
            [](const Topology &a, const Topology &b) { return a.first_frame < b.first_frame; });
  expect(!topologies_.empty(), "a run that goes on has a topology");
  write_indices_behind();
  write_series_behind("contacts.hdf.series", contact_frames_, "contacts");
  write_series_behind("bolts.hdf.series", bolt_frames_, "bolts");
  write_series_behind("liners.hdf.series", liner_frames_, "liners");
  finish();
  on_root(communicator_, [&] { remove_frames_from(folder, std::ssize(times)); });
}

} // namespace gcpdda
