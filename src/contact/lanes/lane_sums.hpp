#pragma once

// What the pairs of a group do to their blocks, added up with one contact after the other, each in registers
// of four numbers: to the bits of BlockSums::finish().

#include "base/lanes.hpp"
#include "contact/lanes/plain_batch.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace gcpdda::GCPDDA_INSTRUCTIONS {

using Four = double __attribute__((vector_size(4 * sizeof(double))));

[[gnu::always_inline]] inline void load_four_at(const double *from, Four &four) {
  std::memcpy(&four, from, sizeof(four));
}
[[gnu::always_inline]] inline void store_four_at(double *to, const Four &four) {
  std::memcpy(to, &four, sizeof(four));
}

/// RegionSums: force and torques, then those of friction, then those of dashpots.
struct RegionAtHand {
  Four force;
  Four shear;
  Four damping;

  [[gnu::always_inline]] explicit RegionAtHand(const RegionSums &region) {
    load_four_at(&region.force.x, force);
    load_four_at(&region.shear_force.x, shear);
    load_four_at(&region.damping_force.x, damping);
    static_assert(
        offsetof(RegionSums, torque) == offsetof(RegionSums, force) + 2 * sizeof(double) &&
        offsetof(RegionSums, shear_torque) == offsetof(RegionSums, shear_force) + 2 * sizeof(double) &&
        offsetof(RegionSums, damping_torque) == offsetof(RegionSums, damping_force) + 2 * sizeof(double));
  }
};

/// A BlockContactSum.
struct SumAtHand {
  Four first;
  Four second;
  double last;

  static_assert(sizeof(BlockContactSum) == 9 * sizeof(double) && sizeof(RigidDof) == 3 * sizeof(double));
  [[gnu::always_inline]] static double *begin_of(BlockContactSum &sum) { return &sum.force.u.x; }
  [[gnu::always_inline]] void load(BlockContactSum &sum) {
    load_four_at(begin_of(sum), first);
    load_four_at(begin_of(sum) + 4, second);
    last = begin_of(sum)[8];
  }
  [[gnu::always_inline]] void store(BlockContactSum &sum) const {
    store_four_at(begin_of(sum), first);
    store_four_at(begin_of(sum) + 4, second);
    begin_of(sum)[8] = last;
  }
  [[gnu::always_inline]] void add_to_lower(const RegionAtHand &r) {
    first += __builtin_shufflevector(r.force, r.shear, 0, 1, 2, 4);
    second += __builtin_shufflevector(r.shear, r.damping, 1, 2, 4, 5);
    last += r.damping[2];
  }
  [[gnu::always_inline]] void add_to_higher(const RegionAtHand &r) {
    first -= Four{1.0, 1.0, -1.0, 1.0} * __builtin_shufflevector(r.force, r.shear, 0, 1, 3, 4);
    second -= Four{1.0, -1.0, 1.0, 1.0} * __builtin_shufflevector(r.shear, r.damping, 1, 3, 4, 5);
    last += r.damping[3];
  }
};

/// A BlockGradientSum.
struct GradientAtHand {
  std::array<Four, 3> dyad;

  static_assert(sizeof(BlockGradientSum) == 3 * sizeof(Four));
  [[gnu::always_inline]] void load(const BlockGradientSum &sum) {
    for (std::size_t k = 0; k < 3; ++k) {
      load_four_at(&sum.force.xx + 4 * k, dyad[k]);
    }
  }
  [[gnu::always_inline]] void store(BlockGradientSum &sum) const {
    for (std::size_t k = 0; k < 3; ++k) {
      store_four_at(&sum.force.xx + 4 * k, dyad[k]);
    }
  }
  [[gnu::always_inline]] void add_to_lower(const GradientAtHand &of_region) {
    for (std::size_t k = 0; k < 3; ++k) {
      dyad[k] += of_region.dyad[k];
    }
  }
  /// As on_higher().
  [[gnu::always_inline]] void add_to_higher(const GradientAtHand &of_region, const RegionAtHand &r,
                                            const Vec2 &apart) {
    const Four arm{apart.x, apart.x, apart.y, apart.y};
    const auto add = [&](std::size_t k, const Four &force) __attribute__((always_inline)) {
      dyad[k] -= of_region.dyad[k] + arm * __builtin_shufflevector(force, force, 0, 1, 0, 1);
    };
    add(0, r.force);
    add(1, r.shear);
    add(2, r.damping);
  }
};

