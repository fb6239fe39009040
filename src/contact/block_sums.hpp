#pragma once

// What contacts do to each owned block, added up while their regions are still in the cache.
//
// A block adds its contacts in the order of its partners' ids, or its last bits would depend on the ranks.
// Pairs ascend by (lower id, higher id), so a block meets its partners in that order if its pairs are added
// as they ascend. Plain pairs without a ghost are evaluated by groups that ascend: what a group does is added
// at once, and its regions are overwritten by those of the next one. Blocks that have some other pair as well
// have to wait for it (Candidates::is_added); regions on them are kept, and finish() adds them. These are
// few: blocks at the border of a domain, and those of odd shape. All plain pairs with a ghost wait, so they
// need no groups: so few would leave many lanes empty.
//
// Where pairs of rows at rest are left out (resting_rows.hpp), regions of all groups stay, and are added once
// more at each evaluation.

#include "contact/candidates.hpp"
#include "contact/region_sums.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace gcpdda {

class PlainBatch;

/// Pairs that touch and count on this rank.
struct ContactCount {
  std::int64_t touching = 0;
  std::int64_t crossing = 0;        ///< the other block is a ghost
  std::int64_t crossing_formed = 0; ///< and they did not touch at the evaluation before

  ContactCount &operator+=(const ContactCount &other);
};

/// One rank counts what is known of a pair.
bool counts_here(const BlockSystem &system, BlockIndex lower);

class BlockSums {
public:
  /// Onto BlockSystem::contact and Deformation::contact of owned rows, which are cleared before their first
  /// contact.
  /// @param keeps  regions stay, so that keep_again() finds them at the next evaluation
  void start(BlockSystem &system, const Candidates &candidates, bool keeps);
  static void clear(BlockSystem &system, std::size_t first, std::size_t last);
  /// The same regions are added once more, because they have changed: kept ones stay where they are.
  void start_again();

  /// Place for what the only region of a plain pair of the group at hand does.
  RegionSums &open(std::uint32_t pair, bool born) {
    const std::size_t slot = slot_of(pair);
    seen_[slot] = static_cast<std::uint8_t>(born ? touches | is_born : touches);
    return group_[slot];
  }
  RegionDyads &dyads(std::uint32_t pair) { return group_dyads_[slot_of(pair)]; }
  /// Where regions stay, a plain pair of the group at hand is evaluated anew ...
  void drop(std::uint32_t pair) { seen_[slot_of(pair)] = 0; }
  /// ... or does what it did.
  void keep_again(std::uint32_t pair) { seen_[slot_of(pair)] &= touches; }
  /// No plain pair does anything.
  void drop_all() { std::fill(seen_.begin(), seen_.end(), std::uint8_t{0}); }
  /// All pairs of a group have been evaluated.
  void close_group(const BlockSystem &system, const Candidates &candidates, std::uint32_t number,
                   const PlainBatch &batch);
  /// Now come so many plain pairs with a ghost.
  void begin_border(std::size_t num_plain);
  /// Place for what the only region of one of them does, until one is opened that is not.
  /// @param place  of its number in Candidates::waiting
  RegionSums &open_border(std::size_t place, bool born) {
    kept_range_[place] = {static_cast<std::uint32_t>(kept_.size()), 1};
    if (has_dyads_) {
      kept_dyads_.emplace_back();
    }
    kept_.push_back({RegionSums{}, born});
    return kept_.back();
  }
  /// Of the last one opened.
  RegionDyads &border_dyads() { return kept_dyads_.back(); }
  /// The pair at this place of Candidates::waiting does what it did.
  void keep_waiting_again(std::size_t place);
  /// All regions of some other pair.
  /// @param dyads  theirs, or none
  void keep(std::uint32_t pair, std::span<const RegionForce> regions, std::span<const RegionDyads> dyads);
  /// All regions of some other pair do what they did.
  void keep_again_other(std::uint32_t pair) { keep_waiting_again(place_of(pair)); }
  /// What waits.
  ContactCount finish(const BlockSystem &system, const Candidates &candidates);

  /// Region `number` of a pair that is not plain, as it is kept.
  RegionSums &kept(std::uint32_t pair, std::size_t number) { return kept_[range_of(pair).begin + number]; }
  /// Null where no block deforms.
  RegionDyads *kept_dyads(std::uint32_t pair, std::size_t number) {
    return has_dyads_ ? &kept_dyads_[range_of(pair).begin + number] : nullptr;
  }

  /// By row of the owned blocks.
  [[nodiscard]] std::span<BlockContactSum> of_blocks() { return sums_; }
  [[nodiscard]] std::span<const BlockContactSum> of_blocks() const { return sums_; }
  /// Of all regions, N/m; once finished.
  [[nodiscard]] double largest_force() const;

private:
  struct KeptRegion : RegionSums {
    bool born = false;
  };
  // What is seen of a pair, by bits.
  static constexpr std::uint8_t touches = 1;
  static constexpr std::uint8_t is_born = 2;

  /// Does an owned row wait for another pair than those of groups?
  [[nodiscard]] bool waits(BlockIndex row) const {
    return row.value < is_added_.size() && is_added_[row.value] == 0;
  }
  /// The only region of a pair of the group at hand.
  void keep_plain(std::uint32_t pair, const RegionSums &region, bool born);
  /// To the lower (k = 0) or the higher block of a pair, if it deforms.
  void add_dyads(const BlockSystem &system, const CandidatePair &pair, std::size_t k,
                 const RegionDyads &dyads, const RegionSums &region);
  /// In Candidates::waiting, of a pair that waits: mostly one that follows the last one asked for.
  std::size_t place_of(std::uint32_t pair);
  RegionRange &range_of(std::uint32_t pair) { return kept_range_[place_of(pair)]; }
  /// Of a plain pair in the group at hand, or among all pairs.
  [[nodiscard]] std::size_t slot_of(std::uint32_t pair) const {
    return keeps_ ? pair : pair % PlainPair::pairs_in_group;
  }

  bool has_dyads_ = false;
  bool is_again_ = false;
  bool keeps_ = false;
  std::span<const std::uint8_t> is_added_; ///< Candidates::is_added
  std::span<BlockContactSum> sums_;        ///< BlockSystem::contact
  std::span<Deformation> deformations_;    ///< BlockSystem::deformation
  ContactCount count_;                     ///< of pairs that are not kept
  double largest_squared_ = 0.0;           ///< of them
  double largest_waiting_squared_ = 0.0;   ///< of the others
  // Of the group at hand, or of all groups, by pair.
  std::vector<RegionSums> group_;
  std::vector<RegionDyads> group_dyads_; ///< if some block deforms
  std::vector<std::uint8_t> seen_;
  // Regions on blocks that wait.
  std::span<const std::uint32_t> waiting_; ///< Candidates::waiting
  std::vector<RegionRange> kept_range_;    ///< of each of them
  std::size_t last_asked_ = 0;
  std::vector<KeptRegion> kept_;
  std::vector<RegionDyads> kept_dyads_;
  // Those of the evaluation before, where they stay.
  std::vector<RegionRange> range_before_;
  std::vector<KeptRegion> before_;
  std::vector<RegionDyads> dyads_before_;
};

} // namespace gcpdda
