#pragma once

#include "base/free_memory.hpp"
#include "base/phase_timer.hpp"
#include "contact/contact_forces.hpp"
#include "contact/in_situ.hpp"
#include "dynamics/ground_motion.hpp"
#include "dynamics/integrate.hpp"
#include "dynamics/scheme.hpp"
#include "dynamics/water_pressure.hpp"
#include "gcpdda/model/scene.hpp"
#include "gcpdda/parallel/communicator.hpp"
#include "io/checkpoint/checkpoint.hpp"
#include "model/generators.hpp"
#include "parallel/ghosts.hpp"
#include "partition/domain_map.hpp"
#include "simulation/balance.hpp"
#include "simulation/bolts.hpp"
#include "simulation/contact_digest.hpp"
#include "simulation/stages.hpp"
#include "simulation/static_state.hpp"
#include "simulation/time_plan.hpp"
#include "statics/pseudo_time.hpp"

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

namespace gcpdda {

/// A scene that cannot be run (exit code 3); what it says goes to people.
class SceneError : public std::runtime_error {
public:
  explicit SceneError(Diagnostics diagnostics)
      : std::runtime_error(diagnostics.empty() ? "bad scene" : to_string(diagnostics.front())),
        diagnostics_(std::move(diagnostics)) {}
  [[nodiscard]] const Diagnostics &diagnostics() const { return diagnostics_; }

private:
  Diagnostics diagnostics_;
};

/// Counts of this rank since the start.
struct Counters {
  std::int64_t evaluations = 0;   ///< candidate pairs looked at closely
  std::int64_t block_steps = 0;   ///< owned blocks summed over steps
  std::int64_t contact_steps = 0; ///< touching pairs summed over steps; each pair on one rank only
  /// Largest number of touching pairs with a ghost in one step, and how many were formed in the run; each
  /// pair on one rank.
  std::int64_t cross_rank_contacts = 0;
  std::int64_t cross_rank_contacts_formed = 0;
  std::int64_t normals_undefined = 0;
  std::int64_t migrations = 0;    ///< blocks that left this rank, the first distribution not counted
  std::int64_t refreshes = 0;     ///< of the neighbourhood after the first
  std::int64_t rebalances = 0;    ///< new maps; each brings a refresh
  std::int64_t messages = 0;      ///< sent to ghosts by steps; refreshes and outputs send more
  std::int64_t bytes = 0;         ///< in these messages
  double max_overlap = 0.0;       ///< m
  double max_overlap_share = 0.0; ///< of the narrowest width
  double fastest_turn = 0.0;      ///< of a deformable block, rad per step
};

/// What limits the step.
struct StepBound {
  double omega_max = 0.0; ///< rad/s, 0 where nothing can touch
  double limit = 2.0;     ///< stable W of scheme and damping; 2 stands in where every W is unstable
  bool always_unstable = false;
  double safety = 0.0; ///< run.safety; where a stage settles 0.9, unless run.safety is below its default
  double undamped_step = 0.0; ///< the step without Rayleigh damping, s
  double time_step = 0.0;     ///< safety * limit / omega_max, s
  double damping_ratio = 0.0; ///< modal ratio the limit was computed with
  std::int64_t block = -1;    ///< the one that sets omega_max; the first of several
  double without_bolts = 0.0; ///< what omega_max would be then, rad/s
};

/// Which blocks the scene's fidelity made rigid and which deformable; all ranks together.
struct FidelityReport {
  std::int64_t num_rigid = 0;
  std::int64_t num_deformable = 0;
  std::int64_t num_asked = 0;    ///< of both, where the scene says the kind
  double worst_rigid = 0.0;      ///< largest share of compliance a rigid block leaves out
  double worst_deformable = 0.0; ///< what the deformable ones would leave out at most
};

/// How far the block is that has gone farthest; of several the one with the smallest id.
struct FarthestBlock {
  double distance = 0.0; ///< of its centroid, m
  std::int64_t block = 0;
};

/// What contacts take from a scene.
inline ContactParameters contact_parameters(const Scene &scene) {
  return {scene.joints, scene.run.contact_damping, scene.run.potential, scene.run.rayleigh.stiffness_damping};
}

/// Where a run begins.
struct Beginning {
  std::filesystem::path folder{};       ///< with whose newest checkpoint; empty: at t = 0
  const Scene *computed_with = nullptr; ///< that state, as it was read; null: the scene of the run
  EarlierResults results = EarlierResults::are_not_looked_at; ///< of that folder
};

/// One run in memory: the state of this rank's blocks and the step. Construction distributes the blocks and
/// finds the consistent initial state; all public members are collective unless const.
class Simulation {
public:
  /// @param scene  valid by itself, the same on all ranks
  /// @throws SceneError with all that is wrong with the block file, the overlaps, the monitors and the step
  /// @throws FileError where the folder it begins with has no checkpoint that fits
  Simulation(const Communicator &communicator, Scene scene, const Beginning &beginning = {});

