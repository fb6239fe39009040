#pragma once

// int d dA over the overlap of two polygons of which one has many vertices.

#include "gcpdda/geometry/vec2.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace gcpdda {

/// Outlines with more vertices than this are worth the cells of integrate_by_cells().
constexpr std::size_t many_vertices = 64;

/// A polygon without the vertices that lie on the straight line between their neighbours up to rounding, and
/// the outward normals of its edges.
struct PlainOutline {
  std::vector<Vec2> vertex;
  std::vector<Vec2> normal;
};
PlainOutline without_straight_vertices(std::span<const Vec2> vertex, std::span<const Vec2> normal);

/// The integral of the distance to the boundary of a simple polygon over its overlap with another one. It
/// costs O(n log n) of the vertices near the overlap and O(n) of the others.
double integrate_by_cells(const PlainOutline &polygon, const PlainOutline &other);

} // namespace gcpdda
