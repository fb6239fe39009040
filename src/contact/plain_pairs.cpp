#include "contact/plain_pairs.hpp"

#include "base/prefetch.hpp"
#include "contact/laws/region_law.hpp"
#include "contact/pair_motion.hpp"

#include <algorithm>
#include <bit>
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

constexpr auto no_place = static_cast<std::uint32_t>(-1);

} // namespace

PlainPairs::PlainPairs(std::shared_ptr<const ContactParameters> parameters, Instructions instructions)
    : parameters_(std::move(parameters)), batch_(make_plain_batch(instructions)) {}

void PlainPairs::begin(const Candidates &candidates) {
  overlaps_.assign(candidates.pairs.size(), PlainOverlap::none);
  details_.resize(keeps_details_ ? candidates.pairs.size() : 0);
  report_ = {};
  kept_ = {};
}

void PlainPairs::keep_details(bool keeps) {
  keeps_details_ = keeps;
  if (!keeps) {
    details_ = {};
  }
}

PlainScene PlainPairs::scene_of(const BlockSystem &system, const Candidates &candidates,
                                const ContactHistory &history, std::span<const Mat2> velocity_gradients,
                                bool is_known) const {
  return {system,
          candidates,
          history,
          velocity_gradients,
          parameters_->damping_ratio,
          parameters_->stiffness_damping,
          is_known};
}

// Up to as many entries of Candidates::plain as there are lanes.
PlainLanes PlainPairs::lanes_of(const PlainScene &scene, std::span<const std::uint32_t> entries) {
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
      own_[i] = constants_of(scene.system, *parameters_, *lanes.constants[i], lanes.memory[i]->law);
      lanes.constants[i] = &own_[i];
    }
  }
  return lanes;
}

PlainResults PlainPairs::open_regions(const PlainWork &work, const PlainLanes &lanes, unsigned touching,
                                      PlainOverlap overlap) {
  const Candidates &candidates = work.scene.candidates;
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
    if (plain.is_mixed && (is_born || chooses_law(candidates.pairs[plain.pair], *lanes.memory[i]))) {
      choosing_.push_back(static_cast<std::uint32_t>(entry_of(plain)));
      return;
    }
    wanted |= 1U << i;
    has_mixed = has_mixed || plain.is_mixed;
    results.sums[i] = is_at_border ? &work.sums.open_border(candidates.border_place(entry_of(plain)), is_born)
                                   : &work.sums.open(plain.pair, is_born);
    results.memory[i] = &work.memory[plain.pair];
    overlaps_[plain.pair] = overlap;
    if (keeps_details_) {
      results.details[i] = &details_[plain.pair];
    }
    if (results.has_dyads) {
      results.dyads[i] = is_at_border ? &work.sums.border_dyads() : &work.sums.dyads(plain.pair);
      results.grips[i] = &work.grips[plain.pair];
    }
  });
  results.wanted = wanted;
  results.has_mixed = has_mixed;
  return results;
}

void PlainPairs::store_alike(const PlainWork &work, const PlainLanes &lanes, unsigned touching,
                             PlainOverlap overlap) {
  const PlainResults results = open_regions(work, lanes, touching, overlap);
  std::array<std::uint16_t, most_lanes> seen_at; // read before it is written over
  for_bits(results.has_mixed ? results.wanted : 0U,
           [&](std::size_t i) { seen_at[i] = lanes.memory[i]->seen_at; });
  const unsigned too_deep = batch_->store(results);
  for_bits(results.has_mixed ? results.wanted : 0U, [&](std::size_t i) {
    if (lanes.pair[i]->is_mixed) {
      results.memory[i]->law = lanes.constants[i]->law;
      results.memory[i]->seen_at = seen_at[i];
    }
  });
  for_bits(too_deep, [&](std::size_t i) {
    report_.note_depth(work.scene.system, work.scene.candidates.pairs[lanes.pair[i]->pair],
                       batch_->overlap(i));
  });
}

void PlainPairs::store_again(const PlainWork &work, const PlainLanes &lanes, unsigned touching) {
  PlainResults results;
  results.has_details = true;
  results.has_dyads = work.has_dyads && lanes.pair[0]->kind.is_deformable;
  std::array<RegionState, most_lanes> known;
  std::array<Vec2, most_lanes> grips;
  for_bits(touching, [&](std::size_t i) {
    const std::uint32_t pair = lanes.pair[i]->pair;
    RegionForce &force = again_[places_[pair % PlainPair::pairs_in_group]];
    force.pair = pair;
    force.born = overlaps_[pair] == PlainOverlap::none; // the one before
    force.bonded = false;
    results.sums[i] = &force;
    results.memory[i] = &known[i];
    results.details[i] = &force;
    if (results.has_dyads) {
      results.dyads[i] = &work.sums.dyads(pair);
      results.grips[i] = &grips[i];
    }
  });
  results.wanted = touching;
  batch_->store(results);
}

