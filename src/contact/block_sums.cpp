#include "gcpdda/contact/block_sums.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <numeric>
#include <type_traits>

namespace gcpdda {

namespace {

using Two = double __attribute__((vector_size(2 * sizeof(double))));

Two load(const Vec2 &a) {
  Two two;
  std::memcpy(&two, &a, sizeof(two));
  return two;
}

/// Straight from where the lanes left them: a copy made piece by piece would have to wait for all of it.
void add(const Vec2 &force, const PairTorques &torque, std::size_t k, RigidDof &sum) {
  const Two whole = k == 0 ? load(sum.u) + load(force) : load(sum.u) - load(force);
  const double turning = sum.r + torque[k];
  sum = {{whole[0], whole[1]}, turning};
}

/// What the lower (k = 0) or the higher block of a region gets of it.
void add_region(const RegionSums &f, std::size_t k, BlockContactSum &sum) {
  add(f.force, f.torque, k, sum.force);
  add(f.shear_force, f.shear_torque, k, sum.shear);
  add(f.damping_force, f.damping_torque, k, sum.damping);
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

void BlockSums::start(const BlockSystem &system, const Candidates &candidates, Keep keep) {
  has_dyads_ = !system.deformation.empty();
  is_added_ = candidates.is_added;
  sums_.assign(system.num_owned, {});
  gradients_.assign(system.deformation.size(), {});
  count_ = {};
  largest_squared_ = 0.0;
  group_.resize(PlainPair::pairs_in_group);
  group_dyads_.resize(has_dyads_ ? PlainPair::pairs_in_group : 0);
  if (keep == Keep::all) {
    kept_range_.assign(candidates.pairs.size(), {});
  } else {
    kept_range_.resize(candidates.pairs.size());
    for (const std::uint32_t pair : candidates.waiting) {
      kept_range_[pair] = {};
    }
  }
  kept_.clear();
  kept_dyads_.clear();
  if (keep == Keep::all) {
    kept_.reserve(candidates.pairs.size());
  } else if (keep_ == Keep::all) { // what all took is not needed again
    kept_.shrink_to_fit();
    kept_dyads_.shrink_to_fit();
  }
  keep_ = keep;
}

void BlockSums::add_dyads(const BlockSystem &system, BlockIndex row, const BlockGradientSum &dyads) {
  if (system.is_deformable(row.value)) {
    BlockGradientSum &sum = gradients_[system.deformation_begin[row.value]];
    sum.force += dyads.force;
    sum.shear += dyads.shear;
    sum.damping += dyads.damping;
  }
}

void BlockSums::close_group(const BlockSystem &system, const Candidates &candidates, std::uint32_t group) {
  for (std::size_t word = 0; word < touched_.size(); ++word) {
    for (std::uint64_t bits = touched_[word]; bits != 0; bits &= bits - 1) {
      const std::size_t slot = 64 * word + static_cast<std::size_t>(std::countr_zero(bits));
      const std::uint32_t number = group * PlainPair::pairs_in_group + static_cast<std::uint32_t>(slot);
      const CandidatePair &pair = candidates.pairs[number];
      const RegionSums &region = group_[slot];
      const bool born = (born_[word] >> slot % 64 & 1U) != 0;
      const std::array<BlockIndex, 2> rows{pair.lower, pair.higher};
      const std::array<When, 2> times{when(pair.lower), when(pair.higher)};
      if (times[0] == When::later || times[1] == When::later) {
        kept_range_[number] = {static_cast<std::uint32_t>(kept_.size()), 1};
        kept_.push_back({region, born});
        if (has_dyads_) {
          kept_dyads_.push_back(group_dyads_[slot]);
        }
      } else {
        count_ += counted(system, pair, born);
        largest_squared_ = std::max(largest_squared_, squared(region.force));
      }
      each_side([&](auto k) {
        if (times[k] == When::at_once) {
          add_region(region, k, sums_[rows[k].value]);
          if (has_dyads_) {
            add_dyads(system, rows[k], group_dyads_[slot][k]);
          }
        }
      });
    }
  }
  touched_ = {};
  born_ = {};
}

void BlockSums::keep(std::uint32_t pair, std::span<const RegionForce> regions,
                     std::span<const RegionDyads> dyads) {
  kept_range_[pair] = {static_cast<std::uint32_t>(kept_.size()), static_cast<std::uint32_t>(regions.size())};
  for (const RegionForce &region : regions) {
    kept_.push_back({region, region.born});
  }
  if (has_dyads_) {
    kept_dyads_.insert(kept_dyads_.end(), dyads.begin(), dyads.end());
    kept_dyads_.resize(kept_.size());
  }
}

ContactCount BlockSums::finish(const BlockSystem &system, const Candidates &candidates) {
  for (std::size_t row = 0; row < system.num_owned; ++row) {
    if (when(BlockIndex{static_cast<std::uint32_t>(row)}) == When::later) {
      sums_[row] = {};
      if (system.is_deformable(row)) {
        gradients_[system.deformation_begin[row]] = {};
      }
    }
  }
  ContactCount count = count_;
  const auto add_kept = [&](std::uint32_t number) {
    const RegionRange range = kept_range_[number];
    if (range.count == 0) {
      return;
    }
    const CandidatePair &pair = candidates.pairs[number];
    const std::array<BlockIndex, 2> rows{pair.lower, pair.higher};
    count += counted(system, pair, kept_[range.begin].born);
    for (std::size_t i = range.begin; i < range.begin + range.count; ++i) {
      for (const std::size_t k : {0U, 1U}) {
        if (when(rows[k]) == When::later) {
          add_region(kept_[i].sums, k, sums_[rows[k].value]);
          if (has_dyads_) {
            add_dyads(system, rows[k], kept_dyads_[i][k]);
          }
        }
      }
    }
  };
  if (keep_ == Keep::all) {
    for (std::uint32_t pair = 0; pair < candidates.pairs.size(); ++pair) {
      add_kept(pair);
    }
  } else {
    std::for_each(candidates.waiting.begin(), candidates.waiting.end(), add_kept);
  }
  return count;
}

double BlockSums::largest_force() const {
  return std::sqrt(std::accumulate(
      kept_.begin(), kept_.end(), largest_squared_,
      [](double largest, const KeptRegion &kept) { return std::max(largest, squared(kept.sums.force)); }));
}

} // namespace gcpdda
