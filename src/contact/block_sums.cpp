#include "gcpdda/contact/block_sums.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <type_traits>

namespace gcpdda {

namespace {

using Two = double __attribute__((vector_size(2 * sizeof(double))));

/// Straight from where the lanes left them: a copy made piece by piece would have to wait for all of it.
Two load(const double &first) {
  Two two;
  std::memcpy(&two, &first, sizeof(two));
  return two;
}

/// A BlockContactSum in registers.
struct SumAtHand {
  std::array<Two, 3> whole;
  std::array<double, 3> turning;

  explicit SumAtHand(const BlockContactSum &sum)
      : whole{load(sum.force.u.x), load(sum.shear.u.x), load(sum.damping.u.x)}, turning{sum.force.r,
                                                                                        sum.shear.r,
                                                                                        sum.damping.r} {}
  /// What the lower (k = 0) or the higher block of a region gets of it.
  void add(const RegionSums &f, std::size_t k) {
    const std::array<Two, 3> part{load(f.force.x), load(f.shear_force.x), load(f.damping_force.x)};
    const std::array<double, 3> torque{f.torque[k], f.shear_torque[k], f.damping_torque[k]};
    for (std::size_t i = 0; i < 3; ++i) {
      whole[i] = k == 0 ? whole[i] + part[i] : whole[i] - part[i];
      turning[i] += torque[i];
    }
  }
  void store(BlockContactSum &sum) const {
    const auto put = [&](std::size_t i, RigidDof &to) {
      std::memcpy(&to.u.x, &whole[i], sizeof(Two));
      to.r = turning[i];
    };
    put(0, sum.force);
    put(1, sum.shear);
    put(2, sum.damping);
  }
};

[[gnu::always_inline]] inline void add_region(const RegionSums &f, std::size_t k, BlockContactSum &sum) {
  SumAtHand at_hand(sum);
  at_hand.add(f, k);
  at_hand.store(sum);
}

ContactCount counted(const BlockSystem &system, const CandidatePair &pair, bool born) {
  if (!counts_here(system, pair.lower)) {
    return {};
  }
  const bool crosses = pair.higher.value >= system.num_owned && !system.is_fixed(pair.higher.value);
  return {1, crosses ? 1 : 0, crosses && born ? 1 : 0};
}

template <class Visit> void each_side(Visit &&visit) {
  visit(std::integral_constant<std::size_t, 0>{});
  visit(std::integral_constant<std::size_t, 1>{});
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

void BlockSums::start(BlockSystem &system, const Candidates &candidates) {
  has_dyads_ = !system.deformation.empty();
  is_again_ = false;
  is_added_ = candidates.is_added;
  sums_ = std::span(system.contact).first(system.num_owned);
  deformations_ = system.deformation;
  count_ = {};
  largest_squared_ = 0.0;
  group_.resize(PlainPair::pairs_in_group);
  group_dyads_.resize(has_dyads_ ? PlainPair::pairs_in_group : 0);
  waiting_ = candidates.waiting;
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

template <class Visit> void BlockSums::for_touched(std::uint32_t group, Visit &&visit) const {
  using Eight = std::uint64_t;
  static_assert(std::endian::native == std::endian::little);
  for (std::size_t first = 0; first < seen_.size(); first += sizeof(Eight)) {
    Eight seen = 0;
    std::memcpy(&seen, &seen_[first], sizeof(seen));
    for (seen &= 0x0101010101010101U * touches; seen != 0; seen &= seen - 1) {
      const std::size_t slot = first + static_cast<std::size_t>(std::countr_zero(seen)) / 8;
      visit(group * PlainPair::pairs_in_group + static_cast<std::uint32_t>(slot), group_[slot],
            (seen_[slot] & is_born) != 0);
    }
  }
}

// Pairs of one lower block follow one another, and its sum stays in registers meanwhile: what it gets as the
// higher block of others has been added before.
template <bool some_wait>
void BlockSums::add_group(const BlockSystem &system, const Candidates &candidates, std::uint32_t group) {
  const CandidatePair *pairs = candidates.pairs.data();
  BlockContactSum *const sums = sums_.data(); // by themselves, or each store might have changed them
  const std::size_t num_owned = sums_.size();
  const auto time_of = [&](BlockIndex row) {
    return some_wait ? when(row) : row.value < num_owned ? When::at_once : When::never;
  };
  BlockContactSum none;
  BlockContactSum *lower = &none;
  SumAtHand at_lower(none);
  double largest_squared = largest_squared_;
  for_touched(group, [&](std::uint32_t number, const RegionSums &region, bool born) {
    const CandidatePair &pair = pairs[number];
    const When lower_time = time_of(pair.lower);
    const When higher_time = time_of(pair.higher);
    BlockContactSum *next = lower_time == When::at_once ? &sums[pair.lower.value] : &none;
    if (next != lower) {
      at_lower.store(*lower);
      at_lower = SumAtHand(*next);
      lower = next;
    }
    at_lower.add(region, 0);
    if (higher_time == When::at_once) {
      add_region(region, 1, sums[pair.higher.value]);
    }
    if (has_dyads_) {
      const RegionDyads &dyads = group_dyads_[number % PlainPair::pairs_in_group];
      each_side([&](auto k) {
        if ((k == 0 ? lower_time : higher_time) == When::at_once) {
          add_dyads(system, pair, k, dyads, region);
        }
      });
    }
    if (some_wait && (lower_time == When::later || higher_time == When::later)) {
      keep_plain(number, region, born);
    } else { // without a ghost, it counts here and does not cross
      largest_squared = std::max(largest_squared, squared(region.force));
      ++count_.touching;
    }
  });
  at_lower.store(*lower);
  largest_squared_ = largest_squared;
}

void BlockSums::close_group(const BlockSystem &system, const Candidates &candidates, std::uint32_t group) {
  if (candidates.are_added[group] != 0) {
    add_group<false>(system, candidates, group);
  } else {
    add_group<true>(system, candidates, group);
  }
  seen_.fill(0);
}

RegionRange &BlockSums::range_of(std::uint32_t pair) {
  const bool is_behind = waiting_[last_asked_] <= pair;
  const auto from = waiting_.begin() + static_cast<std::ptrdiff_t>(is_behind ? last_asked_ : 0);
  last_asked_ = static_cast<std::size_t>(std::lower_bound(from, waiting_.end(), pair) - waiting_.begin());
  return kept_range_[last_asked_];
}

void BlockSums::keep_plain(std::uint32_t pair, const RegionSums &region, bool born) {
  const RegionDyads *dyads = has_dyads_ ? &group_dyads_[pair % PlainPair::pairs_in_group] : nullptr;
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

ContactCount BlockSums::finish(const BlockSystem &system, const Candidates &candidates) {
  ContactCount count = count_;
  largest_waiting_squared_ = 0.0;
  const auto add = [&](const CandidatePair &pair, std::size_t number) {
    const RegionSums &region = kept_[number];
    largest_waiting_squared_ = std::max(largest_waiting_squared_, squared(region.force));
    const std::array<BlockIndex, 2> rows{pair.lower, pair.higher};
    for (const std::size_t k : {0U, 1U}) {
      if (when(rows[k]) == When::later) {
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
