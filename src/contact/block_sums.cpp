#include "contact/block_sums.hpp"

#include "contact/lanes/plain_batch.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace gcpdda {

namespace {

/// What the lower (k = 0) or the higher block of a region gets of it.
void add_region(const RegionSums &f, std::size_t k, BlockContactSum &sum) {
  const auto add = [&](RigidDof &to, const Vec2 &force, const PairTorques &torque) {
    to.u = k == 0 ? to.u + force : to.u - force;
    to.r += torque[k];
  };
  add(sum.force, f.force, f.torque);
  add(sum.shear, f.shear_force, f.shear_torque);
  add(sum.damping, f.damping_force, f.damping_torque);
}

ContactCount counted(const BlockSystem &system, const CandidatePair &pair, bool born) {
  if (!counts_here(system, pair.lower)) {
    return {};
  }
  const bool crosses = pair.higher.value >= system.num_owned && !system.is_fixed(pair.higher.value);
  return {1, crosses ? 1 : 0, crosses && born ? 1 : 0};
}

double squared(Vec2 a) {
  return dot(a, a);
}

} // namespace

ContactCount &ContactCount::operator+=(const ContactCount &other) {
  touching += other.touching;
  crossing += other.crossing;
  crossing_formed += other.crossing_formed;
  return *this;
}

bool counts_here(const BlockSystem &system, BlockIndex lower) {
  return lower.value < system.num_owned || system.is_fixed(lower.value);
}

void BlockSums::start(BlockSystem &system, const Candidates &candidates, bool keeps) {
  constexpr std::size_t in_group = PlainPair::pairs_in_group;
  const std::size_t num_slots =
      keeps ? (candidates.pairs.size() + in_group - 1) / in_group * in_group : in_group;
  if (keeps != keeps_ || num_slots != seen_.size()) {
    seen_.assign(num_slots, 0);
  }
  keeps_ = keeps;
  has_dyads_ = !system.deformation.empty();
  is_again_ = false;
  is_added_ = candidates.is_added;
  sums_ = std::span(system.contact).first(system.num_owned);
  deformations_ = system.deformation;
  count_ = {};
  largest_squared_ = 0.0;
  group_.resize(num_slots);
  group_dyads_.resize(has_dyads_ ? num_slots : 0);
  waiting_ = candidates.waiting;
  if (keeps) {
    std::swap(kept_range_, range_before_);
    std::swap(kept_, before_);
    std::swap(kept_dyads_, dyads_before_);
  }
  kept_range_.assign(waiting_.size(), {});
  last_asked_ = 0;
  kept_.clear();
  kept_dyads_.clear();
}

void BlockSums::start_again() {
  is_again_ = true;
  std::fill(sums_.begin(), sums_.end(), BlockContactSum{});
  for (Deformation &d : deformations_) {
    d.contact = {};
  }
  count_ = {};
  largest_squared_ = 0.0;
}

void BlockSums::clear(BlockSystem &system, std::size_t first, std::size_t last) {
  if (first < last) {
    std::fill_n(system.contact.begin() + static_cast<std::ptrdiff_t>(first), last - first, BlockContactSum{});
    for (std::size_t k = system.deformation_begin[first]; k < system.deformation_begin[last]; ++k) {
      system.deformation[k].contact = {};
    }
  }
}

inline void BlockSums::add_dyads(const BlockSystem &system, const CandidatePair &pair, std::size_t k,
                                 const RegionDyads &dyads, const RegionSums &region) {
  const std::uint32_t row = (k == 0 ? pair.lower : pair.higher).value;
  if (system.is_deformable(row)) {
    const auto add = [&](const BlockGradientSum &part) {
      BlockGradientSum &sum = deformations_[system.deformation_begin[row]].contact;
      sum.force += part.force;
      sum.shear += part.shear;
      sum.damping += part.damping;
    };
    if (k == 0) {
      add(dyads);
    } else {
      add(on_higher(dyads, region, system.motion[pair.lower.value].centroid - system.motion[row].centroid));
    }
  }
}

