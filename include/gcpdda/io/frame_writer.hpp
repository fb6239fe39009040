#pragma once

// Frames of a result folder: the blocks, contacts, bolts and liners of one time in a file each.

#include "gcpdda/io/frame_rows.hpp"
#include "gcpdda/io/result_manifest.hpp"
#include "gcpdda/parallel/communicator.hpp"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <utility>
#include <vector>

namespace gcpdda {

class CollectiveFile;
class WriteBehind;

/// Where a frame's rows come from: each rank hands over those it has, strip by strip, so that nobody holds a
/// frame of all blocks.
class FrameSource {
public:
  FrameSource() = default;
  virtual ~FrameSource() = default;
  FrameSource(const FrameSource &) = delete;
  FrameSource &operator=(const FrameSource &) = delete;
  /// How many rows this rank has.
  [[nodiscard]] virtual std::int64_t num_rows() const = 0;
  /// This rank's rows with first <= block < last behind `rows`, their current vertices behind `vertices`, in
  /// the same order. Not collective.
  virtual void append(std::int64_t first, std::int64_t last, std::vector<FrameRow> &rows,
                      std::vector<Vec2> &vertices) const = 0;
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

/// Writes frames/, run.hdf.series and run.xdmf of a result folder.
/// All members are collective. Files appear under their final name only when complete and on the disk; frames
/// get there while the run goes on. What fails then is told by the next write() or finish().
class FrameWriter {
public:
  /// @param communicator  of all ranks that write
  /// @param directory  the result folder
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
  /// The same for frames/contacts_INDEX.hdf and contacts.hdf.series; exactly one rank has each region.
  void write_contacts(int index, double time, const ContactSource &source);
  /// The same for frames/bolts_INDEX.hdf, behind write(index), and bolts.hdf.series.
  void write_bolts(int index, double time, const BoltFrame &frame);
  /// The same for frames/liners_INDEX.hdf and liners.hdf.series; rows are the same on every rank.
  void write_liners(int index, double time, const std::vector<LinerRow> &rows);
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
  /// The index of frames of contacts, bolts or liners, which `kind` says.
  void write_series_behind(const char *name, const std::vector<std::pair<int, double>> &frames,
                           const char *kind);

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
  std::vector<std::pair<int, double>> contact_frames_;
  std::vector<std::pair<int, double>> bolt_frames_;
  std::vector<std::pair<int, double>> liner_frames_;
};

} // namespace gcpdda
