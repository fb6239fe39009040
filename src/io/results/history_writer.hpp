#pragma once

// Histories of a result folder: monitors, energies, bolts and liners over time, one CSV each.

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

/// Which support has a history; energies have columns of any.
struct SupportHistories {
  bool bolts = false;
  bool liners = false;

  static SupportHistories of(const Scene &scene) { return {!scene.bolts.empty(), !scene.liners.empty()}; }
};

/// Writes history/*.csv. Lives on the root rank only; no member is collective.
class HistoryWriter {
public:
  HistoryWriter(std::filesystem::path directory, std::vector<Monitor> monitors,
                SupportHistories support = {});
  /// Go on with the histories of a run: rows later than `last_time` (s) are cut off, and a last row that was
  /// not written to its end.
  /// @param known  files as they were when the checkpoint was written: rows behind those go, too, because a
  ///               stage without steps may have added some at the same time
  HistoryWriter(std::filesystem::path directory, std::vector<Monitor> monitors, double last_time,
                const std::vector<ResultFile> &known, SupportHistories support = {});
  void write_monitor(std::size_t monitor, double time, const BlockHistoryRow &row);
  void write_energy(double time, const EnergyRow &row);
  void write_bolts(double time, const std::vector<BoltHistoryRow> &rows);
  void write_liners(double time, const std::vector<LinerHistoryRow> &rows);
  /// Of all bolts that have rows, also of those from before a restart, in the order they came.
  [[nodiscard]] const std::vector<BoltLoad> &bolt_loads() const { return bolt_loads_; }
  /// Of all liners, in the same way.
  [[nodiscard]] const std::vector<LinerLoad> &liner_loads() const { return liner_loads_; }
  /// What has been written is on its way to the disk; throws FileError when the disk is full.
  void flush();
  /// What has been flushed is on the disk. Throws FileError.
  void sync() const;
  /// All histories as they are after flush().
  [[nodiscard]] std::vector<ResultFile> files() const;

private:
  [[nodiscard]] std::string header_of(std::size_t history) const;
  [[nodiscard]] std::filesystem::path path_of(std::size_t history) const;
  const BoltLoad &note_bolt(double time, const BoltHistoryRow &row);
  const LinerLoad &note_liner(double time, const LinerHistoryRow &row);
  void note_rows(const std::string &table, std::string_view rows);
  /// Text of a table that is not of a monitor.
  [[nodiscard]] std::string &pending_of(std::string_view table);

  std::filesystem::path directory_;
  std::vector<Monitor> monitors_;
  std::vector<std::size_t> first_of_;   ///< by history of monitors, its first monitor
  std::vector<std::size_t> history_of_; ///< by monitor
  std::vector<bool> is_short_; ///< by history of monitors: begun by a version without displacements, kept so
  std::vector<std::string> tables_; ///< names of the histories behind those of monitors
  std::vector<BoltLoad> bolt_loads_;
  std::vector<LinerLoad> liner_loads_;
  std::unordered_map<std::string, std::size_t> load_of_;  ///< of bolts, by name
  std::unordered_map<std::string, std::size_t> liner_of_; ///< by name
  std::vector<std::string> pending_; ///< text not yet appended, per history of monitors, then by tables_
  std::vector<ResultFile> files_;    ///< what has been appended, in the same order
};

} // namespace gcpdda
