#pragma once

#include <string>

namespace gcpdda::testing {

/// run/scenes/plane_failure.toml, a block on a plane of 30 degrees with a friction angle of 40 degrees, with
/// a cohesion that adds this to its factor of safety against sliding, tan(phi)/tan(th) + c l/(W sin(th)).
std::string plane_failure_toml(double from_cohesion);
double plane_failure_factor(double from_cohesion);

} // namespace gcpdda::testing
