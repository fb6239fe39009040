#pragma once

// Histories of a result folder: monitors, energies and bolts over time, one CSV each.

#include "gcpdda/io/result_manifest.hpp"
#include "gcpdda/io/run_summary.hpp"
#include "gcpdda/model/scene.hpp"

#include <array>
#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace gcpdda {

/// One row of history/<name>.csv, without its time; a point has position, displacement and the first two
/// velocities only, a point of a profile stress, too.
struct BlockHistoryRow {
  Vec2 position;
  double rotation = 0.0;
  std::array<double, 3> velocity{};
  std::array<double, 3> stress{};
  Vec2 contact_force;
  Vec2 displacement = {};  ///< since the start, m
  std::int64_t block = -1; ///< id; of a point that is on no profile -1
};

/// Writes history/*.csv. Lives on the root rank only; no member is collective.
class HistoryWriter {
public:
  /// @param has_bolts  there is a history of bolts, and energies have their columns
  HistoryWriter(std::filesystem::path directory, std::vector<Monitor> monitors, bool has_bolts = false);
  /// Go on with the histories of a run: rows later than `last_time` (s) are cut off, and a last row that was
  /// not written to its end.
  HistoryWriter(std::filesystem::path directory, std::vector<Monitor> monitors, double last_time,
                bool has_bolts = false);
  void write_monitor(std::size_t monitor, double time, const BlockHistoryRow &row);
  void write_energy(double time, const EnergyRow &row);
  void write_bolts(double time, const std::vector<BoltHistoryRow> &rows);
  /// Of all bolts that have rows, also of those from before a restart, in the order they came.
  [[nodiscard]] const std::vector<BoltLoad> &bolt_loads() const { return bolt_loads_; }
  /// What has been written is on its way to the disk; throws FileError when the disk is full.
  void flush();
  /// What has been flushed is on the disk. Throws FileError.
  void sync() const;
  /// All histories as they are after flush().
  [[nodiscard]] std::vector<ResultFile> files() const;

private:
  [[nodiscard]] std::string header_of(std::size_t history) const;
  [[nodiscard]] std::filesystem::path path_of(std::size_t history) const;
  void note_bolt(double time, const BoltHistoryRow &row);
  void note_bolts(std::string_view rows);

  std::filesystem::path directory_;
  std::vector<Monitor> monitors_;
  std::vector<std::size_t> first_of_;   ///< by history of monitors, its first monitor
  std::vector<std::size_t> history_of_; ///< by monitor
  std::vector<bool> is_short_; ///< by history of monitors: begun by a version without displacements, kept so
  bool has_bolts_;
  std::vector<BoltLoad> bolt_loads_;
  std::unordered_map<std::string, std::size_t> load_of_; ///< by name
  std::vector<std::string> pending_; ///< text not yet appended, per monitor, of energy, and of bolts if any
  std::vector<ResultFile> files_;    ///< what has been appended, in the same order
};

} // namespace gcpdda
