#pragma once

#include <string>

namespace gcpdda::testing {

/// A block of 2 m by 0.5 m on a plane of 30 degrees with a friction angle of 40 degrees, and a cohesion that
/// adds this to its factor of safety against sliding, tan(phi)/tan(th) + c l/(W sin(th)); with [[stage]] and
/// [fos].
std::string plane_failure_toml(double from_cohesion);
double plane_failure_factor(double from_cohesion);

} // namespace gcpdda::testing
