// One file per frame, its rows in BlockId order whatever the number of ranks: ids are cut into one slab per
// rank, every row travels once to the owner of its slab, and all ranks write their slabs together. What never
// changes is in a topology file of its own, which the frames link to.

#include "gcpdda/io/result_files.hpp"

#include "durable_file.hpp"
#include "hdf5_input.hpp"
#include "hdf5_vtk_layout.hpp"
#include "numbered_name.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <iterator>
#include <numeric>

namespace gcpdda {

namespace {

constexpr std::array<const char *, 2> constant_cell_data{"block", "material"};
constexpr const char *xdmf_cells = "/XdmfTopology";

std::string frame_name(int index) {
  return fmt::format("frame_{:06}.hdf", index);
}

std::string topology_name(int index) {
  return fmt::format("topology_{:06}.h5", index);
}

// Calls act(row, first vertex, last vertex) for each row.
template <class Act>
void for_each_row(const std::vector<FrameRow> &rows, const std::vector<Vec2> &vertices, Act act) {
  auto vertex = vertices.begin();
  for (const FrameRow &row : rows) {
    act(row, vertex, vertex + row.num_vertices);
    vertex += row.num_vertices;
  }
}

bool is_sound(const FrameData &data, std::int64_t num_blocks) {
  std::int64_t num_vertices = 0;
  for (const FrameRow &row : data.rows) {
    if (row.block < 0 || row.block >= num_blocks || row.num_vertices < 1) {
      return false;
    }
    num_vertices += row.num_vertices;
  }
  return num_vertices == std::ssize(data.vertices);
}

using PlacedRow = std::pair<const FrameRow *, const Vec2 *>; ///< with its first vertex

/// Rows and vertices of this rank's slab, in BlockId order. A frame of all blocks is the largest thing that
/// passes through a rank: what has been handed on is freed at once.
FrameData route_to_slabs(const Communicator &communicator, std::int64_t num_blocks, FrameData data) {
  expect_on_all_ranks(communicator, is_sound(data, num_blocks), "frame rows with valid ids and vertices");
  const auto num_ranks = static_cast<std::size_t>(communicator.size());
  const auto owner_of = [&](const FrameRow &row) {
    return static_cast<std::size_t>(slab_owner(num_blocks, communicator.size(), row.block));
  };
  std::vector<std::vector<FrameRow>> rows(num_ranks);
  std::vector<std::vector<Vec2>> vertices(num_ranks);
  if (num_ranks == 1) {
    rows[0] = std::move(data.rows);
    vertices[0] = std::move(data.vertices);
  } else {
    for_each_row(data.rows, data.vertices, [&](const FrameRow &row, auto first, auto last) {
      rows[owner_of(row)].push_back(row);
      vertices[owner_of(row)].insert(vertices[owner_of(row)].end(), first, last);
    });
    data = {};
  }
  rows = communicator.all_to_all(std::move(rows));
  vertices = communicator.all_to_all(std::move(vertices));

  std::vector<PlacedRow> order;
  for (std::size_t rank = 0; rank < num_ranks; ++rank) {
    for_each_row(rows[rank], vertices[rank],
                 [&](const FrameRow &row, auto first, auto) { order.emplace_back(&row, &*first); });
  }
  const auto by_block = [](const PlacedRow &a, const PlacedRow &b) {
    return a.first->block < b.first->block;
  };
  const bool is_sorted = std::is_sorted(order.begin(), order.end(), by_block);
  std::sort(order.begin(), order.begin() + (is_sorted ? 0 : std::ssize(order)), by_block);
  const bool once =
      std::adjacent_find(order.begin(), order.end(), [&](const PlacedRow &a, const PlacedRow &b) {
        return !by_block(a, b);
      }) == order.end();
  expect_on_all_ranks(communicator, once, "each block on exactly one rank's frame data");
  if (num_ranks == 1 && is_sorted) {
    return {std::move(rows[0]), std::move(vertices[0])};
  }
  FrameData slab;
  slab.rows.reserve(order.size());
  for (const auto &[row, first] : order) {
    slab.rows.push_back(*row);
    slab.vertices.insert(slab.vertices.end(), first, first + row->num_vertices);
  }
  return slab;
}

// XDMF wants its own mixture: for each cell 3 (a polygon), the number of its vertices, their numbers.
void write_xdmf_cells(CollectiveFile &file, RowRange cells, RowRange points,
                      const std::vector<std::int32_t> &sizes) {
  std::vector<std::int64_t> mixed;
  std::int64_t vertex = points.first;
  for (const std::int32_t size : sizes) {
    mixed.push_back(3);
    mixed.push_back(size);
    for (std::int32_t i = 0; i < size; ++i) {
      mixed.push_back(vertex++);
    }
  }
  file.dataset(
      xdmf_cells,
      {points.first + 2 * cells.first, points.count + 2 * cells.count, points.total + 2 * cells.total},
      mixed);
}

void write_cell_data(CollectiveFile &file, RowRange cells, const std::vector<FrameRow> &rows) {
  const auto column = [&](const char *name, auto get) {
    file.dataset(vtk::cell_data(name), cells, vtk::column(rows, get));
  };
  const auto three_columns = [&](const char *name, auto get) {
    file.dataset(vtk::cell_data(name), cells, vtk::three_columns(rows, get), 3);
  };
  column("kind", [](const FrameRow &row) { return row.kind; });
  column("rotation", [](const FrameRow &row) { return row.rotation; });
  three_columns("displacement", [](const FrameRow &row) {
    return std::array{row.displacement.x, row.displacement.y, 0.0};
  });
  three_columns("velocity", [](const FrameRow &row) { return row.velocity; });
  three_columns("stress", [](const FrameRow &row) { return row.stress; });
  three_columns("contact_force", [](const FrameRow &row) { return row.contact_force; });
}

/// @param kind  of the files, "frame" or "bolts"
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

struct XdmfField {
  const char *name;
  const char *number; ///< NumberType and Precision
  int columns;
};
constexpr std::array<XdmfField, 8> xdmf_fields{
    {{"block", "NumberType=\"Int\" Precision=\"8\"", 1},
     {"material", "NumberType=\"Int\" Precision=\"4\"", 1},
     {"kind", "NumberType=\"UChar\" Precision=\"1\"", 1},
     {"displacement", "NumberType=\"Float\" Precision=\"8\"", 3},
     {"rotation", "NumberType=\"Float\" Precision=\"8\"", 1},
     {"velocity", "NumberType=\"Float\" Precision=\"8\"", 3},
     {"stress", "NumberType=\"Float\" Precision=\"8\"", 3},
     {"contact_force", "NumberType=\"Float\" Precision=\"8\"", 3}}};

bool is_constant(const char *name) {
  return std::any_of(constant_cell_data.begin(), constant_cell_data.end(),
                     [name](const char *constant) { return std::strcmp(name, constant) == 0; });
}

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

std::string xdmf_index(const std::vector<IndexedFrame> &frames) {
  std::string text = "<?xml version=\"1.0\"?>\n<Xdmf Version=\"3.0\">\n  <Domain>\n"
                     "    <Grid Name=\"run\" GridType=\"Collection\" CollectionType=\"Temporal\">\n";
  for (const auto &[index, time, num_blocks, num_points, topology] : frames) {
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
    for (const XdmfField &field : xdmf_fields) {
      const std::string dimensions = fmt::format("{}{}", num_blocks, field.columns == 3 ? " 3" : "");
      text +=
          fmt::format("        <Attribute Name=\"{}\" AttributeType=\"{}\" Center=\"Cell\">{}</Attribute>\n",
                      field.name, field.columns == 3 ? "Vector" : "Scalar",
                      xdmf_item(dimensions, field.number, is_constant(field.name) ? topology : frame,
                                vtk::cell_data(field.name)));
    }
    text += "      </Grid>\n";
  }
  return text + "    </Grid>\n  </Domain>\n</Xdmf>\n";
}

} // namespace

std::int64_t slab_begin(std::int64_t num_blocks, int num_ranks, int rank) {
  return num_blocks * rank / num_ranks;
}

int slab_owner(std::int64_t num_blocks, int num_ranks, std::int64_t block) {
  return static_cast<int>(((block + 1) * num_ranks - 1) / num_blocks);
}

FrameWriter::FrameWriter(const Communicator &communicator, std::filesystem::path directory,
                         std::int64_t num_blocks)
    : communicator_(communicator), directory_(std::move(directory)), num_blocks_(num_blocks) {
  on_root(communicator_, [this] { make_directory(directory_ / "frames"); });
}

void FrameWriter::write(int index, double time, FrameData data) {
  expect(frames_.empty() || index > frames_.back().first, "frames in the order of their numbers");
  const FrameData slab = route_to_slabs(communicator_, num_blocks_, std::move(data));
  const RowRange cells = rows_in_rank_order(communicator_, std::ssize(slab.rows));
  const RowRange points = rows_in_rank_order(communicator_, std::ssize(slab.vertices));

  if (topologies_.empty() || topologies_.back().num_cells != cells.total) {
    expect(topologies_.empty() ? cells.total == num_blocks_ : cells.total < topologies_.back().num_cells,
           "all blocks in the first frame, none that come later");
    write_topology(index, slab);
  }
  expect(points.total == topologies_.back().num_points, "as many vertices as in the topology");
  const std::string topology = topology_name(topologies_.back().first_frame);

  CollectiveFile file(communicator_, directory_ / "frames" / frame_name(index));
  vtk::write_header(file, time);
  for (const char *name : vtk::cell_datasets) {
    file.link(vtk::at(name), topology);
  }
  for (const char *name : constant_cell_data) {
    file.link(vtk::cell_data(name), topology);
  }
  vtk::write_points(file, points, slab.vertices);
  write_cell_data(file, cells, slab.rows);
  file.publish();
  all_writes_collective_ = all_writes_collective_ && file.all_writes_collective();

  frames_.emplace_back(index, time);
  write_indices();
}

// A few rows, which the root writes.
void FrameWriter::write_bolts(int index, double time, const BoltFrame &frame) {
  const BoltFrame mine = communicator_.is_root() ? frame : BoltFrame{};
  const RowRange cells = rows_in_rank_order(communicator_, std::ssize(mine.rows));
  const RowRange points = rows_in_rank_order(communicator_, std::ssize(mine.points));
  CollectiveFile file(communicator_, directory_ / "frames" / fmt::format("bolts_{:06}.hdf", index));
  vtk::write_header(file, time);
  vtk::write_cells(file, cells, points, vtk::CellType::poly_line,
                   vtk::column(mine.rows, [](const BoltRow &row) { return row.num_points; }));
  vtk::write_points(file, points, mine.points);
  const auto column = [&](const char *name, auto get) {
    file.dataset(vtk::cell_data(name), cells, vtk::column(mine.rows, get));
  };
  column("bolt", [](const BoltRow &row) { return row.bolt; });
  column("support", [](const BoltRow &row) { return row.support; });
  column("state", [](const BoltRow &row) { return row.state; });
  column("axial_force", [](const BoltRow &row) { return row.axial_force; });
  column("shear_force", [](const BoltRow &row) { return row.shear_force; });
  column("extension", [](const BoltRow &row) { return row.extension; });
  column("slide", [](const BoltRow &row) { return row.slide; });
  file.publish();
  all_writes_collective_ = all_writes_collective_ && file.all_writes_collective();
  bolt_frames_.emplace_back(index, time);
  write_indices();
}

void FrameWriter::write_topology(int index, const FrameData &slab) {
  const RowRange cells = rows_in_rank_order(communicator_, std::ssize(slab.rows));
  const RowRange points = rows_in_rank_order(communicator_, std::ssize(slab.vertices));
  const auto sizes = vtk::column(slab.rows, [](const FrameRow &row) { return row.num_vertices; });
  CollectiveFile file(communicator_, directory_ / "frames" / topology_name(index));
  file.group("/VTKHDF");
  file.group("/VTKHDF/CellData");
  vtk::write_cells(file, cells, points, vtk::CellType::polygon, sizes);
  file.dataset(vtk::cell_data("block"), cells,
               vtk::column(slab.rows, [](const FrameRow &row) { return row.block; }));
  file.dataset(vtk::cell_data("material"), cells,
               vtk::column(slab.rows, [](const FrameRow &row) { return row.material; }));
  write_xdmf_cells(file, cells, points, sizes);
  file.publish();
  all_writes_collective_ = all_writes_collective_ && file.all_writes_collective();
  topologies_.push_back({index, cells.total, points.total});
}

const FrameWriter::Topology &FrameWriter::topology_of(int frame) const {
  const auto later = std::upper_bound(topologies_.begin(), topologies_.end(), frame,
                                      [](int index, const Topology &t) { return index < t.first_frame; });
  return *std::prev(later);
}

void FrameWriter::write_indices() const {
  on_root(communicator_, [this] {
    write_file(directory_ / "run.hdf.series", series_index(frames_, "frame"));
    if (!bolt_frames_.empty()) {
      write_file(directory_ / "bolts.hdf.series", series_index(bolt_frames_, "bolts"));
    }
    std::vector<IndexedFrame> indexed;
    for (const auto &[index, time] : frames_) {
      const Topology &topology = topology_of(index);
      indexed.push_back(
          {index, time, topology.num_cells, topology.num_points, topology_name(topology.first_frame)});
    }
    write_file(directory_ / "run.xdmf", xdmf_index(indexed));
  });
}

std::vector<double> FrameWriter::times() const {
  std::vector<double> times;
  for (const auto &[index, time] : frames_) {
    times.push_back(time);
  }
  return times;
}

// The indices first: none ever tells of a frame that is gone.
void FrameWriter::continue_behind(const std::vector<double> &times) {
  expect(!times.empty() && frames_.empty(), "frames to go on behind, before any are written");
  for (const double time : times) {
    frames_.emplace_back(static_cast<int>(frames_.size()), time);
  }
  const std::filesystem::path folder = directory_ / "frames";
  std::vector<std::int64_t> numbers; // of each topology its first frame, cells and points
  on_root(communicator_, [&] {
    const hdf5::QuietErrors quiet;
    const hdf5::File needed(hdf5::open_to_read(folder / topology_name(0)));
    for (const auto &[index, time] : frames_) {
      if (std::filesystem::exists(folder / fmt::format("bolts_{:06}.hdf", index))) {
        bolt_frames_.emplace_back(index, time);
      }
    }
    for (const std::filesystem::directory_entry &entry : std::filesystem::directory_iterator(folder)) {
      const auto first = number_of(entry.path().filename().string(), "topology", ".h5");
      if (!first || *first >= std::ssize(times)) {
        continue;
      }
      const hdf5::File file(hdf5::open_to_read(entry.path()));
      for (const char *count : {"NumberOfCells", "NumberOfPoints"}) {
        numbers.push_back(hdf5::read_numbers<std::int64_t>(file, vtk::at(count)).at(0));
      }
      numbers.push_back(*first);
    }
  });
  const auto told = communicator_.all_gather(numbers);
  for (std::size_t k = 0; k + 2 < told.front().size(); k += 3) {
    topologies_.push_back({static_cast<int>(told.front()[k + 2]), told.front()[k], told.front()[k + 1]});
  }
  std::sort(topologies_.begin(), topologies_.end(),
            [](const Topology &a, const Topology &b) { return a.first_frame < b.first_frame; });
  expect(!topologies_.empty(), "a run that goes on has a topology");
  write_indices();
  on_root(communicator_, [&] {
    std::vector<std::filesystem::path> later;
    for (const std::filesystem::directory_entry &entry : std::filesystem::directory_iterator(folder)) {
      const std::string name = entry.path().filename().string();
      std::optional<std::int64_t> number = number_of(name, "topology", ".h5");
      for (const char *kind : {"frame", "contacts", "bolts"}) {
        number = number ? number : number_of(name, kind, ".hdf");
      }
      if (number.value_or(-1) >= std::ssize(times)) {
        later.push_back(entry.path());
      }
    }
    for (const std::filesystem::path &path : later) {
      std::filesystem::remove(path);
    }
  });
}

} // namespace gcpdda