void BlockSums::close_group(const BlockSystem &system, const Candidates &candidates, std::uint32_t number,
                            const PlainBatch &batch) {
  static_assert(touches == GroupToAdd::touches);
  const std::uint32_t first = number * PlainPair::pairs_in_group;
  const std::size_t slots = slot_of(first);
  GroupToAdd group{candidates.pairs.data() + first,
                   std::span<const std::uint8_t, PlainPair::pairs_in_group>(seen_.data() + slots,
                                                                            PlainPair::pairs_in_group),
                   group_.data() + slots,
                   has_dyads_ ? group_dyads_.data() + slots : nullptr,
                   sums_,
                   deformations_,
                   system.deformation_begin,
                   system.motion.data(),
                   candidates.are_added[number] != 0 ? std::span<const std::uint8_t>() : is_added_};
  group.largest_squared = largest_squared_;
  batch.add_group(group);
  largest_squared_ = group.largest_squared;
  count_.touching += group.num_touching; // without ghosts, they count here and do not cross
  for (std::size_t k = 0; k < group.num_waiting; ++k) {
    const std::uint32_t pair = first + group.waiting[k];
    keep_plain(pair, group_[slot_of(pair)], (seen_[slot_of(pair)] & is_born) != 0);
  }
  if (!keeps_) {
    drop_all();
  }
}

void BlockSums::begin_border(std::size_t num_plain) {
  kept_.reserve(kept_.size() + num_plain);
  kept_dyads_.reserve(has_dyads_ ? kept_dyads_.size() + num_plain : 0);
}

std::size_t BlockSums::place_of(std::uint32_t pair) {
  const bool is_behind = waiting_[last_asked_] <= pair;
  const auto from = waiting_.begin() + static_cast<std::ptrdiff_t>(is_behind ? last_asked_ : 0);
  last_asked_ = static_cast<std::size_t>(std::lower_bound(from, waiting_.end(), pair) - waiting_.begin());
  return last_asked_;
}

void BlockSums::keep_plain(std::uint32_t pair, const RegionSums &region, bool born) {
  const RegionDyads *dyads = has_dyads_ ? &group_dyads_[slot_of(pair)] : nullptr;
  if (is_again_) {
    kept(pair, 0) = region;
    if (dyads != nullptr) {
      *kept_dyads(pair, 0) = *dyads;
    }
    return;
  }
  range_of(pair) = {static_cast<std::uint32_t>(kept_.size()), 1};
  kept_.push_back({region, born});
  if (dyads != nullptr) {
    kept_dyads_.push_back(*dyads);
  }
}

void BlockSums::keep(std::uint32_t pair, std::span<const RegionForce> regions,
                     std::span<const RegionDyads> dyads) {
  range_of(pair) = {static_cast<std::uint32_t>(kept_.size()), static_cast<std::uint32_t>(regions.size())};
  for (const RegionForce &region : regions) {
    kept_.push_back({region, region.born});
  }
  if (has_dyads_) {
    kept_dyads_.insert(kept_dyads_.end(), dyads.begin(), dyads.end());
    kept_dyads_.resize(kept_.size());
  }
}

void BlockSums::keep_waiting_again(std::size_t place) {
  const RegionRange before = range_before_[place];
  kept_range_[place] = {static_cast<std::uint32_t>(kept_.size()), before.count};
  for (std::size_t k = before.begin; k < before.begin + before.count; ++k) {
    kept_.push_back({before_[k], false});
    if (has_dyads_) {
      kept_dyads_.push_back(dyads_before_[k]);
    }
  }
}

ContactCount BlockSums::finish(const BlockSystem &system, const Candidates &candidates) {
  ContactCount count = count_;
  largest_waiting_squared_ = 0.0;
  const auto add = [&](const CandidatePair &pair, std::size_t number) {
    const RegionSums &region = kept_[number];
    largest_waiting_squared_ = std::max(largest_waiting_squared_, squared(region.force));
    const std::array<BlockIndex, 2> rows{pair.lower, pair.higher};
    for (const std::size_t k : {0U, 1U}) {
      if (waits(rows[k])) {
        add_region(region, k, sums_[rows[k].value]);
        if (has_dyads_) {
          add_dyads(system, pair, k, kept_dyads_[number], region);
        }
      }
    }
  };
  for (std::size_t k = 0; k < waiting_.size(); ++k) {
    const RegionRange range = kept_range_[k];
    if (range.count > 0) {
      const CandidatePair &pair = candidates.pairs[waiting_[k]];
      count += counted(system, pair, kept_[range.begin].born);
      for (std::uint32_t i = 0; i < range.count; ++i) {
        add(pair, range.begin + i);
      }
    }
  }
  return count;
}

double BlockSums::largest_force() const {
  return std::sqrt(std::max(largest_squared_, largest_waiting_squared_));
}

} // namespace gcpdda
