#include "model/joint_plane.hpp"

#include <cmath>

namespace gcpdda {

Pole pole_of(const JointPlane &plane) {
  return {std::sin(plane.dip) * std::cos(plane.bearing), std::cos(plane.dip),
          std::sin(plane.dip) * std::sin(plane.bearing)};
}

// Two unit vectors span the plane across the mean pole: one turns it towards a steeper dip, one along the
// strike.
Pole pole_near(const JointPlane &plane, double angle, double around) {
  const Pole mean = pole_of(plane);
  const Pole steeper{std::cos(plane.dip) * std::cos(plane.bearing), -std::sin(plane.dip),
                     std::cos(plane.dip) * std::sin(plane.bearing)};
  const Pole strike{-std::sin(plane.bearing), 0.0, std::cos(plane.bearing)};
  const double along = std::cos(angle);
  const double a = std::sin(angle) * std::cos(around);
  const double b = std::sin(angle) * std::sin(around);
  return {along * mean.x + a * steeper.x + b * strike.x, along * mean.y + a * steeper.y + b * strike.y,
          along * mean.z + a * steeper.z + b * strike.z};
}

double share_in_section(const Pole &pole) {
  return std::hypot(pole.x, pole.y);
}

double trace_angle(const Pole &pole) {
  return pole.y < 0.0 ? std::atan2(pole.x, -pole.y) : std::atan2(-pole.x, pole.y);
}

} // namespace gcpdda
