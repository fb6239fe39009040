#include "statics/block_stiffness.hpp"

#include <Eigen/Dense>

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

void add_boundary(const BlockSystem &system, std::size_t row, const Surroundings &around, double *matrix,
                  std::size_t width) {
  const bool is_deformable = system.is_deformable(row);
  const std::size_t freedoms = num_freedoms(system, row);
  for (std::size_t k = system.vertex_begin[row]; k < system.vertex_begin[row + 1]; ++k) {
    const Vec2 n = system.reference_normal[k];
    const Vec2 t = perp(n);
    const double length = reference_length(system, row, k - system.vertex_begin[row]);
    for (const double gauss : {-1.0, 1.0}) { // exact: b b^T is quadratic along the edge
      const Vec2 x = system.reference_vertex[k] + (0.5 + gauss / std::sqrt(12.0)) * length * t;
      add_square(forces_of(is_deformable, n, x), 0.5 * length * around.normal_stiffness, freedoms, matrix,
                 width);
      add_square(forces_of(is_deformable, t, x), 0.5 * length * around.tangential_stiffness, freedoms, matrix,
                 width);
    }
  }
}

void add_bolts(const BlockSystem &system, std::size_t row, std::span<const PointSpring> bolts, double *matrix,
               std::size_t width) {
  const bool is_deformable = system.is_deformable(row);
  for (const PointSpring &bolt : bolts) {
    const Vec2 arm = arm_of(system, row, bolt.point);
    for (const Vec2 d : {Vec2{1.0, 0.0}, Vec2{0.0, 1.0}}) {
      add_square(forces_of(is_deformable, d, arm), bolt.stiffness, num_freedoms(system, row), matrix, width);
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

void add_diagonal(const BlockSystem &system, std::span<const ContactSpring> springs,
                  BlockMatrices &matrices) {
  const std::size_t width = matrices.width();
  const auto add = [&](std::size_t row, Vec2 arm, const ContactSpring &s) {
    if (row >= system.num_owned) {
      return;
    }
    const bool is_deformable = system.is_deformable(row);
    const std::size_t freedoms = is_deformable ? 6 : 3;
    double *const matrix = matrices.of(row);
    const Vec2 t = perp(s.normal);
    add_square(forces_of(is_deformable, s.normal, arm), s.normal_stiffness, freedoms, matrix, width);
    add_square(forces_of(is_deformable, t, arm), s.tangential, freedoms, matrix, width);
    std::array<double, 6> bend{};
    add_force(bend.data(), is_deformable, {}, outer(s.normal, t));
    add_square(bend, s.bending, freedoms, matrix, width);
  };
  for (const ContactSpring &s : springs) {
    add(s.lower, s.lower_arm, s);
    add(s.higher, s.higher_arm, s);
  }
}

namespace {

template <int N> void invert_fixed(double *matrix, std::size_t width) {
  using Square = Eigen::Matrix<double, N, N, Eigen::RowMajor>;
  using Stride = Eigen::OuterStride<>;
  Eigen::Map<Square, 0, Stride> map(matrix, Stride(static_cast<Eigen::Index>(width)));
  const Square copy = map;
  map = copy.ldlt().solve(Square::Identity());
}

} // namespace

void invert(double *matrix, std::size_t freedoms, std::size_t width) {
  if (freedoms == 6) {
    invert_fixed<6>(matrix, width);
    return;
  }
  double *const m = matrix;
  const auto at = [&](std::size_t i, std::size_t j) -> double & { return m[i * width + j]; };
  // By cofactors: three unknowns whose scales differ by a length alone.
  const double c00 = at(1, 1) * at(2, 2) - at(1, 2) * at(2, 1);
  const double c01 = at(1, 2) * at(2, 0) - at(1, 0) * at(2, 2);
  const double c02 = at(1, 0) * at(2, 1) - at(1, 1) * at(2, 0);
  const double d = 1.0 / (at(0, 0) * c00 + at(0, 1) * c01 + at(0, 2) * c02);
  const double c11 = at(0, 0) * at(2, 2) - at(0, 2) * at(2, 0);
  const double c12 = at(0, 1) * at(2, 0) - at(0, 0) * at(2, 1);
  const double c22 = at(0, 0) * at(1, 1) - at(0, 1) * at(1, 0);
  at(0, 0) = d * c00, at(0, 1) = at(1, 0) = d * c01, at(0, 2) = at(2, 0) = d * c02;
  at(1, 1) = d * c11, at(1, 2) = at(2, 1) = d * c12, at(2, 2) = d * c22;
}

} // namespace gcpdda::statics
