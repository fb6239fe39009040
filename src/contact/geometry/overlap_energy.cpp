
#include "contact/geometry/overlap_energy.hpp"

#include "contact/geometry/convex_cut.hpp"
#include "contact/geometry/field_energy.hpp"
#include "contact/geometry/large_overlap.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace gcpdda {

namespace {

/// Depth of a point below an edge line.
double depth_below(std::span<const Vec2> vertex, std::span<const Vec2> normal, std::size_t line, Vec2 x) {
  return dot(normal[line], vertex[line] - x);
}

/// The edge lines that can be the nearest somewhere in a region, ascending, at the begin of `lines`. One that
/// nowhere comes as near as another one always is has no cell and cuts none off.
/// @param nearest  the one that is never far: the best guess at the nearest nearly everywhere
/// @param least  scratch, as long as `lines`
template <class Outline>
std::span<const std::size_t>
nearest_lines(const Outline &region, std::span<const Vec2> vertex, std::span<const Vec2> normal,
              double same_line, std::span<std::size_t> lines, std::span<double> least, std::size_t &nearest) {
  double enough = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < vertex.size(); ++i) {
    const Extremes depth = extremes_of(region, [&](Vec2 x) { return depth_below(vertex, normal, i, x); });
    least[i] = depth.least;
    if (depth.largest < enough) {
      enough = depth.largest;
      nearest = i;
    }
  }
  std::size_t count = 0;
  for (std::size_t i = 0; i < vertex.size(); ++i) {
    if (least[i] <= enough + same_line) {
      lines[count++] = i;
    }
  }
  return lines.first(count);
}

/// int over the region of the least of the depths below these lines, where one line is the nearest but near
/// some corners, each with a line of its own: int d_i less what every other line takes off, int (d_i - d_j)
/// over where it is positive. Nothing where two of these parts meet.
template <class Outline>
std::optional<double> integrate_by_corners(const Outline &region, std::span<const Vec2> vertex,
                                           std::span<const Vec2> normal, std::span<const std::size_t> lines,
                                           std::size_t nearest) {
  const auto nearer = [&](std::size_t j) {
    return [&vertex, &normal, nearest, j](Vec2 x) {
      return depth_below(vertex, normal, nearest, x) - depth_below(vertex, normal, j, x);
    };
  };
  double sum = integrate_linear(region, [&](Vec2 x) { return depth_below(vertex, normal, nearest, x); });
  for (const std::size_t j : lines) {
    if (j == nearest) {
      continue;
    }
    const Outline corner = keep_positive(region, nearer(j));
    for (const std::size_t k : lines) {
      if (k != nearest && k != j && extremes_of(corner, nearer(k)).largest > 0.0) {
        return std::nullopt;
      }
    }
    sum -= integrate_linear(corner, nearer(j));
  }
  return sum;
}

/// int over the region of the distance to the boundary of a convex polygon: cut the region into the cells in
/// which one edge line is nearest.
template <class Outline>
double integrate_distance(const Outline &region, std::span<const Vec2> vertex, std::span<const Vec2> normal) {
  double largest = 0.0;
  for (const Vec2 x : vertex) {
    largest = std::max({largest, std::abs(x.x), std::abs(x.y)});
  }
  // Collinear edges share a line up to the rounding of their vertices: the first of them takes the whole
  // cell.
  const double same_line = 64.0 * std::numeric_limits<double>::epsilon() * largest;
  std::array<std::size_t, SmallPolygon::capacity> few;
  std::array<double, SmallPolygon::capacity> least;
  std::vector<std::size_t> many(vertex.size() > few.size() ? vertex.size() : 0);
  std::vector<double> many_least(many.size());
  std::size_t nearest = 0;
  const auto lines =
      many.empty()
          ? nearest_lines(region, vertex, normal, same_line, few, std::span<double>(least), nearest)
          : nearest_lines(region, vertex, normal, same_line, many, std::span<double>(many_least), nearest);
  const auto depth = [&](std::size_t line, Vec2 x) { return depth_below(vertex, normal, line, x); };
  if (const auto sum = integrate_by_corners(region, vertex, normal, lines, nearest)) {
    return *sum;
  }
  double sum = 0.0;
  for (const std::size_t i : lines) {
    Outline cell = region;
    for (const std::size_t j : lines) {
      const auto margin = [&](Vec2 x) { return depth(j, x) - depth(i, x); };
      if (j == i || cell.size() < 3) {
        continue;
      }
      const Extremes found = extremes_of(cell, margin);
      if (std::max(-found.least, found.largest) <= same_line) {
        if (j < i) {
          cell.clear();
        }
      } else if (found.least < 0.0) {
        cell = keep_positive(cell, margin);
      }
    }
    if (cell.size() >= 3) {
      sum += integrate_linear(cell, [&](Vec2 x) { return depth(i, x); });
    }
  }
  return sum;
}

