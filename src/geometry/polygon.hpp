#pragma once

// Area, moments, widths and soundness of polygons.

#include "gcpdda/geometry/vec2.hpp"

#include <span>
#include <vector>

namespace gcpdda {

/// Simplex integrals of a simple polygon (vertices counter-clockwise): area, centroid, and the second
/// moments int x^2, int y^2, int xy dA about the centroid (m4).
struct Moments {
  double area = 0.0;
  Vec2 centroid;
  double xx = 0.0;
  double yy = 0.0;
  double xy = 0.0;
};

/// Positive when the vertices run counter-clockwise (m2).
double signed_area(std::span<const Vec2> vertices);

/// Integrals by the divergence theorem, taken about vertex 0 so that a distant origin costs no digits.
/// Clockwise rings give a negative area (holes).
Moments polygon_moments(std::span<const Vec2> vertices);

/// No edge meets another except neighbours at their common vertex. O(n log n) for common outlines; exact up
/// to rounding of the orientation test.
bool is_simple(std::span<const Vec2> vertices);

/// All turns are left turns or straight up to rounding (counter-clockwise vertices).
bool is_convex(std::span<const Vec2> vertices);

/// Whether edges with these unit normals, one behind the other, lie in one side that is straight but for a
/// turn of 0.01.
bool are_in_one_side(Vec2 normal, Vec2 next_normal);

/// The vertices that keep a polygon from being convex: where the boundary turns right.
std::vector<bool> reentrant_vertices(std::span<const Vec2> vertices);
/// The same into a list that has been used before.
void find_reentrant_vertices(std::span<const Vec2> vertices, std::vector<bool> &reentrant);

/// The corners of the convex hull of points, counter-clockwise. O(n log n).
std::vector<Vec2> convex_hull(std::span<const Vec2> points);

/// How thin a polygon is (m). Convex: the smallest distance between two parallel lines that enclose it, one
/// of them flush with an edge. Otherwise that of the convex hull, or the distance from a re-entrant vertex
/// through the interior to another edge where that is smaller (the leg of an L, the prong of a U). What is
/// no longer than wide and has less than a thousandth of the area is a nib, and no leg.
/// O(n log n) for common outlines.
double narrowest_width(std::span<const Vec2> vertices);

} // namespace gcpdda
