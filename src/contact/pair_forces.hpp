#pragma once

// The regions of one pair of any shapes and laws: their forces and their memory.
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

#include "contact/candidates.hpp"
#include "contact/force_report.hpp"
#include "contact/geometry/overlap.hpp"
#include "contact/opened_regions.hpp"
#include "contact/region_sums.hpp"
#include "model/contact_history.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <tuple>
#include <vector>

namespace gcpdda {

struct RelativeVelocity;

/// Evaluates one pair after the other; buffers live as long as it does.
class PairForces {
public:
  explicit PairForces(std::shared_ptr<const ContactParameters> parameters);
  ~PairForces();
  PairForces(PairForces &&) noexcept;
  PairForces &operator=(PairForces &&) noexcept;

  /// No pair has been evaluated.
  /// @param keeps  regions stay, so that keep_again() finds them at the next evaluation
  void begin(bool keeps);
  /// Find the regions of a pair at the posed trial configuration. They stand behind those of pairs evaluated
  /// before, and so does their memory.
  /// @param old  the memory of the pair's regions
  /// @return how many there are
  std::size_t evaluate(const BlockSystem &system, const CandidatePair &pair, std::uint32_t number,
                       std::span<RegionMemory> old);
  /// The pair has the regions that it had at the evaluation before, and their memory.
  /// @param before  theirs, at that evaluation
  void keep_again(const BlockSystem &system, const CandidatePair &pair, RegionRange before,
                  std::span<const RegionMemory> memory);
  /// The regions of the pair evaluated last begin here.
  [[nodiscard]] std::size_t first_of_pair() const { return first_of_pair_; }
  /// What these do to F; none where no block of the pair deforms.
  [[nodiscard]] std::span<const RegionDyads> dyads() const { return dyads_; }
  /// Take the last region and its memory away.
  void drop_last();

  [[nodiscard]] std::span<RegionForce> regions(std::size_t first, std::size_t count) {
    return std::span(forces_).subspan(first, count);
  }
  [[nodiscard]] std::span<const RegionForce> regions(std::size_t first, std::size_t count) const {
    return std::span(forces_).subspan(first, count);
  }
  /// Of all regions.
  [[nodiscard]] std::vector<RegionMemory> &memory() { return memory_; }
  [[nodiscard]] const ForceReport &report() const { return report_; }

  /// What slip has done against the pressure since begin(), off the work of friction in the ledger of each
  /// block.
  void add_opening_works(const Candidates &candidates, BlockSystem &system);

private:
  /// A bond of the pair at hand, and what became of it.
  struct BondAtWork;
  /// What bonds leave of the friction of a region.
  struct BondShare {
    bool holds = false;    ///< a bond carries the shear
    bool released = false; ///< one has just broken ...
    double shear = 0.0;    ///< ... and leaves this, N/m,
    double length = 0.0;   ///< of a stretch of this length
  };

  /// A region that carries something.
  struct FoundRegion {
    const Region *region;
    RegionForce force;   ///< for k_n/2 = 1, without friction and dashpots
    Vec2 position;       ///< RegionMemory::position, of a pair that is not convex
    RegionMemory *known; ///< what goes on in it; null for a new one
  };

  void find_regions(const BlockSystem &system, const CandidatePair &pair, std::uint32_t number,
                    std::span<RegionMemory> old);
  void load_found(const BlockSystem &system, const CandidatePair &pair, std::uint32_t number,
                  const FoundRegion &found);
  /// That of a region found before of which this one, which is born, was a part; else -1.
  [[nodiscard]] std::int32_t law_beside(const BlockSystem &system, const CandidatePair &pair,
                                        const Region &region) const;
  /// From the edges on which the region at hand lies.
  void choose_law(const BlockSystem &system, const CandidatePair &pair, const Region &region,
                  RegionMemory &memory) const;
  /// References to other regions hold until the next one is appended.
  RegionForce &append_force(const RegionForce &force = {});
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
  /// Torques of the region at hand, from its dyads, which are whole.
  void finish_region(const BlockSystem &system, const CandidatePair &pair, RegionForce &force);
  /// Its dyads on deformable blocks.
  /// @param beyond  what the forces of a bond in `shear_force` do beyond acting at its grip
  void note_dyads(const BlockSystem &system, const CandidatePair &pair, const RegionForce &force,
                  const Mat2 &beyond = {});

  std::shared_ptr<const ContactParameters> parameters_;
  // The regions of an evaluation are the first num_forces_; the others are of evaluations before and spare
  // making new ones.
  std::vector<RegionForce> forces_;
  std::size_t num_forces_ = 0;
  std::vector<RegionForce> before_; ///< of the evaluation before, where they stay
  std::vector<RegionMemory> memory_;
  ForceReport report_;
  /// Of laws that open a region against its pressure, J/m.
  struct OpeningWork {
    std::uint32_t pair = 0;
    std::size_t found_as = 0; ///< the regions of a pair are found one after the other
    double work = 0.0;
  };
  std::vector<OpeningWork> opening_works_;
  // Of the pair at hand.
  Overlap overlap_;
  std::array<TrialOutline, 2> outlines_;
  std::size_t first_of_pair_ = 0;
  std::vector<RegionDyads> dyads_; ///< of its regions, if a block deforms
  std::vector<BondAtWork> bonds_;
  std::vector<FoundRegion> found_;
  /// A memory within reach of a region: their distance (m) and numbers.
  std::vector<std::tuple<double, std::size_t, std::size_t>> matches_;
  std::vector<RegionMemory> opened_;
  ClosedPair closed_;          ///< the same, with one of these taken out
  Mat2 damping_dyad_;          ///< of the region at hand, about its origin
  std::vector<double> facing_; ///< of the pieces at hand, scratch
};

} // namespace gcpdda
