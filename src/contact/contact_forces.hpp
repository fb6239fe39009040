#pragma once

// Contact forces of all candidate pairs at the trial configuration: of plain pairs several at a time
// (plain_pairs.hpp), of all others one after the other (pair_forces.hpp), each block's sum in the order of
// block ids.

#include "base/instructions.hpp"
#include "contact/block_sums.hpp"
#include "contact/candidates.hpp"
#include "contact/force_report.hpp"
#include "contact/pair_forces.hpp"
#include "contact/plain_pairs.hpp"
#include "contact/region_sums.hpp"
#include "contact/resting_groups.hpp"
#include "contact/resting_rows.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace gcpdda {

/// Evaluates pairs; buffers live as long as it does.
class ContactForces {
public:
  explicit ContactForces(ContactParameters parameters, Instructions instructions = Instructions::widest);

  [[nodiscard]] const ContactParameters &parameters() const { return *parameters_; }

  /// Forces of all candidates at the posed trial configuration, from velocities v_n and the regions' memory,
  /// which moves on to this configuration.
  ForceReport evaluate(BlockSystem &system, const Candidates &candidates, ContactHistory &history);

  // evaluate() in parts, for a step that moves blocks while pairs are evaluated in the order of their blocks:
  // begin(), then evaluate_group() for each of Candidates::groups in their order, then evaluate_border().

  /// Fixed rows begin; no pair has been evaluated.
  void begin(BlockSystem &system, const Candidates &candidates);
  /// Rows [first, last), whose trial configurations are posed, begin an evaluation: how they move is found,
  /// from velocities and the increments of their trial configurations, and the sums of owned rows are
  /// cleared. Every owned row below PairGroup::rows_read has begun before evaluate_group().
  void begin_rows(BlockSystem &system, std::size_t first, std::size_t last);
  /// The group's pairs have no ghost, so that they do not wait for the ghosts' trial configurations. After
  /// it, the contacts of owned rows below PairGroup::rows_finished are added, except on rows that wait
  /// (Candidates::is_added), and the other rows below are not read again: their velocities may change.
  void evaluate_group(const BlockSystem &system, const Candidates &candidates, ContactHistory &history,
                      const PairGroup &group);
  /// Pairs with a ghost, after the ghosts have been posed.
  ForceReport evaluate_border(BlockSystem &system, const Candidates &candidates, ContactHistory &history);

  /// What the regions do to the blocks; of blocks that wait only once it is finished.
  [[nodiscard]] BlockSums &sums() { return sums_; }
  [[nodiscard]] const BlockSums &sums() const { return sums_; }
  ContactCount finish_sums(const BlockSystem &system, const Candidates &candidates) {
    return sums_.finish(system, candidates);
  }

  // Regions with their details are found group by group, from what the last evaluation left behind: as long
  // as trial configuration and candidates are those of it.

  /// visit(pair, its regions) for those of pairs [first, last) that touch, in ascending order. Regions are
  /// numbered as in ContactHistory.
  template <class Visit>
  void for_regions(const BlockSystem &system, const Candidates &candidates, const ContactHistory &history,
                   std::uint32_t first, std::uint32_t last, Visit &&visit) {
    for (std::uint32_t begin = first, end = first; begin < last; begin = end) {
      end = std::min(last, (begin / PlainPair::pairs_in_group + 1) * PlainPair::pairs_in_group);
      find_details(system, candidates, history, begin, end);
      for (std::uint32_t pair = begin; pair < end; ++pair) {
        if (const std::span<RegionForce> regions = at_hand(candidates, pair); !regions.empty()) {
          visit(pair, std::span<const RegionForce>(regions));
        }
      }
    }
  }

  /// Evaluations from here on leave the details of all regions behind, 160 bytes a candidate pair: for what
  /// needs them after each evaluation. Else for_regions() finds them group by group, at the cost of another
  /// evaluation.
  void keep_details(bool keeps) { plain_.keep_details(keeps); }
  [[nodiscard]] bool keeps_details() const { return plain_.keeps_details(); }
  /// Evaluations from here on leave out pairs of two rows at rest (resting_rows.hpp), to the same bits.
  /// Details are kept as long.
  void leave_out_resting(bool leaves_out) {
    resting_.set_used(leaves_out);
    keep_details(leaves_out || keeps_details());
  }
  /// Candidates or rows are others from here on.
  void forget_resting() {
    resting_.forget();
    groups_.forget();
    sums_.drop_all();
  }
  /// visit(pair, number of its region, details) for all regions of a pair in the last evaluation.
  template <class Visit>
  void for_kept_details(const Candidates &candidates, const ContactHistory &history, std::uint32_t pair,
                        Visit &&visit) const {
    if (!candidates.pairs[pair].is_plain) {
      std::uint32_t k = 0;
      for (const RegionForce &force : pairs_.regions(ranges_[pair].begin, ranges_[pair].count)) {
        visit(pair, k++, static_cast<const RegionDetails &>(force));
      }
    } else if (history.has_plain(pair)) {
      visit(pair, 0U, plain_.kept(pair));
    }
  }

