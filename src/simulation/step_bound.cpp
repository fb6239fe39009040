#include "simulation/step_bound.hpp"

#include "contact/laws/region_law.hpp"
#include "contact/stiffness_bound.hpp"
#include "dynamics/frequency_bound.hpp"
#include "dynamics/integrate.hpp"
#include "simulation/run_state.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>
#include <vector>

namespace gcpdda {

namespace {

double frequency_bound_of(const RunState &run, std::size_t row, std::span<const PointSpring> springs) {
  const StiffnessBound stiffness =
      stiffness_bound(run.scene.joints, run.blocks.properties[row].material, run.blocks.edge_joints(row));
  return contact_frequency_bound(run.blocks, row, stiffness.normal, stiffness.tangential,
                                 elasticity_of(run.scheme, run.scene.run.elasticity), springs);
}

/// kg/m3, of all mobile blocks. Collective.
double largest_density(const RunState &run) {
  double largest = 0.0;
  for (std::size_t row = 0; row < run.blocks.num_owned; ++row) {
    const BlockProperties &block = run.blocks.properties[row];
    largest = block.keeps_its_velocity() ? largest : std::max(largest, block.mass / block.area);
  }
  return run.communicator.max(largest);
}

/// Upper bound of M^-1 C, 1/s, for the dashpots c' = 2 xi sqrt(k_n m/L) of pairs over the whole boundary of
/// each block, with m = m_A m_B/(m_A + m_B) and L the root of the smaller area. Of two blocks
///     c (v_A - v_B)^2 <= c (1 + q) v_A^2 + c (1 + 1/q) v_B^2,   q^2 = m_A/m_B,
/// and c (1 + q)/m_A <= sqrt(2) c_A/m_A with c_A for m = m_A: sqrt(2) in place of the two that is the
/// neighbour's share of a spring (frequency_bound.hpp). m_A/L is at most sqrt(rho_A rho) L_A. Collective.
double dashpot_bound(const RunState &run) {
  constexpr double sqrt2 = std::numbers::sqrt2; // of 2 c', with half of the factor two of a spring's bound
  const double xi = run.scene.run.contact_damping;
  const double densest = largest_density(run);
  double rate = 0.0;
  for (std::size_t row = 0; row < run.blocks.num_owned && xi > 0.0; ++row) {
    const BlockProperties &block = run.blocks.properties[row];
    const StiffnessBound stiffness =
        stiffness_bound(run.scene.joints, block.material, run.blocks.edge_joints(row));
    const double mass_per_length = std::sqrt(block.mass * densest); // sqrt(rho_A rho) L_A
    rate = std::max(rate, contact_frequency_bound(
                              run.blocks, row, sqrt2 * xi * std::sqrt(stiffness.normal * mass_per_length),
                              sqrt2 * xi * std::sqrt(stiffness.tangential * mass_per_length)));
  }
  return run.communicator.max(rate);
}

/// Strong dashpots limit the step by the sum of all that a block may have. Blocks of jointed rock under
/// stress, xi from 0.1 to 1, come to rest up to 1.4 times this bound, and from 1.6 times on swing for ever
/// with several times the force that presses them. Collective.
/// @param rayleigh_ratio  of the fastest motion
void bound_by_all_dashpots(RunState &run, double rayleigh_ratio) {
  constexpr double within_onset = 1.25;
  if (run.bound.omega_max == 0.0) {
    return;
  }
  const double ratio = 0.5 * dashpot_bound(run) / run.bound.omega_max + rayleigh_ratio;
  const double local_damping = run.clock.stage().local_damping_or(run.scene.run.local_damping);
  const double limit = within_onset * stability_limit(run.scheme, ratio, local_damping);
  if (limit > 0.0 && run.bound.safety * run.bound.limit > limit) {
    run.bound.safety = 1.0;
    run.bound.limit = limit;
  }
}

/// Collective.
FastestBlock fastest_of_all(const Communicator &communicator, const std::vector<FastestBlock> &mine) {
  FastestBlock fastest;
  const auto see = [&](const FastestBlock &block) {
    if (block.speed > fastest.speed ||
        (block.speed == fastest.speed && block.block < fastest.block && block.block >= 0)) {
      fastest = block;
    }
  };
  for (const FastestBlock &block : mine) {
    see(block);
  }
  for (const std::vector<FastestBlock> &other : communicator.all_gather(std::vector{fastest})) {
    see(other.front());
  }
  return fastest;
}

/// Of points of a block, m/s.
double speed_of(const BlockSystem &blocks, std::size_t row) {
  constexpr double one_second = 1.0; // nothing accelerates it
  return motion_bound(blocks, row, one_second);
}

/// Blocks that are free may move as the scene says until a stage brings them to rest. The velocities at hand
/// would give restarts other steps. Collective.
FastestBlock fastest_of_stage(const RunState &run) {
  const Stage &stage = run.clock.stage();
  const auto before = std::span(run.clock.stages).first(static_cast<std::size_t>(run.clock.state.index));
  const bool came_to_rest =
      std::any_of(before.begin(), before.end(), [](const Stage &s) { return s.kind == StageKind::settle; });
  std::vector<FastestBlock> found;
  if (!came_to_rest) {
    found.push_back(run.fastest_given);
  }
  const double begin = run.clock.state.start_time;
  const double end = begin + stage.duration;
  for (std::size_t row = 0; row < run.blocks.num_owned; ++row) {
    const BlockProperties &block = run.blocks.properties[row];
    if (!block.keeps_its_velocity()) {
      continue;
    }
    const auto &prescribed = run.loads.prescribed;
    const auto motion = std::lower_bound(prescribed.begin(), prescribed.end(), block.id,
                                         [](const auto &entry, BlockId id) { return entry.first < id; });
    const bool follows_table = motion != prescribed.end() && motion->first == block.id;
    found.push_back(
        {follows_table ? motion->second.fastest(begin, end, block.radius) : speed_of(run.blocks, row),
         block.id.value});
  }
  return fastest_of_all(run.communicator, found);
}

/// A block that moves too far in a step ends the run. Collective.
void bound_by_motion(RunState &run) {
  run.bound.fastest = fastest_of_stage(run);
  run.bound.motion_step =
      num_blocks(run.scene) > 1 && run.bound.fastest.speed > 0.0
          ? StepBound::share_of_motion * most_motion_in_step(run) / run.bound.fastest.speed
          : std::numeric_limits<double>::infinity();
  run.bound.time_step = std::min(run.bound.stable_step, run.bound.motion_step);
}

} // namespace

FastestBlock fastest_at_start(const RunState &run) {
  std::vector<FastestBlock> found;
  for (std::size_t row = 0; row < run.blocks.num_owned; ++row) {
    const BlockProperties &block = run.blocks.properties[row];
    if (!block.keeps_its_velocity()) {
      found.push_back({speed_of(run.blocks, row), block.id.value});
    }
  }
  return fastest_of_all(run.communicator, found);
}

void find_bound(RunState &run) {
  double omega_squared = 0.0;
  double without_bolts = 0.0;
  std::int64_t limiting = std::numeric_limits<std::int64_t>::max();
  for (std::size_t row = 0; row < run.blocks.num_owned; ++row) {
    const std::span<const PointSpring> springs = run.bolts.springs_at(run.blocks.properties[row].id.value);
    const double own = frequency_bound_of(run, row, springs);
    without_bolts = std::max(without_bolts, springs.empty() ? own : frequency_bound_of(run, row, {}));
    if (own > omega_squared) {
      omega_squared = own;
      limiting = run.blocks.properties[row].id.value;
    }
  }
  const double mine = omega_squared;
  run.communicator.max(std::span(&omega_squared, 1));
  std::int64_t minus_id = mine == omega_squared && omega_squared > 0.0 ? -limiting : -num_blocks(run.scene);
  run.communicator.max(std::span(&minus_id, 1));
  run.bound.block = minus_id == -num_blocks(run.scene) ? -1 : -minus_id;
  // A single block has the bound that it would have among others: its fixed points and its elasticity need a
  // short step although no block can touch it. It swings under gravity at less than sqrt(rho g/k_n) of it.
  run.bound.omega_max = std::sqrt(omega_squared);
  run.bound.without_bolts =
      run.bolts.empty() ? run.bound.omega_max : std::sqrt(run.communicator.max(without_bolts));

  // In a system of blocks the fastest mode is damped more than one joint.
  const double modal_damping_factor = run.fidelity.num_deformable > 0 ? 2.4 : 1.4;
  const double joint_ratio = modal_damping_factor * run.scene.run.contact_damping;
  const double undamped_limit = stability_limit(run.scheme, joint_ratio);
  run.bound.damping_ratio =
      joint_ratio + 0.5 * run.scene.run.rayleigh.stiffness_damping * run.bound.omega_max;
  run.bound.limit = stability_limit(run.scheme, run.bound.damping_ratio);
  if (run.bound.limit <= 0.0) {
    run.bound.always_unstable = true;
    run.bound.limit = 2.0;
    run.notes.push_back(
        {Severity::warning,
         {},
         "contact forces taken where this scene takes them are unstable for every time step",
         fmt::format("the amplitude of a contact oscillation at W = 0.1 grows by {:.2g} a step",
                     amplification(run.scheme, 0.1, run.bound.damping_ratio) - 1.0),
         "use run.contact_time = \"leapfrog\" for results"});
  }
  // On the way to rest nothing needs to be accurate, only stable. Under scaled masses every block swings at
  // the bound, and a step as long keeps the pile awake. A safety below the default asks for a short step.
  constexpr double safety_to_settle = 0.9;
  const Stage &stage = run.clock.stage();
  const bool settles =
      stage.kind == StageKind::settle && !stage.mass_scaling && run.scene.run.safety >= RunSettings{}.safety;
  run.bound.safety = settles ? std::max(run.scene.run.safety, safety_to_settle) : run.scene.run.safety;
  const double local_damping = stage.local_damping_or(run.scene.run.local_damping);
  const double locally_damped = stability_limit(run.scheme, run.bound.damping_ratio, local_damping);
  const bool is_damped = stage.kind == StageKind::settle || local_damping > 0.0; // else as the scene asks
  const double undamped_share = undamped_limit / run.bound.limit;
  if (is_damped && locally_damped > 0.0 &&
      run.bound.safety * run.bound.limit > safety_to_settle * locally_damped) {
    run.bound.safety = safety_to_settle;
    run.bound.limit = locally_damped;
  }
  bound_by_all_dashpots(run, run.bound.damping_ratio - joint_ratio);
  run.bound.stable_step = run.bound.omega_max > 0.0 ? run.bound.safety * run.bound.limit / run.bound.omega_max
                                                    : std::numeric_limits<double>::infinity();
  run.bound.undamped_step = run.bound.stable_step * undamped_share;
  bound_by_motion(run);
}

void scale_masses(RunState &run) {
  const Stage &stage = run.clock.stage();
  if (!stage.mass_scaling || run.clock.state.ended) {
    return;
  }
  std::vector<double> squared(run.blocks.num_owned);
  double minus_slowest = -std::numeric_limits<double>::infinity();
  for (std::size_t row = 0; row < run.blocks.num_owned; ++row) {
    const StiffnessBound stiffness = stiffness_bound(run.scene.joints, run.blocks.properties[row].material);
    squared[row] = contact_frequency_bound(run.blocks, row, stiffness.normal, stiffness.tangential,
                                           elasticity_of(run.scheme, run.scene.run.elasticity),
                                           run.bolts.springs_at(run.blocks.properties[row].id.value));
    if (squared[row] > 0.0) {
      minus_slowest = std::max(minus_slowest, -squared[row]);
    }
  }
  run.communicator.max(std::span(&minus_slowest, 1));
  for (std::size_t row = 0; row < run.blocks.num_owned; ++row) {
    BlockProperties &block = run.blocks.properties[row];
    if (squared[row] > 0.0) {
      const double scaling = std::exp2(std::ceil(std::log2(squared[row] / -minus_slowest) - 1e-9));
      block.mass_scaling = scaling;
      block.mass *= scaling;
      block.inertia *= scaling;
      if (run.blocks.is_deformable(row)) {
        run.blocks.deformation_of(row).second_moment = scaling * run.blocks.deformation_of(row).second_moment;
      }
    }
  }
}

// On all ranks ghosts, too, and the dashpots of pairs, which a refresh would make of the new masses.
void unscale_masses(RunState &run) {
  if (!run.clock.stage().mass_scaling) {
    return;
  }
  for (std::size_t row = 0; row < run.blocks.num_rows(); ++row) {
    BlockProperties &block = run.blocks.properties[row];
    const double back = 1.0 / block.mass_scaling;
    block.mass *= back;
    block.inertia *= back;
    block.mass_scaling = 1.0;
    if (run.blocks.is_deformable(row)) {
      run.blocks.deformation_of(row).second_moment = back * run.blocks.deformation_of(row).second_moment;
    }
  }
  for (CandidatePair &pair : run.neighbours.candidates.pairs) {
    take_law(run.blocks, run.contacts.parameters(), pair.law, pair);
  }
}

} // namespace gcpdda
