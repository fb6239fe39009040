#pragma once

// Numbers by row and degree of freedom, as the solver of the statics module works on them.
//
// A rigid block has the freedoms (u_x, u_y, r). A deformable block has (u_x, u_y, H_xx, H_xy, H_yx, H_yy),
// where a small motion takes its point at the arm a from the centroid by u + H a: H = dF F^-1 with dF the
// change of its deformation gradient. A rigid motion is H = r J with J = [0 -1; 1 0]. The forces that work on
// these freedoms are the force f, the moment (rigid) and the dyad W = sum of f a^T (deformable): the moment
// of a dyad is W_yx - W_xy.
//
// All rows of a field have the same number of places, `width`: 3 where no block of the scene deforms, else
// 6. A rigid row leaves the last three of six at zero.

#include "model/block_system.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

namespace gcpdda::statics {

/// A small motion of one block, or the forces that work on it: u + H a at the arm a, or f and W.
struct PointMap {
  Vec2 u;
  Mat2 gradient;

  [[nodiscard]] Vec2 at(Vec2 arm) const { return u + gradient(arm); }
};

/// H of a rotation.
constexpr Mat2 turning(double r) {
  return {0.0, -r, r, 0.0};
}
/// The moment of a dyad of forces.
constexpr double moment_of(const Mat2 &dyad) {
  return dyad.yx - dyad.xy;
}

template <class Number> class FieldOf {
public:
  FieldOf() = default;
  FieldOf(std::size_t num_rows, std::size_t width) : width_(width), values_(num_rows * width) {}

  [[nodiscard]] std::size_t width() const { return width_; }
  [[nodiscard]] std::size_t num_rows() const { return width_ == 0 ? 0 : values_.size() / width_; }
  [[nodiscard]] Number *of(std::size_t row) { return values_.data() + row * width_; }
  [[nodiscard]] const Number *of(std::size_t row) const { return values_.data() + row * width_; }
  [[nodiscard]] std::span<Number> values() { return values_; }
  [[nodiscard]] std::span<const Number> values() const { return values_; }

private:
  std::size_t width_ = 0;
  std::vector<Number> values_;
};

using Field = FieldOf<double>;
/// In single precision, rows padded with zeros to `lean_width` places, which vector instructions take whole.
using LeanField = FieldOf<float>;
constexpr std::size_t lean_width(std::size_t width) {
  return width == 3 ? 4 : 8;
}

/// Rows [first, last).
struct RowRun {
  std::size_t first = 0;
  std::size_t last = 0;
};

/// Rows come in ascending order.
inline void append_row(std::vector<RowRun> &runs, std::size_t row) {
  if (runs.empty() || runs.back().last < row) {
    runs.push_back({row, row});
  }
  runs.back().last = row + 1;
}

/// Owned rows that forces move, in runs. Fields are zero on the others, and their places are left alone.
inline std::vector<RowRun> moving_rows(const BlockSystem &system) {
  std::vector<RowRun> runs;
  for (std::size_t row = 0; row < system.num_owned; ++row) {
    if (!system.properties[row].keeps_its_velocity()) {
      append_row(runs, row);
    }
  }
  return runs;
}
/// visit(row)
template <class Visit> void for_rows(std::span<const RowRun> runs, Visit &&visit) {
  for (const RowRun &run : runs) {
    for (std::size_t row = run.first; row < run.last; ++row) {
      visit(row);
    }
  }
}
/// visit(place) of all values of a field.
template <class Visit> void for_places(std::span<const RowRun> runs, std::size_t width, Visit &&visit) {
  for (const RowRun &run : runs) {
    for (std::size_t place = run.first * width; place < run.last * width; ++place) {
      visit(place);
    }
  }
}

/// Number of freedoms of a row.
inline std::size_t num_freedoms(const BlockSystem &system, std::size_t row) {
  return system.is_deformable(row) ? 6 : 3;
}

/// Largest distance that a point of an owned row moves by the motion of its next step, m.
inline double length_of_step(const BlockSystem &system, std::size_t row) {
  const std::array<double, 6> &v = system.pseudo[row].velocity;
  const double turning = system.is_deformable(row) ? norm(Mat2{v[2], v[3], v[4], v[5]}) : std::abs(v[2]);
  return norm(Vec2{v[0], v[1]}) + system.properties[row].radius * turning;
}

template <class Number> PointMap motion_at(const Number *freedoms, bool is_deformable) {
  return {{freedoms[0], freedoms[1]},
          is_deformable ? Mat2{freedoms[2], freedoms[3], freedoms[4], freedoms[5]} : turning(freedoms[2])};
}
template <class Number> void add_force(Number *freedoms, bool is_deformable, Vec2 force, const Mat2 &dyad) {
  const auto add = [&](std::size_t i, double value) { freedoms[i] += static_cast<Number>(value); };
  add(0, force.x);
  add(1, force.y);
  if (is_deformable) {
    add(2, dyad.xx);
    add(3, dyad.xy);
    add(4, dyad.yx);
    add(5, dyad.yy);
  } else {
    add(2, moment_of(dyad));
  }
}

} // namespace gcpdda::statics