/// Points of the world in a block's reference axes.
template <class Outline = Polygon>
Outline to_reference(std::span<const Vec2> vertex, const DeformedFrame &frame) {
  Outline mapped;
  for (const Vec2 x : vertex) {
    mapped.push_back(frame.inverse(x - frame.centre));
  }
  return mapped;
}

bool is_convex_and_rigid(const BlockView &block) {
  return block.is_convex && !block.frame;
}

/// The part of `region` inside a convex polygon.
template <class Outline>
Outline common_part(Outline region, std::span<const Vec2> vertex, std::span<const Vec2> normal) {
  for (std::size_t j = 0; j < vertex.size() && region.size() >= 3; ++j) {
    const auto depth = [&](Vec2 x) { return depth_below(vertex, normal, j, x); };
    if (extremes_of(region, depth).least < 0.0) {
      region = keep_positive(region, depth);
    }
  }
  return region;
}

/// Points of the world where the field of `block` is the distance to its outline.
template <class Outline> Outline to_field(std::span<const Vec2> vertex, const BlockView &block) {
  return block.frame ? to_reference<Outline>(vertex, *block.frame) : Outline(vertex.begin(), vertex.end());
}
std::span<const Vec2> vertices_of_field(const BlockView &block) {
  return block.frame ? block.frame->vertex : block.vertex;
}
std::span<const Vec2> normals_of_field(const BlockView &block) {
  return block.frame ? block.frame->normal : block.normal;
}

/// int over the part of a convex outline in a convex block of the field of the block.
template <class Outline> double convex_field_energy(const BlockView &block, const Outline &outline) {
  const std::span<const Vec2> vertex = vertices_of_field(block);
  const std::span<const Vec2> normal = normals_of_field(block);
  const Outline region = common_part(outline, vertex, normal);
  return region.size() < 3 ? 0.0 : integrate_distance(region, vertex, normal);
}

/// Each of the cuts, first by the other block's lines and then between the lines of one, adds a vertex at
/// most.
bool are_small(const BlockView &first, const BlockView &second) {
  return 2 * (first.vertex.size() + second.vertex.size()) <= SmallPolygon::capacity;
}

/// int over the overlap of the field of `block`, over the world. There dA = J dA_ref, so J cancels and the
/// integral is that of the reference distance over the overlap mapped back.
double field_energy(const BlockView &block, const BlockView &other) {
  if (block.is_convex && other.is_convex && are_small(block, other)) {
    return convex_field_energy(block, to_field<SmallPolygon>(other.vertex, block));
  }
  const std::vector<Polygon> other_parts = convex_parts(to_field<Polygon>(other.vertex, block));
  double sum = 0.0;
  if (block.is_convex) {
    for (const Polygon &part : other_parts) {
      sum += convex_field_energy(block, part);
    }
    return sum;
  }
  const std::span<const Vec2> vertex = vertices_of_field(block);
  const FieldEnergy field(vertex, normals_of_field(block));
  for (const Polygon &own_part : convex_parts(vertex)) {
    for (const Polygon &part : other_parts) {
      if (bounding_box(own_part).meets(bounding_box(part))) {
        sum += field.integrate(common_part(own_part, part));
      }
    }
  }
  return sum;
}

/// The same of blocks with many vertices.
double large_field_energy(const BlockView &block, const BlockView &other) {
  const PlainOutline own = block.frame ? without_straight_vertices(block.frame->vertex, block.frame->normal)
                                       : without_straight_vertices(block.vertex, block.normal);
  PlainOutline mapped = without_straight_vertices(other.vertex, other.normal);
  if (block.frame) {
    mapped.vertex = to_reference(mapped.vertex, *block.frame);
    for (std::size_t i = 0; i < mapped.vertex.size(); ++i) {
      const Vec2 along = mapped.vertex[(i + 1) % mapped.vertex.size()] - mapped.vertex[i];
      mapped.normal[i] = (-1.0 / norm(along)) * perp(along);
    }
  }
  return integrate_by_cells(own, mapped);
}

/// Of two convex rigid blocks.
template <class Outline> double rigid_energy(const BlockView &first, const BlockView &second) {
  const Outline region =
      common_part(Outline(first.vertex.begin(), first.vertex.end()), second.vertex, second.normal);
  if (region.size() < 3) {
    return 0.0;
  }
  return integrate_distance(region, first.vertex, first.normal) +
         integrate_distance(region, second.vertex, second.normal);
}

} // namespace

double overlap_energy(const BlockView &first, const BlockView &second) {
  if (!first.box.meets(second.box)) {
    return 0.0;
  }
  if (std::max(first.vertex.size(), second.vertex.size()) > many_vertices) {
    return large_field_energy(first, second) + large_field_energy(second, first);
  }
  if (!is_convex_and_rigid(first) || !is_convex_and_rigid(second)) {
    return field_energy(first, second) + field_energy(second, first);
  }
  return are_small(first, second) ? rigid_energy<SmallPolygon>(first, second)
                                  : rigid_energy<Polygon>(first, second);
}

} // namespace gcpdda
