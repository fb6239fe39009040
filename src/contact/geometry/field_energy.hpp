#pragma once

// int d dA of the distance field of a polygon with re-entrant vertices.

#include "contact/geometry/convex_cut.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace gcpdda {

/// A polygon cut into triangles by clipping ears; a convex one stays whole.
std::vector<Polygon> convex_parts(std::span<const Vec2> vertex);

/// The part of a convex polygon inside another one.
Polygon common_part(Polygon region, const Polygon &other);

/// The integral over convex regions inside a simple polygon; the spans must outlive it.
class FieldEnergy {
public:
  FieldEnergy(std::span<const Vec2> vertex, std::span<const Vec2> normal);

  [[nodiscard]] double integrate(const Polygon &region) const;
  /// The same where one of these edges is the nearest to every point of the region.
  [[nodiscard]] double integrate_among(const Polygon &region, const std::vector<std::size_t> &edges) const;

private:
  /// What may be nearest somewhere in a cell.
  struct Features {
    std::vector<std::size_t> lines;
    std::vector<std::size_t> vertices;
  };

  [[nodiscard]] std::size_t after(std::size_t i) const { return i + 1 == vertex_.size() ? 0 : i + 1; }
  [[nodiscard]] std::size_t before(std::size_t i) const { return i == 0 ? vertex_.size() - 1 : i - 1; }
  [[nodiscard]] Vec2 tangent(std::size_t edge) const { return perp(normal_[edge]); }
  [[nodiscard]] double depth(std::size_t line, Vec2 x) const;
  [[nodiscard]] double distance(std::size_t edge, Vec2 x) const;
  [[nodiscard]] Features near(const Polygon &cell) const;
  [[nodiscard]] double within_domains(const Polygon &cell, const Features &features, std::size_t next) const;
  [[nodiscard]] double among_lines(const Polygon &cell, const Features &features) const;
  [[nodiscard]] double among_vertices(const Polygon &cell, const Features &features) const;
  [[nodiscard]] double of_line_and_vertex(const Polygon &cell, std::size_t line, std::size_t v) const;
  /// What the depth below a line integrates to beyond the distance to the vertex, between the vertex and the
  /// stretch from p to q, along which one of the two is the nearer one, m3.
  [[nodiscard]] double saved_by_vertex(std::size_t line, Vec2 vertex, Vec2 p, Vec2 q) const;

  std::span<const Vec2> vertex_;
  std::span<const Vec2> normal_;
  std::vector<bool> reentrant_;
};

} // namespace gcpdda
