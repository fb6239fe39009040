// What is known of regions besides their sums, found once an evaluation is over.
//
// A step needs of a plain pair what its regions do to the blocks, and their memory. Where they act, in which
// direction, how deep: that is wanted at the start, for frames and for rows of energies. It follows from the
// trial configuration, the velocities in motions and the memory that the evaluation left behind, by the same
// operations in the same order, but without another slide; so a group of pairs is evaluated once more, read,
// and overwritten by the next one. Regions of other pairs are kept with all that is known of them.

#include "contact/contact_forces.hpp"

#include "contact/lanes/plain_batch.hpp"
#include "contact/pair_motion.hpp"

#include <algorithm>
#include <array>

namespace gcpdda {

namespace {

constexpr auto no_place = static_cast<std::uint32_t>(-1);

} // namespace

void ContactForces::find_details(const BlockSystem &system, const Candidates &candidates,
                                 const ContactHistory &history, std::uint32_t first, std::uint32_t last) {
  corners_.clear();
  polygons_.clear();
  places_.assign(PlainPair::pairs_in_group, no_place);
  std::size_t num_forces = num_forces_;
  candidates.for_plain_of_group(first / PlainPair::pairs_in_group, [&](std::size_t entry) {
    const std::uint32_t pair = candidates.plain[entry].pair;
    const PlainOverlap overlap = history.overlaps[pair];
    if (overlap != PlainOverlap::none && first <= pair && pair < last) {
      places_[pair % PlainPair::pairs_in_group] = static_cast<std::uint32_t>(num_forces++);
      (overlap == PlainOverlap::corners ? corners_ : polygons_).push_back(static_cast<std::uint32_t>(entry));
    }
  });
  grow(forces_, num_forces);
  is_again_ = true;
  evaluate_known({system, candidates, history, velocity_gradients_, parameters_.damping_ratio,
                  parameters_.stiffness_damping, true});
  is_again_ = false;
  batch_->take_extremes(); // they have been told
}

void ContactForces::store_again(const PlainLanes &lanes, unsigned touching) {
  PlainResults results;
  results.has_details = true;
  results.has_dyads = is_changing_ && lanes.pair[0]->kind.is_deformable;
  std::array<RegionState, most_lanes> known;
  std::array<Vec2, most_lanes> grips;
  for_bits(touching, [&](std::size_t i) {
    const std::uint32_t pair = lanes.pair[i]->pair;
    RegionForce &force = forces_[places_[pair % PlainPair::pairs_in_group]];
    force.pair = pair;
    force.born = !next_.has_plain(pair); // the one before
    force.bonded = false;
    results.sums[i] = &force;
    results.memory[i] = &known[i];
    results.details[i] = &force;
    if (results.has_dyads) {
      results.dyads[i] = &sums_.dyads(pair);
      results.grips[i] = &grips[i];
    }
  });
  results.wanted = touching;
  batch_->store(results);
}

std::span<RegionForce> ContactForces::at_hand(const Candidates &candidates, std::uint32_t pair) {
  if (!candidates.pairs[pair].is_plain) {
    return std::span(forces_).subspan(ranges_[pair].begin, ranges_[pair].count);
  }
  const std::uint32_t place = places_[pair % PlainPair::pairs_in_group];
  return place == no_place ? std::span<RegionForce>() : std::span(forces_).subspan(place, 1);
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

} // namespace gcpdda
