#include "gcpdda/simulation/energy_ledger.hpp"

#include "gcpdda/base/exact_sum.hpp"

#include <algorithm>

namespace gcpdda {

namespace {

/// Terms summed over all blocks and pairs of all ranks.
struct Terms {
  ExactSum kinetic;
  ExactSum normal;
  ExactSum stick;
  ExactSum gravity;
  ExactSum shear_work;
  ExactSum damping_work;

  void agree(const Communicator &communicator) {
    for (ExactSum *sum : {&kinetic, &normal, &stick, &gravity, &shear_work, &damping_work}) {
      communicator.sum(sum->limbs());
    }
  }
};

double kinetic_energy(const BlockProperties &block, const RigidDof &velocity) {
  return 0.5 * (block.mass * dot(velocity.u, velocity.u) + block.inertia * velocity.r * velocity.r);
}

void add_normal(const Simulation &simulation, double share, ExactSum &sum) {
  const BlockSystem &blocks = simulation.blocks();
  for (const CandidatePair &pair : simulation.candidates().pairs) {
    const std::size_t a = pair.lower.value;
    const std::size_t b = pair.higher.value;
    if (simulation.counts_here(pair) && blocks.box[a].meets(blocks.box[b])) {
      sum.add(share * pair.half_stiffness * overlap_energy(view_of(blocks, a), view_of(blocks, b)));
    }
  }
}

enum class Moment { now, middle };

/// Energy of the stick springs; in the middle of two trial configurations F_n F_{n+1}/(2 k), the form that
/// the leapfrog conserves exactly. Slipping springs keep theirs.
void add_stick(const Simulation &simulation, Moment moment, ExactSum &sum) {
  const auto &pairs = simulation.candidates().pairs;
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const RegionMemory &memory = simulation.history().regions[k];
    if (memory.shear == 0.0 || !simulation.counts_here(pairs[k])) {
      continue;
    }
    const double stiffness = pairs[k].tangential_stiffness * memory.longest;
    double next = memory.shear;
    if (moment == Moment::middle && memory.state == ContactState::stick) {
      next += stiffness * coming_slide(simulation.blocks(), pairs[k], simulation.contacts().pairs()[k]);
    }
    sum.add(0.5 * memory.shear * next / stiffness);
  }
}

Terms initial_terms(const Simulation &simulation) {
  Terms terms;
  const BlockSystem &blocks = simulation.blocks();
  for (std::size_t row = 0; row < blocks.num_owned; ++row) {
    terms.kinetic.add(kinetic_energy(blocks.properties[row], blocks.velocity[row]));
  }
  add_normal(simulation, 1.0, terms.normal);
  add_stick(simulation, Moment::now, terms.stick);
  return terms;
}

Terms current_terms(Simulation &simulation) {
  Terms terms;
  const double time_step = simulation.plan().time_step;
  simulation.look_ahead([&](const BlockSystem &blocks) {
    for (std::size_t row = 0; row < blocks.num_owned; ++row) {
      const BlockProperties &block = blocks.properties[row];
      const BlockLedger &ledger = blocks.ledger[row];
      const RigidDof increment = blocks.trial[row] - blocks.trial_previous[row];
      terms.kinetic.add(kinetic_energy(block, (1.0 / time_step) * increment));
      terms.gravity.add(-(ledger.gravity_work + 0.5 * dot(ledger.gravity_force, increment.u)));
      terms.shear_work.add(ledger.shear_work + 0.5 * work(ledger.shear_force, increment));
      terms.damping_work.add(ledger.damping_work + 0.5 * work(ledger.damping_force, increment));
    }
    add_normal(simulation, 0.5, terms.normal);
    add_stick(simulation, Moment::middle, terms.stick);
  });
  add_normal(simulation, 0.5, terms.normal);
  return terms;
}

/// Largest net force over the largest force that acts anywhere; rows and pairs of the last evaluation.
double unbalanced_ratio(const Simulation &simulation) {
  const BlockSystem &blocks = simulation.blocks();
  std::array<double, 2> largest{};
  for (std::size_t row = 0; row < blocks.num_owned; ++row) {
    largest[0] = std::max(largest[0], norm(simulation.forces()[row].u));
    largest[1] = std::max(largest[1], blocks.properties[row].mass * norm(simulation.scene().run.gravity));
  }
  for (const PairForce &force : simulation.contacts().pairs()) {
    if (force.touching) {
      largest[1] = std::max(largest[1], norm(force.force));
    }
  }
  simulation.communicator().max(largest);
  return largest[1] > 0.0 ? largest[0] / largest[1] : 0.0;
}

double max_speed(const Simulation &simulation) {
  double fastest = 0.0;
  for (std::size_t row = 0; row < simulation.blocks().num_owned; ++row) {
    fastest = std::max(fastest, norm(simulation.blocks().velocity[row].u));
  }
  simulation.communicator().max(std::span(&fastest, 1));
  return fastest;
}

} // namespace

EnergyLedger::EnergyLedger(Simulation &simulation) {
  Terms terms = initial_terms(simulation);
  terms.agree(simulation.communicator());
  stick_at_start_ = terms.stick.value();
  total_at_start_ = terms.kinetic.value() + terms.normal.value() + terms.stick.value();
}

EnergyRow EnergyLedger::row(Simulation &simulation) const {
  EnergyRow row;
  row.unbalanced_ratio = unbalanced_ratio(simulation);
  row.max_speed = max_speed(simulation);
  Terms terms = simulation.step_count() == 0 ? initial_terms(simulation) : current_terms(simulation);
  terms.agree(simulation.communicator());
  row.kinetic = terms.kinetic.value();
  row.contact_normal = terms.normal.value();
  row.contact_stick = terms.stick.value();
  row.gravity = terms.gravity.value();
  row.friction_loss = stick_at_start_ - terms.stick.value() - terms.shear_work.value();
  row.damping_loss = -terms.damping_work.value();
  row.residual = row.kinetic + row.contact_normal + row.contact_stick + row.gravity + row.friction_loss +
                 row.damping_loss - total_at_start_;
  return row;
}

} // namespace gcpdda
