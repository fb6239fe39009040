#include "contact/contact_forces.hpp"

#include "contact/laws/region_law.hpp"
#include "contact/pair_motion.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace gcpdda {

namespace {

// TrialIncrement::turn between a trial configuration and the one before, in a form without cancellation.

/// Of a rigid block that rotated so far, rad.
Mat2 turn_of_rigid(double rotated) {
  SmallTurn turn = SmallTurn::of(rotated);
  if (std::abs(rotated) > SmallTurn::largest) {
    const double half = std::sin(0.5 * rotated);
    turn = {std::sin(rotated), 2.0 * half * half};
  }
  return {turn.versine, -turn.sine, turn.sine, turn.versine};
}

} // namespace

ContactForces::ContactForces(ContactParameters parameters, Instructions instructions)
    : parameters_(std::make_shared<const ContactParameters>(std::move(parameters))),
      plain_(parameters_, instructions), pairs_(parameters_) {}

void ContactForces::begin_rows(BlockSystem &system, std::size_t first, std::size_t last) {
  PlainBatch &batch = plain_.batch();
  resting_.begin_rows(system, first, last);
  velocity_gradients_.resize(system.deformation.size());
  sums_.clear(system, first, std::min(last, system.num_owned));
  const std::size_t width = batch.width();
  const auto in_lanes = [&](std::size_t row) { // did they?
    const std::size_t deformable = system.deformation_begin[row + width] - system.deformation_begin[row];
    if (deformable == width) {
      batch.find_deforming_motions(system, row, velocity_gradients_);
    }
    return deformable == width || (deformable == 0 && batch.find_motions(system, row));
  };
  for (std::size_t row = first; row < last; ++row) {
    while (row + width <= last && last <= system.first_fixed() && in_lanes(row)) {
      row += width;
    }
    if (row == last) {
      break;
    }
    const RigidDof &velocity = system.velocity[row];
    BlockMotion &motion = system.motion[row];
    motion.velocity = velocity.u;
    if (system.is_deformable(row)) {
      const std::size_t k = system.deformation_begin[row];
      velocity_gradients_[k] = system.deformation[k].rate * system.trial_inverse[k];
    } else {
      motion.spin = velocity.r;
      const Mat2 turn = turn_of_rigid(motion.rotated);
      motion.turn[0] = {turn.xx, turn.xy};
    }
  }
}

void ContactForces::evaluate_plain_pairs(const BlockSystem &system, const Candidates &candidates,
                                         ContactHistory &history, std::size_t first, std::size_t last) {
  const PlainWork work{plain_.scene_of(system, candidates, history, velocity_gradients_, false), sums_,
                       resting_, history.plain, history.grips};
  for (const std::uint32_t entry : plain_.evaluate(work, first, last)) {
    evaluate_choice(work, entry);
  }
}

// One region at most.
void ContactForces::evaluate_choice(const PlainWork &work, std::uint32_t entry) {
  const Candidates &candidates = work.scene.candidates;
  const std::uint32_t number = candidates.plain[entry].pair;
  std::array<RegionMemory, 1> known;
  std::size_t count = 0;
  work.scene.history.for_pair(number, [&](const RegionMemory &memory) { known.at(count++) = memory; });
  if (pairs_.evaluate(work.scene.system, candidates.pairs[number], number, std::span(known).first(count)) >
      0) {
    plain_.store_choice(work, entry, pairs_.regions(pairs_.first_of_pair(), 1).front(),
                        pairs_.memory().back(), pairs_.dyads());
    pairs_.drop_last();
  }
}

void ContactForces::evaluate_general_pair(const BlockSystem &system, const Candidates &candidates,
                                          std::uint32_t number, std::span<RegionMemory> old) {
  const auto first_known = static_cast<std::uint32_t>(pairs_.memory().size());
  const auto count =
      static_cast<std::uint32_t>(pairs_.evaluate(system, candidates.pairs[number], number, old));
  const auto begin = static_cast<std::uint32_t>(pairs_.first_of_pair());
  ranges_[number] = {begin, count};
  next_[number] = {first_known, count};
  if (count > 0) {
    const std::span<const RegionDyads> dyads = pairs_.dyads();
    sums_.keep(number, pairs_.regions(begin, count), dyads.first(std::min<std::size_t>(count, dyads.size())));
  }
}

