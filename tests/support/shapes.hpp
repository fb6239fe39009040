#pragma once

// Polygons without a scene, for tests of the contact integral.

#include "contact/geometry/overlap.hpp"
#include "gcpdda/geometry/mat2.hpp"
#include "geometry/polygon.hpp"

#include <cmath>
#include <cstddef>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

namespace gcpdda::testing {

/// The standard distributions differ between libraries; the engine does not.
inline double uniform(std::mt19937 &engine, double low, double high) {
  return low + (high - low) * (static_cast<double>(engine()) / 4294967296.0);
}

/// A polygon that owns what a BlockView looks at; normals and lengths from its edges.
struct Shape {
  std::vector<Vec2> vertex;
  std::vector<Vec2> normal;
  std::vector<double> length;

  [[nodiscard]] BlockView view() const {
    return {vertex, normal, length, bounding_box(vertex), is_convex(vertex), {}};
  }
};

inline Shape shape_of(std::vector<Vec2> vertices) {
  Shape shape;
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const Vec2 edge = vertices[(i + 1) % vertices.size()] - vertices[i];
    const double length = norm(edge);
    shape.normal.push_back({edge.y / length, -edge.x / length});
    shape.length.push_back(length);
  }
  shape.vertex = std::move(vertices);
  return shape;
}

/// The same block at another place, its normals turned, not recomputed.
inline Shape moved(const Shape &shape, double angle, Vec2 about, Vec2 by) {
  Shape result = shape;
  const Rotation turn = Rotation::of(angle);
  for (Vec2 &v : result.vertex) {
    v = about + by + turn(v - about);
  }
  for (Vec2 &n : result.normal) {
    n = turn(n);
  }
  return result;
}

/// A polygon around a centre with radii between two bounds, most of them with re-entrant vertices.
inline std::vector<Vec2> star_polygon(std::mt19937 &engine, int num_vertices, double low, double high,
                                      Vec2 centre) {
  std::vector<Vec2> vertices;
  const double first = uniform(engine, 0.0, 2.0 * std::numbers::pi);
  for (int k = 0; k < num_vertices; ++k) {
    const double angle = first + (k + uniform(engine, -0.3, 0.3)) * 2.0 * std::numbers::pi / num_vertices;
    vertices.push_back(centre + uniform(engine, low, high) * Vec2{std::cos(angle), std::sin(angle)});
  }
  return vertices;
}

/// A block with x = centre + F X.
struct DeformedShape {
  Shape reference;
  Vec2 centre;
  Mat2 gradient;
  Mat2 inverse_gradient;
  Shape world;

  [[nodiscard]] BlockView view() const {
    BlockView view = world.view();
    view.is_convex = is_convex(reference.vertex);
    view.frame = DeformedFrame{centre, gradient, inverse_gradient, reference.vertex, reference.normal};
    return view;
  }
};

inline DeformedShape deformed(const Shape &reference, Vec2 centre, const Mat2 &gradient) {
  std::vector<Vec2> vertices;
  for (const Vec2 v : reference.vertex) {
    vertices.push_back(centre + gradient(v));
  }
  return {reference, centre, gradient, inverse(gradient), shape_of(vertices)};
}

/// The same integrals about another origin.
inline RegionIntegrals about(RegionIntegrals region, Vec2 origin) {
  const Vec2 arm = region.origin - origin;
  region.dyad[0] += arm.x * region.force.x;
  region.dyad[1] += arm.x * region.force.y;
  region.dyad[2] += arm.y * region.force.x;
  region.dyad[3] += arm.y * region.force.y;
  region.pressure_moment += region.pressure * arm;
  region.origin = origin;
  return region;
}

/// Contact integrals of two blocks, all regions together, for k_n/2 = 1; zero where they do not meet.
inline RegionIntegrals contact_of(const BlockView &first, const BlockView &second,
                                  PotentialKind potential = PotentialKind::exact) {
  Overlap overlap;
  if (!overlap.find(first, second, potential)) {
    return {};
  }
  RegionIntegrals sum = overlap.integrate(overlap.regions().front());
  for (const Region &region : overlap.regions().subspan(1)) {
    const RegionIntegrals part = about(overlap.integrate(region), sum.origin);
    sum.force += part.force;
    for (std::size_t i = 0; i < 4; ++i) {
      sum.dyad[i] += part.dyad[i];
    }
    sum.pressure += part.pressure;
    sum.pressure_moment += part.pressure_moment;
  }
  return sum;
}

inline RegionIntegrals contact_of(const Shape &first, const Shape &second,
                                  PotentialKind potential = PotentialKind::exact) {
  return contact_of(first.view(), second.view(), potential);
}

/// Torque of the force on the first block.
inline double torque_about(const RegionIntegrals &region, Vec2 point) {
  return region.dyad[1] - region.dyad[2] + cross(region.origin - point, region.force);
}

} // namespace gcpdda::testing