  /// Advance all blocks from t_n to t_{n+1}.
  void step();

  [[nodiscard]] bool finished() const;
  [[nodiscard]] double time() const {
    return stage_.ended ? stage_.end_time
                        : stage_.start_time + stage_.iteration.skipped + plan_.time(stage_step());
  }
  [[nodiscard]] std::int64_t step_count() const { return step_count_; }

  /// A checkpoint of the state at hand is due.
  [[nodiscard]] bool checkpoint_is_due() const;

  /// The scene has stages; else all of the run is one stage.
  [[nodiscard]] bool is_staged() const { return is_staged_; }
  [[nodiscard]] const std::vector<Stage> &stages() const { return stages_; }
  [[nodiscard]] const StageState &stage() const { return stage_; }
  /// Steps since the stage began: what plan() counts.
  [[nodiscard]] std::int64_t stage_step() const { return step_count_ - stage_.first_step; }
  [[nodiscard]] bool stage_is_over() const {
    return stage_.ended || stage_step() >= plan_.num_steps || fault_.has_value();
  }
  /// A stage that is over gets its result. A settled pile is set to rest, under its own masses.
  void end_stage();
  /// Go over to the next stage and do what it does at once. On return the contact forces are those of the
  /// new state. Remarks go into notes().
  void begin_next_stage();
  /// Of the stages that are over, and of this one as far as it has come.
  [[nodiscard]] std::vector<StageResult> stage_results() const;
  [[nodiscard]] bool is_removed(std::int64_t block) const;
  /// This rank wants the run to stop after the next step; one rank is enough.
  void ask_to_stop() { stop_asked_ = true; }
  /// Some rank asked before the last step; the same on all ranks.
  [[nodiscard]] bool stop_agreed() const { return stop_agreed_; }
  /// Why the run cannot go on; the same on all ranks.
  [[nodiscard]] const std::optional<Fault> &fault() const { return fault_; }

  [[nodiscard]] const Communicator &communicator() const { return communicator_; }
  [[nodiscard]] const Scene &scene() const { return scene_; }
  [[nodiscard]] const BlockSystem &blocks() const { return blocks_; }
  [[nodiscard]] const Candidates &candidates() const { return candidates_; }
  [[nodiscard]] const ContactHistory &history() const { return history_; }
  [[nodiscard]] const ContactForces &contacts() const { return contacts_; }
  /// Of the last evaluation: to be asked for before the trial configuration or the neighbourhood changes.
  [[nodiscard]] const ContactDigest &contact_digest() const {
    if (!digest_) {
      digest_contacts({});
    }
    return *digest_;
  }
  /// It is made then, while `look` is at all regions.
  void digest_contacts(const ContactDigest::Look &look) const {
    digest_.emplace().find(blocks_, candidates_, history_, contacts_, look);
  }
  /// Nobody asks for it for now: it takes 56 bytes a block.
  void forget_contact_digest() const { digest_.reset(); }
  /// visit(pair, its regions) for those of pairs [first, last) that touch, with the same restriction.
  template <class Visit> void for_regions(std::size_t first, std::size_t last, Visit &&visit) const {
    contacts_.for_regions(blocks_, candidates_, history_, static_cast<std::uint32_t>(first),
                          static_cast<std::uint32_t>(last), visit);
  }
  [[nodiscard]] const Bolts &bolts() const { return bolts_; }
  [[nodiscard]] const DomainMap &domain_map() const { return map_; }
  [[nodiscard]] const PartitionReport &partition() const { return partition_; }
  [[nodiscard]] const Ghosts &ghosts() const { return ghosts_; }
  [[nodiscard]] const Scheme &scheme() const { return scheme_; }
  [[nodiscard]] const TimePlan &plan() const { return plan_; }
  [[nodiscard]] const StepBound &bound() const { return bound_; }
  [[nodiscard]] const FidelityReport &fidelity() const { return fidelity_; }
  [[nodiscard]] const Counters &counters() const { return counters_; }
  [[nodiscard]] const PhaseTimes &phases() const { return phases_; }
  [[nodiscard]] PhaseTimes &phases() { return phases_; }
  /// Warnings and remarks of the set-up, the same on all ranks.
  [[nodiscard]] const Diagnostics &notes() const { return notes_; }
  /// What the run so far has to warn of, the same on all ranks.
  [[nodiscard]] Diagnostics warnings() const;
  /// Motion against the ground since the stage began in which it shakes, or since t = 0 in a scene without
  /// stages; nothing in other stages. Collective.
  [[nodiscard]] std::optional<FarthestBlock> permanent_displacement() const;
  /// What a load of a row was in the last evaluation, N per metre.
  [[nodiscard]] Vec2 force_of(const MaterialLoad &load) const;
  /// This rank writes what is known of the pair: one rank for each pair.
  [[nodiscard]] bool counts_here(const CandidatePair &pair) const;
  [[nodiscard]] std::int64_t num_blocks() const { return gcpdda::num_blocks(scene_); }
  /// The checkpoint this run began with; none for a run from t = 0.
  [[nodiscard]] const std::optional<Restored> &restored() const { return restored_; }
  /// The scene of the state this run began with was another one: its fingerprints by stage, else none.
  [[nodiscard]] std::vector<std::uint64_t> changed_from() const;
  /// Everything a checkpoint holds besides the blocks and their contacts, but what the output knows.
  [[nodiscard]] RunFacts facts() const;
  /// @param region  of this candidate
  [[nodiscard]] RegionRecord record_of(std::size_t pair, const RegionMemory &region) const;

