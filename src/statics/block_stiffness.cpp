#include "statics/block_stiffness.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace gcpdda::statics {

namespace {

/// Forces on the freedoms of a row of a unit force d at an arm.
std::array<double, 6> forces_of(bool is_deformable, Vec2 d, Vec2 arm) {
  std::array<double, 6> b{};
  add_force(b.data(), is_deformable, d, outer(d, arm));
  return b;
}

template <std::size_t freedoms>
void add_fixed_square(const std::array<double, 6> &b, double stiffness, double *matrix, std::size_t width) {
  for (std::size_t i = 0; i < freedoms; ++i) {
    for (std::size_t j = 0; j < freedoms; ++j) {
      matrix[i * width + j] += stiffness * b[i] * b[j];
    }
  }
}
void add_square(const std::array<double, 6> &b, double stiffness, std::size_t freedoms, double *matrix,
                std::size_t width) {
  if (freedoms == 3) {
    add_fixed_square<3>(b, stiffness, matrix, width);
  } else {
    add_fixed_square<6>(b, stiffness, matrix, width);
  }
}

/// Where a material point is from the centroid.
Vec2 arm_of(const BlockSystem &system, std::size_t row, Vec2 point) {
  return system.is_deformable(row) ? system.deformation_of(row).trial(point)
                                   : Rotation::of(system.trial[row].r)(point);
}

} // namespace

void add_boundary(const BlockSystem &system, std::size_t row, const StiffnessBound &stiffness, double *matrix,
                  std::size_t width) {
  const bool is_deformable = system.is_deformable(row);
  const std::size_t freedoms = num_freedoms(system, row);
  for (std::size_t k = system.vertex_begin[row]; k < system.vertex_begin[row + 1]; ++k) {
    const Vec2 n = system.reference_normal[k];
    const Vec2 t = perp(n);
    const double length = reference_length(system, row, k - system.vertex_begin[row]);
    for (const double gauss : {-1.0, 1.0}) { // exact: b b^T is quadratic along the edge
      const Vec2 x = system.reference_vertex[k] + (0.5 + gauss / std::sqrt(12.0)) * length * t;
      add_square(forces_of(is_deformable, n, x), 0.5 * length * stiffness.normal, freedoms, matrix, width);
      add_square(forces_of(is_deformable, t, x), 0.5 * length * stiffness.tangential, freedoms, matrix,
                 width);
    }
  }
}

void add_own_springs(const BlockSystem &system, std::size_t row, double *matrix, std::size_t width) {
  const bool is_deformable = system.is_deformable(row);
  const std::size_t freedoms = num_freedoms(system, row);
  for (const Anchor &anchor : system.anchors_of(row)) {
    const Vec2 arm = arm_of(system, row, anchor.point);
    for (const Vec2 d : {Vec2{1.0, 0.0}, Vec2{0.0, 1.0}}) {
      add_square(forces_of(is_deformable, d, arm), anchor.stiffness, freedoms, matrix, width);
    }
  }
  if (!is_deformable) {
    return;
  }
  const Deformation &d = system.deformation_of(row);
  const auto add = [&](std::size_t i, std::size_t j, double value) { matrix[i * width + j] += value; };
  add(2, 2, d.stiffness_direct);
  add(5, 5, d.stiffness_direct);
  add(2, 5, d.stiffness_cross);
  add(5, 2, d.stiffness_cross);
  for (const std::size_t i : {std::size_t{3}, std::size_t{4}}) {
    for (const std::size_t j : {std::size_t{3}, std::size_t{4}}) {
      add(i, j, d.stiffness_shear);
    }
  }
}