/// What a block has of its contacts, while it is the lower one of pairs that follow one another: what it gets
/// as the higher block of others has been added before.
template <class AtHand, class Sum> class LowerSum {
public:
  [[gnu::always_inline]] LowerSum() : of_(&none_) { at_hand_.load(none_); }
  [[gnu::always_inline]] AtHand &of(Sum *sum) {
    sum = sum == nullptr ? &none_ : sum;
    if (sum != of_) {
      at_hand_.store(*of_);
      at_hand_.load(*sum);
      of_ = sum;
    }
    return at_hand_;
  }
  [[gnu::always_inline]] void close() { at_hand_.store(*of_); }

private:
  Sum none_;
  Sum *of_;
  AtHand at_hand_;
};

/// Adds a group's regions to the sums of its blocks.
template <bool has_dyads, bool some_wait> class GroupAdder {
public:
  [[gnu::always_inline]] explicit GroupAdder(GroupToAdd &group)
      : group_(group), num_owned_(group.sums.size()) {}
  /// @return false where one of the blocks waits: then the pair has only been added to the other one
  [[gnu::always_inline]] bool add(std::size_t slot, const RegionAtHand &region) {
    const CandidatePair &pair = group_.pairs[slot];
    lower_.of(sum_of(pair.lower.value)).add_to_lower(region);
    if (BlockContactSum *sum = sum_of(pair.higher.value)) {
      SumAtHand higher;
      higher.load(*sum);
      higher.add_to_higher(region);
      higher.store(*sum);
    }
    if constexpr (has_dyads) {
      add_dyads(pair, slot, region);
    }
    return !(some_wait && (waits(pair.lower.value) || waits(pair.higher.value)));
  }
  [[gnu::always_inline]] void close() {
    lower_.close();
    lower_gradient_.close();
  }

private:
  [[gnu::always_inline]] void add_dyads(const CandidatePair &pair, std::size_t slot,
                                        const RegionAtHand &region) {
    GradientAtHand dyads;
    dyads.load(group_.dyads[slot]);
    lower_gradient_.of(gradient_of(pair.lower.value)).add_to_lower(dyads);
    if (BlockGradientSum *sum = gradient_of(pair.higher.value)) {
      GradientAtHand higher;
      higher.load(*sum);
      higher.add_to_higher(dyads, region,
                           group_.motions[pair.lower.value].centroid -
                               group_.motions[pair.higher.value].centroid);
      higher.store(*sum);
    }
  }
  [[nodiscard, gnu::always_inline]] bool gets_it(std::size_t row) const {
    return row < num_owned_ && (!some_wait || group_.is_added[row] != 0);
  }
  [[nodiscard, gnu::always_inline]] bool waits(std::size_t row) const {
    return row < num_owned_ && !gets_it(row);
  }
  [[gnu::always_inline]] BlockContactSum *sum_of(std::size_t row) {
    return gets_it(row) ? &group_.sums[row] : nullptr;
  }
  [[gnu::always_inline]] BlockGradientSum *gradient_of(std::size_t row) {
    const std::uint32_t entry = group_.deformation_begin[row];
    return gets_it(row) && entry < group_.deformation_begin[row + 1] ? &group_.deformations[entry].contact
                                                                     : nullptr;
  }

  GroupToAdd &group_;
  std::size_t num_owned_;
  LowerSum<SumAtHand, BlockContactSum> lower_;
  LowerSum<GradientAtHand, BlockGradientSum> lower_gradient_;
};

template <bool has_dyads, bool some_wait> inline void add_pairs(GroupToAdd &group) {
  static_assert(std::endian::native == std::endian::little);
  GroupAdder<has_dyads, some_wait> adder(group);
  double largest_squared = group.largest_squared;
  for (std::size_t first = 0; first < group.seen.size(); first += sizeof(std::uint64_t)) {
    std::uint64_t seen = 0;
    std::memcpy(&seen, &group.seen[first], sizeof(seen));
    for (seen &= 0x0101010101010101U * GroupToAdd::touches; seen != 0; seen &= seen - 1) {
      const std::size_t slot = first + static_cast<std::size_t>(std::countr_zero(seen)) / 8;
      const RegionAtHand region(group.regions[slot]);
      if (!adder.add(slot, region)) {
        group.waiting[group.num_waiting++] = static_cast<std::uint16_t>(slot);
        continue;
      }
      const double squared = region.force[0] * region.force[0] + region.force[1] * region.force[1];
      largest_squared = std::max(largest_squared, squared);
      ++group.num_touching;
    }
  }
  adder.close();
  group.largest_squared = largest_squared;
}

} // namespace gcpdda::GCPDDA_INSTRUCTIONS
