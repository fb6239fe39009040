// Histories as CSV.

#include "io/results/history_writer.hpp"

#include "base/check.hpp"
#include "base/text.hpp"
#include "io/hdf5/durable_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <initializer_list>
#include <iterator>
#include <limits>

namespace gcpdda {

namespace {

constexpr const char *block_header = "time[s],x[m],y[m],rotation[rad],vx[m/s],vy[m/s],omega[rad/s],"
                                     "sxx[Pa],syy[Pa],sxy[Pa],fx[N/m],fy[N/m]";
constexpr const char *point_header = "time[s],x[m],y[m],vx[m/s],vy[m/s]";
constexpr const char *displacement_columns = ",ux[m],uy[m]";
constexpr const char *profile_header =
    "time[s],distance[m],x[m],y[m],ux[m],uy[m],vx[m/s],vy[m/s],sxx[Pa],syy[Pa],"
    "sxy[Pa],block\n";
constexpr const char *energy_header =
    "time[s],kinetic[J/m],strain[J/m],contact_normal[J/m],contact_stick[J/m],gravity[J/m],friction_loss[J/m],"
    "damping_loss[J/m],boundary_work[J/m],residual[J/m],unbalanced_ratio[-],max_speed[m/s]\n";
constexpr const char *support_columns = ",support[J/m],support_loss[J/m]";
constexpr const char *bolt_header =
    "time[s],bolt,x_head[m],y_head[m],x_tip[m],y_tip[m],axial[N],shear[N],"
    "extension[m],slide[m],joints,yielded,broken,largest_axial[N],largest_shear[N]\n";
constexpr std::size_t bolt_columns = 15;
constexpr const char *energy_name = "energy";
constexpr const char *bolts_name = "bolts";
constexpr const char *liner_header =
    "time[s],liner,elements,compression[N/m],x_compression[m],y_compression[m],tension[N/m],x_tension[m],"
    "y_tension[m],moment[N],x_moment[m],y_moment[m],shear[N/"
    "m],x_shear[m],y_shear[m],strength_used[-],cracked,"
    "yielded,broken,largest_compression[N/m],largest_tension[N/m],largest_moment[N],largest_shear[N/m],"
    "largest_strength_used[-]\n";
constexpr std::size_t liner_columns = 24;
constexpr const char *liners_name = "liners";

void append_row(std::string &text, std::initializer_list<double> values) {
  const char *separator = "";
  for (const double value : values) {
    text += fmt::format("{}{:.17g}", separator, value);
    separator = ",";
  }
  text += '\n';
}

bool begins_with(const std::filesystem::path &path, const std::string &line) {
  std::ifstream stream(path, std::ios::binary);
  std::string first;
  return std::getline(stream, first) && first + "\n" == line;
}

void write_to(const std::filesystem::path &path, const std::string &text, std::ios::openmode mode) {
  std::ofstream stream(path, std::ios::binary | mode);
  stream.write(text.data(), static_cast<std::streamsize>(text.size()));
  stream.close();
  if (!stream) {
    throw FileError("cannot write " + path.string() + ": " + std::strerror(errno));
  }
}

/// Whole rows of an earlier history up to a time, at most so many; none where there is no history with this
/// header: a monitor may be new.
std::string rows_until(const std::filesystem::path &path, const std::string &header, double last_time,
                       std::int64_t most) {
  std::ifstream stream(path, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  if (!text.starts_with(header)) {
    return "";
  }
  std::size_t end = header.size();
  for (std::size_t next = text.find('\n', end); next != std::string::npos && most > 0;
       next = text.find('\n', end)) {
    if (std::strtod(text.c_str() + end, nullptr) > last_time) {
      break;
    }
    end = next + 1;
    --most;
  }
  return text.substr(header.size(), end - header.size());
}

/// Rows that a history had when the checkpoint was written; any number where the checkpoint does not know it.
std::int64_t rows_of(const std::vector<ResultFile> &known, const std::string &name) {
  const auto file = std::find_if(known.begin(), known.end(),
                                 [&](const ResultFile &one) { return one.name == name && one.rows >= 0; });
  return file == known.end() ? std::numeric_limits<std::int64_t>::max() : file->rows;
}

void note_appended(ResultFile &file, const std::string &rows) {
  file.bytes += std::ssize(rows);
  file.rows += std::count(rows.begin(), rows.end(), '\n');
}

} // namespace

HistoryWriter::HistoryWriter(std::filesystem::path directory, std::vector<Monitor> monitors,
                             SupportHistories support)
    : HistoryWriter(std::move(directory), std::move(monitors), -std::numeric_limits<double>::infinity(), {},
                    support) {}

HistoryWriter::HistoryWriter(std::filesystem::path directory, std::vector<Monitor> monitors, double last_time,
                             const std::vector<ResultFile> &known, SupportHistories support)
    : directory_(std::move(directory)), monitors_(std::move(monitors)), tables_{energy_name} {
  if (support.bolts) {
    tables_.emplace_back(bolts_name);
  }
  if (support.liners) {
    tables_.emplace_back(liners_name);
  }
  for (std::size_t m = 0; m < monitors_.size(); ++m) {
    const bool goes_on = m > 0 && monitors_[m].is_on_profile && monitors_[m - 1].is_on_profile &&
                         monitors_[m].name == monitors_[m - 1].name;
    if (!goes_on) {
      first_of_.push_back(m);
    }
    history_of_.push_back(first_of_.size() - 1);
  }
  is_short_.assign(first_of_.size(), false);
  pending_.resize(first_of_.size() + tables_.size());
  expect(std::none_of(monitors_.begin(), monitors_.end(),
                      [](const Monitor &monitor) { return monitor.name == energy_name; }),
         "no monitor by the name of the energy history");
  make_directory(directory_ / "history");
  for (std::size_t i = 0; i < pending_.size(); ++i) {
    if (i < first_of_.size() && std::isfinite(last_time)) {
      is_short_[i] = true;
      is_short_[i] = begins_with(path_of(i), header_of(i)) && !monitors_[first_of_[i]].is_on_profile;
    }
    const std::string header = header_of(i);
    files_.push_back({"history/" + path_of(i).filename().string(), std::ssize(header), 0});
    if (std::isfinite(last_time)) {
      const std::string rows = rows_until(path_of(i), header, last_time, rows_of(known, files_.back().name));
      note_appended(files_.back(), rows);
      write_file(path_of(i), header + rows);
      if (i > first_of_.size()) {
        note_rows(tables_[i - first_of_.size()], rows);
      }
    } else {
      write_to(path_of(i), header, std::ios::trunc);
    }
  }
}

std::string HistoryWriter::header_of(std::size_t history) const {
  if (history < first_of_.size()) {
    const Monitor &monitor = monitors_[first_of_[history]];
    return monitor.is_on_profile ? profile_header
                                 : fmt::format("{}{}\n", monitor.is_point ? point_header : block_header,
                                               is_short_[history] ? "" : displacement_columns);
  }
  const std::string &table = tables_[history - first_of_.size()];
  if (table != energy_name) {
    return table == bolts_name ? bolt_header : liner_header;
  }
  std::string header = energy_header;
  return tables_.size() > 1 ? header.insert(header.size() - 1, support_columns) : header;
}

std::filesystem::path HistoryWriter::path_of(std::size_t history) const {
  const std::string &name =
      history < first_of_.size() ? monitors_[first_of_[history]].name : tables_[history - first_of_.size()];
  return directory_ / "history" / (name + ".csv");
}

void HistoryWriter::write_monitor(std::size_t monitor, double time, const BlockHistoryRow &row) {
  expect(monitor < monitors_.size(), "a monitor that exists");
  const std::size_t history = history_of_[monitor];
  std::string &text = pending_[history];
  if (monitors_[monitor].is_on_profile) {
    append_row(text, {time, monitors_[monitor].distance, row.position.x, row.position.y, row.displacement.x,
                      row.displacement.y, row.velocity[0], row.velocity[1], row.stress[0], row.stress[1],
                      row.stress[2]});
    text.pop_back();
    text += fmt::format(",{}\n", row.block);
    return;
  }
  if (monitors_[monitor].is_point) {
    append_row(text, {time, row.position.x, row.position.y, row.velocity[0], row.velocity[1]});
  } else {
    append_row(text, {time, row.position.x, row.position.y, row.rotation, row.velocity[0], row.velocity[1],
                      row.velocity[2], row.stress[0], row.stress[1], row.stress[2], row.contact_force.x,
                      row.contact_force.y});
  }
  if (!is_short_[history]) {
    text.pop_back();
    text += fmt::format(",{:.17g},{:.17g}\n", row.displacement.x, row.displacement.y);
  }
}

void HistoryWriter::write_energy(double time, const EnergyRow &row) {
  std::string &text = pending_of(energy_name);
  append_row(text, {time, row.kinetic, row.strain, row.contact_normal, row.contact_stick, row.gravity,
                    row.friction_loss, row.damping_loss, row.boundary_work, row.residual,
                    row.unbalanced_ratio, row.max_speed});
  if (tables_.size() > 1) {
    text.pop_back();
    text += fmt::format(",{:.17g},{:.17g}\n", row.support, row.support_loss);
  }
}

std::string &HistoryWriter::pending_of(std::string_view table) {
  const auto found = std::find(tables_.begin(), tables_.end(), table);
  expect(found != tables_.end(), "a history of this kind of support");
  return pending_[first_of_.size() + static_cast<std::size_t>(found - tables_.begin())];
}

void HistoryWriter::write_bolts(double time, const std::vector<BoltHistoryRow> &rows) {
  for (const BoltHistoryRow &row : rows) {
    const BoltLoad &load = note_bolt(time, row);
    pending_of(bolts_name) +=
        fmt::format("{:.17g},{},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{},{},{},{:."
                    "17g},{:.17g}\n",
                    time, row.name, row.head.x, row.head.y, row.tip.x, row.tip.y, row.axial, row.shear,
                    row.extension, row.slide, row.links, row.yielded, row.broken, load.axial, load.shear);
  }
}

void HistoryWriter::write_liners(double time, const std::vector<LinerHistoryRow> &rows) {
  for (const LinerHistoryRow &row : rows) {
    std::string &text = pending_of(liners_name);
    text += fmt::format("{:.17g},{},{}", time, row.name, row.elements);
    for (const LinerPeak &peak : {row.compression, row.tension, row.moment, row.shear}) {
      text += fmt::format(",{:.17g},{:.17g},{:.17g}", peak.value, peak.where.x, peak.where.y);
    }
    const LinerLoad &load = note_liner(time, row);
    text += fmt::format(",{:.17g},{},{},{},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g}\n", row.strength_used,
                        row.cracked, row.yielded, row.broken, load.compression, load.tension, load.moment,
                        load.shear, load.strength_used);
  }
}

const BoltLoad &HistoryWriter::note_bolt(double time, const BoltHistoryRow &row) {
  const auto [found, is_new] = load_of_.emplace(row.name, bolt_loads_.size());
  if (is_new) {
    bolt_loads_.emplace_back();
  }
  BoltLoad &load = bolt_loads_[found->second];
  load.last = row;
  load.time = time;
  const double axial = std::max(row.axial, row.largest_axial);
  load.axial = is_new ? axial : std::max(load.axial, axial);
  load.shear = std::max({load.shear, row.shear, row.largest_shear});
  return load;
}

const LinerLoad &HistoryWriter::note_liner(double time, const LinerHistoryRow &row) {
  const auto [found, is_new] = liner_of_.emplace(row.name, liner_loads_.size());
  if (is_new) {
    liner_loads_.emplace_back();
  }
  LinerLoad &load = liner_loads_[found->second];
  load.last = row;
  load.time = time;
  load.compression = std::max({load.compression, row.compression.value, row.largest_compression});
  load.tension = std::max({load.tension, row.tension.value, row.largest_tension});
  load.moment = std::max({load.moment, row.moment.value, row.largest_moment});
  load.shear = std::max({load.shear, row.shear.value, row.largest_shear});
  load.strength_used = std::max({load.strength_used, row.strength_used, row.largest_strength_used});
  return load;
}

namespace {

/// Numbers of a row as they have been written.
template <std::size_t columns> struct Numbers {
  CsvRow<columns> row;

  explicit Numbers(std::string_view text) : row(text) {}
  [[nodiscard]] double number(std::size_t k) const {
    return to_number(row.fields[k], std::numeric_limits<double>::max()).value_or(0.0);
  }
  [[nodiscard]] std::int64_t count(std::size_t k) const { return static_cast<std::int64_t>(number(k)); }
  [[nodiscard]] Vec2 point(std::size_t k) const { return {number(k), number(k + 1)}; }
  [[nodiscard]] LinerPeak peak(std::size_t k) const { return {number(k), point(k + 1)}; }
};

} // namespace

// As write_bolts and write_liners have written them.
void HistoryWriter::note_rows(const std::string &table, std::string_view rows) {
  while (!rows.empty()) {
    const std::size_t end = rows.find('\n');
    const std::string_view text = rows.substr(0, end);
    rows.remove_prefix(end + 1);
    if (table == bolts_name) {
      const Numbers<bolt_columns> r(text);
      note_bolt(r.number(0),
                {std::string(r.row.fields[1]), r.point(2), r.point(4), r.number(6), r.number(7), r.number(8),
                 r.number(9), r.count(10), r.count(11), r.count(12), r.number(13), r.number(14)});
    } else {
      const Numbers<liner_columns> r(text);
      note_liner(r.number(0), {std::string(r.row.fields[1]), r.count(2), r.peak(3), r.peak(6), r.peak(9),
                               r.peak(12), r.number(15), r.count(16), r.count(17), r.count(18), r.number(19),
                               r.number(20), r.number(21), r.number(22), r.number(23)});
    }
  }
}

void HistoryWriter::flush() {
  for (std::size_t i = 0; i < pending_.size(); ++i) {
    if (!pending_[i].empty()) {
      write_to(path_of(i), pending_[i], std::ios::app);
      note_appended(files_[i], pending_[i]);
      pending_[i].clear();
    }
  }
}

std::vector<ResultFile> HistoryWriter::files() const {
  return files_;
}

void HistoryWriter::sync() const {
  for (std::size_t i = 0; i < pending_.size(); ++i) {
    sync_file(path_of(i));
  }
}

} // namespace gcpdda
