#pragma once

// The files of a result folder: frames, histories, summary.

#include "gcpdda/geometry/vec2.hpp"
#include "gcpdda/io/result_manifest.hpp"
#include "gcpdda/model/scene.hpp"
#include "gcpdda/parallel/communicator.hpp"

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

namespace gcpdda {

class CollectiveFile;
class WriteBehind;

/// One block's row of a frame, in plain data so that it can travel to the rank that writes its slab.
struct FrameRow {
  std::int64_t block = 0;
  std::int32_t material = 0;
  std::uint8_t kind = 0; ///< 0 fixed, 1 rigid, 2 deformable
  std::int32_t num_vertices = 0;
  Vec2 centroid; ///< current, m; not written
  Vec2 displacement;
  double rotation = 0.0;
  std::array<double, 3> velocity{};
  std::array<double, 3> stress{};        ///< xx, yy, xy, Pa, tension positive
  std::array<double, 3> contact_force{}; ///< N/m, N/m, N
};

/// Where a frame's rows come from: each rank hands over those it has, strip by strip, so that nobody holds a
/// frame of all blocks.
class FrameSource {
public:
  FrameSource() = default;
  virtual ~FrameSource() = default;
  FrameSource(const FrameSource &) = delete;
  FrameSource &operator=(const FrameSource &) = delete;
  [[nodiscard]] virtual std::int64_t num_rows() const = 0;
  /// This rank's rows with first <= block < last behind `rows`, their current vertices behind `vertices`, in
  /// the same order. Not collective.
  virtual void append(std::int64_t first, std::int64_t last, std::vector<FrameRow> &rows,
                      std::vector<Vec2> &vertices) const = 0;
};

/// One touching region: a line from `begin` to `end` (its extent along the contact).
struct ContactRow {
  std::int64_t lower = 0;
  std::int64_t higher = 0;
  std::int32_t position = 0; ///< order of the region within its pair
  std::int32_t joint = 0;    ///< index of its law
  std::uint8_t state = 0;    ///< 1 stick, 2 slip, 3 a bond, whose normal_force is minus its tension
  Vec2 begin;
  Vec2 end;
  double normal_force = 0.0; ///< N/m
  double shear_force = 0.0;
  double overlap = 0.0; ///< m
  double slip = 0.0;    ///< m, accumulated
};

/// A bolt where it crosses a joint, or all of a cable: a line of `num_points` from the side of its head to
/// that of its tip. Forces are those of one bolt.
struct BoltRow {
  std::int64_t bolt = 0; ///< in the order of the scene
  std::int32_t support = 0;
  std::int32_t num_points = 0;
  std::uint8_t state = 0;   ///< 0 elastic, 1 has yielded, 2 broken
  double axial_force = 0.0; ///< N, tension positive
  double shear_force = 0.0; ///< N, positive where the rock towards the tip has moved to the left
  double extension = 0.0;   ///< m
  double slide = 0.0;       ///< m, with the sign of the shear force
};

/// All bolts, the same on every rank; points concatenated in the order of `rows`.
struct BoltFrame {
  std::vector<BoltRow> rows;
  std::vector<Vec2> points;
};

/// Where a frame's contacts come from.
class ContactSource {
public:
  ContactSource() = default;
  virtual ~ContactSource() = default;
  ContactSource(const ContactSource &) = delete;
  ContactSource &operator=(const ContactSource &) = delete;
  /// This rank's regions with first <= lower < last. Not collective.
  [[nodiscard]] virtual std::int64_t count(std::int64_t first, std::int64_t last) const = 0;
  /// The same regions behind `rows`, by (lower, higher, position).
  virtual void append(std::int64_t first, std::int64_t last, std::vector<ContactRow> &rows) const = 0;
};

/// Ids are cut into one contiguous slab per rank; a slab's owner writes its rows.
/// First id of rank's slab, of num_blocks ids over num_ranks ranks; slab_begin(n, p, p) == n.
std::int64_t slab_begin(std::int64_t num_blocks, int num_ranks, int rank);
int slab_owner(std::int64_t num_blocks, int num_ranks, std::int64_t block);

/// Writes frames/, run.hdf.series and run.xdmf of a result folder.
/// All members are collective. Files appear under their final name only when complete and on the disk; frames
/// get there while the run goes on. What fails then is told by the next write() or finish().
class FrameWriter {
public:
  /// @param num_blocks  all blocks of the scene, fixed ones included
  /// @param ids_per_strip  that a rank writes at a time, 0 for the usual number; files do not depend on it
  FrameWriter(const Communicator &communicator, std::filesystem::path directory, std::int64_t num_blocks,
              std::int64_t ids_per_strip = 0);
  ~FrameWriter(); ///< waits for frames that are on their way

