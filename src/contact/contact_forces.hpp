#pragma once

// Contact forces of all candidate pairs at the trial configuration.
//
// Two convex blocks have one contact region; with a re-entrant vertex a pair can have several (regions.hpp),
// each with its own spring. With N the normal force of a region on the block of lower id and P = int p ds:
//     n_r = N/|N|,   t_r = perp(n_r),   l = extent of the pieces along t_r,
//     x_r = int p x ds / P, always in the hull of the patch.
// (The line of action of a resultant runs away when normals nearly cancel.)
//
// Friction is Coulomb with a stick spring. Its elongation is taken from successive TRIAL configurations of
// the two blocks' material points now at x_r:
//     du = (increment of A at x_r) - (increment of B at x_r),
//     F_t += k_t du.t_r,   k_t = ratio k_n max(l so far),
// in the form increment of u + (F*_n - F*_{n-1}) X, for rigid blocks (I - R(-dtheta)) r, which never
// subtracts world positions: a block at rest then creeps by 1e-15 and not 5e-12 m per 100 s. Velocities times
// dt would feed energy into a sticking block, and a k_t that follows the current l gains energy in every
// cycle of opening. F_t is cut at cap = |N| tan(phi) + c l first; the dashpot adds to it and the sum is cut
// again. A region's spring turns with t_r, dies with the region, and gets no increment in the step of its
// birth. On a pair with a deformable block friction acts, and du is taken, not at x_r but at the region's
// grip, a point that is fixed in the material as long as the joint sticks (src/contact/laws/grip.hpp). Of
// several regions of a pair each finds its memory among those between the same stretches of the two outlines
// that lie within reach of the old and the new extent in the lower block's axes: the nearest two of all
// first.
//
// The normal dashpot is distributed: on each piece with outward normal n of its own block and u = -n_r (lower
// block) or n_r (higher), w = max(0, u.n), the traction q = max(-s w p, (c'/2) w (v_own - v_other).u) acts
// along u. It is linear along the piece and cut exactly where it would exceed what the pressure gives along
// u: w p, times the share s = |N| / sum of int w p ds that pieces facing backwards leave over, so that the
// resultant never pulls. (Cutting at q = -p lets tips and tilted faces pull: their pressure counts only w p
// along u.) Along n_r, not along the piece's normal: there it would drag on the sunk leading side of a
// sliding block.

#include "base/instructions.hpp"
#include "contact/block_sums.hpp"
#include "contact/candidates.hpp"
#include "contact/geometry/overlap.hpp"
#include "contact/opened_regions.hpp"
#include "contact/region_sums.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <tuple>
#include <vector>

namespace gcpdda {

/// Something a step cannot go on with.
struct Fault {
  enum class Cause : std::int32_t { not_finite = 0, too_deep = 1, too_fast = 2 };
  Cause cause = Cause::not_finite;
  BlockId block;
  BlockId other;      ///< invalid where no pair is involved
  double value = 0.0; ///< overlap (m) or motion per step (m)
  double limit = 0.0;

  /// Which of several faults is reported: a choice that does not depend on the ranks.
  friend bool operator<(const Fault &a, const Fault &b) {
    return std::tie(a.block, a.other, a.cause) < std::tie(b.block, b.other, b.cause);
  }
};

/// Keep the first of two faults.
inline void keep_first(std::optional<Fault> &kept, const Fault &fault) {
  if (!kept || fault < *kept) {
    kept = fault;
  }
}

/// What one evaluation of all candidates saw.
struct ForceReport {
  std::int64_t evaluations = 0; ///< pairs whose boxes met
  std::int64_t normals_undefined = 0;
  double max_overlap = 0.0;       ///< m
  double max_overlap_share = 0.0; ///< of the pair's narrowest width
  std::optional<Fault> fault;     ///< the one with the smallest ids
};

class PlainBatch;
struct PlainScene;
struct PlainLanes;
struct PlainResults;

/// Evaluates pairs; buffers live as long as it does.
class ContactForces {
public:
  /// Normals of a region cancel when the resultant falls below this share of the total pressure.
  static constexpr double least_resultant = 0.1;

