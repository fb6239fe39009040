#include "simulation/energy_ledger.hpp"

#include "base/exact_sum.hpp"
#include "contact/block_view.hpp"
#include "contact/geometry/overlap_energy.hpp"
#include "contact/laws/bonds.hpp"
#include "contact/laws/region_law.hpp"
#include "contact/opened_regions.hpp"
#include "contact/pair_energies.hpp"
#include "dynamics/deformable.hpp"
#include "dynamics/half_works.hpp"
#include "simulation/step_rows.hpp"
#include "simulation/unbalanced.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>

namespace gcpdda {

namespace {

/// Terms summed over all blocks and pairs of all ranks.
struct Terms {
  ExactSum kinetic;
  ExactSum strain;
  ExactSum normal;
  ExactSum excess;
  ExactSum stick;
  ExactSum gravity;
  ExactSum shear_work;
  ExactSum damping_work;
  ExactSum load_work;
  LinkEnergies support;

  void agree(const Communicator &communicator) {
    for (ExactSum *sum : {&kinetic, &strain, &normal, &excess, &stick, &gravity, &shear_work, &damping_work,
                          &load_work, &support.stored, &support.dissipated}) {
      communicator.sum(sum->limbs());
    }
  }
};

/// Of a row that moves and deforms at these rates; a driven block has none to speak of.
double kinetic_energy(const BlockSystem &blocks, std::size_t row, const RigidDof &velocity,
                      const Mat2 &rate) {
  const BlockProperties &block = blocks.properties[row];
  if (block.keeps_its_velocity()) {
    return 0.0;
  }
  const double turning = blocks.is_deformable(row) ? kinetic_energy(blocks.deformation_of(row), rate)
                                                   : 0.5 * block.inertia * velocity.r * velocity.r;
  return 0.5 * block.mass * dot(velocity.u, velocity.u) + turning;
}

/// k_n/2 of a mixed pair: that of its regions in the ratio of their energies, which to first order is that of
/// int d^2 ds; of a region that nobody has evaluated yet that of the law it would be born with.
double mean_stiffness(const RunState &run, std::size_t number, const BlockView &first,
                      const BlockView &second) {
  const CandidatePair &pair = run.neighbours.candidates.pairs[number];
  const ContactParameters &parameters = run.contacts.parameters();
  const std::vector<RegionMemory> known = run.neighbours.history.of_pair(number);
  Overlap overlap;
  overlap.find(first, second, parameters.potential);
  double weights = 0.0;
  double weighted = 0.0;
  for (const Region &region : overlap.regions()) {
    std::int32_t law = law_of_region(run.blocks, parameters.joints, pair, overlap.pieces(), region);
    for (const RegionMemory &memory : known) {
      const bool same =
          memory.lower_stretch == region.faces.first && memory.higher_stretch == region.faces.second;
      law = same ? memory.law : law;
    }
    const double weight = energy_weight(overlap, region);
    weights += weight;
    weighted += weight * parameters.constants(law).half_stiffness;
  }
  return weights > 0.0 ? weighted / weights : parameters.constants(pair.law).half_stiffness;
}

/// Potential of the contact pressure of each candidate pair, J/m; zero where the pair counts on another rank.
std::vector<double> normal_energies(const RunState &run) {
  std::vector<double> found(run.neighbours.candidates.pairs.size(), 0.0);
  const BlockSystem &blocks = run.blocks;
  PairEnergies energies;
  std::array<TrialOutline, 2> outlines;
  std::span<const double> of_group;
  const ContactHistory &history = run.neighbours.history;
  const auto half_stiffness_of = [&](std::int32_t law) {
    return run.contacts.parameters().constants(law).half_stiffness;
  };
  for (std::size_t k = 0; k < run.neighbours.candidates.pairs.size(); ++k) {
    const CandidatePair &pair = run.neighbours.candidates.pairs[k];
    const std::size_t a = pair.lower.value;
    const std::size_t b = pair.higher.value;
    const bool is_opened = history.is_opened(k);
    const std::size_t place = k % PlainPair::pairs_in_group;
    if (place == 0) {
      of_group = energies.of_group(blocks, run.neighbours.candidates,
                                   static_cast<std::uint32_t>(k / PlainPair::pairs_in_group));
    }
    if (!counts_here(run.blocks, pair.lower) ||
        !(is_opened || blocks.motion[a].box.meets(blocks.motion[b].box))) {
      continue;
    }
    const double energy = of_group[place];
    const bool is_known = !std::isnan(energy) && !is_opened;
    const bool has_plain = history.has_plain(k); // one region
    const std::int32_t law = has_plain && pair.is_mixed ? history.plain[k].law : pair.law;
    const bool has_one_law = has_plain || !pair.is_mixed;
    if (is_known && (has_one_law || energy == 0.0)) {
      found[k] = half_stiffness_of(law) * energy;
      continue;
    }
    const BlockView first = view_of(blocks, a, outlines[0]);
    const BlockView second = view_of(blocks, b, outlines[1]);
    if (is_opened) {
      const double rest = pair.is_convex  ? 0.0
                          : pair.is_mixed ? mean_stiffness(run, k, first, second)
                                          : half_stiffness_of(pair.law);
      found[k] =
          opened_energy(blocks, pair, run.contacts.parameters(), history.of_pair(k), first, second, rest);
    } else {
      const double half_stiffness =
          has_one_law ? half_stiffness_of(law) : mean_stiffness(run, k, first, second);
      found[k] = half_stiffness * (is_known ? energy : overlap_energy(first, second));
    }
  }
  return found;
}

/// The mean of both configurations, and what it adds to the energy that the steps keep (EnergyRow::excess).
void add_normal(std::span<const double> before, std::span<const double> after, Terms &terms) {
  for (std::size_t k = 0; k < before.size(); ++k) {
    terms.normal.add(0.5 * before[k]);
    terms.normal.add(0.5 * after[k]);
    const double step = std::sqrt(std::max(0.0, after[k])) - std::sqrt(std::max(0.0, before[k]));
    terms.excess.add(0.5 * step * step);
  }
}

// Energy of the stick springs and of open bonds; in the middle of two trial configurations F_n F_{n+1}/(2 k),
// the form that the leapfrog conserves exactly. Slipping springs keep theirs.

struct Spring {
  double stiffness = 0.0; ///< k_t, N/m2
  double half_stiffness = 0.0;
};

Spring spring_of(const RunState &run, const CandidatePair &pair, const RegionState &memory) {
  const LawConstants constants = run.contacts.parameters().constants(memory.law >= 0 ? memory.law : pair.law);
  return {constants.tangential_stiffness * memory.longest, constants.half_stiffness};
}

/// visit(pair, memory) for all regions and bonds that count here.
template <class Visit> void for_memories(const RunState &run, Visit &&visit) {
  for (std::size_t k = 0; k < run.neighbours.candidates.pairs.size(); ++k) {
    const CandidatePair &pair = run.neighbours.candidates.pairs[k];
    if (counts_here(run.blocks, pair.lower)) {
      run.neighbours.history.for_pair(k, [&](const RegionMemory &memory) { visit(pair, memory); });
    }
  }
}

void add_stick(const RunState &run, ExactSum &sum) {
  for_memories(run, [&](const CandidatePair &pair, const RegionMemory &memory) {
    const Spring spring = spring_of(run, pair, memory);
    if (memory.is_bond()) {
      sum.add(2.0 * spring.half_stiffness * bond_energy(run.blocks, pair, memory, false));
    }
    if (memory.shear != 0.0) {
      sum.add(0.5 * memory.shear * memory.shear / spring.stiffness);
    }
  });
}

/// In the middle, while the coming configuration is looked at.
void add_bonds(const RunState &run, ExactSum &sum) {
  for_memories(run, [&](const CandidatePair &pair, const RegionMemory &bond) {
    if (!bond.is_bond()) {
      return;
    }
    const Spring spring = spring_of(run, pair, bond);
    sum.add(2.0 * spring.half_stiffness * bond_energy(run.blocks, pair, bond, true));
    if (bond.shear != 0.0) {
      const double slide = opening_of(run.blocks, pair, bond, Configuration::trial).slide;
      const double next =
          bond.shear + (bond.state == ContactState::slip ? 0.0 : spring.stiffness * (slide - bond.slip));
      sum.add(0.5 * bond.shear * next / spring.stiffness);
    }
  });
}

/// In the middle, of all but bonds.
void add_coming_stick(RunState &run, const ComingConfiguration &coming, ExactSum &sum) {
  run.digest.emplace().find(
      run.blocks, run.neighbours.candidates, run.neighbours.history, run.contacts,
      [&](std::uint32_t number, std::size_t k, const RegionForce &force) {
        const CandidatePair &pair = run.neighbours.candidates.pairs[number];
        const RegionState &memory = run.neighbours.history.state(number, k);
        if (force.bonded || memory.shear == 0.0 || !counts_here(run.blocks, pair.lower)) {
          return;
        }
        const Spring spring = spring_of(run, pair, memory);
        const double slide = memory.state == ContactState::slip
                                 ? 0.0
                                 : coming.slide(run.blocks, pair, force.grip, force.normal);
        sum.add(0.5 * memory.shear * (memory.shear + spring.stiffness * slide) / spring.stiffness);
      });
}

enum class Moment { now, middle };

/// Strain energy of owned rows. In the middle of two trial configurations that of the elastic force applied
/// at the first one and half its work on the way: with implicit elasticity the energy at F* itself says
/// nothing.
void add_strain(const BlockSystem &blocks, Moment moment, ExactSum &sum) {
  for (std::size_t row = 0; row < blocks.num_owned; ++row) {
    if (blocks.is_deformable(row)) {
      const Deformation &d = blocks.deformation_of(row);
      sum.add(moment == Moment::now
                  ? strain_energy(d, d.trial)
                  : applied_strain_energy(d) + 0.5 * contract(d.internal, blocks.gradient_increment(row)));
    }
  }
}

/// Mean rate of F between the last two trial configurations; zero for a rigid row.
Mat2 stretch_rate(const BlockSystem &blocks, std::size_t row, double time_step) {
  return blocks.is_deformable(row) ? (1.0 / time_step) * blocks.gradient_increment(row) : Mat2{};
}

Terms initial_terms(const RunState &run) {
  Terms terms;
  const BlockSystem &blocks = run.blocks;
  for (std::size_t row = 0; row < blocks.num_owned; ++row) {
    const bool deformable = blocks.is_deformable(row);
    terms.kinetic.add(kinetic_energy(blocks, row, blocks.velocity[row],
                                     deformable ? blocks.deformation_of(row).rate : Mat2{}));
  }
  add_strain(blocks, Moment::now, terms.strain);
  for (const double energy : normal_energies(run)) {
    terms.normal.add(energy);
  }
  add_stick(run, terms.stick);
  run.bolts.add_energies(1.0, terms.support);
  return terms;
}

Terms current_terms(RunState &run) {
  Terms terms;
  const double time_step = run.clock.plan.time_step;
  std::optional<ComingConfiguration> coming;
  std::vector<double> coming_normal;
  {
    const ComingTrial ahead(run);
    const BlockSystem &blocks = run.blocks;
    for (std::size_t row = 0; row < blocks.num_owned; ++row) {
      const BlockLedger &ledger = blocks.ledger[row];
      const HalfWorks half = half_works(blocks, row, applied_forces(blocks, row));
      const RigidDof increment = blocks.motion[row].increment();
      terms.kinetic.add(
          kinetic_energy(blocks, row, (1.0 / time_step) * increment, stretch_rate(blocks, row, time_step)));
      terms.gravity.add(-(ledger.gravity + half.gravity));
      terms.shear_work.add(ledger.shear + half.shear);
      terms.damping_work.add(ledger.damping + half.damping);
      terms.load_work.add(ledger.load + half.load + anchor_half_work(blocks, row));
    }
    add_strain(blocks, Moment::middle, terms.strain);
    coming_normal = normal_energies(run);
    add_bonds(run, terms.stick);
    run.bolts.add_energies_at(blocks, 0.5, terms.support);
    coming.emplace(blocks);
  }
  add_coming_stick(run, *coming, terms.stick);
  add_normal(normal_energies(run), coming_normal, terms);
  run.bolts.add_energies(0.5, terms.support);
  return terms;
}

/// Blocks that have just been set to rest are no longer damped: then that of their verdict. Collective.
double ratio_of_row(RunState &run) {
  const StageState &stage = run.clock.state;
  const bool has_ended =
      run.clock.is_staged && run.clock.stage().takes_steps() && std::ssize(stage.results) > stage.index;
  return has_ended ? stage.results.back().unbalanced_ratio : unbalanced_ratio(run);
}

double max_speed(const RunState &run) {
  double fastest = 0.0;
  for (std::size_t row = 0; row < run.blocks.num_owned; ++row) {
    fastest = std::max(fastest, norm(run.blocks.velocity[row].u));
  }
  run.communicator.max(std::span(&fastest, 1));
  return fastest;
}

} // namespace

EnergyLedger::EnergyLedger(RunState &run) : time_step_(run.clock.plan.time_step) {
  Terms terms = initial_terms(run);
  terms.agree(run.communicator);
  stick_at_start_ = terms.stick.value();
  total_at_start_ = terms.kinetic.value() + terms.strain.value() + terms.normal.value() +
                    terms.stick.value() + terms.support.stored.value();
}

EnergyRow EnergyLedger::row(RunState &run) const {
  EnergyRow row;
  row.unbalanced_ratio = ratio_of_row(run);
  row.max_speed = max_speed(run);
  Terms terms = run.clock.step_count == 0 ? initial_terms(run) : current_terms(run);
  terms.agree(run.communicator);
  row.kinetic = terms.kinetic.value();
  row.strain = terms.strain.value();
  row.contact_normal = terms.normal.value();
  row.excess = terms.excess.value();
  row.contact_stick = terms.stick.value();
  row.gravity = terms.gravity.value();
  row.friction_loss = stick_at_start_ - terms.stick.value() - terms.shear_work.value();
  row.damping_loss = -terms.damping_work.value();
  row.boundary_work = terms.load_work.value();
  row.support = terms.support.stored.value();
  row.support_loss = terms.support.dissipated.value();
  row.residual = row.kinetic + row.strain + row.contact_normal + row.contact_stick + row.gravity +
                 row.friction_loss + row.damping_loss + row.support + row.support_loss - row.boundary_work -
                 total_at_start_;
  if (!before_.empty()) {
    for (std::size_t k = 0; k < carried.size(); ++k) {
      row.*carried[k] += before_[k];
    }
  }
  return row;
}

void EnergyLedger::note_end(RunState &run) {
  const EnergyRow now = row(run);
  at_end_.clear();
  for (double EnergyRow::*sum : carried) {
    at_end_.push_back(now.*sum);
  }
}

// A coming step of another length would end at another time: the row is that of the step at the end.
void EnergyLedger::step_over(RunState &run) {
  const double coming = std::exchange(run.clock.plan.time_step, time_step_);
  const EnergyRow now = row(run);
  run.clock.plan.time_step = time_step_ = coming;
  before_.resize(carried.size());
  at_end_.resize(carried.size());
  for (std::size_t k = 0; k < carried.size(); ++k) {
    before_[k] += at_end_[k] - now.*carried[k];
  }
}

void EnergyLedger::tell(RunFacts &facts) const {
  facts.total_at_start = total_at_start_;
  facts.stick_at_start = stick_at_start_;
  facts.ledger = before_;
  facts.ledger.insert(facts.ledger.end(), at_end_.begin(), at_end_.end());
}

} // namespace gcpdda
