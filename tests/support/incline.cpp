#include "incline.hpp"

#include "contact/block_view.hpp"
#include "contact/contact_forces.hpp"
#include "model/block_system.hpp"

#include <array>
#include <cmath>
#include <stdexcept>

namespace gcpdda::testing {

namespace {

/// What is missing to steady sliding: {normal force - m g cos, moment about the centroid}, with the normal
/// force from the code's own overlap integrals and friction of the full cap at x_r, against the motion.
std::array<double, 2> imbalance(const Incline &incline, BlockSystem &system, double depth, double tilt) {
  system.trial[0] = {-depth * incline.outward(), tilt};
  pose(system, 0, 2);
  Overlap overlap;
  std::array<TrialOutline, 2> outlines;
  if (!overlap.find(view_of(system, 0, outlines[0]), view_of(system, 1, outlines[1]), PotentialKind::exact)) {
    throw std::runtime_error("the sliding square has lost its plane");
  }
  const RegionIntegrals region = overlap.integrate(overlap.regions().front());
  const double half = 0.5 * incline.normal_stiffness;
  const Vec2 normal_force = half * region.force;
  const Vec2 normal = (1.0 / norm(normal_force)) * normal_force;
  const Vec2 friction = (norm(normal_force) * std::tan(incline.friction_deg * degree)) * perp(normal);
  const Vec2 point = region.origin + (1.0 / region.pressure) * region.pressure_moment;
  const Vec2 centroid = system.motion[0].centroid;
  const double moment = half * (region.dyad[1] - region.dyad[2]) +
                        cross(region.origin - centroid, normal_force) + cross(point - centroid, friction);
  return {dot(normal_force + friction, incline.outward()) -
              incline.weight() * std::cos(incline.slope_deg * degree),
          moment};
}

} // namespace

Vec2 Incline::downhill() const {
  return {std::cos(slope_deg * degree), -std::sin(slope_deg * degree)};
}

double Incline::acceleration() const {
  return earth_gravity *
         (std::sin(slope_deg * degree) - std::tan(friction_deg * degree) * std::cos(slope_deg * degree));
}

std::vector<Vec2> Incline::in_world(const std::vector<Vec2> &points) const {
  return placed(points, -slope_deg * degree, foot);
}

std::vector<Vec2> Incline::plane() const {
  return in_world(rectangle({-5.0, -2.0}, {30.0, 0.0}));
}

std::vector<Vec2> Incline::flat_square(double depth) const {
  return in_world(rectangle({-0.5, -depth}, {0.5, 1.0 - depth}));
}

double Incline::static_depth() const {
  return 1.0 - std::sqrt(1.0 - 2.0 * weight() * std::cos(slope_deg * degree) / normal_stiffness);
}

std::vector<Vec2> Incline::sliding_square() const {
  BlockSystem system;
  SceneBlock square;
  square.vertices = flat_square(0.0);
  SceneBlock support;
  support.vertices = plane();
  support.fixed = true;
  append_block(system, BlockId{1}, square, Material{"rock", rock_density});
  append_block(system, BlockId{0}, support, Material{"rock", rock_density});

  // Start from a linear pressure under the base: resultant at e = tan(phi)/2 from its middle, over the whole
  // base while e <= 1/6, else over the three-fold distance to the toe. Clockwise tilt sinks the toe.
  const double normal = weight() * std::cos(slope_deg * degree);
  const double lever = 0.5 * std::tan(friction_deg * degree);
  const bool whole_base = lever <= 1.0 / 6.0;
  const double length = whole_base ? 1.0 : 3.0 * (0.5 - lever);
  double tilt = -(whole_base ? 12.0 * lever : 2.0 / (length * length)) * normal / normal_stiffness;
  double depth = whole_base ? normal / normal_stiffness : -tilt * (length - 0.5);

  for (int iteration = 0; iteration < 12; ++iteration) {
    const double step = 1e-4 * static_depth();
    const auto f = imbalance(*this, system, depth, tilt);
    const auto f_deeper = imbalance(*this, system, depth + step, tilt);
    const auto f_turned = imbalance(*this, system, depth, tilt + step);
    const double a = (f_deeper[0] - f[0]) / step;
    const double b = (f_turned[0] - f[0]) / step;
    const double c = (f_deeper[1] - f[1]) / step;
    const double d = (f_turned[1] - f[1]) / step;
    const double determinant = a * d - b * c;
    depth -= (d * f[0] - b * f[1]) / determinant;
    tilt -= (a * f[1] - c * f[0]) / determinant;
  }
  imbalance(*this, system, depth, tilt);
  return TrialOutline(system, 0).vertex;
}

std::string Incline::toml(const std::vector<Vec2> &square, Setting setting) const {
  setting.friction_deg = friction_deg;
  setting.normal_stiffness = normal_stiffness;
  return head(setting) + block_toml("plane", plane(), "fixed = true") + block_toml("slider", square);
}

} // namespace gcpdda::testing
