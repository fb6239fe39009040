#include "support/plane_failure.hpp"

#include "support/scenes.hpp"
#include "support/setting.hpp"

#include <fmt/format.h>

#include <cmath>

namespace gcpdda::testing {

namespace {
constexpr double slope = 30.0 * degree;
constexpr double friction_deg = 40.0;
} // namespace

std::string plane_failure_toml(double from_cohesion) {
  const Vec2 size{2.0, 0.5};
  const double weight = rock_density * earth_gravity * size.x * size.y;
  return fmt::format(R"([run]
fidelity = "rigid"
gravity = [{:.17g}, {:.17g}]
[material.rock]
density = {}
[joint.default]
normal_stiffness = 2e8
friction_angle_deg = {}
cohesion = {:.17g}
[[stage]]
kind = "settle"
limit = 10.0
[fos]
tolerance = 0.004
limit = 30.0
)",
                     earth_gravity * std::sin(slope), -earth_gravity * std::cos(slope), rock_density,
                     friction_deg, from_cohesion * weight * std::sin(slope) / size.x) +
         block_toml("slope", rectangle({-2.0, -1.0}, {20.0, 0.0}), "fixed = true") +
         block_toml("slider", rectangle({0.0, 0.0}, size));
}

double plane_failure_factor(double from_cohesion) {
  return std::tan(friction_deg * degree) / std::tan(slope) + from_cohesion;
}

} // namespace gcpdda::testing
