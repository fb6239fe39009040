#include "dynamics/integrate.hpp"

#include "base/prefetch.hpp"
#include "dynamics/block_solve.hpp"
#include "dynamics/deformable.hpp"
#include "dynamics/lanes/block_lanes.hpp"
#include "dynamics/own_springs.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

namespace gcpdda {

namespace {

bool is_finite(const RigidDof &a) {
  return std::isfinite(a.u.x) && std::isfinite(a.u.y) && std::isfinite(a.r);
}

} // namespace

PrescribedMotion::PrescribedMotion(std::span<const VelocityRow> table) {
  for (const VelocityRow &row : table) {
    Row next{row.time, {{row.velocity[0], row.velocity[1]}, row.velocity[2]}, {}};
    if (!rows_.empty()) {
      const Row &last = rows_.back();
      next.displacement =
          last.displacement + (0.5 * (next.time - last.time)) * (last.velocity + next.velocity);
    }
    rows_.push_back(next);
  }
}

const PrescribedMotion::Row &PrescribedMotion::last_before(double time) const {
  const auto after = std::upper_bound(rows_.begin() + 1, rows_.end(), time,
                                      [](double t, const Row &row) { return t < row.time; });
  return *std::prev(after);
}

RigidDof PrescribedMotion::velocity(double time) const {
  const Row &row = last_before(time);
  if (&row == &rows_.back()) {
    return row.velocity;
  }
  const Row &next = *(&row + 1);
  return row.velocity + ((time - row.time) / (next.time - row.time)) * (next.velocity - row.velocity);
}

RigidDof PrescribedMotion::displacement(double time) const {
  const Row &row = last_before(time);
  return row.displacement + (0.5 * (time - row.time)) * (row.velocity + velocity(time));
}

double PrescribedMotion::fastest(double begin, double end, double radius) const {
  const auto speed = [&](const RigidDof &v) { return norm(v.u) + radius * std::abs(v.r); };
  double most = std::max(speed(velocity(begin)), speed(velocity(end)));
  for (const Row &row : rows_) { // a velocity between two rows is slower than one of both
    most = row.time > begin && row.time < end ? std::max(most, speed(row.velocity)) : most;
  }
  return most;
}

namespace {

/// Rows with four vertices on their way to the lanes.
class Quads {
public:
  Quads(BlockSystem &system, std::size_t width, PoseQuads pose)
      : system_(system), width_(width), pose_(pose) {}

  void add(std::size_t row) {
    system_.motion[row].centroid = system_.properties[row].centroid + system_.trial[row].u;
    rows_[count_++] = row;
    if (count_ == width_) {
      flush();
    }
  }
  void flush() {
    if (count_ > 0) {
      pose_(system_, std::span(rows_).first(count_));
    }
    count_ = 0;
  }

private:
  BlockSystem &system_;
  const std::size_t width_;
  const PoseQuads pose_;
  std::array<std::size_t, most_lanes> rows_;
  std::size_t count_ = 0;
};

} // namespace

void pose_in_lanes(BlockSystem &system, std::size_t first, std::size_t last) {
  const BlockLanes &lanes = block_lanes(Instructions::widest);
  Quads rigid(system, lanes.width, lanes.pose_rigid_quads);
  Quads deformable(system, lanes.width, lanes.pose_deformable_quads);
  std::size_t others = first; // where a run of them may begin
  for (std::size_t row = first; row < last; ++row) {
    if (system.num_vertices(row) == 4) {
      (system.is_deformable(row) ? deformable : rigid).add(row);
    } else if (row + 1 == last || system.num_vertices(row + 1) == 4) {
      pose(system, others, row + 1);
    } else {
      continue;
    }
    others = row + 1;
  }
  rigid.flush();
  deformable.flush();
}

namespace {

/// x* - x_n by v_n and a_n.
struct TrialFactors {
  double by_velocity;
  double by_acceleration;

