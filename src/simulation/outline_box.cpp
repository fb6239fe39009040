#include "simulation/outline_box.hpp"

#include <cmath>

namespace gcpdda {

Aabb box_around(const BlockSystem &system, std::size_t row) {
  constexpr double rounding = 1e-6; // far above that of a vertex, which is that of its coordinates
  double reach = (1.0 + rounding) * system.properties[row].radius;
  if (system.is_deformable(row)) { // no vector grows by more than the norm of all four numbers
    const Mat2 &gradient = system.deformation_of(row).gradient;
    reach *= std::hypot(std::hypot(gradient.xx, gradient.xy), std::hypot(gradient.yx, gradient.yy));
  }
  const Vec2 centroid = system.centroid(row);
  return Aabb{centroid, centroid}.inflated(reach);
}

} // namespace gcpdda
