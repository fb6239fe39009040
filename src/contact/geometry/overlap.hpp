#pragma once

// The contact integral of two blocks, by edges.
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
// Inside a block with re-entrant vertices the lines are not enough: see distance_field.cpp, and regions.cpp
// for what shares a spring there. A deformable block's field is the distance in its reference polygon divided
// by J = det F, which derives from an energy; the distance to the current boundary does net work on a closed
// path. The other block's edges are mapped there, where they stay straight and keep their parameter; pieces
// are mapped back.
//
// Locality, bit for bit: pieces end only where the active line changes; lines are anchored at vertices and
// use stored normals; the order of summation starts where a block's boundary enters the other one, never at
// vertex 0; moments are taken about the first piece. What a block looks like beyond the edges that meet the
// overlap changes no bit of its contact force. The length of those edges themselves costs no digits either:
// an edge that comes in from outside is measured from its entry.

#include "gcpdda/geometry/mat2.hpp"
#include "gcpdda/geometry/vec2.hpp"
#include "gcpdda/model/scene.hpp"
#include "geometry/aabb.hpp"

#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace gcpdda {

/// How a deformable block maps its reference axes to the world: x = centre + F X.
struct DeformedFrame {
  Vec2 centre;
  Mat2 gradient;                ///< F
  Mat2 inverse;                 ///< F^-1
  std::span<const Vec2> vertex; ///< reference vertices and unit normals
  std::span<const Vec2> normal;
};

/// A simple polygon in the world: counter-clockwise vertices, outward unit normals and lengths of the edges
/// that start at them.
struct BlockView {
  std::span<const Vec2> vertex;
  std::span<const Vec2> normal;
  std::span<const double> length;
  Aabb box;
  bool is_convex = true;              ///< and without parted sides
  std::optional<DeformedFrame> frame; ///< of a deformable block
  bool has_parted_sides = false;      ///< vertices within straight sides part regions
};

/// Part of an edge inside the other block, with one feature of the other block's boundary nearest along it.
struct Piece {
  Vec2 begin;
  Vec2 normal; ///< outward of the block whose edge this is
  double length = 0.0;
  double depth_begin = 0.0; ///< phi H of the other block: distance, for deformable blocks divided by J, m
  double depth_end = 0.0;
  bool enters = false;     ///< the boundary comes in from outside at `begin`
  std::int32_t edge = 0;   ///< number of this edge in its own block
  std::int32_t face = 0;   ///< nearest edge of the other block; of a piece nearest to a re-entrant vertex the
                           ///< edge on its side
  std::int32_t curve = -1; ///< number in Overlap::curves() where the depth is not linear

  [[nodiscard]] Vec2 end() const { return begin + length * perp(normal); }
};

/// Depth along a piece that is nearest to a re-entrant vertex: scale sqrt(q^2 + (s - foot)^2), s from the
/// piece's begin. The foot lies outside the piece or at one of its ends, so the depth is monotonous.
struct DepthCurve {
  double scale = 1.0;
  double q = 0.0;    ///< m
  double foot = 0.0; ///< m
};

/// Where a region lies: numbers of the stretches between vertices that part regions (from vertex 0 on) that
/// face each other; 0 for a convex block.
struct RegionFaces {
  std::int32_t first = 0;
  std::int32_t second = 0;
  friend auto operator<=>(const RegionFaces &, const RegionFaces &) = default;
};

/// A connected part of a contact that one spring serves: pieces [begin, middle) lie on the first block's
/// edges, [middle, end) on the second's.
struct Region {
  std::uint32_t begin = 0;
  std::uint32_t middle = 0;
  std::uint32_t end = 0;
  RegionFaces faces;
};

/// Integrals over one contact region, for k_n/2 = 1: lengths in m, so forces in m2.
struct RegionIntegrals {
  Vec2 origin;                  ///< what the moments are about
  Vec2 force;                   ///< on the first block
  std::array<double, 4> dyad{}; ///< int (x - origin) df on the first block: xx, xy, yx, yy
  double pressure = 0.0;        ///< int d ds
  Vec2 pressure_moment;         ///< int d (x - origin) ds
};

/// The pieces of two blocks and the regions they form; buffers are reused from call to call.
class Overlap {
public:
  Overlap();
  ~Overlap();
  Overlap(Overlap &&) noexcept;
  Overlap &operator=(Overlap &&) noexcept;

  /// Collect the pieces of both blocks' edges, region by region; false if there are none.
  bool find(const BlockView &first, const BlockView &second, PotentialKind potential);

  /// One region for two convex blocks. Otherwise by faces, then in the order of the lower-numbered piece.
  [[nodiscard]] std::span<const Region> regions() const { return regions_; }
  [[nodiscard]] std::span<const Piece> pieces() const { return pieces_; }
  [[nodiscard]] std::span<const DepthCurve> curves() const { return curves_; }
  [[nodiscard]] RegionIntegrals integrate(const Region &region) const;
  /// A linear function nowhere above the piece's depth, by its end values; the depth itself where that is
  /// linear.
  [[nodiscard]] std::array<double, 2> depth_floor(const Piece &piece) const {
    return piece.curve < 0 ? std::array{piece.depth_begin, piece.depth_end} : curve_floor(piece);
  }

private:
  /// The pieces of one block's edges inside the other, which is convex.
  [[nodiscard]] std::array<double, 2> curve_floor(const Piece &piece) const;
  /// @tparam deformed  the other block has a frame
  template <bool deformed>
  void clip_edges(const BlockView &own, const BlockView &other, PotentialKind potential);
  /// Those inside a block with re-entrant vertices.
  void trace_edges(const BlockView &own, const BlockView &other, PotentialKind potential);
  /// One piece with the potential linear between its ends.
  [[nodiscard]] Piece chord(Piece piece, double s_begin, double s_end, bool leaves) const;
  /// The pieces of one edge from s to s_end, starting on `line`.
  void walk_envelope(Piece piece, std::size_t line, double s, double s_end);
  /// Pieces of one edge, made in a deformable block's reference axes; in the world they start at `begin`.
  void to_world(std::size_t first_piece, Vec2 begin, double stretch, double scale);

  std::vector<Piece> pieces_;
  std::vector<DepthCurve> curves_;
  std::vector<Region> regions_;
  /// An edge line of the other block that may be the nearest one somewhere.
  struct Line {
    Vec2 normal;
    Vec2 vertex;
    std::int32_t face = 0;
  };
  /// Fill the first num_lines_ of lines_; false if the blocks cannot overlap.
  bool keep_lines(const BlockView &own, const BlockView &other);

  // Scratch, as long as the largest block so far.
  std::vector<Line> lines_;
  std::size_t num_lines_ = 0;
  std::vector<double> alpha_;
  std::vector<double> beta_;
  struct OfReentrant;
  std::unique_ptr<OfReentrant> of_reentrant_; ///< made for the first pair that needs it
};

} // namespace gcpdda
