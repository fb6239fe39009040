#include "partition/cell_grid.hpp"

#include "base/check.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace gcpdda {

namespace {

std::int32_t cells_along(double length, double cell_size) {
  // A length that is a whole number of cells up to rounding gets no extra sliver; points beyond belong to the
  // border cell anyway.
  return std::max(1, static_cast<std::int32_t>(std::ceil(length / cell_size * (1.0 - 1e-12))));
}

} // namespace

CellGrid CellGrid::over(const Aabb &region, std::int64_t num_cells) {
  expect(num_cells >= 1 && num_cells <= max_background_cells, "background cells: 1 to 2^27");
  if (region.empty()) {
    return {};
  }
  const Vec2 extent = region.extent();
  expect(std::isfinite(extent.x) && std::isfinite(extent.y), "background cells: finite region");
  const auto n = static_cast<double>(num_cells);
  // Square cells of equal share; a strip thinner than those gets one row of cells.
  const double size =
      std::max(std::sqrt(extent.x / n) * std::sqrt(extent.y), std::max(extent.x, extent.y) / n);
  if (!(size > 0.0)) {
    return {.origin = region.low};
  }
  return {region.low, size, cells_along(extent.x, size), cells_along(extent.y, size)};
}

Aabb box_without_strays(std::span<const Vec2> points) {
  constexpr std::size_t few = 20;
  constexpr std::size_t points_per_stray = 1000;
  if (points.size() < few) {
    return bounding_box(points);
  }
  const auto strays = static_cast<std::ptrdiff_t>(1 + points.size() / points_per_stray);
  const auto range = [&](double Vec2::*coordinate) {
    std::vector<double> values;
    values.reserve(points.size());
    for (const Vec2 p : points) {
      values.push_back(p.*coordinate);
    }
    const auto lowest = values.begin() + strays;
    const auto highest = values.end() - 1 - strays;
    std::nth_element(values.begin(), lowest, values.end());
    std::nth_element(lowest + 1, highest, values.end());
    return std::pair(*lowest, *highest);
  };
  const auto [left, right] = range(&Vec2::x);
  const auto [low, high] = range(&Vec2::y);
  return {{left, low}, {right, high}};
}

} // namespace gcpdda