namespace {

/// What the springs of a region are to a rigid row: of (u_x, u_y, r) only the lower triangle.
void add_springs_of_rigid(const ContactSpring &s, Vec2 arm, double *matrix, std::size_t width) {
  const Vec2 n = s.normal;
  const Vec2 t = perp(n);
  const double lever_n = cross(arm, n);
  const double lever_t = cross(arm, t);
  const double k_n = s.normal_stiffness;
  const double k_t = s.tangential;
  double *const second = matrix + width;
  double *const third = second + width;
  matrix[0] += k_n * n.x * n.x + k_t * t.x * t.x;
  second[0] += k_n * n.y * n.x + k_t * t.y * t.x;
  second[1] += k_n * n.y * n.y + k_t * t.y * t.y;
  third[0] += k_n * lever_n * n.x + k_t * lever_t * t.x;
  third[1] += k_n * lever_n * n.y + k_t * lever_t * t.y;
  third[2] += k_n * lever_n * lever_n + k_t * lever_t * lever_t + s.bending;
}

/// The products of two levers out of (1, a_x, a_y), a lower triangle line by line.
using LeverProducts = std::array<double, 6>;

LeverProducts products_of(double one, Vec2 arm) {
  return {one, arm.x * one, arm.x * arm.x, arm.y * one, arm.y * arm.x, arm.y * arm.y};
}

/// What the springs of a region are to a deformable row, the lower triangle. A force d works on its freedoms
/// (u_x, H_xx, H_xy) by d_x (1, a_x, a_y), and on the other three by d_y: parts of b b^T are products of two
/// components of d and of two levers.
void add_springs_of_deformable(const ContactSpring &s, Vec2 arm, double *matrix) {
  constexpr std::array<std::size_t, 3> of_x{0, 2, 3};
  constexpr std::array<std::size_t, 3> of_y{1, 4, 5};
  const Vec2 n = s.normal;
  const Vec2 t = perp(n);
  const LeverProducts levers_n = products_of(1.0, arm);
  const LeverProducts levers_t = products_of(1.0, arm + s.grip * t);
  const LeverProducts levers_bent = products_of(0.0, t);
  const auto part = [&](double nn, double tt) {
    LeverProducts sum;
    for (std::size_t k = 0; k < sum.size(); ++k) {
      sum[k] = nn * (s.normal_stiffness * levers_n[k] + s.bending * levers_bent[k]) +
               tt * s.tangential * levers_t[k];
    }
    return sum;
  };
  const LeverProducts xx = part(n.x * n.x, t.x * t.x);
  const LeverProducts yx = part(n.y * n.x, t.y * t.x);
  const LeverProducts yy = part(n.y * n.y, t.y * t.y);
  const auto at = [&](std::size_t i, std::size_t j) -> double & {
    return matrix[6 * std::max(i, j) + std::min(i, j)];
  };
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      const std::size_t k = i * (i + 1) / 2 + j;
      at(of_x[i], of_x[j]) += xx[k];
      at(of_y[i], of_y[j]) += yy[k];
      at(of_y[i], of_x[j]) += yx[k];
      if (i != j) {
        at(of_y[j], of_x[i]) += yx[k];
      }
    }
  }
}

} // namespace

void add_diagonal(const BlockSystem &system, std::span<const ContactSpring> springs,
                  BlockMatrices &matrices) {
  const std::size_t width = matrices.width();
  const auto add = [&](std::size_t row, Vec2 arm, const ContactSpring &s) {
    if (row >= system.num_owned) {
      return;
    }
    if (width == 6 && system.is_deformable(row)) {
      add_springs_of_deformable(s, arm, matrices.of(row));
    } else {
      add_springs_of_rigid(s, arm, matrices.of(row), width);
    }
  };
  for (const ContactSpring &s : springs) {
    add(s.lower, s.lower_arm, s);
    add(s.higher, s.higher_arm, s);
  }
}

namespace {

/// By sweeps of Gauss and Jordan, which need no other pivots where a matrix is positive.
void invert_six(double *matrix) {
  constexpr std::size_t size = 6;
  for (std::size_t i = 0; i < size; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      matrix[j * size + i] = matrix[i * size + j];
    }
  }
  for (std::size_t k = 0; k < size; ++k) {
    double *const pivot_row = matrix + k * size;
    const double per_pivot = 1.0 / pivot_row[k];
    std::array<double, size> scaled{};
    for (std::size_t j = 0; j < size; ++j) {
      scaled[j] = per_pivot * pivot_row[j];
    }
    scaled[k] = per_pivot;
    for (std::size_t i = 0; i < size; ++i) {
      double *const row = matrix + i * size;
      const double factor = row[k];
      row[k] = 0.0;
      for (std::size_t j = 0; j < size; ++j) {
        row[j] -= factor * scaled[j];
      }
    }
    std::copy(scaled.begin(), scaled.end(), pivot_row);
  }
}

} // namespace

void invert(double *matrix, std::size_t freedoms, std::size_t width) {
  if (freedoms == 6) {
    invert_six(matrix);
    return;
  }
  double *const m = matrix;
  const auto at = [&](std::size_t i, std::size_t j) -> double & { return m[i * width + j]; };
  // By cofactors: three unknowns whose scales differ by a length alone.
  const double a = at(0, 0);
  const double b = at(1, 0);
  const double c = at(1, 1);
  const double d = at(2, 0);
  const double e = at(2, 1);
  const double f = at(2, 2);
  const double c00 = c * f - e * e;
  const double c01 = e * d - b * f;
  const double c02 = b * e - c * d;
  const double scale = 1.0 / (a * c00 + b * c01 + d * c02);
  at(0, 0) = scale * c00, at(0, 1) = at(1, 0) = scale * c01, at(0, 2) = at(2, 0) = scale * c02;
  at(1, 1) = scale * (a * f - d * d), at(1, 2) = at(2, 1) = scale * (b * d - a * e);
  at(2, 2) = scale * (a * c - b * b);
}

} // namespace gcpdda::statics
