#pragma once

// Convex polygons cut by lines, for integrals over an overlap.

#include "gcpdda/geometry/vec2.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <vector>

namespace gcpdda {

using Polygon = std::vector<Vec2>;

/// A polygon of few vertices, without allocation; used as a Polygon is.
class SmallPolygon {
public:
  static constexpr std::size_t capacity = 32;

  SmallPolygon() {
  } // NOLINT(modernize-use-equals-default): it leaves the vertices as they are, most are never used
  template <class Iterator> SmallPolygon(Iterator first, Iterator last) { assign(first, last); }
  SmallPolygon(const SmallPolygon &other) { assign(other.begin(), other.end()); }
  SmallPolygon &operator=(const SmallPolygon &other) { return assign(other.begin(), other.end()), *this; }

  void push_back(Vec2 x) { vertices_[size_++] = x; }
  void clear() { size_ = 0; }
  [[nodiscard]] std::size_t size() const { return size_; }
  const Vec2 &operator[](std::size_t i) const { return vertices_[i]; }
  [[nodiscard]] const Vec2 *begin() const { return vertices_.data(); }
  [[nodiscard]] const Vec2 *end() const { return vertices_.data() + size_; }

private:
  template <class Iterator> void assign(Iterator first, Iterator last) {
    size_ = 0; // not std::copy: a call of memmove takes longer than the few vertices
    for (; first != last; ++first) {
      vertices_[size_++] = *first;
    }
  }

  union {
    std::array<Vec2, capacity> vertices_;
  };
  std::size_t size_ = 0;
};

/// The part of a convex polygon where distance(x) >= 0 for a linear function given by its values at the
/// vertices.
template <class Outline, class Distance>
Outline keep_positive(const Outline &polygon, const Distance &distance) {
  Outline kept;
  const double first = polygon.size() > 0 ? distance(polygon[0]) : 0.0;
  double db = first;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const bool is_last = i + 1 == polygon.size();
    const Vec2 a = polygon[i];
    const Vec2 b = polygon[is_last ? 0 : i + 1];
    const double da = db;
    db = is_last ? first : distance(b);
    if (da >= 0.0) {
      kept.push_back(a);
    }
    if ((da > 0.0 && db < 0.0) || (da < 0.0 && db > 0.0)) {
      kept.push_back(a + (da / (da - db)) * (b - a));
    }
  }
  return kept;
}

/// Least and largest value of a function at the vertices.
struct Extremes {
  double least = 0.0;
  double largest = 0.0;
};
template <class Outline, class Distance>
Extremes extremes_of(const Outline &polygon, const Distance &distance) {
  Extremes extremes{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  for (const Vec2 x : polygon) {
    const double d = distance(x);
    extremes.least = std::min(extremes.least, d);
    extremes.largest = std::max(extremes.largest, d);
  }
  return extremes;
}

/// int d dA of a linear function over a convex polygon: each triangle of the fan by the mean of its corners.
template <class Outline, class Distance>
double integrate_linear(const Outline &polygon, const Distance &distance) {
  double sum = 0.0;
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
    const double area = 0.5 * cross(polygon[i] - polygon[0], polygon[i + 1] - polygon[0]);
    sum += area * (distance(polygon[0]) + distance(polygon[i]) + distance(polygon[i + 1])) / 3.0;
  }
  return sum;
}

} // namespace gcpdda