void PlainPairs::evaluate_alike(const PlainWork &work, std::span<const std::uint32_t> entries, Way way) {
  const PlainLanes lanes = lanes_of(work.scene, entries);
  const unsigned given = (1U << entries.size()) - 1U; // lanes beyond repeat the last one
  const auto leave = [&](unsigned which, std::vector<std::uint32_t> &to) {
    for_bits(which & given, [&](std::size_t i) { to.push_back(entries[i]); });
  };
  const bool are_corners = way == Way::corners;
  PlainBatch::Seen seen =
      are_corners ? batch_->evaluate_corners(work.scene, lanes) : batch_->evaluate(work.scene, lanes);
  if (are_corners) {
    leave(~(seen.touching | seen.apart), remaining_);
  } else if (way == Way::polygon_as_before && lanes.pair[0]->kind.may_be_corners()) {
    leave(seen.with_corners, corners_);
    seen.touching &= ~seen.with_corners;
  }
  const unsigned touching = seen.touching & given;
  report_.evaluations -=
      std::popcount(~seen.meeting & given); // they were thought to meet, and are looked at once
  if (touching != 0 && work.scene.is_known) {
    store_again(work, lanes, touching);
  } else if (touching != 0) {
    store_alike(work, lanes, touching, are_corners ? PlainOverlap::corners : PlainOverlap::polygon);
  }
}

// As many entries that are alike at a time as there are lanes.
void PlainPairs::evaluate_all(const PlainWork &work, std::span<const std::uint32_t> entries, Way way) {
  const std::vector<PlainPair> &plain = work.scene.candidates.plain;
  const std::size_t width = batch_->width();
  for (std::size_t begin = 0, end = 0; begin < entries.size(); begin = end) {
    for (std::size_t k = begin + ahead; k < std::min(entries.size(), begin + ahead + width); ++k) {
      fetch_pair(work.scene.candidates, work.scene.history, plain[entries[k]].pair);
    }
    end = begin + 1;
    const std::size_t most = std::min(entries.size(), begin + width);
    while (end < most && plain[entries[begin]].is_like(plain[entries[end]])) {
      ++end;
    }
    evaluate_alike(work, entries.subspan(begin, end - begin), way);
  }
}

// Mostly each list does with its own kernel. What was another polygon than that of two corners mostly stays
// so, and counting the corners inside costs less than looking for that overlap in vain. Which kernel takes a
// pair depends on its shapes alone, not on the list it came from: where the one for corners applies, one
// corner of each block is inside the other one.
void PlainPairs::evaluate_known(const PlainWork &work) {
  remaining_.clear();
  evaluate_all(work, polygons_, Way::polygon_as_before);
  evaluate_all(work, corners_, Way::corners);
  evaluate_all(work, remaining_, Way::polygon);
}

void PlainPairs::evaluate_without_region(const PlainWork &work) {
  corners_.clear();
  polygons_.clear();
  for (const std::uint32_t entry : without_region_) {
    (work.scene.candidates.plain[entry].kind.may_be_corners() ? corners_ : polygons_).push_back(entry);
  }
  evaluate_known(work);
}

