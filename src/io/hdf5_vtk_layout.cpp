#include "hdf5_vtk_layout.hpp"

#include <numeric>

namespace gcpdda::vtk {

std::string at(const std::string &name) {
  return "/VTKHDF/" + name;
}

std::string cell_data(const std::string &name) {
  return "/VTKHDF/CellData/" + name;
}

void write_header(CollectiveFile &file, double time) {
  file.group("/VTKHDF");
  file.group("/VTKHDF/CellData");
  file.attribute("/VTKHDF", "Version", std::array<std::int64_t, 2>{1, 0});
  file.attribute("/VTKHDF", "Type", std::string("UnstructuredGrid"));
  file.attribute("/VTKHDF", "time", time);
}

void write_cells(CollectiveFile &file, RowRange cells, RowRange points, CellType type,
                 const std::vector<std::int32_t> &sizes) {
  std::vector<std::int64_t> connectivity(static_cast<std::size_t>(points.count));
  std::iota(connectivity.begin(), connectivity.end(), points.first);

  // Row c + 1 of Offsets is the end of cell c; row 0, a zero, is the root's.
  std::vector<std::int64_t> offsets;
  RowRange offset_rows{cells.first + 1, cells.count, cells.total + 1};
  if (file.is_root()) {
    offsets.push_back(0);
    offset_rows.first -= 1;
    offset_rows.count += 1;
  }
  std::int64_t end = points.first;
  for (const std::int32_t size : sizes) {
    end += size;
    offsets.push_back(end);
  }

  file.number(at("NumberOfPoints"), points.total);
  file.number(at("NumberOfCells"), cells.total);
  file.number(at("NumberOfConnectivityIds"), points.total);
  file.dataset(at("Connectivity"), points, connectivity);
  file.dataset(at("Offsets"), offset_rows, offsets);
  file.dataset(at("Types"), cells, std::vector<std::uint8_t>(sizes.size(), static_cast<std::uint8_t>(type)));
}

void write_points(CollectiveFile &file, RowRange points, const std::vector<Vec2> &vertices) {
  file.dataset(at("Points"), points,
               three_columns(vertices,
                             [](Vec2 p) {
                               return std::array{p.x, p.y, 0.0};
                             }),
               3);
}

} // namespace gcpdda::vtk
