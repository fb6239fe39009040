#include "contact/contact_forces.hpp"

#include "base/prefetch.hpp"
#include "contact/lanes/plain_batch.hpp"
#include "contact/laws/bond_work.hpp"
#include "contact/laws/region_law.hpp"
#include "contact/pair_motion.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <utility>

namespace gcpdda {

namespace {

/// Pairs between asking for what a pair alone has and using it; more than a batch, less than fills a cache.
constexpr std::size_t ahead = 16;

void fetch_pair(const Candidates &candidates, const ContactHistory &history, std::uint32_t pair) {
  prefetch(&candidates.pairs[pair], sizeof(CandidatePair));
  prefetch(&history.plain[pair], sizeof(RegionState));
  if (!history.grips.empty()) {
    prefetch(&history.grips[pair], sizeof(Vec2));
  }
}

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
    : parameters_(std::move(parameters)), batch_(make_plain_batch(instructions)) {}
ContactForces::~ContactForces() = default;
ContactForces::ContactForces(ContactForces &&) noexcept = default;
ContactForces &ContactForces::operator=(ContactForces &&) noexcept = default;

void ContactForces::begin_rows(BlockSystem &system, std::size_t first, std::size_t last) {
  velocity_gradients_.resize(system.deformation.size());
  sums_.clear(system, first, std::min(last, system.num_owned));
  const std::size_t width = batch_->width();
  const auto in_lanes = [&](std::size_t row) { // did they?
    const std::size_t deformable = system.deformation_begin[row + width] - system.deformation_begin[row];
    if (deformable == width) {
      batch_->find_deforming_motions(system, row, velocity_gradients_);
    }
    return deformable == width || (deformable == 0 && batch_->find_motions(system, row));
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

RegionForce &ContactForces::append_force(const RegionForce &force) {
  grow(forces_, num_forces_ + 1);
  return forces_[num_forces_++] = force;
}

// Up to as many entries of Candidates::plain as there are lanes.
PlainLanes ContactForces::lanes_of(const PlainScene &scene, std::span<const std::uint32_t> entries) {
  static_assert(std::tuple_size_v<decltype(own_)> == most_lanes);
  PlainLanes lanes;
  lanes.count = entries.size();
  const std::size_t width = batch_->width();
  const PlainPair *plains = scene.candidates.plain.data();
  const CandidatePair *pairs = scene.candidates.pairs.data();
  const PlainOverlap *overlaps = scene.history.overlaps.data();
  const RegionState *known = scene.history.plain.data();
  const std::vector<Vec2> &grips = scene.history.grips;
  for (std::size_t i = 0; i < width; ++i) {
    const PlainPair &plain = plains[entries[std::min(i, entries.size() - 1)]];
    const bool is_known = overlaps[plain.pair] != PlainOverlap::none;
    lanes.pair[i] = &plain;
    lanes.constants[i] = pairs + plain.pair;
    lanes.memory[i] = is_known ? known + plain.pair : &PlainLanes::no_memory;
    lanes.grip[i] = grips.empty() ? &PlainLanes::no_grip : &grips[plain.pair];
    if (plain.is_mixed && is_known && lanes.memory[i]->law != lanes.constants[i]->law) {
      own_[i] = constants_of(scene.system, parameters_, *lanes.constants[i], lanes.memory[i]->law);
      lanes.constants[i] = &own_[i];
    }
  }
  return lanes;
}

void ContactForces::evaluate_alike(const PlainScene &scene, std::span<const std::uint32_t> entries, Way way) {
  const PlainLanes lanes = lanes_of(scene, entries);
  const unsigned given = (1U << entries.size()) - 1U; // lanes beyond repeat the last one
  const auto leave = [&](unsigned which, std::vector<std::uint32_t> &to) {
    for_bits(which & given, [&](std::size_t i) { to.push_back(entries[i]); });
  };
  const bool are_corners = way == Way::corners;
  PlainBatch::Seen seen =
      are_corners ? batch_->evaluate_corners(scene, lanes) : batch_->evaluate(scene, lanes);
  if (are_corners) {
    leave(~(seen.touching | seen.apart), remaining_);
  } else if (way == Way::polygon_as_before && lanes.pair[0]->kind.may_be_corners()) {
    leave(seen.with_corners, corners_);
    seen.touching &= ~seen.with_corners;
  }
  const unsigned touching = seen.touching & given;
  report_.evaluations -=
      std::popcount(~seen.meeting & given); // they were thought to meet, and are looked at once
  if (touching != 0 && is_again_) {
    store_again(lanes, touching);
  } else if (touching != 0) {
    store_alike(scene, lanes, touching, are_corners ? PlainOverlap::corners : PlainOverlap::polygon);
  }
}

PlainResults ContactForces::open_regions(const Candidates &candidates, const PlainLanes &lanes,
                                         unsigned touching, PlainOverlap overlap) {
  PlainResults results;
  results.has_dyads = lanes.pair[0]->kind.is_deformable;
  results.has_details = keeps_details_;
  const auto entry_of = [&](const PlainPair &plain) {
    return static_cast<std::size_t>(&plain - candidates.plain.data());
  };
  const bool is_at_border = entry_of(*lanes.pair[0]) >= candidates.num_interior_plain; // as all others, then
  unsigned wanted = 0;
  bool has_mixed = false;
  for_bits(touching, [&](std::size_t i) {
    const PlainPair &plain = *lanes.pair[i];
    const bool is_born = lanes.memory[i] == &PlainLanes::no_memory;
    if (is_born && plain.is_mixed) {
      births_.push_back(static_cast<std::uint32_t>(entry_of(plain)));
      return;
    }
    wanted |= 1U << i;
    has_mixed = has_mixed || plain.is_mixed;
    results.sums[i] = is_at_border ? &sums_.open_border(candidates.border_place(entry_of(plain)), is_born)
                                   : &sums_.open(plain.pair, is_born);
    results.memory[i] = &plain_memory_[plain.pair];
    next_.overlaps[plain.pair] = overlap;
    if (keeps_details_) {
      results.details[i] = &details_[plain.pair];
    }
    if (results.has_dyads) {
      results.dyads[i] = is_at_border ? &sums_.border_dyads() : &sums_.dyads(plain.pair);
      results.grips[i] = &plain_grips_[plain.pair];
    }
  });
  results.wanted = wanted;
  results.has_mixed = has_mixed;
  return results;
}

void ContactForces::store_alike(const PlainScene &scene, const PlainLanes &lanes, unsigned touching,
                                PlainOverlap overlap) {
  const PlainResults results = open_regions(scene.candidates, lanes, touching, overlap);
  const unsigned too_deep = batch_->store(results);
  for_bits(results.has_mixed ? results.wanted : 0U, [&](std::size_t i) {
    if (lanes.pair[i]->is_mixed) {
      results.memory[i]->law = lanes.constants[i]->law;
    }
  });
  for_bits(too_deep, [&](std::size_t i) {
    note_depth(scene.system, scene.candidates.pairs[lanes.pair[i]->pair], batch_->overlap(i));
  });
}

template <class Visit>
void ContactForces::for_batches(const Candidates &candidates, const ContactHistory &history,
                                std::span<const std::uint32_t> entries, Visit &&visit) {
  const std::vector<PlainPair> &plain = candidates.plain;
  const std::size_t width = batch_->width();
  for (std::size_t begin = 0, end = 0; begin < entries.size(); begin = end) {
    for (std::size_t k = begin + ahead; k < std::min(entries.size(), begin + ahead + width); ++k) {
      fetch_pair(candidates, history, plain[entries[k]].pair);
    }
    end = begin + 1;
    const std::size_t most = std::min(entries.size(), begin + width);
    while (end < most && plain[entries[begin]].is_like(plain[entries[end]])) {
      ++end;
    }
    visit(entries.subspan(begin, end - begin));
  }
}

void ContactForces::evaluate_all(const PlainScene &scene, const std::vector<std::uint32_t> &entries,
                                 Way way) {
  for_batches(scene.candidates, scene.history, entries,
              [&](std::span<const std::uint32_t> batch) { evaluate_alike(scene, batch, way); });
}

// Mostly each list does with its own kernel. What was another polygon than that of two corners mostly stays
// so, and counting the corners inside costs less than looking for that overlap in vain. Which kernel takes a
// pair depends on its shapes alone, not on the list it came from: where the one for corners applies, one
// corner of each block is inside the other one.
void ContactForces::evaluate_known(const PlainScene &scene) {
  remaining_.clear();
  evaluate_all(scene, polygons_, Way::polygon_as_before);
  evaluate_all(scene, corners_, Way::corners);
  evaluate_all(scene, remaining_, Way::polygon);
}

void ContactForces::evaluate_without_region(const PlainScene &scene) {
  corners_.clear();
  polygons_.clear();
  for (const std::uint32_t entry : without_region_) {
    (scene.candidates.plain[entry].kind.may_be_corners() ? corners_ : polygons_).push_back(entry);
  }
  evaluate_known(scene);
}

// Those that did not touch before hardly ever do: on their own they are seen to be apart with little work.
void ContactForces::find_meeting(const BlockSystem &system, const Candidates &candidates,
                                 const ContactHistory &history, std::size_t first, std::size_t last) {
  const std::array<std::vector<std::uint32_t> *, 3> lists{&without_region_, &corners_, &polygons_};
  std::array<std::uint32_t *, lists.size()> ends{};
  for (std::size_t i = 0; i < lists.size(); ++i) {
    lists[i]->resize(last - first);
    ends[i] = lists[i]->data();
  }
  const BlockMotion *motions = system.motion.data();
  for (std::size_t k = first; k < last; ++k) {
    const PlainPair &plain = candidates.plain[k];
    const PlainOverlap overlap = history.overlaps[plain.pair];
    std::uint32_t *&end = ends[static_cast<std::size_t>(overlap)];
    *end = static_cast<std::uint32_t>(k);
    bool meets = true; // that known boxes part is rare, and the lanes will see it
    if (overlap == PlainOverlap::none) {
      const CandidatePair &pair = candidates.pairs[plain.pair];
      meets = motions[pair.lower.value].box.meets(motions[pair.higher.value].box);
    }
    end += meets ? 1 : 0;
  }
  for (std::size_t i = 0; i < lists.size(); ++i) {
    lists[i]->resize(static_cast<std::size_t>(ends[i] - lists[i]->data()));
    report_.evaluations += std::ssize(*lists[i]);
  }
}

void ContactForces::close_group(const BlockSystem &system, const Candidates &candidates,
                                std::uint32_t group) {
  sums_.close_group(system, candidates, group, *batch_);
}

void ContactForces::evaluate_plain_pairs(const BlockSystem &system, const Candidates &candidates,
                                         const ContactHistory &history, std::size_t first, std::size_t last) {
  const PlainScene scene{system,
                         candidates,
                         history,
                         velocity_gradients_,
                         parameters_.damping_ratio,
                         parameters_.stiffness_damping,
                         false};
  find_meeting(system, candidates, history, first, last);
  evaluate_known(scene);
  evaluate_without_region(scene);
  for (const std::uint32_t entry : births_) {
    evaluate_birth(system, candidates, entry);
  }
  births_.clear();
}

std::size_t ContactForces::append_regions(const BlockSystem &system, const Candidates &candidates,
                                          std::uint32_t number, std::span<RegionMemory> old) {
  first_of_pair_ = num_forces_;
  dyads_.clear();
  find_regions(system, candidates, number, old);
  return num_forces_ - first_of_pair_;
}

// One region at most.
void ContactForces::evaluate_birth(const BlockSystem &system, const Candidates &candidates,
                                   std::uint32_t entry) {
  const std::uint32_t number = candidates.plain[entry].pair;
  if (append_regions(system, candidates, number, {}) == 0) {
    return;
  }
  next_.overlaps[number] = PlainOverlap::polygon;
  plain_memory_[number] = next_.regions.back();
  if (!plain_grips_.empty()) {
    plain_grips_[number] = next_.regions.back().grip;
  }
  next_.regions.pop_back();
  const bool is_at_border = entry >= candidates.num_interior_plain;
  (is_at_border ? sums_.open_border(candidates.border_place(entry), true) : sums_.open(number, true)) =
      forces_[first_of_pair_];
  if (!dyads_.empty()) {
    (is_at_border ? sums_.border_dyads() : sums_.dyads(number)) = dyads_.front();
  }
  if (keeps_details_) {
    details_[number] = forces_[first_of_pair_];
  }
  drop_last_force();
}

void ContactForces::evaluate_general_pair(const BlockSystem &system, const Candidates &candidates,
                                          std::uint32_t number, std::span<RegionMemory> old) {
  const std::size_t first_known = next_.regions.size();
  const std::size_t count = append_regions(system, candidates, number, old); // of memories as well
  const auto begin = static_cast<std::uint32_t>(first_of_pair_);
  ranges_[number] = {begin, static_cast<std::uint32_t>(count)};
  next_.ranges[number] = {static_cast<std::uint32_t>(first_known), static_cast<std::uint32_t>(count)};
  if (count > 0) {
    sums_.keep(number, std::span(forces_).subspan(begin, count),
               std::span(dyads_).first(std::min(count, dyads_.size())));
  }
}

void ContactForces::evaluate_general_pairs(const BlockSystem &system, const Candidates &candidates,
                                           ContactHistory &history, std::span<const std::uint32_t> pairs) {
  for (const std::uint32_t k : pairs) {
    const CandidatePair &pair = candidates.pairs[k];
    if (system.motion[pair.lower.value].box.meets(system.motion[pair.higher.value].box) ||
        history.has_bonds(k) || history.is_opened(k)) {
      ++report_.evaluations;
      evaluate_general_pair(system, candidates, k, history.of_other(k));
    }
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
  num_forces_ = 0;
  opening_works_.clear();
  next_.overlaps.assign(candidates.pairs.size(), PlainOverlap::none);
  next_.ranges.assign(candidates.general.empty() ? 0 : candidates.pairs.size(), {});
  next_.regions.clear();
  ranges_.resize(next_.ranges.size());
  for (const std::uint32_t pair : candidates.general) {
    ranges_[pair] = {};
  }
  sums_.start(system, candidates);
  details_.resize(keeps_details_ ? candidates.pairs.size() : 0);
  report_ = {};
}

void ContactForces::keep_details(bool keeps) {
  keeps_details_ = keeps;
  if (!keeps) {
    details_ = {};
  }
}

void ContactForces::evaluate_group(const BlockSystem &system, const Candidates &candidates,
                                   ContactHistory &history, const PairGroup &group) {
  plain_memory_ = history.plain;
  plain_grips_ = history.grips;
  if (group.first < group.last) {
    evaluate_plain_pairs(system, candidates, history, group.first, group.last);
    close_group(system, candidates, group.number);
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
  plain_memory_ = history.plain;
  plain_grips_ = history.grips;
  for (std::size_t first = candidates.num_interior_plain; first < num_plain;
       first += PlainPair::pairs_in_group) {
    evaluate_plain_pairs(system, candidates, history, first,
                         std::min<std::size_t>(num_plain, first + PlainPair::pairs_in_group));
  }
  evaluate_general_pairs(system, candidates, history,
                         std::span(candidates.general).subspan(candidates.num_interior_general));
  std::swap(history.overlaps, next_.overlaps);
  std::swap(history.ranges, next_.ranges);
  std::swap(history.regions, next_.regions);
  const PlainBatch::Extremes seen = batch_->take_extremes();
  report_.normals_undefined += seen.normals_undefined;
  report_.max_overlap = std::max(report_.max_overlap, seen.max_overlap);
  report_.max_overlap_share = std::max(report_.max_overlap_share, seen.max_overlap_share);
  return report_;
}

void ContactForces::note(const BlockSystem &system, const CandidatePair &pair, const RegionForce &force) {
  report_.normals_undefined += force.normal_undefined ? 1 : 0;
  report_.max_overlap = std::max(report_.max_overlap, force.overlap);
  report_.max_overlap_share = std::max(report_.max_overlap_share, 0.5 * force.overlap / pair.allowed_overlap);
  note_depth(system, pair, force.overlap);
}

void ContactForces::note_depth(const BlockSystem &system, const CandidatePair &pair, double overlap) {
  if (overlap > pair.allowed_overlap) {
    keep_first(report_.fault, {Fault::Cause::too_deep, system.properties[pair.lower.value].id,
                               system.properties[pair.higher.value].id, overlap, pair.allowed_overlap});
  }
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
