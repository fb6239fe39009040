#pragma once

// Sentences of the log on faults, the time step, progress, laws, bolts and verdicts.

#include "gcpdda/io/run_summary.hpp"
#include "simulation/simulation.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace gcpdda {

/// Why a run cannot go on.
std::string fault_message(const Simulation &simulation);

/// Which blocks are rigid, and what that leaves out.
std::string words_on_fidelity(const FidelityReport &fidelity, double accepted_error);

/// The stage at hand is the static solver's.
bool begins_statically(const Simulation &simulation);
/// How many time steps there are.
std::string words_on_steps(const Simulation &simulation);

/// How many ranks and blocks there are, and how blocks and work are shared. Collective.
std::string words_on_blocks(const Simulation &simulation);

/// The time step, how many there are, and what bounds it.
std::string words_on_time_step(const Simulation &simulation);

/// The step that a block with a given velocity sets, where one does.
std::string words_on_motion_bound(const Simulation &simulation);

/// The stiffness and strength of a joint law.
std::string words_on_law(const JointLaw &law);

/// The strength of a joint law: its friction, Coulomb's or that of Barton and Bandis, and its cohesion.
std::string words_on_strength(const JointLaw &law);

/// How a stage has ended.
std::string words_on_stage(const std::string &name, const StageResult &result);

/// Which blocks have slid in a settle stage, and how far.
/// @param block  name of the one that has slid farthest
std::string words_on_slide(const std::string &stage, const std::string &block, const StageResult &result);
/// What is to be told where blocks have slid to where they hold in a settle stage; nothing for slides below
/// StageResult::telling_slide.
std::optional<Diagnostic> warning_of_slide(const Simulation &simulation, const Stage &stage,
                                           const StageResult &result);

/// How far a run is, from the last row of energies and the time of a step, s. A stage that waits for its
/// verdict says how near to rest it was when it was looked at last: nobody knows when it will be there.
std::string words_on_progress(const Simulation &simulation, const EnergyRow &energy, double per_step);

/// Tell in `summary` how a run has ended, and why.
/// @param directory  of the run; empty where nobody can go on from it
void tell_end(const Simulation &simulation, const std::filesystem::path &directory, RunSummary &summary);

/// The most loaded bolts and liners, how many have cracked, yielded and broken, and which liners without a
/// compressive_strength have borne more than concrete can.
std::vector<std::string> words_on_support(const RunSummary &summary, const Scene &scene);

/// How many bolts there are, and what they do to the step.
std::string words_on_bolts(const Simulation &simulation);

} // namespace gcpdda