  /// The shear of a region may be replaced by friction alone, also in its memory: for the initial state.
  class ShearToSet {
  public:
    ShearToSet(const BlockSystem &system, const CandidatePair &pair, RegionForce &force, RegionDyads *dyads,
               RegionState &memory);
    /// @param shear  N/m
    void set(double shear);

    const CandidatePair &pair;
    const RegionForce &force;
    RegionState &memory;
    Vec2 tangent;
    Vec2 arm_lower; ///< of the grip from the trial centroids
    Vec2 arm_higher;

  private:
    RegionForce &changing_;
    RegionDyads *dyads_; ///< of deformable blocks
  };
  /// change(ShearToSet) for all regions; sums are made anew and to be finished once more.
  template <class Change>
  void change_shear(const BlockSystem &system, const Candidates &candidates, ContactHistory &history,
                    Change &&change) {
    const auto all = static_cast<std::uint32_t>(candidates.pairs.size());
    sums_.start_again();
    is_changing_ = true;
    for (std::uint32_t begin = 0, end = 0; begin < all; begin = end) {
      end = std::min(all, begin + PlainPair::pairs_in_group);
      find_details(system, candidates, history, begin, end);
      for (std::uint32_t pair = begin; pair < end; ++pair) {
        const std::span<RegionForce> regions = at_hand(candidates, pair);
        for (std::size_t k = 0; k < regions.size(); ++k) {
          change(ShearToSet(system, candidates.pairs[pair], regions[k],
                            dyads_at_hand(system, candidates, pair, k), history.state(pair, k)));
          put_sums(candidates, pair, k, regions[k]);
        }
      }
      sums_.close_group(system, candidates, begin / PlainPair::pairs_in_group, plain_.batch());
    }
    is_changing_ = false;
  }

  /// What slip has done against the pressure in the last evaluation, off the work of friction in the ledger
  /// of each block.
  void add_opening_works(const Candidates &candidates, BlockSystem &system) {
    pairs_.add_opening_works(candidates, system);
  }

private:
  /// Of an entry of Candidates::plain whose region must choose among laws.
  void evaluate_choice(const PlainWork &work, std::uint32_t entry);
  void evaluate_general_pairs(const BlockSystem &system, const Candidates &candidates,
                              ContactHistory &history, std::span<const std::uint32_t> pairs);
  void evaluate_general_pair(const BlockSystem &system, const Candidates &candidates, std::uint32_t number,
                             std::span<RegionMemory> old);
  /// Entries [first, last) of Candidates::plain, at most PlainPair::pairs_in_group.
  void evaluate_plain_pairs(const BlockSystem &system, const Candidates &candidates, ContactHistory &history,
                            std::size_t first, std::size_t last);
  /// Of pairs [first, last), which are of one group.
  void find_details(const BlockSystem &system, const Candidates &candidates, const ContactHistory &history,
                    std::uint32_t first, std::uint32_t last);
  /// Those of a pair of the group at hand.
  std::span<RegionForce> at_hand(const Candidates &candidates, std::uint32_t pair);
  RegionDyads *dyads_at_hand(const BlockSystem &system, const Candidates &candidates, std::uint32_t pair,
                             std::size_t number);
  /// A pair that is not plain and is left out.
  void keep_general_pair(const BlockSystem &system, const Candidates &candidates, std::uint32_t number,
                         std::span<const RegionMemory> old);
  void put_sums(const Candidates &candidates, std::uint32_t pair, std::size_t number,
                const RegionForce &force);

  std::shared_ptr<const ContactParameters> parameters_;
  PlainPairs plain_;
  PairForces pairs_; ///< those that are not plain
  BlockSums sums_;
  RestingRows resting_;
  RestingGroups groups_;
  std::vector<RegionRange> ranges_;        ///< of the regions of pairs_, by pair that is not plain
  std::vector<RegionRange> ranges_before_; ///< the same at the evaluation before, where regions stay
  std::vector<RegionRange> next_;          ///< what ContactHistory::ranges becomes; afterwards what it was
  std::int64_t evaluations_ = 0;           ///< of pairs that are not plain, so far
  bool is_changing_ = false;               ///< change_shear() is at work
  std::vector<Mat2> velocity_gradients_;   ///< 1/s, by entry of BlockSystem::deformation
};

/// The trial configuration that comes next, seen from the last one.
class ComingConfiguration {
public:
  /// @param system  has moved on to it
  explicit ComingConfiguration(const BlockSystem &system);
  /// Slide along t_r of what is the contact point with this normal in the last one.
  /// @param system  is back in the last one
  [[nodiscard]] double slide(const BlockSystem &system, const CandidatePair &pair, Vec2 point,
                             Vec2 normal) const;

private:
  std::vector<RigidDof> steps_; ///< by row
  std::vector<Mat2> turns_;     ///< by entry of BlockSystem::deformation
};

} // namespace gcpdda
