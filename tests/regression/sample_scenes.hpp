#pragma once

#include <string>

namespace gcpdda::testing {

/// Two blocks and a fixed floor, 0.1 s in 4 outputs: "slider" slides on "floor", "tower" stands on it. Line
/// and column of what follows are what the tests of diagnostics count on.
std::string small_scene();

/// A head with this normal stiffness, time step and duration, and a floor; blocks are added by the test.
std::string head_scene(double normal_stiffness, double time_step, double duration);

} // namespace gcpdda::testing
