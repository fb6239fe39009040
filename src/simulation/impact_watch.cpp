#include "simulation/impact_watch.hpp"

#include "base/exact_sum.hpp"
#include "base/round_numbers.hpp"
#include "io/results/id_slabs.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <utility>

namespace gcpdda {

namespace {

/// Impacts with less than this share of the largest kinetic energy of the run up to the end of their stage
/// are not reported.
constexpr double dust = 1e-3;
/// Nor of those with less than this share of the stored energy: blocks at rest still tremble by about 1e-3 of
/// what their joints have closed by, and a trembling contact is no impact.
constexpr double trembling = 1e-6;
/// A row is sharp if its residual is known to this share of the energies at hand.
constexpr double sharp = 0.1 * ImpactWatch::worth_telling;
constexpr int most_waits = 20; ///< for a sharp row, where impacts follow each other without a pause
constexpr double rounding_of_residual = 1e-11; ///< its error, as a share of the terms in it
/// Positions are known to this share of their distance from the origin.
constexpr double rounding_of_position = 10.0 * std::numeric_limits<double>::epsilon();

/// A block that has changed its rank between two looks, as either of the ranks knows it.
struct Migrant {
  std::int64_t id = 0;
  RigidDof velocity;
  double mass = 0.0; ///< zero from the rank it has left
  double inertia = 0.0;
};

double turned_energy(double mass, double inertia, const RigidDof &before, const RigidDof &after) {
  const RigidDof change = after - before;
  return 0.125 * (mass * dot(change.u, change.u) + inertia * change.r * change.r);
}

double size_of_terms(const EnergyRow &row) {
  return row.kinetic + row.strain + row.contact_normal + row.contact_stick + std::abs(row.gravity) +
         std::abs(row.friction_loss) + std::abs(row.damping_loss) + std::abs(row.boundary_work) +
         row.support + std::abs(row.support_loss);
}

/// Energy of the motion that round-off of positions causes: forces from it make blocks swing by that much.
/// Where nothing acts this motion is all there is. Collective.
double energy_of_rounding(const Simulation &simulation) {
  const BlockSystem &blocks = simulation.blocks();
  ExactSum energy;
  for (std::size_t row = 0; row < blocks.num_owned; ++row) {
    const BlockProperties &block = blocks.properties[row];
    if (!block.keeps_its_velocity()) {
      const double farthest = norm(blocks.centroid(row)) + block.radius;
      const double speed = rounding_of_position * farthest * simulation.bound().omega_max;
      energy.add(0.5 * block.mass * speed * speed);
    }
  }
  simulation.communicator().sum(energy.limbs());
  return energy.value();
}

} // namespace

// The row at t = 0 is not in the middle of two configurations; on the way to rest speeds and their energies
// are not physical. Contact forces by the linear potential have no energy that a ledger could hold.
bool ImpactWatch::sees(const Simulation &simulation) {
  const Stage &stage = simulation.stages()[static_cast<std::size_t>(simulation.stage().index)];
  return simulation.step_count() > 0 && stage.kind != StageKind::settle &&
         simulation.scene().run.potential == PotentialKind::exact;
}

// Those that have changed ranks meet at the rank whose slab has their id.
double ImpactWatch::turned_since_last_look(const Simulation &simulation) const {
  const BlockSystem &blocks = simulation.blocks();
  const Communicator &world = simulation.communicator();
  ExactSum energy;
  std::vector<std::vector<Migrant>> migrants(static_cast<std::size_t>(world.size()));
  const auto send = [&](const Migrant &migrant) {
    migrants[static_cast<std::size_t>(slab_owner(simulation.num_blocks(), world.size(), migrant.id))]
        .push_back(migrant);
  };
  auto before = seen_.begin();
  const auto send_those_below = [&](std::int64_t id) {
    for (; before != seen_.end() && before->id.value < id; ++before) {
      send({before->id.value, before->velocity, 0.0, 0.0});
    }
  };
  for (std::size_t row = 0; row < blocks.num_owned; ++row) {
    const BlockProperties &block = blocks.properties[row];
    if (block.keeps_its_velocity()) {
      continue;
    }
    send_those_below(block.id.value);
    if (before != seen_.end() && before->id == block.id) {
      energy.add(turned_energy(block.mass, block.inertia, before->velocity, blocks.velocity[row]));
      ++before;
    } else {
      send({block.id.value, blocks.velocity[row], block.mass, block.inertia});
    }
  }
  send_those_below(simulation.num_blocks());
  std::vector<Migrant> met;
  for (const std::vector<Migrant> &from_rank : world.all_to_all(std::move(migrants))) {
    met.insert(met.end(), from_rank.begin(), from_rank.end());
  }
  std::sort(met.begin(), met.end(), [](const Migrant &a, const Migrant &b) {
    return std::pair(a.id, a.mass) < std::pair(b.id, b.mass);
  });
  for (std::size_t k = 0; k + 1 < met.size(); ++k) {
    if (met[k].id == met[k + 1].id) {
      energy.add(turned_energy(met[k + 1].mass, met[k + 1].inertia, met[k].velocity, met[k + 1].velocity));
    }
  }
  world.sum(energy.limbs());
  return energy.value();
}

/// Since the reference, on any rank. Collective.
bool ImpactWatch::nothing_has_touched(const Simulation &simulation) const {
  const bool has_touched = simulation.counters().contact_steps > contact_steps_;
  return simulation.communicator().max(has_touched ? 1.0 : 0.0) == 0.0;
}

void ImpactWatch::note(const Simulation &simulation, const EnergyRow &row) {
  const BlockSystem &blocks = simulation.blocks();
  damping_loss_ = row.damping_loss;
  seen_.clear();
  for (std::size_t k = 0; k < blocks.num_owned; ++k) {
    if (!blocks.properties[k].keeps_its_velocity()) {
      seen_.push_back({blocks.properties[k].id, blocks.velocity[k]});
    }
  }
}

void ImpactWatch::begin_at(const Simulation &simulation, Residual residual) {
  has_reference_ = true;
  is_suspected_ = false;
  waits_ = 0;
  root_ = 0.0;
  damped_ = 0.0;
  time_ = simulation.time();
  contact_steps_ = simulation.counters().contact_steps;
  residual_ = residual;
}

void ImpactWatch::keep(const ImpactGain &found) {
  constexpr double larger = 2.0; // so that no more are kept than the logarithm of 1/dust
  if (findings_.empty() || found.energy > larger * findings_.back().energy) {
    findings_.push_back(found);
  }
}

void ImpactWatch::drop_dust() {
  const auto first = std::find_if(findings_.begin(), findings_.end(), [&](const ImpactGain &finding) {
    return finding.energy > dust * most_kinetic_;
  });
  findings_.erase(findings_.begin(), first);
}

std::optional<ImpactGain> ImpactWatch::conclude() {
  drop_dust();
  if (has_told_ || findings_.empty()) {
    return std::nullopt;
  }
  has_told_ = true;
  seen_ = {};
  return findings_.front();
}

void ImpactWatch::look(const Simulation &simulation, const EnergyRow &row) {
  if (has_told_ || !sees(simulation)) {
    return;
  }
  most_kinetic_ = std::max(most_kinetic_, row.kinetic);
  drop_dust();
  const double per_step = simulation.plan().time_step * simulation.bound().omega_max;
  const double most_excess = std::min(row.contact_normal, 0.5 * per_step * per_step * row.kinetic);
  const Residual now{row.residual - std::max(row.excess, most_excess), row.residual - row.excess};
  if (!has_reference_ || nothing_has_touched(simulation)) {
    note(simulation, row);
    begin_at(simulation, now);
    return;
  }
  root_ += std::sqrt(turned_since_last_look(simulation));
  damped_ += std::max(0.0, row.damping_loss - damping_loss_);
  const double energy = root_ * root_ + damped_;
  note(simulation, row);
  const bool is_sharp = now.high - now.low <= sharp * (row.kinetic + energy);
  if (!is_sharp && ++waits_ <= most_waits) {
    return; // impacts are under way
  }
  const double gain = std::max(0.0, now.low - residual_.high);
  const double loss = std::max(0.0, residual_.low - now.high);
  const ImpactGain found{time_, simulation.time(), gain - loss, energy};
  const double least = std::max(worth_telling * energy, rounding_of_residual * size_of_terms(row));
  const double stored = row.strain + row.contact_normal + row.contact_stick;
  if (std::abs(found.gained) <= least || energy <= std::max(dust * most_kinetic_, trembling * stored) ||
      energy <= energy_of_rounding(simulation)) {
    begin_at(simulation, now);
    return;
  }
  const bool is_last = simulation.stage_step() == simulation.plan().num_steps;
  if (!std::exchange(is_suspected_, true) && !is_last) {
    return;
  }
  keep(found);
  begin_at(simulation, now);
}

// The change falls with the square of the step. By chance it may have been small for its step: half of what
// is allowed is aimed at, and no more than the step at which a square on a floor without friction stays below
// it whatever the chance (W_max^2 = 4 W^2 there, so W_max = 0.4 gives W^2/4 = 0.01).
Diagnostic warning_of(const Simulation &simulation, const ImpactGain &gain) {
  const double share = std::abs(gain.gained) / gain.energy;
  const double time_step = simulation.plan().time_step;
  const StepBound &bound = simulation.bound();
  const double longest = std::min(time_step * std::sqrt(0.5 * ImpactWatch::worth_telling / share),
                                  bound.omega_max > 0.0 ? 0.4 / bound.omega_max : time_step);
  const bool in_seconds = simulation.scene().run.time_step > 0.0 || bound.omega_max == 0.0;
  const std::string hint = in_seconds
                               ? fmt::format("use run.time_step = {:.2g} or less", two_digits_below(longest))
                               : fmt::format("use run.safety = {:.2g} or less",
                                             two_digits_below(longest * bound.omega_max / bound.limit));
  return {
      Severity::warning,
      {},
      fmt::format("impacts between t = {:.6g} and {:.6g} s {} {:.3g} J/m, {:.2g} % of their energy of {:.3g} "
                  "J/m, by the time step alone",
                  gain.begin, gain.end, gain.gained > 0.0 ? "gained" : "lost", std::abs(gain.gained),
                  100.0 * share, gain.energy),
      "contacts close and open within a step, and the error falls with its square",
      hint};
}

} // namespace gcpdda