  explicit ContactForces(ContactParameters parameters, Instructions instructions = Instructions::widest);
  ~ContactForces();
  ContactForces(ContactForces &&) noexcept;
  ContactForces &operator=(ContactForces &&) noexcept;

  [[nodiscard]] const ContactParameters &parameters() const { return parameters_; }

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
  void keep_details(bool keeps);
  [[nodiscard]] bool keeps_details() const { return keeps_details_; }
  /// visit(pair, number of its region, details) for all regions of the last evaluation, by ascending pair.
  template <class Visit>
  void for_kept_details(const Candidates &candidates, const ContactHistory &history, Visit &&visit) const {
    for (std::uint32_t pair = 0; pair < candidates.pairs.size(); ++pair) {
      if (!candidates.pairs[pair].is_plain) {
        for (std::uint32_t k = 0; k < ranges_[pair].count; ++k) {
          visit(pair, k, static_cast<const RegionDetails &>(forces_[ranges_[pair].begin + k]));
        }
      } else if (history.has_plain(pair)) {
        visit(pair, 0U, details_[pair]);
      }
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
      close_group(system, candidates, begin / PlainPair::pairs_in_group);
    }
    is_changing_ = false;
  }

  /// What slip has done against the pressure in the last evaluation, off the work of friction in the ledger
  /// of each block.
  void add_opening_works(const Candidates &candidates, BlockSystem &system);

private:
  struct RelativeVelocity;
  /// A bond of the pair at hand, and what became of it.
  struct BondAtWork;
  /// What bonds leave of the friction of a region.
  struct BondShare {
    bool holds = false;    ///< a bond carries the shear
    bool released = false; ///< one has just broken ...
    double shear = 0.0;    ///< ... and leaves this, N/m
  };

  /// A region that carries something.
  struct FoundRegion {
    const Region *region;
    RegionForce force;   ///< for k_n/2 = 1, without friction and dashpots
    Vec2 position;       ///< RegionMemory::position, of a pair that is not convex
    RegionMemory *known; ///< what goes on in it; null for a new one
  };

