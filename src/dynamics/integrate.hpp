#pragma once

// The step of the blocks: predict trial configurations, solve each block's own system, update.

#include "base/instructions.hpp"
#include "dynamics/scheme.hpp"
#include "model/block_system.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <vector>

namespace gcpdda {

/// What acts on blocks through their own springs.
struct OwnForces {
  Vec2 wave{};                    ///< velocity of the wave that comes in through viscous sides, m/s
  double stiffness_damping = 0.0; ///< beta of Rayleigh damping, of the blocks' own elasticity, s
  double local_damping = 0.0;     ///< share of the net force that deformable blocks lose
};

/// Motion of a block that follows a velocity table: its velocity and the exact integral of it.
class PrescribedMotion {
public:
  /// @param table  at least one row, times strictly rising from 0
  explicit PrescribedMotion(std::span<const VelocityRow> table);

  [[nodiscard]] RigidDof velocity(double time) const;
  [[nodiscard]] RigidDof displacement(double time) const; ///< since t = 0
  /// The largest speed of a point as far from the centroid as `radius` (m) between two times (s), m/s.
  [[nodiscard]] double fastest(double begin, double end, double radius) const;

private:
  struct Row {
    double time = 0.0;
    RigidDof velocity;
    RigidDof displacement;
  };
  [[nodiscard]] const Row &last_before(double time) const;

  std::vector<Row> rows_;
};

/// Rows [first, last).
struct RowSpan {
  std::size_t first = 0;
  std::size_t last = 0;
};

/// The next trial configuration of a row. Angles r of a deformable row, of displacement and trial, are those
/// of F's rotation, unwrapped.
TrialConfiguration next_trial(const BlockSystem &system, const Scheme &scheme, double time_step,
                              std::size_t row);

/// Set the next trial configurations of these rows, with the increments from the ones before, and pose them.
void predict(BlockSystem &system, const Scheme &scheme, double time_step, RowSpan rows);
/// Predict all owned rows.
inline void predict(BlockSystem &system, const Scheme &scheme, double time_step) {
  predict(system, scheme, time_step, {0, system.num_owned});
}

/// As pose() of rows [first, last), all of which have been posed before; quadrilaterals several at a time.
void pose_in_lanes(BlockSystem &system, std::size_t first, std::size_t last);

/// a = M^-1 f of one rigid block.
inline RigidDof accelerate(const BlockProperties &block, const RigidDof &force) {
  return {(1.0 / block.mass) * force.u, force.r / block.inertia};
}

/// a_n = M^-1 f of all owned rows, elastic forces of deformable rows (at their trial configuration) included:
/// the consistent start. Anchored points do not accelerate.
void accelerate(BlockSystem &system);

/// Largest distance (m) a point of the block may move before the next trial configuration has been left
/// behind.
inline double motion_bound(const BlockSystem &system, std::size_t row, double time_step) {
  const double radius = system.properties[row].radius;
  const RigidDof &v = system.velocity[row];
  const RigidDof &a = system.acceleration[row];
  double turning = std::abs(v.r);
  double turning_rate = std::abs(a.r);
  if (system.is_deformable(row)) {
    turning = norm(system.deformation_of(row).rate);
    turning_rate = norm(system.deformation_of(row).acceleration);
  }
  return time_step * (norm(v.u) + radius * turning) +
         time_step * time_step * (norm(a.u) + radius * turning_rate);
}

/// Largest distance (m) a point of the block has moved since the last refresh of the neighbourhood.
inline double moved_since_refresh(const BlockSystem &system, std::size_t row) {
  const RigidDof moved = system.displacement[row] - system.refreshed[row];
  double turned = std::abs(moved.r);
  if (system.is_deformable(row)) {
    const Deformation &d = system.deformation_of(row);
    turned = norm(d.gradient - d.refreshed);
  }
  return norm(moved.u) + system.properties[row].radius * turned;
}

constexpr double rounding_of_most_motion = 1.0 + 1e-12;

/// No less than the sum of these two, and found without a root.
inline double most_motion(const BlockSystem &system, std::size_t row, double time_step) {
  const double radius = system.properties[row].radius;
  const auto most = [](Vec2 u) { return std::abs(u.x) + std::abs(u.y); };
  const auto most_turn = [](const Mat2 &f) {
    return std::abs(f.xx) + std::abs(f.xy) + std::abs(f.yx) + std::abs(f.yy);
  };
  const RigidDof moved = system.displacement[row] - system.refreshed[row];
  const RigidDof &v = system.velocity[row];
  const RigidDof &a = system.acceleration[row];
  double turned = std::abs(moved.r);
  double turning = std::abs(v.r);
  double turning_rate = std::abs(a.r);
  if (system.is_deformable(row)) {
    const Deformation &d = system.deformation_of(row);
    turned = most_turn(d.gradient - d.refreshed);
    turning = most_turn(d.rate);
    turning_rate = most_turn(d.acceleration);
  }
  return rounding_of_most_motion *
         (most(moved.u) + radius * turned +
          time_step * (most(v.u) + radius * turning + time_step * (most(a.u) + radius * turning_rate)));
}

/// What is to be known of rows that have been advanced.
struct AdvanceReport {
  /// The first one whose new state is not finite, or was turned inside out (det F <= 0); it keeps its old
  /// one.
  std::optional<std::size_t> broken;
  std::vector<RowSpan> rows_to_check; ///< most_motion() of all other rows is at most safe_motion
  double largest_turn = 0.0;          ///< of a deformable one, rad

  void add_broken(std::size_t row) { broken = std::min(row, broken.value_or(row)); }
  void add_turn(double turn) { largest_turn = std::max(largest_turn, turn); }
  void clear() {
    broken.reset();
    rows_to_check.clear();
    largest_turn = 0.0;
  }
};

/// Advance owned rows [first, last) from t_n to t_{n+1} under their total forces: one system each, diagonal
/// for a rigid block without fixed points, else by its own factorised matrix. Needs make_block_matrices().
///
/// What local damping takes from deformable rows is added to their forces and damping forces, and its work
/// over the increment of x* that ends here to their ledger.
///
/// The elastic and anchor forces that were applied are noted; of the anchors' work the half over the
/// increment of x* that ends here, the other half is the caller's after the next predict().
///
/// @param safe_motion  a row whose most_motion() is at most this needs no check, m
void solve_and_update(BlockSystem &system, const OwnForces &own, const Scheme &scheme, double time_step,
                      Elasticity elasticity, std::size_t first, std::size_t last, double safe_motion,
                      AdvanceReport &report);
/// All owned rows.
/// @return first row whose new state is broken
inline std::optional<std::size_t> solve_and_update(BlockSystem &system, const OwnForces &own,
                                                   const Scheme &scheme, double time_step,
                                                   Elasticity elasticity) {
  AdvanceReport report;
  solve_and_update(system, own, scheme, time_step, elasticity, 0, system.num_owned,
                   std::numeric_limits<double>::infinity(), report);
  return report.broken;
}

} // namespace gcpdda
