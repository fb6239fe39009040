#pragma once

// The coarse level of the preconditioner: rigid motions of cells of blocks.
//
// Cells are squares of `blocks_a_side` mean block sizes, laid from the least centroid of the scene, and a
// block belongs to the cell of its centroid at t = 0: cells depend on the scene and not on the ranks. (Squares
// of 4 mean sizes save no products with K, and take twice the CPU time of an iteration of 10^5 blocks.) P moves
// the blocks of a cell as one rigid body about the middle of the cell, and turns it by 1/(side of the cell),
// so that all three unknowns of a cell have the same size. The coarse matrix is
//     K_c = P^T (K + M) P
// with a matrix M of each block that keeps a cell from being singular where no contact holds it.
//
// Every rank factorises and solves the whole of K_c, by the same code and in the same order of unknowns. For
// that it needs the same bits. Entries are therefore summed as integers in units of a power of two, 2^-40 of
// the largest contribution of all ranks: the sum of integers does not depend on their order. A preconditioner
// forgives the rounding of its entries. The pattern of K_c follows from the springs of all ranks, because the
// order of elimination follows from the pattern.

#include "gcpdda/parallel/communicator.hpp"
#include "statics/block_stiffness.hpp"

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace gcpdda::statics {

class CoarseGrid {
public:
  explicit CoarseGrid(const Communicator &communicator);
  ~CoarseGrid();
  CoarseGrid(CoarseGrid &&) noexcept;
  CoarseGrid &operator=(CoarseGrid &&) noexcept;

  /// Cells of the rows of a neighbourhood. Collective.
  void lay(const BlockSystem &system);
  /// Make and factorise K_c. Collective.
  /// @param matrices  M of owned rows
  void factorise(const BlockSystem &system, std::span<const ContactSpring> springs,
                 const BlockMatrices &matrices);
  /// z += P K_c^-1 P^T r for owned rows. Collective.
  void add_correction(const BlockSystem &system, const Field &r, Field &z);

  [[nodiscard]] std::size_t num_cells() const { return keys_.size(); }

private:
  static constexpr double blocks_a_side = 8.0;
  using Three = std::array<double, 3>;
  using Square = std::array<Three, 3>;
  struct Factors;

  [[nodiscard]] bool has_cell(std::size_t row) const { return cell_of_[row] >= 0; }
  [[nodiscard]] std::ptrdiff_t first_unknown(std::size_t row) const {
    return 3 * static_cast<std::ptrdiff_t>(cell_of_[row]);
  }
  /// @return false where no block of any rank moves
  bool lay_cells(const BlockSystem &system);
  /// Column and line of the cell of a row.
  [[nodiscard]] std::array<std::int64_t, 2> place_of(const BlockSystem &system, std::size_t row) const;
  [[nodiscard]] Three to_cell(const BlockSystem &system, std::size_t row, const double *forces) const;
  /// The unit force of one of a spring's three springs on the freedoms of the cell of a row.
  [[nodiscard]] std::array<Three, 3> forces_on_cell(std::size_t row, Vec2 arm, Vec2 normal) const;
  [[nodiscard]] Square on_cell(const BlockSystem &system, std::size_t row,
                               const BlockMatrices &matrices) const;
  static Square product(const ContactSpring &spring, const std::array<Three, 3> &a,
                        const std::array<Three, 3> &b, double sign);
  void restrict_to_cells(const BlockSystem &system, const Field &r);
  /// visit(higher cell, lower cell, its part of K_c) for what this rank counts.
  template <class Visit>
  void for_parts(const BlockSystem &system, std::span<const ContactSpring> springs,
                 const BlockMatrices &matrices, Visit &&visit) const;
  template <class Visit> void for_parts_of(const ContactSpring &spring, Visit &&visit) const;
  void find_pattern(std::span<const ContactSpring> springs);
  void fill_matrix(double unit);
  [[nodiscard]] std::int64_t key_of(std::int64_t higher, std::int64_t lower) const {
    return higher * static_cast<std::int64_t>(keys_.size()) + lower;
  }

  Communicator communicator_;
  Vec2 origin_;
  double side_ = 1.0;
  double per_side_ = 1.0;
  std::int64_t columns_ = 1;
  std::vector<std::int64_t> keys_;    ///< of the cells that hold a mobile block of any rank, ascending
  std::vector<std::int32_t> cell_of_; ///< by row; -1: the row does not move
  std::vector<Vec2> arms_;            ///< by row: of the centroid from the middle of the cell, over the side
  std::vector<Three> on_cells_;       ///< by owned row: its part of P^T r
  std::vector<std::int64_t> pattern_; ///< key_of() of the blocks of K_c, ascending
  std::vector<std::int64_t> sums_;    ///< of a block of K_c, or of P^T r, in units
  std::unique_ptr<Factors> factors_;
};

} // namespace gcpdda::statics
