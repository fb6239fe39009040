#pragma once

// Plain pairs (candidates.hpp): which of them are evaluated together, by which kernel, and where what they do
// goes.
//
// A step needs of a plain pair what its region does to the blocks, and its memory. Where it acts, in which
// direction, how deep: that is wanted at the start, for frames and for rows of energies. It follows from the
// trial configuration, the velocities in motions and the memory that the evaluation left behind, by the same
// operations in the same order, but without another slide; so a group of pairs is evaluated once more, read,
// and overwritten by the next one.

#include "contact/block_sums.hpp"
#include "contact/candidates.hpp"
#include "contact/force_report.hpp"
#include "contact/lanes/plain_batch.hpp"
#include "contact/region_sums.hpp"
#include "contact/resting_groups.hpp"
#include "model/contact_history.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace gcpdda {

/// What plain pairs are evaluated from, and where what they do goes.
struct PlainWork {
  PlainScene scene;
  BlockSums &sums;
  const RestingRows &resting;
  std::span<RegionState> memory; ///< by pair
  std::span<Vec2> grips;         ///< by pair, where a block deforms
  bool has_dyads = false;        ///< details are wanted with the dyads of deformable blocks
};

/// Evaluates plain pairs; buffers live as long as it does.
class PlainPairs {
public:
  PlainPairs(std::shared_ptr<const ContactParameters> parameters, Instructions instructions);

  [[nodiscard]] PlainBatch &batch() const { return *batch_; }
  [[nodiscard]] PlainScene scene_of(const BlockSystem &system, const Candidates &candidates,
                                    const ContactHistory &history, std::span<const Mat2> velocity_gradients,
                                    bool is_known) const;

  /// No pair has been evaluated.
  void begin(const Candidates &candidates);
  /// Entries [first, last) of Candidates::plain, at most PlainPair::pairs_in_group.
  /// @return those whose region must choose among laws: they are evaluated by themselves, and stored
  std::span<const std::uint32_t> evaluate(const PlainWork &work, std::size_t first, std::size_t last);
  void store_choice(const PlainWork &work, std::uint32_t entry, const RegionForce &force,
                    const RegionMemory &memory, std::span<const RegionDyads> dyads);
  /// A group of pairs of rows at rest, as RestingGroups::rests() says: they keep what they have.
  void keep_group(const ContactHistory &history, std::uint32_t number, const RestingGroups::Kept &kept);
  /// Of the last entries that were evaluated; none where not all of them kept what they had.
  [[nodiscard]] const std::optional<RestingGroups::Kept> &kept() const { return kept_here_; }
  /// All pairs have been evaluated.
  /// @param overlaps  become those of this evaluation
  ForceReport finish(std::vector<PlainOverlap> &overlaps);

  /// Of the pairs [first, last), which are of one group, once the evaluation is over.
  void find_details(const PlainWork &work, std::uint32_t first, std::uint32_t last);
  /// That of a pair of the group at hand, or none.
  [[nodiscard]] std::span<RegionForce> at_hand(std::uint32_t pair);

  /// Evaluations from here on leave the details of all regions behind, 160 bytes a candidate pair.
  void keep_details(bool keeps);
  [[nodiscard]] bool keeps_details() const { return keeps_details_; }
  /// Of a pair that touches, if they are kept.
  [[nodiscard]] const RegionDetails &kept(std::uint32_t pair) const { return details_[pair]; }

private:
  /// The overlap that a kernel supposes: one corner of each block; some other polygon, as in the step before
  /// or for certain.
  enum class Way { corners, polygon_as_before, polygon };
  PlainLanes lanes_of(const PlainScene &scene, std::span<const std::uint32_t> entries);
  /// Places for the lanes that touch.
  PlainResults open_regions(const PlainWork &work, const PlainLanes &lanes, unsigned touching,
                            PlainOverlap overlap);
  /// What the batch at hand found for the lanes that touch, as regions and their memory.
  void store_alike(const PlainWork &work, const PlainLanes &lanes, unsigned touching, PlainOverlap overlap);
  /// Once more, with details.
  void store_again(const PlainWork &work, const PlainLanes &lanes, unsigned touching);
  void evaluate_alike(const PlainWork &work, std::span<const std::uint32_t> entries, Way way);
  void evaluate_all(const PlainWork &work, std::span<const std::uint32_t> entries, Way way);
  /// Evaluate corners_ and polygons_.
  void evaluate_known(const PlainWork &work);
  void evaluate_without_region(const PlainWork &work);
  /// Entries [first, last) whose boxes meet, and what those at rest keep.
  void find_meeting(const PlainWork &work, std::size_t first, std::size_t last);
  /// Does an entry keep what the evaluation before has found? Then it is there.
  bool keeps(const PlainWork &work, std::size_t entry, RestingGroups::Kept &kept);

  std::shared_ptr<const ContactParameters> parameters_;
  std::unique_ptr<PlainBatch> batch_;
  // Entries of Candidates::plain whose boxes meet, by the overlap each pair had in the last evaluation.
  std::vector<std::uint32_t> corners_;
  std::vector<std::uint32_t> polygons_;       ///< the overlap was some other polygon
  std::vector<std::uint32_t> remaining_;      ///< no longer an overlap of corners
  std::vector<std::uint32_t> without_region_; ///< the blocks did not touch
  std::vector<std::uint32_t> choosing_;       ///< their region must choose among laws
  std::array<CandidatePair, most_lanes> own_; ///< constants of mixed pairs at hand, by lane
  std::vector<PlainOverlap> overlaps_;        ///< what those of the history become; afterwards what they were
  ForceReport report_;                        ///< of what has been evaluated so far
  RestingGroups::Kept kept_;                  ///< of pairs that are left out
  std::optional<RestingGroups::Kept> kept_here_; ///< as kept() says
  std::vector<RegionForce> again_;               ///< details of the group at hand
  std::vector<std::uint32_t> places_;            ///< in again_, by pair of the group at hand
  bool keeps_details_ = false;
  std::vector<RegionDetails> details_; ///< by pair that touches, if they are kept
};

} // namespace gcpdda