  /// Visit the trial configuration of the next step without taking it: what the energy ledger needs. On
  /// return the state is as before, and what contacts say as well.
  template <class Look> void look_ahead(Look &&look) {
    std::vector<RigidDof> trial = blocks_.trial;
    std::vector<Deformation> deformation = blocks_.deformation;
    std::vector<RigidDof> increments;
    std::vector<std::array<Vec2, 2>> turns(deformation.size());
    increments.reserve(blocks_.motion.size());
    for (std::size_t row = 0; row < blocks_.motion.size(); ++row) {
      increments.push_back(blocks_.motion[row].increment());
      if (blocks_.is_deformable(row)) {
        turns[blocks_.deformation_begin[row]] = blocks_.motion[row].turn;
      }
    }
    find_prescribed_rows();
    send_border_trials();
    predict_rows({0, blocks_.num_owned});
    receive_ghosts();
    look(blocks_);
    blocks_.trial = std::move(trial);
    blocks_.deformation = std::move(deformation);
    for (std::size_t row = 0; row < increments.size(); ++row) {
      blocks_.motion[row].set_increment(increments[row]);
      if (blocks_.is_deformable(row)) {
        blocks_.motion[row].turn = turns[blocks_.deformation_begin[row]];
      }
    }
    pose_in_lanes(blocks_, 0, blocks_.num_mobile());
    increments = {};
    give_back_free_memory(2 * blocks_.num_rows() * sizeof(RigidDof));
  }

private:
  void begin_as_restored(const Scene &start, const BlockSystem &rows, const StageState &saved,
                         const RunFacts &facts);
  void plan_all_stages();
  void plan_stage();
  void scale_masses();
  void unscale_masses();
  void set_to_rest();
  [[nodiscard]] RigidDof damped_motion(std::size_t row) const;
  void look_at_stage();
  void stop_at_energy_peak();
  void book_stop();
  void mark_stage();
  void evaluate_still();
  void adopt(const Stage &stage, double begin);
  void change_bolts(const std::vector<Bolt> &before);
  void adopt_materials(const std::vector<Material> &before);
  void adopt_block(std::int64_t id, const SceneBlock &before, const SceneBlock &after);
  void free_block(std::int64_t id, const SceneBlock &block);
  [[nodiscard]] std::vector<std::int64_t> select_blocks(const BlockSelection &selection) const;
  void excavate(const std::vector<std::int64_t> &ids, double relax);
  void unload(const std::vector<std::int64_t> &removed, double duration);
  void remove_blocks(const std::vector<std::int64_t> &ids);
  [[nodiscard]] Unloading unloading_of(BlockId block) const;
  // Forces that change with time, see loads.cpp.
  void list_courses();
  std::int64_t new_course(LoadCourse course);
  void load_sides(std::span<SceneBlock> slab) const;
  [[nodiscard]] static double start_of_stage(std::int64_t stage, const StageState &state);
  void change_side_stress(const Rise &change);
  std::vector<PointLoad> loads_after(std::vector<PointLoad> acting, std::vector<PointLoad> listed,
                                     const Rise &change);
  void adopt_loads(std::size_t row, const std::vector<PointLoad> &before,
                   const std::vector<PointLoad> &after);
  [[nodiscard]] bool loads_are_changing() const;
  void distribute(const Beginning &beginning);
  void take_prints(const Beginning &beginning);
  void restore(const Beginning &beginning, ContactMemory &memory);
  void expect_own_state(const ScenePrints &saved, std::int64_t stage,
                        std::span<const std::uint64_t> past) const;
  void identify(std::span<const SceneBlock> slab);
  void go_on();
  [[nodiscard]] std::vector<SceneBlock> cut_region();
  [[nodiscard]] std::vector<SceneBlock> load_slab(std::vector<SceneBlock> cut);
  void note_groups(std::span<const SceneBlock> slab);
  void find_model_sizes(std::span<const SceneBlock> slab);
  void survey(std::span<const SceneBlock> slab);
  void find_laws_on_edges(std::span<const SceneBlock> slab);
  void warn_of_rounding(double size, double farthest);
  void warn_of_lively_impacts();
  // What is implausible, see doubts.cpp.
  void doubt_blocks(std::span<const SceneBlock> slab);
  void doubt_use(std::span<const SceneBlock> slab);
  void doubt_holds(std::span<const SceneBlock> slab);
  void doubt_sizes(std::span<const SceneBlock> slab);
  void doubt_stiffness(double pressure, double size);
  void doubt_slivers(std::span<const SceneBlock> slab);
  void explain_slivers();
  void doubt_gaps();
  void doubt_monitors();
  void take_blocks(std::vector<SceneBlock> slab);
  void place_monitors(std::span<const SceneBlock> slab);
  void place_point(std::span<const SceneBlock> slab, Monitor &monitor);
  void check_named_block(std::span<const SceneBlock> slab, const Monitor &monitor);
  [[nodiscard]] std::vector<std::int64_t> count_contact_work();
  void find_bound();
  [[nodiscard]] double frequency_bound_of(std::size_t row, std::span<const PointSpring> springs) const;
  [[nodiscard]] Vec2 gravity() const;
  void open_earthquake();
  [[nodiscard]] double shaking_since() const;
  [[nodiscard]] Vec2 ground_acceleration() const;
  [[nodiscard]] Vec2 incoming_wave() const;
  void add_dashpot(const SceneBlock &block, const Material &material);
  void wake_dashpots();
  [[nodiscard]] bool opens_viscous_sides() const;
  [[nodiscard]] std::vector<std::int64_t> held_beyond_viscous_sides() const;
  void prepare_matrices();
  void find_initial_state();
  void check_bonds();
  void check_initial_overlaps();
  void find_initial_friction();
  void apply_in_situ_stress();
  void stress_rows();
  void tell_of_swelling(const SwellReport &mine);
  void put_initial_shear();
  void accelerate_owned();
  [[nodiscard]] ContactMemory remembered_contacts() const;
  /// @param given  what is remembered of contacts, if it is not what stands in their history
  void refresh(std::optional<ContactMemory> given = {});
  // The parts of a step in their order, see simulation.cpp; moving.cpp says how owned rows go through it.
  void rebalance_if_uneven();
  void begin_step();
  void send_border_trials();
  /// Set the trial configurations of owned rows below `end`, which begin a contact evaluation.
  void predict_to(std::size_t end);
  void evaluate_group(const PairGroup &group);
  void progress_messages();
  /// Advance owned rows below `end` to the end of the step; rows that wait stay behind.
  void advance_to(std::size_t end);
  void receive_ghosts();
  void evaluate_border();
  void sum_forces();
  void advance_remaining();
  void prescribe_motion();
  void judge_stage();
  void report();
  // Steps of the static solver, see static_stage.cpp.
  [[nodiscard]] bool is_static() const;
  [[nodiscard]] std::string not_served() const;
  [[nodiscard]] double end_of_loads() const;
  void leave_statics(const std::string &reason);
  void close_statics();
  void lay_statics();
  void open_statics();
  void refresh_statics();
  void static_step();
  void evaluate_statically();
  void book_static_work();
  void find_static_motion();
  void judge_statics();
  void report_statically();

