#include "gcpdda/contact/contact_forces.hpp"

#include "bond_work.hpp"
#include "pair_motion.hpp"
#include "plain_batch.hpp"

#include "gcpdda/base/prefetch.hpp"
#include "gcpdda/contact/region_law.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace gcpdda {

namespace {

/// Pairs between asking for what a pair alone has and using it; more than a batch, less than fills a cache.
constexpr std::size_t ahead = 12;

void fetch_pair(const Candidates &candidates, const ContactHistory &history, std::uint32_t pair) {
  prefetch(&candidates.pairs[pair], sizeof(CandidatePair));
  prefetch(history.regions.data() + history.ranges[pair].begin, sizeof(RegionMemory));
}

/// How a trial configuration moved since the one before, in a form without cancellation.
TrialIncrement trial_increment(const BlockSystem &system, std::size_t row) {
  const RigidDof step = system.trial[row] - system.trial_previous[row];
  if (system.is_deformable(row)) {
    const Deformation &d = system.deformation_of(row);
    return {step.u, (d.trial - d.trial_previous) * system.trial_inverse[system.deformation_begin[row]]};
  }
  SmallTurn turn = SmallTurn::of(step.r);
  if (std::abs(step.r) > SmallTurn::largest) {
    const double half = std::sin(0.5 * step.r);
    turn = {std::sin(step.r), 2.0 * half * half};
  }
  return {step.u, {turn.versine, -turn.sine, turn.sine, turn.versine}};
}

} // namespace

ContactForces::ContactForces(ContactParameters parameters, Instructions instructions)
    : parameters_(std::move(parameters)), batch_(make_plain_batch(instructions)) {}
ContactForces::~ContactForces() = default;
ContactForces::ContactForces(ContactForces &&) noexcept = default;
ContactForces &ContactForces::operator=(ContactForces &&) noexcept = default;

void ContactForces::set_shear(std::size_t region, double shear, Vec2 lower_arm, Vec2 higher_arm) {
  RegionForce &force = forces_[region];
  const Vec2 tangent = perp(force.normal);
  const auto add_torques = [&](PairTorques &torque, Vec2 f) {
    torque[0] += cross(lower_arm, f);
    torque[1] -= cross(higher_arm, f);
  };
  const Vec2 change = (force.shear - shear) * tangent;
  add_force(force, force.point, change);
  add_torques(force.torque, change);
  const Vec2 drag = (force.shear + dot(force.shear_force, tangent)) * tangent;
  force.damping_force += drag;
  add_torques(force.damping_torque, drag);
  if (region < damping_dyads_.size()) {
    damping_dyads_[region] += outer(force.point - force.origin, drag);
  }
  force.shear = shear;
  force.shear_force = -shear * tangent;
  force.shear_torque = {};
  add_torques(force.shear_torque, force.shear_force);
}

void ContactForces::find_increments(const BlockSystem &system, std::size_t first, std::size_t last) {
  for (std::size_t row = first; row < last; ++row) {
    increments_[row] = trial_increment(system, row);
    if (system.is_deformable(row)) {
      const std::size_t k = system.deformation_begin[row];
      const Mat2 &to_reference = system.trial_inverse[k];
      deforming_[k] = {determinant(to_reference) * transposed(to_reference),
                       system.deformation[k].rate * to_reference};
    }
  }
}

RegionForce &ContactForces::append_force(const RegionForce &force) {
  make_room_for(1);
  return forces_[num_forces_++] = force;
}

/// Up to as many entries of Candidates::plain as there are lanes.
void ContactForces::evaluate_alike(const BlockSystem &system, const Candidates &candidates,
                                   const ContactHistory &history, std::span<const std::uint32_t> entries) {
  static_assert(std::tuple_size_v<decltype(own_)> == PlainBatch::most_lanes);
  std::array<const CandidatePair *, PlainBatch::most_lanes> constants;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const PlainPair &plain = candidates.plain[entries[i]];
    constants[i] = &candidates.pairs[plain.pair];
    if (plain.is_mixed && history.ranges[plain.pair].count > 0) {
      own_[i] = constants_of(system, parameters_, *constants[i], history.of_pair(plain.pair).front().law);
      constants[i] = &own_[i];
    }
  }
  const PlainScene scene{system,
                         candidates,
                         history,
                         increments_,
                         deforming_,
                         parameters_.damping_ratio,
                         parameters_.stiffness_damping};
  const unsigned touching = batch_->evaluate(scene, entries, std::span(constants).first(entries.size()));
  if (touching == 0) {
    return;
  }
  PlainBatch::Results results;
  make_room_for(entries.size());
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const PlainPair &plain = candidates.plain[entries[i]];
    if ((touching >> i & 1U) == 0) {
      continue;
    }
    const bool is_born = history.ranges[plain.pair].count == 0;
    if (is_born && plain.is_mixed) {
      births_.push_back(plain.pair);
      continue;
    }
    ranges_[plain.pair] = {static_cast<std::uint32_t>(num_forces_), 1};
    RegionForce &force = forces_[num_forces_++];
    force.pair = plain.pair;
    force.born = is_born;
    force.bonded = false;
    results.force[i] = &force;
  }
  next_.regions.resize(num_forces_);
  for (std::size_t i = 0; i < entries.size(); ++i) {
    if (results.force[i] != nullptr) {
      RegionMemory &memory = next_.regions[static_cast<std::size_t>(results.force[i] - forces_.data())];
      memory.law = candidates.plain[entries[i]].is_mixed ? constants[i]->law : memory.law;
      results.memory[i] = &memory;
    }
  }
  batch_->store(results);
  for (std::size_t i = 0; i < entries.size(); ++i) {
    if (results.force[i] == nullptr) {
      continue;
    }
    const PlainPair &plain = candidates.plain[entries[i]];
    if (plain.is_deformable) {
      damping_dyads_.resize(static_cast<std::size_t>(results.force[i] - forces_.data()) + 1);
      damping_dyads_.back() = batch_->damping_dyad(i);
    }
    note(system, candidates.pairs[plain.pair], *results.force[i]);
  }
}

