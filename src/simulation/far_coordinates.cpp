#include "simulation/far_coordinates.hpp"

#include "contact/stiffness_bound.hpp"
#include "geometry/point_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace gcpdda {

namespace {

/// The rounding of coordinates at which settling begins to fail, as a share of the tolerance of a stage times
/// the largest overlap at rest over the square root of the number of blocks. Walls of 36 and 615 blocks and
/// slopes of 105 blocks settle at shares of 2.5 and do not at 4.5.
constexpr double share_that_disturbs = 3.0;

/// One unit in the last place of x, m.
double rounding_of(double x) {
  return std::nextafter(x, std::numeric_limits<double>::infinity()) - x;
}

/// A coordinate that is rounded by this much or less, m.
double coordinate_with(double rounding) {
  return rounding / std::numeric_limits<double>::epsilon();
}

double farthest_in(const Aabb &box) {
  return std::max({std::abs(box.low.x), std::abs(box.low.y), std::abs(box.high.x), std::abs(box.high.y)});
}

/// What to subtract from the coordinates `low` to `high` along an axis so that they lie at the origin: a
/// multiple of the power of ten below the `size` of the model. Zero where they lie near the origin already.
/// @param limit  largest coordinate that does not disturb, m
double round_offset(double low, double high, double size, double limit) {
  constexpr double near = 100.0; // sizes
  if (std::max(std::abs(low), std::abs(high)) <= std::min(near * size, limit)) {
    return 0.0;
  }
  const double step = std::pow(10.0, std::floor(std::log10(size)));
  return step * std::round(0.5 * (low + high) / step) + 0.0; // no negative zero
}

/// One digit, downwards.
double rounded_down(double x) {
  const double digit = std::pow(10.0, std::floor(std::log10(x)));
  return digit * std::floor(x / digit);
}

/// @param limit      largest coordinate that does not disturb, m
/// @param stiffness  largest normal stiffness that works where the model lies, Pa/m
std::string words_on_remedy(const Aabb &box, double limit, double stiffness) {
  const Vec2 extent = box.extent();
  const double size = std::max(extent.x, extent.y);
  if (size > limit) { // too large wherever its origin is
    return fmt::format("use normal_stiffness = {:.1g} or less", rounded_down(stiffness));
  }
  return fmt::format("subtract [{:.15g}, {:.15g}] from all coordinates, or use normal_stiffness = {:.1g} or "
                     "less",
                     round_offset(box.low.x, box.high.x, size, limit),
                     round_offset(box.low.y, box.high.y, size, limit), rounded_down(stiffness));
}

/// The stage that waits for the smallest unbalanced forces; null where no stage waits for rest.
const Stage *strictest_stage(const RunState &run) {
  const Stage *strictest = nullptr;
  for (const Stage &stage : run.clock.stages) {
    if (run.clock.is_staged && stage.until_verdict &&
        (strictest == nullptr || stage.tolerance < strictest->tolerance)) {
      strictest = &stage;
    }
  }
  return strictest;
}

} // namespace

// A joint closes by pressure/k_n, and the rounding of its coordinates makes a share rounding/(pressure/k_n)
// of its force wrong. A stage compares unbalanced forces with its tolerance times the largest force. Rounding
// that differs from step to step shakes the blocks; the largest unbalanced force grows with the square root
// of their number.
void doubt_coordinates(RunState &run, const ModelExtent &extent) {
  constexpr double least_depth = 10.0; // roundings by which the smallest block rests
  const double stiffness = stiffest_joint(run.scene.joints);
  const double farthest = farthest_in(extent.box);
  const double rounding = rounding_of(farthest);
  const double overlap = extent.pressure / stiffness;
  if (const Stage *stage = strictest_stage(run); stage != nullptr && overlap > 0.0) {
    const double most =
        share_that_disturbs * stage->tolerance * overlap / std::sqrt(static_cast<double>(extent.num_mobile));
    if (rounding > most) {
      run.notes.push_back(
          {Severity::warning, stage->where,
           fmt::format("coordinates of {} m are rounded by {:.2g} m, and joints close by no more than "
                       "{:.2g} m at rest",
                       coordinate_text(farthest), rounding, overlap),
           fmt::format("rounding disturbs their forces, and stage '{}' may never reach its tolerance of {:g}",
                       stage->name, stage->tolerance),
           words_on_remedy(extent.box, coordinate_with(most), stiffness * most / rounding)});
      return;
    }
  }
  double density = std::numeric_limits<double>::infinity();
  for (const Material &material : run.scene.materials) {
    density = std::min(density, material.density);
  }
  const double depth = density * norm(run.scene.run.gravity) * extent.smallest / stiffness;
  if (const double most = depth / least_depth; depth > 0.0 && rounding > most) {
    run.notes.push_back(
        {Severity::warning,
         {},
         fmt::format("the smallest block rests by an overlap of {:.2g} m, and coordinates of {} m are "
                     "rounded by {:.2g} m",
                     depth, coordinate_text(farthest), rounding),
         "forces at rest will be rounding errors",
         words_on_remedy(extent.box, coordinate_with(most), stiffness * most / rounding)});
  }
}

} // namespace gcpdda
