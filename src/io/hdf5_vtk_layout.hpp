#pragma once

#include "gcpdda/geometry/vec2.hpp"

#include "hdf5_collective_file.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

/// The VTKHDF 1.0 UnstructuredGrid layout, shared by frames of blocks and of contacts.
namespace gcpdda::vtk {

enum class CellType : std::uint8_t { line = 3, poly_line = 4, polygon = 7 };

/// The groups and the attributes that make the file VTKHDF, and its time.
void write_header(CollectiveFile &file, double time);

/// NumberOf*, Connectivity, Offsets, Types of cells that share no points: each owns the next `size` of them.
/// @param sizes  vertices of each of this rank's cells
void write_cells(CollectiveFile &file, RowRange cells, RowRange points, CellType type,
                 const std::vector<std::int32_t> &sizes);

/// Names of the datasets write_cells makes.
inline constexpr std::array<const char *, 6> cell_datasets{
    "NumberOfPoints", "NumberOfCells", "NumberOfConnectivityIds", "Connectivity", "Offsets", "Types"};

/// Points of the plane z = 0.
void write_points(CollectiveFile &file, RowRange points, const std::vector<Vec2> &vertices);

/// Dataset "/VTKHDF/<name>".
std::string at(const std::string &name);
/// Dataset "/VTKHDF/CellData/<name>".
std::string cell_data(const std::string &name);

/// get(row) of each row: a column of a table.
template <class Row, class Get> auto column(const std::vector<Row> &rows, Get get) {
  std::vector<std::decay_t<decltype(get(rows.front()))>> values;
  values.reserve(rows.size());
  for (const Row &row : rows) {
    values.push_back(get(row));
  }
  return values;
}

/// The same where get(row) is a triple: three columns, flat.
template <class Row, class Get> std::vector<double> three_columns(const std::vector<Row> &rows, Get get) {
  std::vector<double> values;
  values.reserve(3 * rows.size());
  for (const Row &row : rows) {
    const std::array<double, 3> triple = get(row);
    values.insert(values.end(), triple.begin(), triple.end());
  }
  return values;
}

} // namespace gcpdda::vtk
