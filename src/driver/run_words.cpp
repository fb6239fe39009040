#include "driver/run_words.hpp"

#include "base/round_numbers.hpp"
#include "simulation/dust.hpp"
#include "simulation/rank_facts.hpp"
#include "simulation/strain_watch.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <iterator>
#include <limits>
#include <numeric>

namespace gcpdda {

namespace {

/// What to try where blocks move too far in a step, with values that differ from those of this run.
/// @param longest  of the steps that can help, s
std::string words_on_shorter_step(const Simulation &simulation,
                                  double longest = std::numeric_limits<double>::infinity()) {
  const Stage &stage = simulation.stages()[static_cast<std::size_t>(simulation.stage().index)];
  const double shorter = std::min({0.5 * simulation.plan().time_step, simulation.bound().time_step, longest});
  std::string step = fmt::format("run.time_step = {:.2g}", two_digits_below(shorter));
  if (stage.kind != StageKind::settle) {
    return step;
  }
  const std::string name = simulation.is_staged() ? fmt::format(" in stage '{}'", stage.name) : "";
  return stage.kinetic_damping
             ? fmt::format("local_damping = 0.8 in place of kinetic_damping{}, or {}", name, step)
             : fmt::format("kinetic_damping = true{}, or {}", name, step);
}

/// The first thing to try where one of two blocks is a sliver cut from a region.
std::string words_on_dust(const Simulation &simulation, const Fault &fault) {
  const double width =
      width_against_dust(simulation.scene(), fault.block.value, fault.other.value, 2.0 * fault.limit);
  return width > 0.0 ? fmt::format("region.min_width = {:.2g}, because one of them is a sliver that becomes "
                                   "part of a neighbour by that, or ",
                                   width)
                     : "";
}

} // namespace

std::string fault_message(const Simulation &simulation) {
  const Fault &fault = *simulation.fault();
  const auto name = [&](BlockId id) { return block_name(simulation.scene(), id.value); };
  const std::string where = fmt::format("block '{}' at t = {:.9g} s", name(fault.block), simulation.time());
  switch (fault.cause) {
  case Fault::Cause::too_deep:
    return fmt::format(
        "{}: overlaps block '{}' by {:.4g} m, deeper than half the narrowest width {:.4g} m, where the "
        "contact force reverses; try {}a larger joint.normal_stiffness, or {}",
        where, name(fault.other), fault.value, fault.limit, words_on_dust(simulation, fault),
        words_on_shorter_step(simulation));
  case Fault::Cause::too_fast:
    if (fault.other.value < 0) {
      return fmt::format(
          "{}: moves {:.4g} m in one step, more than {:.4g} m, a quarter of the narrowest block width, and "
          "could pass through a block, though none is near it now; where it has left the model, put a fixed "
          "block below that it lands on, or excavate it in a stage before; else try {}",
          where, fault.value, fault.limit,
          words_on_shorter_step(simulation, StepBound::share_of_motion * fault.limit / fault.value *
                                                simulation.plan().time_step));
    }
    return fmt::format(
        "{}: moves {:.4g} m in one step, more than {:.4g} m, a quarter of the narrowest block width, and "
        "could pass through a block; try {}",
        where, fault.value, fault.limit,
        words_on_shorter_step(simulation, StepBound::share_of_motion * fault.limit / fault.value *
                                              simulation.plan().time_step));
  case Fault::Cause::not_finite:
    break;
  }
  if (fault.value > large_strain) {
    return fmt::format(
        "{}: its state is no longer finite, and deformable blocks are strained by up to {:.2g}, "
        "for which linear elasticity is not meant; try a larger youngs_modulus, or check its "
        "unit, Pa",
        where, fault.value);
  }
  return fmt::format("{}: its state is no longer finite; try {}", where, words_on_shorter_step(simulation));
}

std::string words_on_fidelity(const FidelityReport &fidelity, double accepted_error) {
  const std::string deformable =
      fidelity.num_deformable > 0 ? fmt::format("; of the deformable blocks it would leave out up to {:.2g}",
                                                fidelity.worst_deformable)
                                  : "";
  return fmt::format(
      "fidelity: {} rigid and {} deformable blocks; rigid leaves out up to {:.2g} of the joints' "
      "compliance k_n L/(E + k_n L), accepted are {:g}{}",
      fidelity.num_rigid, fidelity.num_deformable, fidelity.worst_rigid, accepted_error, deformable);
}

namespace {

/// Pseudo-time has no limit in seconds, and each of its steps is looked at.
bool is_in_pseudo_time(const Simulation &simulation, const Stage &stage) {
  return stage.solver == Solver::statics && simulation.stage().iteration.is_left == 0;
}

/// How near to rest a stage is that waits for its verdict. Large models are looked at seldom.
std::string words_on_look(const Simulation &simulation, const Stage &stage) {
  if (!is_in_pseudo_time(simulation, stage) &&
      simulation.stage_step() < steps_between_verdicts(simulation.num_blocks())) {
    return "not looked at yet";
  }
  const StageLook &last = simulation.stage().memory.last;
  return fmt::format("unbalanced {:.1e}, {:.0e} at rest  moved {:.2g} of a block's size",
                     last.unbalanced_ratio, stage.tolerance, last.moved);
}

} // namespace

std::string words_on_progress(const Simulation &simulation, const EnergyRow &energy, double per_step) {
  const Stage &stage = simulation.stages()[static_cast<std::size_t>(simulation.stage().index)];
  const auto num_steps = static_cast<double>(simulation.plan().num_steps);
  const double share = static_cast<double>(simulation.stage_step()) / num_steps;
  constexpr std::size_t bar_length = 20;
  const auto filled = static_cast<std::size_t>(share * static_cast<double>(bar_length));
  const double remaining = per_step * (1.0 - share) * num_steps;
  const std::string limit =
      is_in_pseudo_time(simulation, stage) ? "" : fmt::format("limit in {:.0f} s  ", remaining);
  const std::string outlook = stage.until_verdict
                                  ? limit + words_on_look(simulation, stage)
                                  : fmt::format("remaining {:.0f} s  unbalanced {:.1e}  max speed {:.3g} m/s",
                                                remaining, energy.unbalanced_ratio, energy.max_speed);
  return fmt::format("[{:.<{}}] {:5.1f} %  t = {:.6g} s  step {}  {:.3g} block-steps/s  {}",
                     std::string(filled, '='), bar_length, 100.0 * share, simulation.time(),
                     simulation.step_count(), static_cast<double>(simulation.num_blocks()) / per_step,
                     outlook);
}

void tell_end(const Simulation &simulation, const std::filesystem::path &directory, RunSummary &summary) {
  const Stage &stage = simulation.stages()[static_cast<std::size_t>(simulation.stage().index)];
  const Verdict verdict = simulation.stage().verdict;
  if (simulation.fault()) {
    summary.verdict = "failed";
    summary.message = fault_message(simulation);
  } else if (!simulation.finished()) {
    summary.verdict = "stopped";
    summary.message = fmt::format("stopped by a signal at t = {:g} s", simulation.time());
    if (!directory.empty()) {
      summary.message += fmt::format(", go on with gcpdda restart {}", directory.string());
    }
  } else if (simulation.is_staged() && stage.until_verdict) {
    summary.verdict = word_of(verdict);
    summary.message = fmt::format("stage '{}' {} at t = {:g} s", stage.name,
                                  verdict == Verdict::undecided ? "reached its limit undecided"
                                  : verdict == Verdict::failed  ? "has failed"
                                                                : "has settled",
                                  simulation.time());
  } else {
    summary.verdict = "completed";
    summary.message = fmt::format("reached t = {:g} s", simulation.time());
  }
}

bool begins_statically(const Simulation &simulation) {
  return simulation.is_staged() && simulation.state().clock.stage().solver == Solver::statics;
}

std::string words_on_steps(const Simulation &simulation) {
  const TimePlan &plan = simulation.plan();
  return begins_statically(simulation)
             ? "for motion that takes over from the static solver"
             : fmt::format("{} steps of {:.6g} s in all", plan.num_steps, plan.duration);
}

// Blocks that stages have excavated are neither mobile nor fixed.
std::string words_on_blocks(const Simulation &simulation) {
  const Communicator &communicator = simulation.communicator();
  const auto owned = counts_by_rank(communicator, static_cast<std::int64_t>(simulation.blocks().num_owned));
  const auto work =
      counts_by_rank(communicator, static_cast<std::int64_t>(simulation.candidates().pairs.size()));
  const auto mobile = std::accumulate(owned.begin(), owned.end(), std::int64_t{0});
  return fmt::format(
      "gcpdda: {} rank{}, {} mobile and {} fixed blocks, {} to {} per rank, imbalance {:.3f} ({})",
      communicator.size(), communicator.size() == 1 ? "" : "s", mobile,
      simulation.num_blocks() - mobile - std::ssize(simulation.stage().removed),
      *std::min_element(owned.begin(), owned.end()), *std::max_element(owned.begin(), owned.end()),
      imbalance_of(work), simulation.partition().by_metis ? "METIS" : "space-filling curve");
}

std::string words_on_motion_bound(const Simulation &simulation) {
  const StepBound &bound = simulation.bound();
  return fmt::format(
      "at most {:.6g} s, set by block '{}': at its {:.6g} m/s it moves {:.4g} m in it, {:g} of "
      "a quarter of the narrowest block width",
      bound.time_step, block_name(simulation.scene(), bound.fastest.block), bound.fastest.speed,
      bound.time_step * bound.fastest.speed, StepBound::share_of_motion);
}

std::string words_on_time_step(const Simulation &simulation) {
  const StepBound &bound = simulation.bound();
  if (bound.is_set_by_motion()) {
    return fmt::format("step {:.6g} s, {}; recommended {}", simulation.plan().time_step,
                       words_on_steps(simulation), words_on_motion_bound(simulation));
  }
  return fmt::format("step {:.6g} s, {}; recommended at most {:.6g} s = safety {:g} x limit "
                     "{:.3f} / omega_max {:.6g} rad/s (contact stiffness over each block's boundary)",
                     simulation.plan().time_step, words_on_steps(simulation), bound.time_step, bound.safety,
                     bound.limit, bound.omega_max);
}

std::string words_on_law(const JointLaw &law) {
  return fmt::format(
      "joint '{}': normal stiffness {:.6g} Pa/m{}, tangential ratio {:g}, {}", law.name, law.normal_stiffness,
      law.allowed_overlap > 0.0
          ? fmt::format(" for an allowed overlap of {:g} block sizes", law.allowed_overlap)
      : law.rock_mass_modulus > 0.0
          ? fmt::format(" for a rock mass of {:g} Pa with joints every {:g} m in rock of {:g} Pa",
                        law.rock_mass_modulus, law.spacing, law.intact_modulus)
          : "",
      law.tangential_ratio, words_on_strength(law));
}

std::string words_on_strength(const JointLaw &law) {
  const double angle = std::atan(law.tan_friction) * 180.0 / std::acos(-1.0);
  return law.is_barton_bandis
             ? fmt::format("Barton-Bandis friction with jrc {:g}, jcs {:g} Pa and residual friction angle "
                           "{:g} deg, cohesion {:g} Pa",
                           law.roughness, law.strength, angle, law.cohesion)
             : fmt::format("friction angle {:g} deg, cohesion {:g} Pa", angle, law.cohesion);
}

std::string words_on_stage(const std::string &name, const StageResult &result) {
  if (result.verdict == Verdict::done) {
    return fmt::format("stage '{}' at t = {:.9g} s, {} blocks removed", name, result.time, result.removed);
  }
  return fmt::format("stage '{}' {} at t = {:.9g} s after {} steps: unbalanced {:.2e}, largest motion "
                     "{:.3g} of a block's size{}",
                     name, word_of(result.verdict), result.time, result.steps, result.unbalanced_ratio,
                     result.moved,
                     result.loose == 0 ? ""
                                       : fmt::format(", but for {} loose block{}", result.loose,
                                                     result.loose == 1 ? "" : "s"));
}

std::string words_on_slide(const std::string &stage, const std::string &block, const StageResult &result) {
  const std::string others = result.slid_blocks == 2  ? " and 1 other block"
                             : result.slid_blocks > 2 ? fmt::format(" and {} others", result.slid_blocks - 1)
                                                      : "";
  return fmt::format(
      "block '{}'{} slid in stage '{}' before rest, the farthest by {:.3g} m or {:.2g} of its size", block,
      others, stage, result.slide_distance, result.slide);
}

std::optional<Diagnostic> warning_of_slide(const Simulation &simulation, const Stage &stage,
                                           const StageResult &result) {
  if (!result.has_slid() || stage.is_trial()) { // of trials the search tells
    return std::nullopt;
  }
  return Diagnostic{
      Severity::warning, stage.where,
      words_on_slide(stage.name, block_name(simulation.scene(), result.slid_block), result),
      "the stage has settled where the blocks came to hold, and their strength may have failed where they "
      "were",
      fmt::format("look at the frames; failure_motion = {:.1g} of the stage takes such a slide for failure",
                  0.5 * result.slide)};
}

namespace {

std::string words_on_loads(const std::vector<BoltLoad> &loads) {
  const auto most = [&](double BoltLoad::*force) {
    return *std::max_element(loads.begin(), loads.end(),
                             [force](const BoltLoad &a, const BoltLoad &b) { return a.*force < b.*force; });
  };
  const auto count = [&](std::int64_t BoltHistoryRow::*what) {
    return std::count_if(loads.begin(), loads.end(),
                         [what](const BoltLoad &load) { return load.last.*what > 0; });
  };
  const BoltLoad axial = most(&BoltLoad::axial);
  const BoltLoad shear = most(&BoltLoad::shear);
  return fmt::format(
      "bolts: largest tension {:.4g} N in '{}', largest shear {:.4g} N in '{}'; of {} bolts {} "
      "yielded and {} broke",
      axial.axial, axial.last.name, shear.shear, shear.last.name, loads.size(),
      count(&BoltHistoryRow::yielded), count(&BoltHistoryRow::broken));
}

std::string words_on_loads(const std::vector<LinerLoad> &loads) {
  const auto most = [&](double LinerLoad::*force) {
    return *std::max_element(loads.begin(), loads.end(),
                             [force](const LinerLoad &a, const LinerLoad &b) { return a.*force < b.*force; });
  };
  const auto sum = [&](std::int64_t LinerHistoryRow::*what) {
    return std::accumulate(
        loads.begin(), loads.end(), std::int64_t{0},
        [what](std::int64_t so_far, const LinerLoad &load) { return so_far + load.last.*what; });
  };
  const LinerLoad thrust = most(&LinerLoad::compression);
  const LinerLoad moment = most(&LinerLoad::moment);
  const LinerLoad shear = most(&LinerLoad::shear);
  const LinerLoad tension = most(&LinerLoad::tension);
  return fmt::format(
      "liners: largest thrust {:.4g} N/m in '{}', largest moment {:.4g} N in '{}', largest shear "
      "{:.4g} N/m in '{}', largest tension {:.4g} N/m in '{}'; of {} elements {} cracked, {} yielded and {} "
      "broke",
      thrust.compression, thrust.last.name, moment.moment, moment.last.name, shear.shear, shear.last.name,
      tension.tension, tension.last.name, sum(&LinerHistoryRow::elements), sum(&LinerHistoryRow::cracked),
      sum(&LinerHistoryRow::yielded), sum(&LinerHistoryRow::broken));
}

/// Of bolts or liners, what is in place at the end; the rest bears nothing.
template <class Load> std::vector<Load> in_place(const std::vector<Load> &loads) {
  std::vector<Load> found;
  std::copy_if(loads.begin(), loads.end(), std::back_inserter(found),
               [](const Load &load) { return load.in_place; });
  return found;
}

/// The sentence on those in place, and how many have been taken away.
template <class Load> std::string words_on_place(const std::string &kind, const std::vector<Load> &loads) {
  const std::vector<Load> left = in_place(loads);
  const std::size_t away = loads.size() - left.size();
  const std::string words = left.empty() ? kind + ": none is in place" : words_on_loads(left);
  return away == 0 ? words
                   : fmt::format("{}; {} {} been taken away", words, away, away == 1 ? "has" : "have");
}

void warn_of_thrust(const LinerLoad &load, const Scene &scene, std::vector<std::string> &words) {
  constexpr double strong_concrete = 60e6; // Pa
  const auto support = std::find_if(scene.supports.begin(), scene.supports.end(),
                                    [&](const SupportType &type) { return type.name == load.support; });
  if (support == scene.supports.end() || support->compressive_strength < SupportType::unlimited ||
      load.compression <= strong_concrete * support->thickness) {
    return;
  }
  words.push_back(to_string(
      Diagnostic{Severity::warning,
                 {},
                 fmt::format("liner '{}' has borne a thrust of {:.3g} MPa over its thickness", load.last.name,
                             1e-6 * load.compression / support->thickness),
                 "shotcrete and concrete bear 10 to 60 MPa",
                 fmt::format("give support.{}.compressive_strength, or put it in later", load.support)}));
}

} // namespace

std::vector<std::string> words_on_support(const RunSummary &summary, const Scene &scene) {
  std::vector<std::string> words;
  for (const LinerLoad &load : summary.liners) {
    warn_of_thrust(load, scene, words);
  }
  if (!summary.bolts.empty()) {
    words.push_back(words_on_place("bolts", summary.bolts));
  }
  if (!summary.liners.empty()) {
    words.push_back(words_on_place("liners", summary.liners));
  }
  return words;
}

std::string words_on_bolts(const Simulation &simulation) {
  const StepBound &bound = simulation.bound();
  const std::vector<BoltLink> &links = simulation.bolts().links();
  const auto elements =
      std::count_if(links.begin(), links.end(), [](const BoltLink &link) { return link.liner >= 0; });
  const std::size_t bolts = simulation.scene().bolts.size();
  const std::size_t liners = simulation.scene().liners.size();
  std::string text;
  if (bolts > 0) {
    text = fmt::format("bolts: {} in the scene, springs in place: {}", bolts, std::ssize(links) - elements);
  }
  if (liners > 0) {
    text += fmt::format("{}liners: {} in the scene, elements in place: {}", text.empty() ? "" : "; ", liners,
                        elements);
  }
  return text + fmt::format("; omega_max {:.6g} rad/s with them, {:.6g} rad/s without", bound.omega_max,
                            bound.without_bolts);
}

} // namespace gcpdda
