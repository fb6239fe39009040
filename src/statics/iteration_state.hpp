#pragma once

// What the static solver remembers between two evaluations, of all ranks alike.

#include <cstdint>

namespace gcpdda::statics {

/// Where an iteration of the static solver stands; the same on all ranks, and all that a checkpoint holds of
/// it besides BlockSystem::pseudo and the springs.
struct IterationState {
  std::int64_t evaluations = 0; ///< 0: it has not begun
  std::int64_t products = 0;    ///< with K
  std::int64_t is_left = 0;     ///< 1: the dynamic solver has taken over
  std::int64_t run = 0;         ///< evaluations since the motion has begun anew
  std::int64_t short_runs = 0;  ///< in a row, before that
  double power_before = 0.0;    ///< v.f at the beginning of the step at hand
  double momentum = 0.0;        ///< v.q
  double longest = 0.0;         ///< largest overlap so far, m
  double least_ratio = 1e300;   ///< least unbalanced ratio of the window at hand ...
  double last_least = 1e300;    ///< ... and of the one before
  double least_loose = 1.0;     ///< the same of the share of loose blocks
  double last_loose = 1.0;
  double skipped = 0.0; ///< s: the stage begins when its loads are complete
};

} // namespace gcpdda::statics