  /// Go on behind the first frames of a run: later ones are removed, the indices tell of those that stay and
  /// are there.
  /// @param times  of frames 0, 1, ... that stay, s
  /// @param files  files() when they were written; known to the root
  void continue_behind(const std::vector<double> &times, const std::vector<ResultFile> &files = {});

  /// Frame number `index` (0, 1, ...); exactly one rank has each block. From one frame to the next blocks may
  /// go, none may come.
  void write(int index, double time, const FrameSource &source);
  /// The same for frames/contacts_<index>.hdf; exactly one rank has each region.
  void write_contacts(int index, double time, const ContactSource &source);
  /// The same for frames/bolts_<index>.hdf, behind write(index), and bolts.hdf.series.
  void write_bolts(int index, double time, const BoltFrame &frame);
  /// All frames have their final names.
  void finish();
  /// And the indices are on the disk, too. A restart makes them anew.
  void sync();
  /// False once HDF5 has broken a collective write into independent ones: slow, and worth a test.
  [[nodiscard]] bool all_writes_collective() const { return all_writes_collective_; }
  /// Of all frames, s; frame k is the k-th.
  [[nodiscard]] std::vector<double> times() const;
  /// Everything in frames/, in the order it was written; after finish(), by the root alone.
  [[nodiscard]] const std::vector<ResultFile> &files();

private:
  void publish_behind(CollectiveFile &file, const std::filesystem::path &path);
  void write_indices_behind();

  Communicator communicator_;
  std::filesystem::path directory_;
  std::unique_ptr<WriteBehind> behind_; ///< at work on the root
  std::int64_t num_blocks_;
  std::int64_t ids_per_strip_;
  /// What stays the same from one frame on, until blocks go.
  struct Topology {
    int first_frame = 0; ///< which its file is named after
    std::int64_t num_cells = 0;
    std::int64_t num_points = 0;
  };
  /// What a strip of this rank's slab is of the last topology.
  struct Place {
    std::int64_t first_cell = 0;
    std::int64_t num_cells = 0;
    std::int64_t first_point = 0;
    std::int64_t num_points = 0;
  };
  [[nodiscard]] const Topology &topology_of(int frame) const;
  [[nodiscard]] Topology survey(int index, const FrameSource &source);
  void write_topology(const Topology &topology, const FrameSource &source);
  template <class Tables>
  void write_strips(CollectiveFile &file, const Topology &topology, const FrameSource &source) const;