  TrialFactors(const Scheme &scheme, double time_step)
      : by_velocity(scheme.trial_velocity * time_step),
        by_acceleration(scheme.trial_acceleration * time_step * time_step) {}
  template <class T>
  [[nodiscard]] T operator()(const T &state, const T &velocity, const T &acceleration) const {
    return state + (by_velocity * velocity + by_acceleration * acceleration);
  }
};

TrialConfiguration next_trial(const BlockSystem &system, const TrialFactors &next, std::size_t row) {
  TrialConfiguration trial{next(system.displacement[row], system.velocity[row], system.acceleration[row]),
                           {}};
  if (system.is_deformable(row)) {
    const Deformation &d = system.deformation_of(row);
    trial.gradient = next(d.gradient, d.rate, d.acceleration);
    trial.motion.r = system.displacement[row].r + angle_between(d.gradient, trial.gradient);
  }
  return trial;
}

} // namespace

TrialConfiguration next_trial(const BlockSystem &system, const Scheme &scheme, double time_step,
                              std::size_t row) {
  return next_trial(system, TrialFactors(scheme, time_step), row);
}

void predict(BlockSystem &system, const Scheme &scheme, double time_step, RowSpan rows) {
  pose(system, 0, 0); // lists have their lengths
  const TrialFactors next(scheme, time_step);
  const BlockLanes &lanes = block_lanes(Instructions::widest);
  const auto in_lanes = [&](std::size_t row) { // were they?
    const std::size_t end = row + lanes.width;
    if (end > rows.last) {
      return false;
    }
    const std::size_t num_deformable = system.deformation_begin[end] - system.deformation_begin[row];
    if (num_deformable == 0) {
      lanes.predict_rigids(system, row, next.by_velocity, next.by_acceleration);
    } else if (num_deformable == lanes.width) {
      prefetch(system.deformation.data() + system.deformation_begin[end], lanes.width * sizeof(Deformation));
      lanes.predict_deformables(system, row, next.by_velocity, next.by_acceleration);
    }
    return num_deformable == 0 || num_deformable == lanes.width;
  };
  for (std::size_t row = rows.first; row < rows.last;) {
    if (in_lanes(row)) {
      row += lanes.width;
    } else {
      set_trial(system, row, next_trial(system, next, row));
      ++row;
    }
  }
  pose_in_lanes(system, rows.first, rows.last);
}

void accelerate(BlockSystem &system) {
  for (std::size_t i = 0; i < system.num_owned; ++i) {
    const bool held = system.has_matrix(i) && !system.anchors_of(i).empty();
    if (!system.is_deformable(i)) {
      system.acceleration[i] = held ? accelerate_held(system, i, system.contact[i].force, {}).rigid
                                    : accelerate(system.properties[i], system.contact[i].force);
      continue;
    }
    Deformation &d = system.deformation_of(i);
    d.internal = elastic_force(d, d.trial);
    const Mat2 force = d.contact.force - d.internal;
    const HeldAcceleration a =
        held ? accelerate_held(system, i, system.contact[i].force, force)
             : HeldAcceleration{accelerate(system.properties[i], system.contact[i].force),
                                force * inverse(d.second_moment)};
    d.acceleration = a.gradient;
    system.acceleration[i] = {a.rigid.u, 0.0};
  }
}

void solve_and_update(BlockSystem &system, const OwnForces &own, const Scheme &scheme, double time_step,
                      Elasticity elasticity, std::size_t first, std::size_t last, double safe_motion,
                      AdvanceReport &report) {
  const BlockSolve step = block_solve(own, scheme, time_step, elasticity);
  solve_by_matrix(system, step, first, last, safe_motion, report);
  for (std::size_t i = first; i < last; ++i) {
    if (deforms_freely(system, i)) {
      continue; // and was looked at in the lanes that stepped it
    }
    report.rows_to_check.push_back({i, i + 1});
    if (system.has_matrix(i)) {
      continue;
    }
    const RigidDof a = system.acceleration[i];
    const RigidDof a_new = (1.0 / (1.0 - scheme.alpha_m)) *
                           (accelerate(system.properties[i], system.contact[i].force) - scheme.alpha_m * a);
    const RigidDof d_new =
        system.displacement[i] + (time_step * system.velocity[i] +
                                  time_step * time_step * ((0.5 - scheme.beta) * a + scheme.beta * a_new));
    const RigidDof v_new = system.velocity[i] + time_step * ((1.0 - scheme.gamma) * a + scheme.gamma * a_new);
    if (!is_finite(a_new) || !is_finite(v_new) || !is_finite(d_new)) {
      report.add_broken(i);
      continue;
    }
    system.acceleration[i] = a_new;
    system.displacement[i] = d_new;
    system.velocity[i] = v_new;
  }
}

} // namespace gcpdda
