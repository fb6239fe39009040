#include "io/results/bolt_frame_writer.hpp"

#include "io/results/hdf5_vtk_layout.hpp"

#include <type_traits>

namespace gcpdda {

void write_bolt_frame(const Communicator &communicator, CollectiveFile &file, double time,
                      const BoltFrame &frame) {
  const BoltFrame mine = communicator.is_root() ? frame : BoltFrame{};
  const RowRange cells = rows_in_rank_order(communicator, std::ssize(mine.rows));
  const RowRange points = rows_in_rank_order(communicator, std::ssize(mine.points));
  const auto values_of = [&](auto get) {
    std::vector<std::decay_t<decltype(get(BoltRow{}))>> values;
    for (const BoltRow &row : mine.rows) {
      values.push_back(get(row));
    }
    return values;
  };
  std::vector<double> coordinates;
  for (const Vec2 &point : mine.points) {
    coordinates.insert(coordinates.end(), {point.x, point.y, 0.0});
  }
  vtk::write_header(file, time);
  vtk::CellTables(file, cells.total, points.total, vtk::CellType::poly_line)
      .write(cells.first, points.first, values_of([](const BoltRow &row) { return row.num_points; }));
  file.dataset(vtk::at("Points"), points, coordinates, 3);
  const auto column = [&](const char *name, auto get) {
    file.dataset(vtk::cell_data(name), cells, values_of(get));
  };
  column("bolt", [](const BoltRow &row) { return row.bolt; });
  column("support", [](const BoltRow &row) { return row.support; });
  column("state", [](const BoltRow &row) { return row.state; });
  column("axial_force", [](const BoltRow &row) { return row.axial_force; });
  column("shear_force", [](const BoltRow &row) { return row.shear_force; });
  column("extension", [](const BoltRow &row) { return row.extension; });
  column("slide", [](const BoltRow &row) { return row.slide; });
}

} // namespace gcpdda
