#include "gcpdda/io/result_files.hpp"

#include "durable_file.hpp"

#include "gcpdda/base/check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <initializer_list>

namespace gcpdda {

namespace {

constexpr const char *block_header = "time[s],x[m],y[m],rotation[rad],vx[m/s],vy[m/s],omega[rad/s],"
                                     "sxx[Pa],syy[Pa],sxy[Pa],fx[N/m],fy[N/m]\n";
constexpr const char *point_header = "time[s],x[m],y[m],vx[m/s],vy[m/s]\n";
constexpr const char *energy_header =
    "time[s],kinetic[J/m],strain[J/m],contact_normal[J/m],contact_stick[J/m],gravity[J/m],friction_loss[J/m],"
    "damping_loss[J/m],boundary_work[J/m],residual[J/m],unbalanced_ratio[-],max_speed[m/s]\n";
constexpr const char *energy_name = "energy";

void append_row(std::string &text, std::initializer_list<double> values) {
  const char *separator = "";
  for (const double value : values) {
    text += fmt::format("{}{:.17g}", separator, value);
    separator = ",";
  }
  text += '\n';
}

void write_to(const std::filesystem::path &path, const std::string &text, std::ios::openmode mode) {
  std::ofstream stream(path, std::ios::binary | mode);
  stream.write(text.data(), static_cast<std::streamsize>(text.size()));
  stream.close();
  if (!stream) {
    throw FileError("cannot write " + path.string() + ": " + std::strerror(errno));
  }
}

std::filesystem::path history_path(const std::filesystem::path &directory, const std::string &name) {
  return directory / "history" / (name + ".csv");
}

} // namespace

HistoryWriter::HistoryWriter(std::filesystem::path directory, std::vector<Monitor> monitors)
    : directory_(std::move(directory)), monitors_(std::move(monitors)), pending_(monitors_.size() + 1) {
  expect(std::none_of(monitors_.begin(), monitors_.end(),
                      [](const Monitor &monitor) { return monitor.name == energy_name; }),
         "no monitor by the name of the energy history");
  make_directory(directory_ / "history");
  for (const Monitor &monitor : monitors_) {
    write_to(history_path(directory_, monitor.name), monitor.is_point ? point_header : block_header,
             std::ios::trunc);
  }
  write_to(history_path(directory_, energy_name), energy_header, std::ios::trunc);
}

void HistoryWriter::write_monitor(std::size_t monitor, double time, const BlockHistoryRow &row) {
  expect(monitor < monitors_.size(), "a monitor that exists");
  if (monitors_[monitor].is_point) {
    append_row(pending_[monitor], {time, row.position.x, row.position.y, row.velocity[0], row.velocity[1]});
    return;
  }
  append_row(pending_[monitor], {time, row.position.x, row.position.y, row.rotation, row.velocity[0],
                                 row.velocity[1], row.velocity[2], row.stress[0], row.stress[1],
                                 row.stress[2], row.contact_force.x, row.contact_force.y});
}

void HistoryWriter::write_energy(double time, const EnergyRow &row) {
  append_row(pending_.back(), {time, row.kinetic, row.strain, row.contact_normal, row.contact_stick,
                               row.gravity, row.friction_loss, row.damping_loss, row.boundary_work,
                               row.residual, row.unbalanced_ratio, row.max_speed});
}

void HistoryWriter::flush() {
  for (std::size_t i = 0; i < pending_.size(); ++i) {
    if (!pending_[i].empty()) {
      const std::string name = i < monitors_.size() ? monitors_[i].name : energy_name;
      write_to(history_path(directory_, name), pending_[i], std::ios::app);
      pending_[i].clear();
    }
  }
}

} // namespace gcpdda
