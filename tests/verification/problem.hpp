#pragma once

// Runs of the verification problems, and what each check prints and adds to the table.

#include "support/setting.hpp"

#include <filesystem>
#include <optional>
#include <string>

namespace gcpdda::testing {

/// One step, counted as cost of the current test.
void step(Simulation &simulation);
/// Step to a time that is a whole number of steps, or to the next step after it; a fault fails the test.
void run_until(Simulation &simulation, double time);
/// Step to the end.
void run(Simulation &simulation);

// Each check prints problem, what is expected, what was got and the error, and appends the same, with CPU
// time and steps of the test so far, to the CSV file that GCPDDA_VERIFICATION_TABLE names, if it does.

/// The relative error is at most the tolerance.
void expect_value(const std::string &problem, double expected, double got, double tolerance);
/// At most the limit.
void expect_below(const std::string &problem, double limit, double got);
/// At least the limit.
void expect_above(const std::string &problem, double limit, double got);

/// GCPDDA_VERIFICATION_FULL is set: problems take their full size however long it
/// takes.
bool full_size();
/// Where further tables go: beside the table of checks; none without one.
std::optional<std::filesystem::path> table_folder();

} // namespace gcpdda::testing