void ContactForces::evaluate_general_pairs(const BlockSystem &system, const Candidates &candidates,
                                           ContactHistory &history, std::span<const std::uint32_t> pairs) {
  for (const std::uint32_t k : pairs) {
    const CandidatePair &pair = candidates.pairs[k];
    const std::span<const RegionMemory> known = history.of_other(k);
    const bool chooses = std::ranges::any_of(
        known, [&](const RegionMemory &m) { return !m.is_bond() && chooses_law(pair, m); });
    if (resting_.has(pair.lower.value) && resting_.has(pair.higher.value) && !history.is_opened(k) &&
        !chooses) {
      keep_general_pair(system, candidates, k, history.of_other(k));
    } else if (system.motion[pair.lower.value].box.meets(system.motion[pair.higher.value].box) ||
               history.has_bonds(k) || history.is_opened(k)) {
      ++evaluations_;
      evaluate_general_pair(system, candidates, k, history.of_other(k));
    }
  }
}

void ContactForces::keep_general_pair(const BlockSystem &system, const Candidates &candidates,
                                      std::uint32_t number, std::span<const RegionMemory> old) {
  const RegionRange before = ranges_before_[number];
  if (before.count > 0) {
    ranges_[number] = {static_cast<std::uint32_t>(pairs_.memory().size()), before.count};
    next_[number] = ranges_[number];
    pairs_.keep_again(system, candidates.pairs[number], before, old);
    ranges_[number].begin = static_cast<std::uint32_t>(pairs_.first_of_pair());
    sums_.keep_again_other(number);
  }
}

ForceReport ContactForces::evaluate(BlockSystem &system, const Candidates &candidates,
                                    ContactHistory &history) {
  begin(system, candidates);
  begin_rows(system, 0, system.num_owned);
  for (const PairGroup &group : candidates.groups) {
    evaluate_group(system, candidates, history, group);
  }
  return evaluate_border(system, candidates, history);
}

void ContactForces::begin(BlockSystem &system, const Candidates &candidates) {
  begin_rows(system, system.first_fixed(), system.num_rows());
  plain_.begin(candidates);
  pairs_.begin(resting_.is_used());
  evaluations_ = 0;
  next_.assign(candidates.general.empty() ? 0 : candidates.pairs.size(), {});
  if (resting_.is_used()) {
    ranges_before_ = ranges_;
    groups_.begin(candidates);
  }
  ranges_.resize(next_.size());
  for (const std::uint32_t pair : candidates.general) {
    ranges_[pair] = {};
  }
  sums_.start(system, candidates, resting_.is_used());
}

void ContactForces::evaluate_group(const BlockSystem &system, const Candidates &candidates,
                                   ContactHistory &history, const PairGroup &group) {
  if (group.first < group.last) {
    if (!resting_.is_used()) {
      evaluate_plain_pairs(system, candidates, history, group.first, group.last);
    } else if (const auto &kept = groups_.rests(group.number, resting_)) {
      plain_.keep_group(history, group.number, *kept);
    } else {
      evaluate_plain_pairs(system, candidates, history, group.first, group.last);
      groups_.note(group.number, plain_.kept());
    }
    sums_.close_group(system, candidates, group.number, plain_.batch());
  }
  if (group.is_last) {
    evaluate_general_pairs(system, candidates, history,
                           std::span(candidates.general).first(candidates.num_interior_general));
  }
}

ForceReport ContactForces::evaluate_border(BlockSystem &system, const Candidates &candidates,
                                           ContactHistory &history) {
  begin_rows(system, system.num_owned, system.first_fixed());
  const std::size_t num_plain = candidates.plain.size();
  sums_.begin_border(num_plain - candidates.num_interior_plain);
  for (std::size_t first = candidates.num_interior_plain; first < num_plain;
       first += PlainPair::pairs_in_group) {
    evaluate_plain_pairs(system, candidates, history, first,
                         std::min<std::size_t>(num_plain, first + PlainPair::pairs_in_group));
  }
  evaluate_general_pairs(system, candidates, history,
                         std::span(candidates.general).subspan(candidates.num_interior_general));
  ForceReport report = plain_.finish(history.overlaps);
  report.add(pairs_.report());
  report.evaluations += evaluations_;
  std::swap(history.ranges, next_);
  std::swap(history.regions, pairs_.memory());
  return report;
}