void ContactForces::evaluate_plain_pairs(const BlockSystem &system, const Candidates &candidates,
                                         ContactHistory &history, std::size_t first, std::size_t last) {
  const std::vector<PlainPair> &plain = candidates.plain;
  meeting_.resize(last - first);
  std::size_t num_meeting = 0;
  for (std::size_t k = first; k < last; ++k) {
    meeting_[num_meeting] = static_cast<std::uint32_t>(k);
    num_meeting += system.box[plain[k].lower.value].meets(system.box[plain[k].higher.value]) ? 1 : 0;
  }
  report_.evaluations += static_cast<std::int64_t>(num_meeting);
  const auto alike = [&](std::size_t a, std::size_t b) {
    return plain[meeting_[a]].is_like(plain[meeting_[b]]);
  };
  births_.clear();
  const std::size_t width = batch_->width();
  for (std::size_t begin = 0, end = 0; begin < num_meeting; begin = end) {
    for (std::size_t k = begin + ahead; k < std::min(num_meeting, begin + ahead + width); ++k) {
      fetch_pair(candidates, history, plain[meeting_[k]].pair);
    }
    end = begin + 1;
    while (end < std::min(num_meeting, begin + width) && alike(begin, end)) {
      ++end;
    }
    evaluate_alike(system, candidates, history, std::span(meeting_).subspan(begin, end - begin));
  }
  for (const std::uint32_t number : births_) {
    const auto begin = static_cast<std::uint32_t>(num_forces_);
    evaluate_pair(system, candidates, number, {});
    ranges_[number] = {begin, static_cast<std::uint32_t>(num_forces_) - begin};
  }
}

void ContactForces::evaluate_general_pairs(const BlockSystem &system, const Candidates &candidates,
                                           ContactHistory &history, std::span<const std::uint32_t> pairs) {
  for (const std::uint32_t k : pairs) {
    const CandidatePair &pair = candidates.pairs[k];
    if (system.box[pair.lower.value].meets(system.box[pair.higher.value]) || history.has_bonds(k) ||
        history.is_dilated(k)) {
      ++report_.evaluations;
      const auto begin = static_cast<std::uint32_t>(num_forces_);
      evaluate_pair(system, candidates, k,
                    std::span(history.regions).subspan(history.ranges[k].begin, history.ranges[k].count));
      ranges_[k] = {begin, static_cast<std::uint32_t>(num_forces_) - begin};
    }
  }
}

void ContactForces::evaluate_interior(const BlockSystem &system, const Candidates &candidates,
                                      ContactHistory &history) {
  increments_.assign(system.num_rows(), {});
  deforming_.resize(system.deformation.size());
  find_increments(system, 0, system.num_owned);
  num_forces_ = 0;
  damping_dyads_.clear();
  bond_dyads_.clear();
  dilation_works_.clear();
  next_.regions.clear();
  ranges_.assign(candidates.pairs.size(), {});
  // Most candidates touch: to grow by doubling would take more memory than to have room for all.
  forces_.reserve(candidates.pairs.size());
  next_.regions.reserve(candidates.pairs.size());
  report_ = {};
  evaluate_plain_pairs(system, candidates, history, 0, candidates.num_interior_plain);
  evaluate_general_pairs(system, candidates, history,
                         std::span(candidates.general).first(candidates.num_interior_general));
}

ForceReport ContactForces::evaluate_border(const BlockSystem &system, const Candidates &candidates,
                                           ContactHistory &history) {
  find_increments(system, system.num_owned, system.first_fixed());
  evaluate_plain_pairs(system, candidates, history, candidates.num_interior_plain, candidates.plain.size());
  evaluate_general_pairs(system, candidates, history,
                         std::span(candidates.general).subspan(candidates.num_interior_general));
  next_.ranges = ranges_;
  std::swap(history, next_);
  return report_;
}

void ContactForces::note(const BlockSystem &system, const CandidatePair &pair, const RegionForce &force) {
  report_.normals_undefined += force.normal_undefined ? 1 : 0;
  report_.max_overlap = std::max(report_.max_overlap, force.overlap);
  report_.max_overlap_share = std::max(report_.max_overlap_share, 0.5 * force.overlap / pair.allowed_overlap);
  if (force.overlap > pair.allowed_overlap) {
    keep_first(report_.fault, {Fault::Cause::too_deep, system.properties[pair.lower.value].id,
                               system.properties[pair.higher.value].id, force.overlap, pair.allowed_overlap});
  }
}

double coming_slide(const BlockSystem &system, const CandidatePair &pair, const RegionForce &force) {
  const auto increment = [&](BlockIndex row) {
    return system.is_fixed(row.value) ? TrialIncrement{} : trial_increment(system, row.value);
  };
  return dot(slide_at(system, pair, force.point, increment(pair.lower), increment(pair.higher)),
             perp(force.normal));
}

} // namespace gcpdda
