#pragma once

// Joint planes in space and their traces in the section of the model. The axes are those of the section: x
// along it, y up, z out of it.

#include "gcpdda/model/rock_region.hpp"

namespace gcpdda {

/// Unit normal of a plane.
struct Pole {
  double x = 0.0;
  double y = 0.0;
  double z = 0.0;
};

/// The upward normal of the mean plane.
Pole pole_of(const JointPlane &plane);

/// A pole at `angle` from that of the mean plane, rad, turned about it by `around`.
Pole pole_near(const JointPlane &plane, double angle, double around);

/// Length of the pole's part in the section, 0 to 1: true spacing over apparent spacing, and 0 for a plane
/// that is parallel to the section.
double share_in_section(const Pole &pole);

/// Angle of the plane's trace against the x axis, counter-clockwise, in [-pi/2, pi/2]:
/// tan(angle) = -tan(dip) cos(dip direction - azimuth). A plane that dips towards +x has a negative one.
double trace_angle(const Pole &pole);

} // namespace gcpdda