  std::vector<Topology> topologies_; ///< by first frame
  std::vector<Place> places_;        ///< empty where nobody has looked yet
  bool all_writes_collective_ = true;
  std::vector<ResultFile> files_; ///< without a size until somebody asks
  std::vector<int> lost_;         ///< frames that were not there when a restart went on behind them
  std::vector<std::pair<int, double>> frames_;
  std::vector<std::pair<int, double>> bolt_frames_; ///< known to the root
};

/// One row of history/<name>.csv, without its time; a point has position and the first two velocities only.
struct BlockHistoryRow {
  Vec2 position;
  double rotation = 0.0;
  std::array<double, 3> velocity{};
  std::array<double, 3> stress{};
  Vec2 contact_force;
};

/// Columns of history/energy.csv after the time.
struct EnergyRow {
  double kinetic = 0.0;
  double strain = 0.0;
  double contact_normal = 0.0;
  double contact_stick = 0.0;
  double gravity = 0.0;
  double friction_loss = 0.0;
  double damping_loss = 0.0;
  double boundary_work = 0.0;
  double residual = 0.0;
  double unbalanced_ratio = 0.0;
  double max_speed = 0.0;
  double support = 0.0; ///< this and the next in scenes with bolts only
  double support_loss = 0.0;
  double excess = 0.0; ///< at least so much is in contact_normal only because it is a mean; not written
};

/// One row of history/bolts.csv: largest values over the joints that one bolt crosses.
struct BoltHistoryRow {
  std::string name;
  Vec2 head; ///< m
  Vec2 tip;
  double axial = 0.0;     ///< N, tension
  double shear = 0.0;     ///< N
  double extension = 0.0; ///< m
  double slide = 0.0;     ///< m
  std::int64_t links = 0;
  std::int64_t yielded = 0;
  std::int64_t broken = 0;
};

/// What one bolt has borne, for summary.json.
struct BoltLoad {
  BoltHistoryRow last;    ///< its last row
  double time = 0.0;      ///< of it, s
  double axial = 0.0;     ///< largest tension of all its rows, N
  double shear = 0.0;     ///< N
  double installed = 0.0; ///< when it was put in last, s; the next two are not known to the history
  bool in_place = false;
  std::string support;
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
  bool has_bolts_;
  std::vector<BoltLoad> bolt_loads_;
  std::unordered_map<std::string, std::size_t> load_of_; ///< by name
  std::vector<std::string> pending_; ///< text not yet appended, per monitor, of energy, and of bolts if any
  std::vector<ResultFile> files_;    ///< what has been appended, in the same order
};

/// Everything summary.json holds.
struct RunSummary {
  int ranks = 1;
  std::int64_t blocks = 0;
  std::int64_t fixed_blocks = 0;
  std::int64_t steps = 0;
  double time = 0.0;
  double time_step = 0.0;
  double time_step_min = 0.0;
  std::int64_t contacts = 0;
  std::int64_t contact_steps = 0;
  std::vector<std::int64_t> evaluations_per_rank;
  std::vector<std::int64_t> work_per_rank;   ///< evaluations and blocks, summed over steps
  std::vector<std::int64_t> ghosts_per_rank; ///< at the end
  double wall_s = 0.0;
  double cpu_s = 0.0;
  double setup_wall_s = 0.0;
  double output_wall_s = 0.0;
  double total_wall_s = 0.0;
  double max_overlap = 0.0;
  double permanent_displacement = -1.0; ///< m, largest since the ground began to shake; negative: it did not
  std::string permanent_block;          ///< the one that has moved so far
  EnergyRow energy;
  double imbalance = 1.0;
  double bytes_sent_per_step = 0.0;
  double messages_per_step = 0.0;
  /// name, {min, mean, max over ranks} in wall seconds
  std::vector<std::pair<std::string, std::array<double, 3>>> phases;
  /// name, count: extra facts a test or a person may want (migrations, refreshes, cross_rank_contacts, ...)
  std::vector<std::pair<std::string, double>> counters;
  double restarted_at = -1.0; ///< s, negative for a run from t = 0; times and counters "of the run" then are
                              ///< of all of it, wall and CPU times, evaluations and messages of this part
  struct StageLine {
    std::string name;
    std::string verdict;
    StageResult result;
  };
  std::vector<BoltLoad> bolts;   ///< those that have been in place
  std::vector<StageLine> stages; ///< those that have begun; none in a scene without stages
  std::string verdict;
  std::string message;
};

/// Written to a temporary name and renamed. Root only.
void write_summary(const std::filesystem::path &directory, const RunSummary &summary);

/// Makes the folder of a run, root only. A folder that holds a run is refused with FileError unless
/// `overwrite`, which removes only what a run writes. Writes scene.toml (the resolved text).
void prepare_result_directory(const std::filesystem::path &directory, bool overwrite,
                              const std::string &resolved_scene);

/// Makes a run's folder fit to go on with: its scene.toml is this one, its summary is gone. Root only.
void reopen_result_directory(const std::filesystem::path &directory, const std::string &resolved_scene);

/// Whether summary.json says that the run has reached its end. Root only.
bool says_completed(const std::filesystem::path &directory);

/// Root only: decomposition/owners_<step>.csv, `block,rank` in BlockId order; anything that depends on ranks
/// lives there.
void write_owners(const std::filesystem::path &directory, std::int64_t step,
                  const std::vector<std::int32_t> &owner_of_block);

} // namespace gcpdda
