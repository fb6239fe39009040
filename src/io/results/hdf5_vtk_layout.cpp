#include "io/results/hdf5_vtk_layout.hpp"

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

CellTables::CellTables(CollectiveFile &file, std::int64_t num_cells, std::int64_t num_points, CellType type)
    : file_(file), type_(type) {
  file.number(at("NumberOfPoints"), num_points);
  file.number(at("NumberOfCells"), num_cells);
  file.number(at("NumberOfConnectivityIds"), num_points);
  connectivity_ = file.table<std::int64_t>(at("Connectivity"), num_points);
  offsets_ = file.table<std::int64_t>(at("Offsets"), num_cells + 1);
  types_ = file.table<std::uint8_t>(at("Types"), num_cells);
}

void CellTables::write(std::int64_t first_cell, std::int64_t first_point,
                       const std::vector<std::int32_t> &sizes) {
  // Row c + 1 of Offsets is the end of cell c; row 0, a zero, is the root's.
  const bool with_zero = file_.is_root() && first_cell == 0;
  numbers_.assign(with_zero ? 1 : 0, 0);
  std::int64_t end = first_point;
  for (const std::int32_t size : sizes) {
    end += size;
    numbers_.push_back(end);
  }
  file_.write(offsets_, with_zero ? 0 : first_cell + 1, std::span<const std::int64_t>(numbers_));

  numbers_.resize(static_cast<std::size_t>(end - first_point));
  std::iota(numbers_.begin(), numbers_.end(), first_point);
  file_.write(connectivity_, first_point, std::span<const std::int64_t>(numbers_));
  same_type_.assign(sizes.size(), static_cast<std::uint8_t>(type_));
  file_.write(types_, first_cell, std::span<const std::uint8_t>(same_type_));
}

} // namespace gcpdda::vtk
