#pragma once

// Factors L D L^T of the coarse matrix, whose unknowns come in threes, one three for each cell.
//
// Every rank factorises and solves the whole of it, so that the time this takes does not fall with their
// number. Elimination by cells asks for one index where there are nine numbers, and has a column of a block
// in one register: with factors by single unknowns a run of 100,290 blocks on one rank spends 8 % of its time
// here, and with these 4 %.
//
// The pattern of a row of L are the ancestors, in the tree of elimination, of the columns in which the matrix
// has blocks (Davis 2005, Algorithm 849, doi:10.1145/1114268.1114277). The order is that of minimum degree.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace gcpdda::statics {

/// Three numbers, filled up with a zero.
using Column = double __attribute__((vector_size(4 * sizeof(double))));

class CoarseFactors {
public:
  /// Where a block of the lower triangle stands.
  struct Place {
    std::int32_t higher = 0; ///< cell
    std::int32_t lower = 0;  ///< the same or another
  };

  /// Order of elimination, and pattern of L.
  /// @param places  each of them once, all of the diagonal among them
  void analyse(std::size_t num_cells, std::span<const Place> places);
  /// @param blocks  of these places in their order, nine numbers each, line by line
  void factorise(std::span<const double> blocks);
  /// The motions of cells under these forces, three numbers each. A cell whose pivot is not positive rests.
  /// @return forces.motions
  double solve(std::span<const double> forces, std::span<float> motions);

private:
  using Square = std::array<Column, 3>;
  /// A block of the matrix in its row.
  struct Entry {
    std::int32_t column = 0;
    std::size_t block = 0;
    bool is_transposed = false; ///< its row is that of the lower cell
  };

  void find_order(std::span<const Place> places);
  void take_entries(std::span<const Place> places);
  void find_pattern();
  /// Row k of L and its pivot.
  void eliminate(std::size_t k, std::span<const double> blocks);

  std::size_t num_cells_ = 0;
  std::vector<std::size_t> place_of_cell_; ///< in the order of elimination, as all rows and columns below
  // The matrix.
  std::vector<std::size_t> diagonal_;    ///< blocks
  std::vector<std::size_t> first_entry_; ///< of a row
  std::vector<Entry> entries_;
  // L: the columns of a row ascend, and so do the rows of a column.
  std::vector<std::size_t> first_in_row_;
  std::vector<std::int32_t> columns_;
  std::vector<std::size_t> first_in_column_;
  std::vector<std::int32_t> rows_;
  std::vector<Square> lower_;   ///< by column
  std::vector<Square> inverse_; ///< D^-1
  // While a row is eliminated, and in a solution.
  std::vector<std::size_t> end_in_column_;
  std::vector<Square> row_; ///< (L D)^T, by column
  std::vector<Column> x_;
};

} // namespace gcpdda::statics
