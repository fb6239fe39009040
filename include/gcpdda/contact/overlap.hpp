#pragma once

// The contact integral of two convex blocks, by edges.
//
// The generalized contact potential puts on contactor C and target T, over their overlap S,
//     f_C = p_n int_{boundary of S} n (phi_C - phi_T) ds,      n outward of S,
// with phi_B = d_B / H, d_B the distance to the boundary of B. On the pieces of C's edges inside T phi_C = 0,
// on the pieces of T's edges inside C phi_T = 0. So S itself is never needed: take every edge of one block,
// keep the part inside the other block and load it with the pressure p = p_n phi_other = (k_n/2) d_other
// along its inward normal, the opposite force on the other block at the same point. Touching and coincident
// edges carry d = 0, so it does not matter whether they count as inside: there is no degenerate case and no
// tolerance.
//
// Inside a convex block d is the lower envelope of the signed distances to its edge lines. Along an edge
// x(s) = a + s t these are linear, g_j(s) = alpha_j + beta_j s, and the part inside is the interval where all
// are positive: [largest root of the rising lines, smallest root of the falling ones]. The walk starts on the
// line that lets the edge in (or the lowest one at s = 0) and changes line at crossings: the next line is the
// one with a smaller slope whose crossing comes first. Choosing instead the lowest line by comparing values
// at each crossing picks wrongly in rounding, because there the two values are equal; slopes are not.
//
// Locality, bit for bit: pieces end only where the active line changes; lines are anchored at vertices and
// use stored normals; the order of summation starts where a block's boundary enters the other one, never at
// vertex 0; moments are taken about the first piece. What a block looks like beyond the edges that meet the
// overlap changes no bit of its contact force. The length of those edges themselves costs no digits either:
// an edge that comes in from outside is measured from its entry.

#include "gcpdda/geometry/aabb.hpp"
#include "gcpdda/geometry/vec2.hpp"
#include "gcpdda/model/scene.hpp"

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace gcpdda {

/// A convex polygon in the world: counter-clockwise vertices, outward unit normals and lengths of the edges
/// that start at them.
struct ConvexView {
  std::span<const Vec2> vertex;
  std::span<const Vec2> normal;
  std::span<const double> length;
  Aabb box;
};

/// Part of an edge inside the other block, with the other block's distance field linear along it.
struct Piece {
  Vec2 begin;
  Vec2 normal; ///< outward of the block whose edge this is
  double length = 0.0;
  double depth_begin = 0.0; ///< d of the other block, m
  double depth_end = 0.0;
  bool enters = false; ///< the boundary comes in from outside at `begin`

  [[nodiscard]] Vec2 end() const { return begin + length * perp(normal); }
};

/// Integrals over one contact region, for k_n/2 = 1: lengths in m, so forces in m2.
struct RegionIntegrals {
  Vec2 origin;                  ///< what the moments are about
  Vec2 force;                   ///< on the first block
  std::array<double, 4> dyad{}; ///< int (x - origin) df on the first block: xx, xy, yx, yy
  double pressure = 0.0;        ///< int d ds
  Vec2 pressure_moment;         ///< int d (x - origin) ds
};

/// The pieces of two blocks; buffers are reused from call to call.
class Overlap {
public:
  /// Collect the pieces of both blocks' edges; false if there are none.
  bool find(const ConvexView &first, const ConvexView &second, PotentialKind potential);

  [[nodiscard]] std::span<const Piece> pieces() const { return pieces_; }
  /// Pieces [0, num_first()) lie on the first block's edges.
  [[nodiscard]] std::size_t num_first() const { return num_first_; }
  [[nodiscard]] RegionIntegrals integrate() const;

private:
  void clip_edges(const ConvexView &own, const ConvexView &other, PotentialKind potential);
  /// One piece with the potential linear between its ends.
  [[nodiscard]] Piece chord(Piece piece, double s_begin, double s_end, bool leaves) const;
  /// The pieces of one edge from s to s_end, starting on `line`.
  void walk_envelope(Piece piece, std::size_t line, double s, double s_end);
  void start_at_entry(std::size_t first_piece);

  std::vector<Piece> pieces_;
  std::size_t num_first_ = 0;
  std::vector<double> alpha_;
  std::vector<double> beta_;
};

/// Energy int_S (d_A + d_B) dA (m3) that belongs to the forces of RegionIntegrals: moving a block changes it
/// by minus the work of its contact force. For the ledger, not for the step: it assembles S.
double overlap_energy(const ConvexView &first, const ConvexView &second);

} // namespace gcpdda
