#pragma once

// Searches for factors of safety that are known otherwise, each with the static and the dynamic solver.

#include "problem.hpp"

#include "driver/safety_factor.hpp"
#include "gcpdda/model/scene.hpp"

#include <string>

namespace gcpdda::testing {

/// gcpdda fos, whose files are removed, or the bound of limit analysis alone.
SafetyOutcome search_quietly(const Scene &scene, bool only_bound = false);

/// Whether the thresholds of a trial's verdict (simulation/stages.hpp) were set with a system in view. No
/// threshold may be set with a system of the untouched half.
enum class Half { tuned, untouched };

/// A system of blocks whose factor of safety is known.
struct KnownLimit {
  std::string problem;
  double factor = 1.0;
  Half half = Half::untouched;
  double tolerance = 0.01;       ///< of the middle of the bracket; the default bracket is as wide
  double bound_tolerance = 3e-3; ///< of the bound of limit analysis; 0: no bound is asked for
};

/// Searches the factor of a scene with both solvers, expects exit code 0, no undecided trial and a factor
/// within the tolerance, and adds a row for each to safety_limits.csv beside the table of checks.
void expect_factor(const KnownLimit &limit, const Scene &scene);
/// Expects the same of a scene with a settle stage of 10 s and defaults for everything else.
void expect_factor(const KnownLimit &limit, const std::string &toml);

} // namespace gcpdda::testing
