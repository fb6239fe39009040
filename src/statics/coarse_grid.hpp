#pragma once

// The coarse level of the preconditioner: rigid motions of cells of blocks.
//
// Cells are squares of `blocks_a_side` mean block sizes, laid from the least centroid of the scene, and a
// block belongs to the cell of its centroid at t = 0: cells depend on the scene and not on the ranks.
// (Squares of 4 mean sizes take more time for K_c, those of 8 more evaluations.) P moves the blocks of a cell
// as one rigid body about the middle of the cell, and turns it by 1/(side of the cell), so that all three
// unknowns of a cell have the same size. The coarse matrix is
//     K_c = P^T (K + M) P
// with a matrix M of each block that keeps a cell from being singular where no contact holds it.
//
// Every rank factorises and solves the whole of K_c, by the same code and in the same order of unknowns. For
// that it needs the same bits. Entries are therefore summed as integers in units of a power of two, 2^-40 of
// the largest contribution of all ranks: the sum of integers does not depend on their order. A preconditioner
// forgives the rounding of its entries. Forces on cells have one unit for all iterations of an inner solve,
// 2^-36 of the size that they begin with, and those of a block are cut at 2^12 times that. The pattern
// of K_c follows from the springs of all ranks, because the order of elimination follows from the pattern.

#include "gcpdda/parallel/communicator.hpp"
#include "statics/block_stiffness.hpp"
#include "statics/coarse_factors.hpp"
#include "statics/springs.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

namespace gcpdda::statics {

class CoarseGrid {
public:
  explicit CoarseGrid(const Communicator &communicator) : communicator_(communicator) {}

  /// Cells of the rows of a neighbourhood. Collective.
  void lay(const BlockSystem &system);
  /// Cells of some of them, which alone move from here on. Collective.
  /// @param moves  by row
  void choose(const BlockSystem &system, std::span<const std::uint8_t> moves);
  /// Make and factorise K_c. Collective.
  /// @param matrices  M of owned rows
  /// @param mass  D of owned rows, of which a small share holds cells that nothing else does
  void factorise(const BlockSystem &system, const ContactSprings &springs, const BlockMatrices &matrices,
                 const BlockMatrices &mass);

  // P K_c^-1 P^T r is found in parts, so that the solver may take its fields as it passes their rows.
  /// The largest of these forces on cells. Collective.
  [[nodiscard]] double largest(const BlockSystem &system, std::span<const RowRun> rows,
                               const Field &forces) const;
  void clear_forces() { std::fill(forces_.begin(), forces_.end(), 0); }
  /// To P^T q, the part of a row that moves; q of about one.
  void add_forces(std::size_t row, bool is_deformable, const float *q) {
    std::int64_t *to = forces_.data() + first_unknown(row);
    for (const float value : to_cell(row, is_deformable, q)) {
      *to++ += std::llrint(std::clamp(value * units, -most_units, most_units));
    }
  }
  /// P^T q of all ranks, and these numbers of all ranks, in one reduction. Collective.
  void sum_forces(std::span<std::int64_t> others);
  /// r is q, and its motions are found.
  /// @return (P^T r)^T K_c^-1 P^T r
  double begin();
  /// r is less q by so many times; the rest as above.
  double subtract(double times);
  /// To a row that moves, its part of these motions.
  void add_motion(std::size_t row, bool is_deformable, float *z) const {
    const float *const motion = lean_motions_.data() + first_unknown(row);
    const float turn = motion[2] * static_cast<float>(per_side_);
    z[0] += motion[0] - motion[2] * arms_[row].y;
    z[1] += motion[1] + motion[2] * arms_[row].x;
    if (is_deformable) {
      z[3] -= turn;
      z[4] += turn;
    } else {
      z[2] += turn;
    }
  }