// Those that did not touch before hardly ever do: on their own they are seen to be apart with little work.
void PlainPairs::find_meeting(const PlainWork &work, std::size_t first, std::size_t last) {
  const PlainScene &scene = work.scene;
  const Candidates &candidates = scene.candidates;
  const bool some_rest = work.resting.is_used();
  const std::array<std::vector<std::uint32_t> *, 3> lists{&without_region_, &corners_, &polygons_};
  std::array<std::uint32_t *, lists.size()> ends{};
  for (std::size_t i = 0; i < lists.size(); ++i) {
    lists[i]->resize(last - first);
    ends[i] = lists[i]->data();
  }
  const BlockMotion *motions = scene.system.motion.data();
  std::size_t num_kept = 0;
  RestingGroups::Kept kept;
  for (std::size_t k = first; k < last; ++k) {
    const PlainPair &plain = candidates.plain[k];
    if (some_rest) {
      if (keeps(work, k, kept)) {
        ++num_kept;
        continue;
      }
      overlaps_[plain.pair] = PlainOverlap::none; // a group kept as a whole may have said something else
    }
    const PlainOverlap overlap = scene.history.overlaps[plain.pair];
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
  kept_.add(kept);
  kept_here_ = num_kept == last - first ? std::optional(kept) : std::nullopt;
}

bool PlainPairs::keeps(const PlainWork &work, std::size_t entry, RestingGroups::Kept &kept) {
  const Candidates &candidates = work.scene.candidates;
  const std::uint32_t number = candidates.plain[entry].pair;
  const CandidatePair &pair = candidates.pairs[number];
  const ContactHistory &history = work.scene.history;
  const PlainOverlap overlap = history.overlaps[number];
  const bool chooses = overlap != PlainOverlap::none && chooses_law(pair, history.plain[number]);
  if (chooses || !work.resting.has(pair.lower.value) || !work.resting.has(pair.higher.value)) {
    work.sums.drop(number);
    return false;
  }
  overlaps_[number] = overlap;
  if (overlap != PlainOverlap::none) {
    if (entry < candidates.num_interior_plain) {
      work.sums.keep_again(number);
    } else {
      work.sums.keep_waiting_again(candidates.border_place(entry));
    }
    kept.add({details_[number].normal_undefined ? 1 : 0, details_[number].overlap});
  }
  return true;
}

void PlainPairs::keep_group(const ContactHistory &history, std::uint32_t number,
                            const RestingGroups::Kept &kept) {
  const std::size_t first = std::size_t{number} * PlainPair::pairs_in_group;
  const std::size_t count = std::min<std::size_t>(PlainPair::pairs_in_group, overlaps_.size() - first);
  std::copy_n(history.overlaps.begin() + static_cast<std::ptrdiff_t>(first), count,
              overlaps_.begin() + static_cast<std::ptrdiff_t>(first));
  kept_.add(kept);
}

std::span<const std::uint32_t> PlainPairs::evaluate(const PlainWork &work, std::size_t first,
                                                    std::size_t last) {
  choosing_.clear();
  find_meeting(work, first, last);
  evaluate_known(work);
  evaluate_without_region(work);
  return choosing_;
}

void PlainPairs::store_choice(const PlainWork &work, std::uint32_t entry, const RegionForce &force,
                              const RegionMemory &memory, std::span<const RegionDyads> dyads) {
  const Candidates &candidates = work.scene.candidates;
  const std::uint32_t number = candidates.plain[entry].pair;
  overlaps_[number] = PlainOverlap::polygon;
  work.memory[number] = memory;
  if (!work.grips.empty()) {
    work.grips[number] = memory.grip;
  }
  const bool is_at_border = entry >= candidates.num_interior_plain;
  (is_at_border ? work.sums.open_border(candidates.border_place(entry), force.born)
                : work.sums.open(number, force.born)) = force;
  if (!dyads.empty()) {
    (is_at_border ? work.sums.border_dyads() : work.sums.dyads(number)) = dyads.front();
  }
  if (keeps_details_) {
    details_[number] = force;
  }
}

ForceReport PlainPairs::finish(std::vector<PlainOverlap> &overlaps) {
  std::swap(overlaps, overlaps_);
  const PlainBatch::Extremes seen = batch_->take_extremes();
  report_.normals_undefined = kept_.normals_undefined + seen.normals_undefined;
  report_.max_overlap = std::max(kept_.max_overlap, seen.max_overlap);
  report_.max_overlap_share = seen.max_overlap_share;
  return report_;
}

void PlainPairs::find_details(const PlainWork &work, std::uint32_t first, std::uint32_t last) {
  const Candidates &candidates = work.scene.candidates;
  corners_.clear();
  polygons_.clear();
  places_.assign(PlainPair::pairs_in_group, no_place);
  std::size_t num_regions = 0;
  candidates.for_plain_of_group(first / PlainPair::pairs_in_group, [&](std::size_t entry) {
    const std::uint32_t pair = candidates.plain[entry].pair;
    const PlainOverlap overlap = work.scene.history.overlaps[pair];
    if (overlap != PlainOverlap::none && first <= pair && pair < last) {
      places_[pair % PlainPair::pairs_in_group] = static_cast<std::uint32_t>(num_regions++);
      (overlap == PlainOverlap::corners ? corners_ : polygons_).push_back(static_cast<std::uint32_t>(entry));
    }
  });
  grow(again_, num_regions);
  evaluate_known(work);
  batch_->take_extremes(); // they have been told
}

std::span<RegionForce> PlainPairs::at_hand(std::uint32_t pair) {
  const std::uint32_t place = places_[pair % PlainPair::pairs_in_group];
  return place == no_place ? std::span<RegionForce>() : std::span(again_).subspan(place, 1);
}

} // namespace gcpdda
