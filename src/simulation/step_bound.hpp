#pragma once

// What limits the time step.

#include <cstdint>
#include <limits>

namespace gcpdda {

struct RunState;

/// The block that moves fastest among some.
struct FastestBlock {
  double speed = 0.0;      ///< of any of its points, m/s; 0: none moves
  std::int64_t block = -1; ///< the first of several
};

struct StepBound {
  /// Of the farthest that a block may move in a step, in a step that blocks with given velocities set.
  static constexpr double share_of_motion = 0.9;

  double omega_max = 0.0; ///< rad/s, 0 where forces move no block
  double limit = 2.0;     ///< stable W of scheme and damping; 2 stands in where every W is unstable
  bool always_unstable = false;
  /// run.safety; where a stage settles 0.9, unless run.safety is below its default; 1 where strong dashpots
  /// set the limit
  double safety = 0.0;
  double undamped_step = 0.0; ///< the step without Rayleigh damping, s
  double stable_step = 0.0;   ///< safety * limit / omega_max, s
  double time_step = 0.0;     ///< the shorter one of this and of motion_step, s
  double damping_ratio = 0.0; ///< modal ratio the limit was computed with
  std::int64_t block = -1;    ///< the one that sets omega_max; the first of several
  double without_bolts = 0.0; ///< what omega_max would be then, rad/s
  FastestBlock fastest;       ///< of those to which the scene gives a velocity in this stage
  /// The step in which it moves by share_of_motion of the farthest that a block may, s.
  double motion_step = std::numeric_limits<double>::infinity();

  [[nodiscard]] bool is_set_by_motion() const { return motion_step < stable_step; }
};

/// The fastest of the blocks that have just been taken from the scene and that no velocity is prescribed for.
/// Collective.
FastestBlock fastest_at_start(const RunState &run);

/// Sets run.bound for the stage that begins. Collective.
void find_bound(RunState &run);

/// In a stage with mass scaling each block is made as heavy as its joints need it to be to swing no faster
/// than the slowest block: the step is then as long as for that one. By powers of two, which can be taken
/// back without rounding. Collective.
void scale_masses(RunState &run);
void unscale_masses(RunState &run);

} // namespace gcpdda
