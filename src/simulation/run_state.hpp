#pragma once

// A run in memory as plain data: what the parts of the step, the start, the stages and the ledger work on.

#include "base/phase_timer.hpp"
#include "contact/contact_forces.hpp"
#include "dynamics/scheme.hpp"
#include "gcpdda/base/scene_error.hpp"
#include "gcpdda/model/scene.hpp"
#include "gcpdda/parallel/communicator.hpp"
#include "io/checkpoint/checkpoint.hpp"
#include "io/checkpoint/checkpoint_reader.hpp"
#include "simulation/bolts.hpp"
#include "simulation/contact_digest.hpp"
#include "simulation/loads.hpp"
#include "simulation/neighbourhood.hpp"
#include "simulation/stage_clock.hpp"
#include "simulation/static_state.hpp"
#include "simulation/step_bound.hpp"
#include "statics/pseudo_time.hpp"

#include <cstdint>
#include <optional>
#include <vector>

namespace gcpdda {

/// Counts of this rank since the start.
struct Counters {
  std::int64_t evaluations = 0;   ///< candidate pairs looked at closely
  std::int64_t most_pairs = 0;    ///< largest number of them in one step
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
  std::int64_t products = 0;      ///< with the stiffness of contacts, by the static solver
  std::int64_t messages = 0;      ///< sent to ghosts by steps; refreshes and outputs send more
  std::int64_t bytes = 0;         ///< in these messages
  std::int64_t reductions = 0;    ///< maxima and sums over all ranks, also of refreshes and outputs
  double max_overlap = 0.0;       ///< m
  double max_overlap_share = 0.0; ///< of the narrowest width
  double fastest_turn = 0.0;      ///< of a deformable block, rad per step
};

/// Which blocks the scene's fidelity made rigid and which deformable; all ranks together.
struct FidelityReport {
  std::int64_t num_rigid = 0;
  std::int64_t num_deformable = 0;
  std::int64_t num_asked = 0;    ///< of both, where the scene says the kind
  double worst_rigid = 0.0;      ///< largest share of compliance a rigid block leaves out
  double worst_deformable = 0.0; ///< what the deformable ones would leave out at most
};

/// What a look at a stage sees of a block.
struct BlockLook {
  double unbalanced = 0.0; ///< net force, local damping left out, N/m
  double yardstick = 0.0;  ///< by what it is measured (unbalanced.hpp), N/m
  double load = 0.0;       ///< weight and applied force, N/m
  double motion = 0.0;     ///< since the look before, m
  double kinetic = 0.0;    ///< J/m
  double moved = 0.0;      ///< since the stage began, in sizes of the block ...
  bool beyond_sag = false; ///< ... and farther than a pile sags
};

struct RunState {
  /// Nothing has been distributed yet.
  RunState(const Communicator &world, Scene given);

  Communicator communicator;
  Scene scene;
  BlockSystem blocks;
  Neighbourhood neighbours;
  ContactForces contacts;
  ForceReport force_report;   ///< of the last evaluation
  ContactCount contact_count; ///< at the last evaluation
  Bolts bolts;
  Loads loads;
  StageClock clock;
  Scheme scheme;
  StepBound bound;
  FastestBlock fastest_given; ///< fastest_at_start()
  FidelityReport fidelity;
  std::vector<BlockLook> looks;          ///< at each owned block, of the last look at a stage
  std::vector<std::int64_t> look_sums;   ///< scratch
  std::vector<double> unbalanced_forces; ///< scratch of unbalanced.hpp, as those that follow
  std::vector<double> yardsticks;
  std::vector<double> contact_loads;
  std::optional<statics::PseudoTime> statics; ///< while a stage has the static solver
  StaticState saved_statics;                  ///< of the checkpoint it began with, until the first step
  double local_damping = 0.0;                 ///< of this stage
  double thinnest = 0.0;                      ///< narrowest width of any block that is there, m
  double sag = 0.0;                           ///< largest_sag() of the scene, m
  double in_situ_overlap = 0.0;               ///< largest overlap of the in-situ stress, m
  bool stop_asked = false;
  bool stop_agreed = false;
  SceneIdentity identity;
  std::vector<ScenePrints> prints;        ///< of this scene, by stage
  std::vector<ScenePrints> prints_before; ///< of the scene that the state it began with was computed with
  std::optional<Restored> restored;       ///< what it began with; none for a run from t = 0
  std::optional<Fault> local_fault;
  std::optional<Fault> fault; ///< why the run cannot go on; the same on all ranks
  Counters counters;
  std::int64_t first_reduction = 0; ///< of the run, of all that its communicator has found
  PhaseTimes phases;
  Diagnostics notes;                   ///< warnings and remarks of the set-up, the same on all ranks
  std::optional<ContactDigest> digest; ///< of the last evaluation, once it has been asked for
};

/// Largest distance that a point of a block has moved.
inline double motion_between(const BlockProperties &block, const RigidDof &from, const RigidDof &to) {
  return norm(to.u - from.u) + block.radius * std::abs(to.r - from.r);
}

/// What contacts take from a scene.
ContactParameters contact_parameters(const Scene &scene);

/// Find the neighbourhood anew. Collective.
/// @param memory  what is remembered of contacts; without it what stands in their history
void refresh(RunState &run);
void refresh(RunState &run, ContactMemory memory);

/// Every 64 steps. Collective.
void rebalance_if_uneven(RunState &run);

/// visit(pair, its regions) for those of pairs [first, last) that touch, with details of the last evaluation:
/// to be asked for before the trial configuration or the neighbourhood changes.
template <class Visit> void for_regions(RunState &run, std::size_t first, std::size_t last, Visit &&visit) {
  run.contacts.for_regions(run.blocks, run.neighbours.candidates, run.neighbours.history,
                           static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(last), visit);
}

/// Made when it is first asked for after an evaluation, with the same restriction.
const ContactDigest &contact_digest(RunState &run);

/// Two blocks that close by half their width in a step skip the force that parts them, m.
inline double most_motion_in_step(const RunState &run) {
  return 0.25 * run.thinnest;
}
/// A block whose most_motion() is at most this needs no check, m.
double safe_motion(const RunState &run);

} // namespace gcpdda
