#pragma once

// Contact forces of plain pairs (candidates.hpp), several at a time. The laws are those of
// pair_forces.hpp, for convex blocks: one region a pair.

#include "base/instructions.hpp"
#include "contact/candidates.hpp"
#include "contact/region_sums.hpp"
#include "model/block_system.hpp"
#include "model/contact_history.hpp"

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

namespace gcpdda {

/// What plain pairs are evaluated from.
struct PlainScene {
  const BlockSystem &system;
  const Candidates &candidates;
  const ContactHistory &history;
  std::span<const Mat2> velocity_gradients; ///< 1/s, by entry of BlockSystem::deformation
  double damping_ratio = 0.0;
  double stiffness_damping = 0.0;
  bool is_known = false; ///< the memories are those that this evaluation left behind: only details are wanted
};

/// Up to as many pairs as there are lanes, with like numbers of edges, all rigid or none; lanes beyond repeat
/// the last one.
struct PlainLanes {
  std::size_t count = 0;
  std::array<const PlainPair *, most_lanes> pair;
  std::array<const CandidatePair *, most_lanes> constants;
  std::array<const RegionState *, most_lanes> memory; ///< no_memory where there is none
  std::array<const Vec2 *, most_lanes> grip;          ///< of pairs with a deformable block

  static const RegionState no_memory; ///< has a slip below 0
  static constexpr Vec2 no_grip{};
};

/// Where results go, by lane.
struct PlainResults {
  unsigned wanted = 0; ///< bits of the lanes someone asks for, which touch; other places are not looked at
  std::array<RegionSums *, most_lanes> sums;
  std::array<RegionState *, most_lanes> memory;
  bool has_mixed = false; ///< some pair has a choice of laws: its memory keeps its own
  bool has_details = false;
  std::array<RegionDetails *, most_lanes> details;
  bool has_dyads = false; ///< the blocks deform
  std::array<RegionDyads *, most_lanes> dyads;
  std::array<Vec2 *, most_lanes> grips; ///< of blocks that deform
};

/// A group of plain pairs that have all been evaluated.
struct GroupToAdd {
  static constexpr std::uint8_t touches = 1; ///< bit of `seen`

  const CandidatePair *pairs; ///< its first one
  std::span<const std::uint8_t, PlainPair::pairs_in_group> seen;
  // Of those that touch.
  const RegionSums *regions;
  const RegionDyads *dyads; ///< null where no block deforms
  // Of blocks: of the owned rows, by entry of BlockSystem::deformation, of all rows.
  std::span<BlockContactSum> sums;
  std::span<Deformation> deformations;
  const RowOffsets &deformation_begin;
  const BlockMotion *motions;
  std::span<const std::uint8_t> is_added; ///< Candidates::is_added, if some of the blocks wait
  // What comes of it.
  std::size_t num_waiting = 0;
  std::array<std::uint16_t, PlainPair::pairs_in_group> waiting{}; ///< slots of pairs with a block that waits
  std::int64_t num_touching = 0;                                  ///< other pairs
  double largest_squared = 0.0; ///< of the forces of their regions and what it was before, (N/m)^2
};

/// Evaluates as many pairs at once as the registers of its instructions hold. All instructions give the same
/// bits: each operation is rounded by itself.
class PlainBatch {
public:
  virtual ~PlainBatch() = default;
  [[nodiscard]] virtual std::size_t width() const = 0;
  /// How rigid rows move, as many from `first` on as there are lanes.
  /// @return false, and nothing is written, where one turns by more than a series reaches
  virtual bool find_motions(BlockSystem &system, std::size_t first) const = 0;
  /// The same of deformable rows.
  virtual void find_deforming_motions(BlockSystem &system, std::size_t first,
                                      std::span<Mat2> velocity_gradients) const = 0;
  /// What an evaluation says of each lane, by bits.
  struct Seen {
    unsigned touching = 0;
    unsigned meeting = 0;      ///< the boxes do
    unsigned apart = 0;        ///< the blocks are seen not to touch
    unsigned with_corners = 0; ///< of each block one corner is in the other one: evaluate_corners() may do
  };
  /// Whatever the overlap is.
  virtual Seen evaluate(const PlainScene &scene, const PlainLanes &lanes) = 0;
  /// The same with far less work, where PlainPair::Kind::may_be_corners, for those that overlap with one
  /// corner of each block (lane_corners.hpp). Others do not touch; some are seen to be apart, the rest is
  /// left to evaluate().
  virtual Seen evaluate_corners(const PlainScene &scene, const PlainLanes &lanes) = 0;
  /// Energies by lane, m3; see find_energies.
  struct Energies {
    unsigned known = 0; ///< by bits
    std::array<double, most_lanes> energy;
  };
  /// Of pairs that overlap with one corner of each block, where PlainPair::Kind::may_be_corners.
  virtual Energies find_corner_energies(const BlockSystem &system, const Candidates &candidates,
                                        const PlainLanes &lanes) = 0;
  /// Of most others of blocks with no more than most_corner_edges edges.
  virtual Energies find_energies(const BlockSystem &system, const Candidates &candidates,
                                 const PlainLanes &lanes) = 0;
  /// Write the sums, all of the details but pair, birth and bond, and of the memory what two convex blocks
  /// need; its law is that of a pair which has only one.
  /// @return bit i is set where the overlap of lane i exceeds what is allowed
  virtual unsigned store(const PlainResults &results) = 0;
  /// Thickness of the overlap in a lane that touches, m.
  [[nodiscard]] virtual double overlap(std::size_t lane) const = 0;
  /// Of all that has been stored since these were taken last.
  struct Extremes {
    std::int64_t normals_undefined = 0;
    double max_overlap = 0.0;
    double max_overlap_share = 0.0;
  };
  virtual Extremes take_extremes() = 0;
  /// On each block in the order of the pairs.
  virtual void add_group(GroupToAdd &group) const = 0;
};

/// Visit the numbers of the bits that are set, the least first.
template <class Visit> void for_bits(unsigned bits, Visit &&visit) {
  for (; bits != 0; bits &= bits - 1) {
    visit(static_cast<std::size_t>(std::countr_zero(bits)));
  }
}

std::unique_ptr<PlainBatch> make_plain_batch(Instructions instructions);
// With these instructions, where GCPDDA_HAS_COPIES.
std::unique_ptr<PlainBatch> make_avx2_batch();
std::unique_ptr<PlainBatch> make_avx512_batch();

} // namespace gcpdda