  /// The regions of one pair, whatever its shapes and laws, behind all others.
  /// @return how many
  std::size_t append_regions(const BlockSystem &system, const Candidates &candidates, std::uint32_t pair,
                             std::span<RegionMemory> old);
  void evaluate_general_pair(const BlockSystem &system, const Candidates &candidates, std::uint32_t pair,
                             std::span<RegionMemory> old);
  /// Of an entry of Candidates::plain that has no region so far and must choose among laws.
  void evaluate_birth(const BlockSystem &system, const Candidates &candidates, std::uint32_t entry);
  void find_regions(const BlockSystem &system, const Candidates &candidates, std::uint32_t pair,
                    std::span<RegionMemory> old);
  void load_found(const BlockSystem &system, const CandidatePair &pair, std::uint32_t number,
                  const FoundRegion &found);
  void evaluate_general_pairs(const BlockSystem &system, const Candidates &candidates,
                              ContactHistory &history, std::span<const std::uint32_t> pairs);
  void close_group(const BlockSystem &system, const Candidates &candidates, std::uint32_t group);
  /// Entries [first, last) of Candidates::plain, at most PlainPair::pairs_in_group.
  void evaluate_plain_pairs(const BlockSystem &system, const Candidates &candidates,
                            const ContactHistory &history, std::size_t first, std::size_t last);
  /// The overlap that a kernel supposes: one corner of each block; some other polygon, as in the step before
  /// or for certain.
  enum class Way { corners, polygon_as_before, polygon };
  PlainLanes lanes_of(const PlainScene &scene, std::span<const std::uint32_t> entries);
  void evaluate_alike(const PlainScene &scene, std::span<const std::uint32_t> entries, Way way);
  /// Entries [first, last) whose boxes meet.
  void find_meeting(const BlockSystem &system, const Candidates &candidates, const ContactHistory &history,
                    std::size_t first, std::size_t last);
  void evaluate_all(const PlainScene &scene, const std::vector<std::uint32_t> &entries, Way way);
  /// Evaluate corners_ and polygons_.
  void evaluate_known(const PlainScene &scene);
  void evaluate_without_region(const PlainScene &scene);
  /// Places for the lanes that touch.
  PlainResults open_regions(const Candidates &candidates, const PlainLanes &lanes, unsigned touching,
                            PlainOverlap overlap);
  /// What the batch at hand found for the lanes that touch, as regions and their memory.
  void store_alike(const PlainScene &scene, const PlainLanes &lanes, unsigned touching, PlainOverlap overlap);
  /// Once more, with details.
  void store_again(const PlainLanes &lanes, unsigned touching);
  /// Of pairs [first, last), which are of one group.
  void find_details(const BlockSystem &system, const Candidates &candidates, const ContactHistory &history,
                    std::uint32_t first, std::uint32_t last);
  /// Those of a pair of the group at hand.
  std::span<RegionForce> at_hand(const Candidates &candidates, std::uint32_t pair);
  RegionDyads *dyads_at_hand(const BlockSystem &system, const Candidates &candidates, std::uint32_t pair,
                             std::size_t number);
  void put_sums(const Candidates &candidates, std::uint32_t pair, std::size_t number,
                const RegionForce &force);
  /// Visit entries of Candidates::plain that are alike, as many at a time as there are lanes.
  template <class Visit>
  void for_batches(const Candidates &candidates, const ContactHistory &history,
                   std::span<const std::uint32_t> entries, Visit &&visit);
  /// References to other regions hold until the next one is appended.
  RegionForce &append_force(const RegionForce &force = {});
  void drop_last_force() { --num_forces_; }
  /// Regions of the pair at hand that carry something, each with its memory.
  void find_touching(const BlockSystem &system, const CandidatePair &pair, std::span<RegionMemory> old);
  /// Which old region of a pair that is not convex goes on in which new one.
  void match_memories(const BlockSystem &system, const CandidatePair &pair, std::span<RegionMemory> old);
  /// Normal force for k_n/2 = 1, direction and size of a region; false if it carries nothing.
  bool measure(const Region &region, RegionForce &force) const;
  /// The same for the pair's law, with friction and dashpots.
  void load_region(const BlockSystem &system, const CandidatePair &pair, const Region &region,
                   const BondShare &bonds, RegionMemory &memory, RegionForce &force);
  /// Stretch the pair's bonds and see which of them hold.
  void find_bonds(const BlockSystem &system, const CandidatePair &pair, std::span<const Piece> pieces,
                  std::span<const RegionMemory> memory);
  [[nodiscard]] BondShare share_of_bonds(const CandidatePair &pair, const Region &region) const;
  /// Those that hold as regions of their own.
  void append_bonds(const BlockSystem &system, const CandidatePair &pair, std::uint32_t number);
  /// The pair at hand with `opening` taken out, and its region that goes on with this memory.
  const Region *find_opened(const BlockSystem &system, const CandidatePair &pair, const RegionMemory &memory,
                            Vec2 opening);
  void evaluate_opened(const BlockSystem &system, const CandidatePair &pair, std::uint32_t number,
                       const RegionMemory &known);
  void keep_open(const BlockSystem &system, const CandidatePair &pair, std::uint32_t number,
                 const RegionMemory &known);
  void add_friction(const BlockSystem &system, const CandidatePair &pair, const RelativeVelocity &velocity,
                    const BondShare &bonds, RegionMemory &memory, RegionForce &force);
  void slip(const BlockSystem &system, const CandidatePair &pair, const JointLaw &law, double stiffness,
            RegionMemory &memory, const RegionForce &force);
  void add_normal_dashpot(const CandidatePair &pair, const RelativeVelocity &velocity, const Region &region,
                          RegionForce &force);
  void add_shear(RegionForce &force, double elastic, double viscous);
  void add_damping(RegionForce &force, Vec2 f, Vec2 moment, Vec2 direction);
  void note(const BlockSystem &system, const CandidatePair &pair, const RegionForce &force);
  void note_depth(const BlockSystem &system, const CandidatePair &pair, double overlap);
  /// Torques of the region at hand, from its dyads, which are whole.
  void finish_region(const BlockSystem &system, const CandidatePair &pair, RegionForce &force);
  /// Its dyads on deformable blocks.
  /// @param beyond  what the forces of a bond in `shear_force` do beyond acting at its grip
  void note_dyads(const BlockSystem &system, const CandidatePair &pair, const RegionForce &force,
                  const Mat2 &beyond = {});