void ContactForces::find_details(const BlockSystem &system, const Candidates &candidates,
                                 const ContactHistory &history, std::uint32_t first, std::uint32_t last) {
  plain_.find_details({plain_.scene_of(system, candidates, history, velocity_gradients_, true),
                       sums_,
                       resting_,
                       {},
                       {},
                       is_changing_},
                      first, last);
}

std::span<RegionForce> ContactForces::at_hand(const Candidates &candidates, std::uint32_t pair) {
  return candidates.pairs[pair].is_plain ? plain_.at_hand(pair)
                                         : pairs_.regions(ranges_[pair].begin, ranges_[pair].count);
}

RegionDyads *ContactForces::dyads_at_hand(const BlockSystem &system, const Candidates &candidates,
                                          std::uint32_t pair, std::size_t number) {
  if (system.deformation.empty()) {
    return nullptr;
  }
  return candidates.pairs[pair].is_plain ? &sums_.dyads(pair) : sums_.kept_dyads(pair, number);
}

void ContactForces::put_sums(const Candidates &candidates, std::uint32_t pair, std::size_t number,
                             const RegionForce &force) {
  (candidates.pairs[pair].is_plain ? sums_.open(pair, force.born) : sums_.kept(pair, number)) = force;
}

ContactForces::ShearToSet::ShearToSet(const BlockSystem &system, const CandidatePair &of, RegionForce &force_,
                                      RegionDyads *dyads, RegionState &state)
    : pair(of), force(force_), memory(state), tangent(perp(force_.normal)),
      arm_lower(force_.grip - system.motion[of.lower.value].centroid),
      arm_higher(force_.grip - system.motion[of.higher.value].centroid), changing_(force_), dyads_(dyads) {}

void ContactForces::ShearToSet::set(double shear) {
  RegionForce &f = changing_;
  const auto add_torques = [&](PairTorques &torque, Vec2 added) {
    torque[0] += cross(arm_lower, added);
    torque[1] -= cross(arm_higher, added);
  };
  const Vec2 change = (f.shear - shear) * tangent;
  add_force(f, f.grip, change);
  add_torques(f.torque, change);
  const Vec2 drag = (f.shear + dot(f.shear_force, tangent)) * tangent;
  f.damping_force += drag;
  add_torques(f.damping_torque, drag);
  const Vec2 elastic = -shear * tangent;
  if (dyads_ != nullptr) {
    dyads_->force += outer(arm_lower, change);
    dyads_->damping += outer(arm_lower, drag);
    dyads_->shear =
        f.bonded ? dyads_->shear + outer(arm_lower, elastic - f.shear_force) : outer(arm_lower, elastic);
  }
  f.shear = shear;
  f.shear_force = elastic;
  f.shear_torque = {};
  add_torques(f.shear_torque, elastic);
  memory.shear = shear;
}

ComingConfiguration::ComingConfiguration(const BlockSystem &system) {
  steps_.reserve(system.num_rows());
  for (std::size_t row = 0; row < system.num_rows(); ++row) {
    steps_.push_back(system.motion[row].increment());
  }
  turns_.resize(system.deformation.size());
  for (std::size_t row = 0; row < system.num_rows(); ++row) {
    if (system.is_deformable(row)) {
      turns_[system.deformation_begin[row]] = system.increment_of(row).turn;
    }
  }
}

double ComingConfiguration::slide(const BlockSystem &system, const CandidatePair &pair, Vec2 point,
                                  Vec2 normal) const {
  const auto increment_of = [&](BlockIndex index) {
    const std::size_t row = index.value;
    const RigidDof &step = steps_[row];
    const Mat2 turn =
        system.is_deformable(row) ? turns_[system.deformation_begin[row]] : turn_of_rigid(step.r);
    return increment_at({step.u, turn}, point - (system.motion[row].centroid + step.u));
  };
  return dot(increment_of(pair.lower) - increment_of(pair.higher), perp(normal));
}

} // namespace gcpdda