  [[nodiscard]] std::size_t num_cells() const { return keys_.size(); }

private:
  static constexpr double blocks_a_side = 6.0;
  static constexpr float units = 0x1p36F;      ///< of a force of one
  static constexpr float most_units = 0x1p48F; ///< of the forces of a row
  struct Arm {
    float x = 0.0F;
    float y = 0.0F;
  };
  template <class Number> using ThreeOf = std::array<Number, 3>;
  using Three = ThreeOf<double>;
  using Square = std::array<Three, 3>;

  [[nodiscard]] bool has_cell(std::size_t row) const { return cell_of_[row] >= 0; }
  [[nodiscard]] std::ptrdiff_t first_unknown(std::size_t row) const {
    return 3 * static_cast<std::ptrdiff_t>(cell_of_[row]);
  }
  /// @return false where no block of any rank moves
  bool lay_cells(const BlockSystem &system);
  /// Column and line of the cell of a row.
  [[nodiscard]] std::array<std::int64_t, 2> place_of(const BlockSystem &system, std::size_t row) const;
  template <class Number>
  [[nodiscard]] ThreeOf<Number> to_cell(std::size_t row, bool is_deformable, const Number *forces) const {
    const Number moment = is_deformable ? forces[4] - forces[3] : forces[2];
    const Arm arm = arms_[row];
    return {forces[0], forces[1],
            moment * static_cast<Number>(per_side_) + (arm.x * forces[1] - arm.y * forces[0])};
  }
  /// The unit force of one of a spring's three springs on the freedoms of the cell of a row.
  [[nodiscard]] std::array<Three, 3> forces_on_cell(std::size_t row, Vec2 arm, Vec2 normal) const;
  [[nodiscard]] Square on_cell(const BlockSystem &system, std::size_t row, const BlockMatrices &matrices,
                               const BlockMatrices &mass) const;
  static Square product(const ContactSpring &spring, const std::array<Three, 3> &a,
                        const std::array<Three, 3> &b, double sign);
  /// visit(higher cell, lower cell, its part of K_c) for what this rank counts.
  template <class Visit>
  void for_parts(const BlockSystem &system, const ContactSprings &springs, const BlockMatrices &matrices,
                 const BlockMatrices &mass, Visit &&visit) const;
  template <class Visit> void for_parts_of(const ContactSpring &spring, Visit &&visit) const;
  void find_pattern(const ContactSprings &springs);
  /// Where pattern_ holds a block of K_c; it must. Each cell has a few blocks.
  [[nodiscard]] std::size_t place_in_pattern(std::int64_t higher, std::int64_t lower) const {
    std::size_t place = first_of_cell_[static_cast<std::size_t>(higher)];
    while (pattern_[place] != key_of(higher, lower)) {
      ++place;
    }
    return place;
  }
  void factorise_sums(double unit);
  [[nodiscard]] std::int64_t key_of(std::int64_t higher, std::int64_t lower) const {
    return higher * static_cast<std::int64_t>(keys_.size()) + lower;
  }

  Communicator communicator_;
  bool has_cells_ = false; ///< some block of some rank moves
  Vec2 origin_;
  double side_ = 1.0;
  double per_side_ = 1.0;
  std::int64_t columns_ = 1;
  std::vector<std::int64_t> keys_;    ///< of the cells that hold a mobile block of any rank, ascending
  std::vector<std::int32_t> cell_of_; ///< by row; -1: the row does not move
  std::vector<Arm> arms_;             ///< by row: of the centroid from the middle of the cell, over the side
  std::vector<std::int64_t> pattern_; ///< key_of() of the blocks of K_c, ascending
  std::vector<std::size_t> first_of_cell_; ///< in pattern_, by higher cell
  std::vector<std::int64_t> sums_;         ///< entries of K_c, in units
  std::vector<std::int64_t> forces_;       ///< P^T q, in units
  std::vector<double> residual_;           ///< P^T r
  std::vector<float> lean_motions_;        ///< of cells, as they are added to rows
  std::vector<std::int64_t> analysed_;     ///< pattern of the factors
  CoarseFactors factors_;
};

} // namespace gcpdda::statics
