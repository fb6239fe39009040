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

void write_liner_frame(const Communicator &communicator, CollectiveFile &file, double time,
                       const std::vector<LinerRow> &rows) {
  const std::vector<LinerRow> mine = communicator.is_root() ? rows : std::vector<LinerRow>{};
  const RowRange cells = rows_in_rank_order(communicator, std::ssize(mine));
  const RowRange points = rows_in_rank_order(communicator, 2 * std::ssize(mine));
  std::vector<double> coordinates;
  for (const LinerRow &row : mine) {
    for (const Vec2 &node : row.nodes) {
      coordinates.insert(coordinates.end(), {node.x, node.y, 0.0});
    }
  }
  const std::vector<std::int32_t> sizes(mine.size(), 2);
  vtk::write_header(file, time);
  vtk::CellTables(file, cells.total, points.total, vtk::CellType::poly_line)
      .write(cells.first, points.first, sizes);
  file.dataset(vtk::at("Points"), points, coordinates, 3);
  const auto column = [&](const char *name, auto member) {
    std::vector<std::decay_t<decltype(LinerRow{}.*member)>> values;
    for (const LinerRow &row : mine) {
      values.push_back(row.*member);
    }
    file.dataset(vtk::cell_data(name), cells, values);
  };
  column("liner", &LinerRow::liner);
  column("support", &LinerRow::support);
  column("state", &LinerRow::state);
  column("cracked", &LinerRow::cracked);
  column("axial_force", &LinerRow::axial_force);
  column("shear_force", &LinerRow::shear_force);
  column("moment_begin", &LinerRow::moment_begin);
  column("moment_end", &LinerRow::moment_end);
  column("extension", &LinerRow::extension);
  column("slide", &LinerRow::slide);
  column("turn", &LinerRow::turn);
  column("thickness", &LinerRow::thickness);
  column("strength_used", &LinerRow::strength_used);
}

} // namespace gcpdda
