#pragma once

// The grip: the material point where friction acts on a pair with a deformable block.
//
// Let q = (x_A, F_A, x_B, F_B) be the unknowns of a pair, A the lower block, X = F^-1 (x - x_c) a block's
// reference coordinates, (x) the dyadic product. Friction F_t along t = t_r at a point x does on q the work
// of
//     b(x) = (t, t (x) X_A; -t, -t (x) X_B),     f = -F_t b(x),     dF_t = k_t b(x).dq.
// With s the place of x along t in the material of the blocks, the tangent stiffness of a contact that sticks
// is
//     -df/dq = k_t b b^T + F_t g (ds/dq)^T + O(F_t),     g = db/ds = (0, t (x) F_A^-1 t; 0, -t (x) F_B^-1 t).
// The last term is the turning of t, of the order of F_t against k_t times the joint's length: the shear
// strain of the joint. The second one has rank one and is not symmetric: g does work on the difference of the
// blocks' strains along t, and ds/dq is whatever makes the point wander. The centre of pressure x_r of a
// closed joint of length l and depth d that is tilted by theta lies at s = l^2 theta/(12 d), so that, with N
// = k_n l d,
//     K[strain, tilt] = F_t l^2/(12 d) = (F_t/N) k_n l^3/12,     K[tilt, strain] = 0:
// F_t/N times the joint's own stiffness in tilt, at any stress and any time step. Two modes w_e, w_t with
// that and a symmetric coupling c between them have complex frequencies where (w_e^2 - w_t^2)^2 < -4 c (c +
// kappa): the blocks shake themselves apart. The middle of the part that is closed at the moment wanders too
// where a joint gapes. A point that is fixed in the material has ds = 0, and the tangent is symmetric but for
// the term of t. Rigid blocks have no strain, g does no work on them, and friction between two acts at x_r.
//
// The grip X_g is kept in the lower block's reference axes. It is looked at along t alone: friction acts at
// x_r + s t with s = (x_c + F X_g - x_r).t, so the levers of F_t about both centroids are those of x_r, and
// rolling and rocking do not see it. (Across t it is off a material point by no more than the overlap.) With
// l the extent of the region along t and m its middle, in each evaluation:
// 1. s = m where the region is new, or longer than ever: the more of a joint has closed, the farther reaches
//    what the spring stands for. Else s goes on, cut to the extent where its point has parted; that is kept,
//    so that a point moves in but not out again.
// 2. F_t += k_t du.t with du at x_r + s t.
// 3. Where F_t is cut at the cap, s goes the share (|F_t| - cap)/cap of the way to m: all of it once the
//    joint has slipped by the whole stretch cap/k_t of its spring. So it follows the overlap along a sliding
//    block, at any time step.
// Where none of these moves it X_g keeps its bits, and s is read from it: an evaluation that is repeated with
// the memory it left behind finds the same grip.
//
// Thus a small swing of a joint that sticks moves the grip at most once, and cannot be driven by it. In the
// middle k_t l b b^T <= k_t int b b^T ds: the bound on the time step (frequency_bound.hpp) covers
// friction, which it would not at a point that wanders.
//
// LaneGrip (lane_grip.hpp) is the same in SIMD lanes.

#include "contact/block_view.hpp"
#include "contact/candidates.hpp"
#include "contact/region_sums.hpp"

#include <algorithm>

namespace gcpdda {

/// The grip of a region, from what is remembered of it to what will be.
class Grip {
public:
  /// @param known    X_g so far
  /// @param is_new   there is none so far
  /// @param longest  extent of the region before this evaluation, m
  Grip(const BlockSystem &system, const CandidatePair &pair, const RegionForce &force, Vec2 known,
       bool is_new, double longest)
      : system_(system), row_(pair.lower.value), force_(force), reference_(known) {
    if (is_new || force.extent_end - force.extent_begin > longest) {
      move_to_middle();
    } else if (const double along = place(); along < force.extent_begin || along > force.extent_end) {
      move(std::clamp(along, force.extent_begin, force.extent_end));
    }
  }
  void move_to_middle() { move(middle()); }
  /// @param excess  of the elastic shear over its cap, N/m
  void slip(double excess, double cap) {
    const double along = place();
    move(along + std::min(1.0, excess / cap) * (middle() - along));
  }
  /// X_g.
  [[nodiscard]] Vec2 reference() const { return reference_; }
  /// Where friction acts.
  [[nodiscard]] Vec2 point() const {
    return at(std::min(std::max(place(), force_.extent_begin), force_.extent_end));
  }

private:
  [[nodiscard]] double middle() const { return 0.5 * (force_.extent_begin + force_.extent_end); }
  [[nodiscard]] Vec2 at(double along) const { return force_.point + along * perp(force_.normal); }
  [[nodiscard]] double place() const {
    return dot(current_point(system_, row_, reference_) - force_.point, perp(force_.normal));
  }
  void move(double along) { reference_ = reference_point(system_, row_, at(along)); }

  const BlockSystem &system_;
  std::size_t row_;
  const RegionForce &force_;
  Vec2 reference_;
};

/// True for pairs with a deformable block; between two rigid ones friction acts at x_r.
inline bool has_grip(const BlockSystem &system, const CandidatePair &pair) {
  return system.is_deformable(pair.lower.value) || system.is_deformable(pair.higher.value);
}

} // namespace gcpdda
