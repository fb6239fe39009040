#pragma once

// One run in memory: the state of this rank's blocks and the step. What it is made of is plain data
// (simulation/run_state.hpp), and what is done with it stands in the files that are included here; those who
// only look at a run use the names below.

#include "io/checkpoint/checkpoint_reader.hpp"
#include "partition/partition_cells.hpp"
#include "simulation/ground.hpp"
#include "simulation/run_state.hpp"
#include "simulation/stage_runner.hpp"
#include "simulation/start.hpp"
#include "simulation/step_report.hpp"
#include "simulation/step_rows.hpp"

#include <cstdint>
#include <optional>
#include <vector>

namespace gcpdda {

/// All public members are collective unless const.
class Simulation {
public:
  /// @param scene  valid by itself, the same on all ranks
  /// @throws SceneError, FileError as start() does
  Simulation(const Communicator &communicator, Scene scene, const Beginning &beginning = {});
  Simulation(const Simulation &) = delete; // what steps with it holds on to its state
  Simulation &operator=(const Simulation &) = delete;

  /// Advance all blocks from t_n to t_{n+1}.
  void step();

  [[nodiscard]] RunState &state() { return run_; }
  [[nodiscard]] const RunState &state() const { return run_; }

  [[nodiscard]] bool finished() const { return run_.fault || run_.clock.is_finished(); }
  [[nodiscard]] double time() const { return run_.clock.time(); }
  [[nodiscard]] std::int64_t step_count() const { return run_.clock.step_count; }

  /// The scene has stages; else all of the run is one stage.
  [[nodiscard]] bool is_staged() const { return run_.clock.is_staged; }
  [[nodiscard]] const std::vector<Stage> &stages() const { return run_.clock.stages; }
  [[nodiscard]] const StageState &stage() const { return run_.clock.state; }
  /// Steps since the stage began: what plan() counts.
  [[nodiscard]] std::int64_t stage_step() const { return run_.clock.stage_step(); }
  [[nodiscard]] bool stage_is_over() const { return run_.fault || run_.clock.stage_is_over(); }
  void end_stage() { gcpdda::end_stage(run_); }
  void begin_next_stage() { gcpdda::begin_next_stage(run_); }
  [[nodiscard]] std::vector<StageResult> stage_results() { return gcpdda::stage_results(run_); }
  [[nodiscard]] bool is_removed(std::int64_t block) const {
    return gcpdda::is_removed(run_.clock.state, block);
  }
  /// This rank wants the run to stop after the next step; one rank is enough.
  void ask_to_stop() { run_.stop_asked = true; }
  /// Some rank asked before the last step; the same on all ranks.
  [[nodiscard]] bool stop_agreed() const { return run_.stop_agreed; }
  /// Why the run cannot go on; the same on all ranks.
  [[nodiscard]] const std::optional<Fault> &fault() const { return run_.fault; }

  [[nodiscard]] const Communicator &communicator() const { return run_.communicator; }
  [[nodiscard]] const Scene &scene() const { return run_.scene; }
  [[nodiscard]] const BlockSystem &blocks() const { return run_.blocks; }
  [[nodiscard]] const Candidates &candidates() const { return run_.neighbours.candidates; }
  [[nodiscard]] const ContactHistory &history() const { return run_.neighbours.history; }
  [[nodiscard]] const ContactForces &contacts() const { return run_.contacts; }
  [[nodiscard]] const Bolts &bolts() const { return run_.bolts; }
  [[nodiscard]] const DomainMap &domain_map() const { return run_.neighbours.map; }
  [[nodiscard]] const PartitionReport &partition() const { return run_.neighbours.partition; }
  [[nodiscard]] const Ghosts &ghosts() const { return run_.neighbours.ghosts; }
  [[nodiscard]] const Scheme &scheme() const { return run_.scheme; }
  [[nodiscard]] const TimePlan &plan() const { return run_.clock.plan; }
  [[nodiscard]] const StepBound &bound() const { return run_.bound; }
  [[nodiscard]] const FidelityReport &fidelity() const { return run_.fidelity; }
  [[nodiscard]] const Counters &counters() const { return run_.counters; }
  [[nodiscard]] const PhaseTimes &phases() const { return run_.phases; }
  [[nodiscard]] PhaseTimes &phases() { return run_.phases; }
  /// Warnings and remarks of the set-up, the same on all ranks.
  [[nodiscard]] const Diagnostics &notes() const { return run_.notes; }
  /// This rank writes what is known of the pair: one rank for each pair.
  [[nodiscard]] bool counts_here(const CandidatePair &pair) const {
    return gcpdda::counts_here(run_.blocks, pair.lower);
  }
  [[nodiscard]] std::int64_t num_blocks() const { return gcpdda::num_blocks(run_.scene); }
  /// The checkpoint this run began with; none for a run from t = 0.
  [[nodiscard]] const std::optional<Restored> &restored() const { return run_.restored; }

private:
  RunState run_;
  StepRows rows_;
};

} // namespace gcpdda
