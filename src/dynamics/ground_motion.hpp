#pragma once

// Motion of the ground by a record.
//
// A rigid base. Whatever is held - fixed blocks and sides, rollers, fixed points - moves with the base, and
// all positions and velocities of the run are those against it: in axes that move with acceleration a(t) each
// block has the force -m a(t) besides its others, and no other change. So a block that has not moved against
// the base has the displacement zero, and what is left when the shaking is over is the permanent one.
//
// In a step that begins at t_n the force is that of the mean acceleration
//     a = [v(t + dt/2) - v(t - dt/2)]/dt,     t = t_n + (1 - af) dt,
// so that its impulses add up to the velocity of the record, whatever the step; where a is constant it is a.

#include "gcpdda/model/earthquake.hpp"

#include <vector>

namespace gcpdda {

class GroundMotion {
public:
  GroundMotion() = default;
  /// Rows of velocity have a constant acceleration between them, rows of acceleration a linear one.
  /// @param earthquake  with its record, two rows at least
  explicit GroundMotion(const Earthquake &earthquake);

  /// Time since its first row, s. Before it the velocity (m/s) is that of the first row, after the last row
  /// that of the last one: blocks that move with the base notice neither.
  [[nodiscard]] Vec2 velocity(double time) const;
  /// Since the first row, m.
  [[nodiscard]] Vec2 displacement(double time) const;
  /// Mean acceleration within dt/2 of a time (m/s2); zero before the first row, which is not reached across.
  [[nodiscard]] Vec2 mean_acceleration(double time, double time_step) const;

  [[nodiscard]] double duration() const { return pieces_.empty() ? 0.0 : pieces_.back().time; }
  /// Largest size of the acceleration, m/s2.
  [[nodiscard]] double peak_acceleration() const { return peak_; }

private:
  /// From its time to that of the next one: a + j (t - time).
  struct Piece {
    double time = 0.0;
    Vec2 displacement;
    Vec2 velocity;
    Vec2 acceleration;
    Vec2 jerk;
  };
  [[nodiscard]] const Piece &piece_at(double time) const;
  void join();
  void correct(Baseline baseline);

  std::vector<Piece> pieces_; ///< the last one is at rest with respect to the end of the record
  double peak_ = 0.0;
};

} // namespace gcpdda
