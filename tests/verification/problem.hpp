#pragma once

// Runs of the verification problems, and the line each check prints.

#include "support/setting.hpp"

#include <string>

namespace gcpdda::testing {

/// Step to a time that is a whole number of steps, or to the next step after it; a fault fails the test.
void run_until(Simulation &simulation, double time);
/// Step to the end.
void run(Simulation &simulation);

/// Prints problem, expected, got and relative error, and fails above the tolerance.
void expect_value(const std::string &problem, double expected, double got, double tolerance);
/// Prints problem, limit and value, and fails above the limit.
void expect_below(const std::string &problem, double limit, double got);
/// Prints problem and both numbers, and fails below the limit.
void expect_above(const std::string &problem, double limit, double got);

} // namespace gcpdda::testing
