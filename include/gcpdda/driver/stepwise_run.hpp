#pragma once

// A run that its caller steps and looks at.

#include "gcpdda/base/scene_error.hpp"
#include "gcpdda/io/frame_rows.hpp"
#include "gcpdda/io/frame_writer.hpp"
#include "gcpdda/io/run_summary.hpp"
#include "gcpdda/model/scene.hpp"
#include "gcpdda/parallel/communicator.hpp"

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace gcpdda {

/// A run in memory that its caller steps and looks at; run_scene() (driver/run.hpp) is one that writes
/// everything by itself. All members are collective unless they are const.
class StepwiseRun {
public:
  /// Distributes the blocks over the ranks and finds the initial state. A scene with a region has got what
  /// cuts it (blockgen/region_blocks.hpp).
  /// @throws SceneError with all that is wrong with the blocks and the step
  StepwiseRun(const Communicator &communicator, Scene scene);
  ~StepwiseRun();
  StepwiseRun(const StepwiseRun &) = delete;
  StepwiseRun &operator=(const StepwiseRun &) = delete;

  /// One step; where a stage is over the next one begins first. Not to be called once it is finished.
  void step();
  /// All stages are over, or something has failed.
  [[nodiscard]] bool is_finished() const;
  /// Why the run cannot go on, the same on all ranks; nothing where it can.
  [[nodiscard]] std::optional<std::string> fault() const;

  [[nodiscard]] double time() const;             ///< s
  [[nodiscard]] double time_step() const;        ///< s
  [[nodiscard]] std::int64_t step_count() const; ///< steps since the beginning of the run
  /// Number of the stage, 0 where the scene has none.
  [[nodiscard]] std::int64_t stage() const;
  [[nodiscard]] std::int64_t num_blocks() const; ///< of all ranks, fixed ones included
  /// Warnings and remarks of the start, the same on all ranks.
  [[nodiscard]] const Diagnostics &notes() const;

  /// Blocks of this rank, by their number in the scene: each block is on one rank.
  /// @param vertices  gets their current vertices, m, FrameRow::num_vertices of each in the same order
  [[nodiscard]] std::vector<FrameRow> blocks(std::vector<Vec2> *vertices = nullptr);
  /// Contacts of this rank, by the numbers of their blocks: each contact is on one rank.
  [[nodiscard]] std::vector<ContactRow> contacts();
  /// Energies of all blocks; `residual` is what the time steps made of them since the start.
  [[nodiscard]] EnergyRow energy();
  /// Frame number `index` with its contacts, for ParaView and plot.py.
  void write_frame(FrameWriter &frames, int index);

private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

} // namespace gcpdda
