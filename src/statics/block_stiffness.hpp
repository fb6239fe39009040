#pragma once

// Matrices of one block: the mass of the motion in pseudo-time, the block's own springs, and what a
// preconditioner needs of a block.
//
// Mass. D is the stiffness that the block's whole boundary would have if it lay on fixed neighbours,
//     D = sum over edges of int (k_n b_n b_n^T + k_t b_t b_t^T) ds,
// the matrix of contact_frequency_bound() in dynamics/frequency_bound.hpp, with b_n and b_t the forces on the
// freedoms (field.hpp) of unit tractions: of a traction d at the arm a these are d and d a^T. D has the size
// of the stiffness that contacts can have, for every block, whatever touches it at the moment. It is taken in
// reference axes: as a scale it need not turn with the block.
//
// Own springs. A deformable block has its elasticity, the same in all axes because it is isotropic: on H it
// is [a b; b a] for H_xx and H_yy and c for H_xy + H_yx. Fixed points have a spring in each direction.
#include "contact/stiffness_bound.hpp"
#include "statics/field.hpp"
#include "statics/springs.hpp"

#include <span>
#include <vector>

namespace gcpdda::statics {

/// Symmetric matrices of the owned rows of a system, `width` squared places each.
class BlockMatrices {
public:
  BlockMatrices() = default;
  BlockMatrices(std::size_t num_rows, std::size_t width)
      : num_rows_(num_rows), width_(width), entries_(num_rows * width * width, 0.0) {}
  [[nodiscard]] std::size_t num_rows() const { return num_rows_; }
  [[nodiscard]] std::size_t width() const { return width_; }
  [[nodiscard]] double *of(std::size_t row) { return entries_.data() + row * width_ * width_; }
  [[nodiscard]] const double *of(std::size_t row) const { return entries_.data() + row * width_ * width_; }

private:
  std::size_t num_rows_ = 0;
  std::size_t width_ = 0;
  std::vector<double> entries_;
};

/// D of an owned row, with the stiffness of its joints.
void add_boundary(const BlockSystem &system, std::size_t row, const StiffnessBound &stiffness, double *matrix,
                  std::size_t width);
/// Elasticity and fixed points of an owned row.
void add_own_springs(const BlockSystem &system, std::size_t row, double *matrix, std::size_t width);
/// The blocks on the diagonal of K, onto the lower triangles of the matrices of owned rows.
void add_diagonal(const BlockSystem &system, std::span<const ContactSpring> springs, BlockMatrices &matrices);
/// Inverse of a symmetric positive definite matrix, given by its lower triangle, in the places of it.
void invert(double *matrix, std::size_t freedoms, std::size_t width);

/// y += matrix p for the freedoms of one row.
template <std::size_t freedoms>
void add_square_product(const double *matrix, std::size_t width, const double *p, double *y) {
  for (std::size_t i = 0; i < freedoms; ++i) {
    double sum = 0.0;
    for (std::size_t j = 0; j < freedoms; ++j) {
      sum += matrix[i * width + j] * p[j];
    }
    y[i] += sum;
  }
}
inline void add_block_product(const double *matrix, std::size_t freedoms, std::size_t width, const double *p,
                              double *y) {
  if (freedoms == 3) {
    add_square_product<3>(matrix, width, p, y);
  } else {
    add_square_product<6>(matrix, width, p, y);
  }
}

} // namespace gcpdda::statics