  void find_prescribed_rows();
  void prepare_forces();
  /// Set the trial configurations of owned rows, prescribed ones by their tables.
  void predict_rows(RowSpan rows);
  void find_waiting_rows();
  void advance_rows(std::size_t first, std::size_t end);
  /// @return the first row that is not free
  std::size_t advance_free(std::size_t first, std::size_t end);
  void evaluate_bolts();
  void take(const ForceReport &report);
  void gather_forces(std::size_t first, std::size_t last, const BodyForces &body);
  AppliedForces gather_block(std::size_t row, const BodyForces &body, const WaterLoad &water);
  void gather_gradient(std::size_t row, const WaterLoad &water);
  /// Two blocks that close by half their width in a step skip the force that parts them, m.
  [[nodiscard]] double most_motion_in_step() const { return 0.25 * thinnest_; }
  /// A block whose most_motion() is at most this needs no check, m.
  [[nodiscard]] double safe_motion() const;
  [[nodiscard]] double own_status();
  void count();
  void agree_on_fault();

  Communicator communicator_;
  Scene scene_;
  BlockSystem blocks_;
  DomainMap map_;
  PartitionReport partition_;
  Balance balance_;
  Ghosts ghosts_;
  Candidates candidates_;
  ContactHistory history_;
  mutable ContactForces contacts_;              ///< details are found when somebody asks
  mutable std::optional<ContactDigest> digest_; ///< once it has been asked for
  Bolts bolts_;
  OwnForces own_forces_; ///< at the last evaluation
  TrialOutline outline_; ///< of a block in water
  /// How far a step has come with the owned rows.
  struct StepProgress {
    BodyForces body;              ///< of this step
    std::size_t predicted = 0;    ///< rows below have their trial configurations
    std::size_t advanced = 0;     ///< rows below are at the end of the step, except waiting ones
    std::size_t passed = 0;       ///< spans of `waiting` below `advanced`
    std::vector<RowSpan> waiting; ///< rows that cannot be advanced with their group
    AdvanceReport report;         ///< of the last step
  };
  StepProgress progress_;
  struct PrescribedRow {
    std::size_t row;
    RigidDof trial; ///< in the step at hand
    RigidDof increment;
  };
  std::vector<PrescribedRow> prescribed_rows_;
  std::vector<TrialConfiguration> border_trials_; ///< by entry of Ghosts::sent_rows()
  /// Motion of every block that has a velocity table, by ascending id: all ranks know them all.
  std::vector<std::pair<BlockId, PrescribedMotion>> prescribed_;
  std::vector<LoadCourse> courses_;         ///< what loads are multiplied by; 0: the constant one
  std::vector<InSituStress> side_stresses_; ///< on sides of the region: at the start, then those of stages
  GroundMotion ground_;
  FidelityReport fidelity_;
  Scheme scheme_;
  StepBound bound_;
  TimePlan plan_;
  std::int64_t step_count_ = 0;
  /// Share of the skin that blocks in a stage with the static solver may use up before a refresh: pairs that
  /// are twice as far apart are still known, and springs of contacts that have opened with them.
  static constexpr double share_of_skin_kept = 0.25;
  std::optional<statics::PseudoTime> statics_; ///< while a stage has it
  StaticState restored_statics_;               ///< until the first step
  std::vector<Stage> stages_;                  ///< at least one
  StageState stage_;
  bool is_staged_ = false;
  double local_damping_ = 0.0; ///< of this stage
  double load_time_ = 0.0;     ///< when loads were last evaluated, s
  double thinnest_ = 0.0;      ///< narrowest width of any block, m
  double sag_ = 0.0;           ///< largest_sag() of the scene, m
  double base_skin_ = 0.0;
  double in_situ_overlap_ = 0.0; ///< largest overlap of the in-situ stress, m
  double skin_ = 0.0;
  bool stale_ = true;
  bool stop_asked_ = false;
  bool stop_agreed_ = false;
  SceneIdentity identity_;
  std::vector<ScenePrints> prints_;        ///< of this scene, by stage
  std::vector<ScenePrints> prints_before_; ///< of the scene that the state it began with was computed with
  std::optional<Restored> restored_;
  ForceReport force_report_;
  ContactCount contact_count_; ///< at the last evaluation
  std::optional<Fault> local_fault_;
  std::optional<Fault> fault_;
  Counters counters_;
  PhaseTimes phases_;
  Diagnostics notes_;
};

} // namespace gcpdda
