#pragma once

// Contact forces of all candidate pairs at the trial configuration.
//
// Two convex blocks have one contact region. With N the normal force on the block of lower id and P = int p
// ds:
//     n_r = N/|N|,   t_r = perp(n_r),   l = extent of the pieces along t_r,
//     x_r = int p x ds / P, always in the hull of the patch.
// (The line of action of a resultant runs away when normals nearly cancel.)
//
// Friction is Coulomb with a stick spring. Its elongation is taken from successive TRIAL configurations of
// the two blocks' material points now at x_r:
//     du = (increment of A at x_r) - (increment of B at x_r),
//     F_t += k_t du.t_r,   k_t = ratio k_n max(l so far),
// in the form increment of u + (I - R(-dtheta)) r, which never subtracts world positions: a block at rest
// then creeps by 1e-15 and not 5e-12 m per 100 s. Velocities times dt would feed energy into a sticking
// block, and a k_t that follows the current l gains energy in every cycle of opening. F_t is cut at
// cap = |N| tan(phi) + c l first; the dashpot adds to it and the sum is cut again. A region's spring turns
// with t_r, dies with the region, and gets no increment in the step of its birth.
//
// The normal dashpot is distributed: on each piece with outward normal n of its own block and u = -n_r (lower
// block) or n_r (higher), w = max(0, u.n), the traction q = max(-s w p, (c'/2) w (v_own - v_other).u) acts
// along u. It is linear along the piece and cut exactly where it would exceed what the pressure gives along
// u: w p, times the share s = |N| / sum of int w p ds that pieces facing backwards leave over, so that the
// resultant never pulls. (Cutting at q = -p lets tips and tilted faces pull: their pressure counts only w p
// along u.) Along n_r, not along the piece's normal: there it would drag on the sunk leading side of a
// sliding block.

#include "gcpdda/contact/candidates.hpp"
#include "gcpdda/contact/overlap.hpp"

#include <cstdint>
#include <optional>
#include <tuple>
#include <vector>

namespace gcpdda {

/// Force on the lower block of a pair and what is known about its contact; the higher block gets the opposite
/// at the same points.
struct PairForce {
  bool touching = false;
  bool born = false;             ///< not touching at the evaluation before
  bool normal_undefined = false; ///< normals nearly cancel: no friction, no dashpot
  Vec2 origin;                   ///< what dyad and moments are about
  Vec2 force;                    ///< normal, friction and dashpot, N/m
  std::array<double, 4> dyad{};  ///< int (x - origin) df: xx, xy, yx, yy, N
  Vec2 shear_force;              ///< elastic part of friction in `force`
  double shear_moment = 0.0;     ///< about origin
  Vec2 damping_force;            ///< dashpots in `force`
  double damping_moment = 0.0;
  Vec2 point;                ///< x_r
  Vec2 normal;               ///< n_r
  double normal_force = 0.0; ///< |N|
  double shear = 0.0;        ///< friction and tangential dashpot along -t_r on the lower block
  double cap = 0.0;          ///< N/m
  double overlap = 0.0;      ///< thickness of the overlap along n_r, m
  double extent_begin = 0.0; ///< of the pieces along t_r, from x_r, m
  double extent_end = 0.0;
};

/// How trial configurations moved since the last evaluation, by row.
struct TrialIncrement {
  Vec2 u;
  double sine = 0.0;
  double one_minus_cosine = 0.0;
};

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
  double max_overlap = 0.0;
  std::optional<Fault> fault; ///< the one with the smallest ids
};

/// Evaluates pairs; buffers live as long as it does.
class ContactForces {
public:
  explicit ContactForces(ContactParameters parameters) : parameters_(std::move(parameters)) {}

  [[nodiscard]] const ContactParameters &parameters() const { return parameters_; }

  /// Forces of all candidates at the posed trial configuration, from velocities v_n and the regions' memory,
  /// which moves on to this configuration.
  ForceReport evaluate(const BlockSystem &system, const Candidates &candidates, ContactHistory &history);

  /// By pair, in candidate order.
  [[nodiscard]] const std::vector<PairForce> &pairs() const { return forces_; }

  /// Replace the shear of a touching pair, friction alone; for the initial state.
  void set_shear(std::size_t pair, double shear);

private:
  struct RelativeVelocity;

  void evaluate_pair(const BlockSystem &system, const CandidatePair &pair, RegionMemory &memory,
                     PairForce &force);
  /// Normal force, direction and size of the overlap; false if the blocks do not touch.
  bool find_region(const BlockSystem &system, const CandidatePair &pair, PairForce &force);
  void add_friction(const BlockSystem &system, const CandidatePair &pair, const RelativeVelocity &velocity,
                    RegionMemory &memory, PairForce &force);
  void add_normal_dashpot(const CandidatePair &pair, const RelativeVelocity &velocity,
                          PairForce &force) const;
  void add_shear(PairForce &force, double elastic, double viscous) const;

  ContactParameters parameters_;
  Overlap overlap_;
  std::vector<PairForce> forces_;
  std::vector<TrialIncrement> increments_;
};

/// Sums of one block's contacts, in the order of the other blocks' ids.
struct BlockContactSum {
  RigidDof force;   ///< about the trial centroid
  RigidDof shear;   ///< elastic friction in it
  RigidDof damping; ///< dashpots in it
};
BlockContactSum sum_contacts(const BlockSystem &system, const Candidates &candidates,
                             std::span<const PairForce> forces, std::size_t row);

/// (1/area) int sym(x f) of a block's contacts about its trial centroid: xx, yy, xy in Pa, tension positive.
std::array<double, 3> mean_stress(const BlockSystem &system, const Candidates &candidates,
                                  std::span<const PairForce> forces, std::size_t row);

/// One contact's part of a block's force and dyad about the block's trial centroid.
struct ContactPart {
  Vec2 force;
  std::array<double, 4> dyad{};
};
ContactPart contact_part(const PairForce &force, bool is_lower, Vec2 centroid);

/// Slide along t_r of the last evaluation's contact point when the system has moved on to its next trial
/// configuration.
double coming_slide(const BlockSystem &system, const CandidatePair &pair, const PairForce &force);

ConvexView view_of(const BlockSystem &system, std::size_t row);

} // namespace gcpdda
