#pragma once

// The layout of VTKHDF files.

#include "io/hdf5/hdf5_collective_file.hpp"

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
class CellTables {
public:
  CellTables(CollectiveFile &file, std::int64_t num_cells, std::int64_t num_points, CellType type);
  /// Some of this rank's cells. Collective.
  /// @param sizes  vertices of each
  void write(std::int64_t first_cell, std::int64_t first_point, const std::vector<std::int32_t> &sizes);

private:
  CollectiveFile &file_;
  CellType type_;
  CollectiveFile::Table connectivity_;
  CollectiveFile::Table offsets_;
  CollectiveFile::Table types_;
  std::vector<std::int64_t> numbers_;
  std::vector<std::uint8_t> same_type_;
};

/// Names of the datasets CellTables makes.
inline constexpr std::array<const char *, 6> cell_datasets{
    "NumberOfPoints", "NumberOfCells", "NumberOfConnectivityIds", "Connectivity", "Offsets", "Types"};

/// Dataset "/VTKHDF/<name>".
std::string at(const std::string &name);
/// Dataset "/VTKHDF/CellData/<name>".
std::string cell_data(const std::string &name);

} // namespace gcpdda::vtk