  ContactParameters parameters_;
  Overlap overlap_;
  std::array<TrialOutline, 2> outlines_; ///< of the pair at hand, if it is not plain
  std::unique_ptr<PlainBatch> batch_;
  // Entries of Candidates::plain whose boxes meet, by the overlap each pair had in the last evaluation.
  std::vector<std::uint32_t> corners_;
  std::vector<std::uint32_t> polygons_;       ///< the overlap was some other polygon
  std::vector<std::uint32_t> remaining_;      ///< no longer an overlap of corners
  std::vector<std::uint32_t> without_region_; ///< the blocks did not touch
  std::vector<std::uint32_t> births_;         ///< new ones that must choose among laws
  std::array<CandidatePair, 8> own_;          ///< constants of mixed pairs at hand, by lane
  BlockSums sums_;
  // The regions of pairs that are not plain are the first num_forces_; those of plain pairs of the group at
  // hand follow. The others are of evaluations before and spare making new ones.
  std::vector<RegionForce> forces_;
  std::size_t num_forces_ = 0;
  std::vector<RegionRange> ranges_;   ///< of forces_, by pair that is not plain
  std::vector<std::uint32_t> places_; ///< in forces_, by plain pair of the group at hand
  bool is_again_ = false;             ///< find_details() is at work
  bool keeps_details_ = false;
  std::vector<RegionDetails> details_; ///< by plain pair that touches, if they are kept
  bool is_changing_ = false;           ///< change_shear() is
  ForceReport report_;                 ///< of what has been evaluated so far
  /// What the history becomes, but for ContactHistory::plain, whose entries are written where they are read;
  /// afterwards what it was.
  ContactHistory next_;
  std::span<RegionState> plain_memory_;  ///< that of the evaluation at hand
  std::span<Vec2> plain_grips_;          ///< the same, ContactHistory::grips
  std::vector<Mat2> velocity_gradients_; ///< 1/s, by entry of BlockSystem::deformation
  std::size_t first_of_pair_ = 0;        ///< region of the pair at hand
  std::vector<RegionDyads> dyads_;       ///< of its regions, if a block deforms
  Mat2 damping_dyad_;                    ///< of the region at hand, about its origin
  std::vector<BondAtWork> bonds_;        ///< of the pair at hand
  std::vector<FoundRegion> found_;       ///< of the pair at hand
  /// A memory within reach of a region: their distance (m) and numbers.
  std::vector<std::tuple<double, std::size_t, std::size_t>> matches_;
  std::vector<double> facing_; ///< of the pieces at hand, scratch
  /// Of laws that open a region against its pressure, J/m.
  struct OpeningWork {
    std::uint32_t pair = 0;
    double work = 0.0;
  };
  std::vector<OpeningWork> opening_works_;
  std::vector<RegionMemory> opened_; ///< of the pair at hand
  ClosedPair closed_;                ///< the same, with one of these taken out
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
