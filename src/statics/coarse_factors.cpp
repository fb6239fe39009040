#include "statics/coarse_factors.hpp"

#include <Eigen/LU>
#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>

#include <algorithm>
#include <array>
#include <utility>

namespace gcpdda::statics {

namespace {

using Columns = std::array<Column, 3>;

Columns block_of(std::span<const double> blocks, std::size_t block) {
  const double *const b = blocks.data() + 9 * block;
  return {Column{b[0], b[3], b[6], 0.0}, Column{b[1], b[4], b[7], 0.0}, Column{b[2], b[5], b[8], 0.0}};
}

Columns transposed(const Columns &a) {
  return {Column{a[0][0], a[1][0], a[2][0], 0.0}, Column{a[0][1], a[1][1], a[2][1], 0.0},
          Column{a[0][2], a[1][2], a[2][2], 0.0}};
}

/// y += a x
void add_product(const Columns &a, const Column &x, Column &y) {
  y += a[0] * x[0] + a[1] * x[1] + a[2] * x[2];
}
/// y -= a x, of a column or of all three.
void subtract_product(const Columns &a, const Column &x, Column &y) {
  y -= a[0] * x[0] + a[1] * x[1] + a[2] * x[2];
}
void subtract_product(const Columns &a, const Columns &x, Columns &y) {
  for (std::size_t j = 0; j < 3; ++j) {
    subtract_product(a, x[j], y[j]);
  }
}

/// Of a symmetric square; zero where it is not positive.
Columns inverse_of(const Columns &a) {
  Eigen::Matrix3d matrix;
  for (Eigen::Index i = 0; i < 3; ++i) {
    for (Eigen::Index j = 0; j < 3; ++j) {
      const auto row = static_cast<std::size_t>(std::max(i, j)); // the lower triangle
      matrix(i, j) = a[static_cast<std::size_t>(std::min(i, j))][row];
    }
  }
  const Eigen::Matrix3d inverse = matrix.inverse();
  if (!(matrix.determinant() > 0.0) || !inverse.allFinite()) {
    return {};
  }
  Columns columns;
  for (std::size_t j = 0; j < 3; ++j) {
    const Eigen::Vector3d column = inverse.col(static_cast<Eigen::Index>(j));
    columns[j] = Column{column[0], column[1], column[2], 0.0};
  }
  return columns;
}

/// From how many each row has to where it begins.
void add_up(std::vector<std::size_t> &first) {
  for (std::size_t k = 1; k < first.size(); ++k) {
    first[k] += first[k - 1];
  }
}

std::size_t index(std::int32_t number) {
  return static_cast<std::size_t>(number);
}

} // namespace

void CoarseFactors::analyse(std::size_t num_cells, std::span<const Place> places) {
  num_cells_ = num_cells;
  find_order(places);
  take_entries(places);
  find_pattern();
  lower_.resize(rows_.size());
  inverse_.resize(num_cells_);
  row_.assign(num_cells_, {});
  x_.resize(num_cells_);
}

void CoarseFactors::find_order(std::span<const Place> places) {
  const auto size = static_cast<Eigen::Index>(num_cells_);
  std::vector<Eigen::Triplet<double>> both;
  both.reserve(2 * places.size());
  for (const Place &place : places) {
    both.emplace_back(place.higher, place.lower, 1.0);
    both.emplace_back(place.lower, place.higher, 1.0);
  }
  Eigen::SparseMatrix<double> pattern(size, size);
  pattern.setFromTriplets(both.begin(), both.end());
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> cells;
  Eigen::AMDOrdering<int>()(pattern, cells);
  place_of_cell_.resize(num_cells_);
  for (Eigen::Index k = 0; k < size; ++k) {
    place_of_cell_[index(cells.indices()[k])] = static_cast<std::size_t>(k);
  }
}

void CoarseFactors::take_entries(std::span<const Place> places) {
  const auto row_and_column = [&](const Place &place) {
    const std::size_t a = place_of_cell_[index(place.higher)];
    const std::size_t b = place_of_cell_[index(place.lower)];
    return std::pair(std::max(a, b), std::min(a, b));
  };
  diagonal_.resize(num_cells_);
  first_entry_.assign(num_cells_ + 1, 0);
  for (std::size_t block = 0; block < places.size(); ++block) {
    const auto [row, column] = row_and_column(places[block]);
    if (row == column) {
      diagonal_[row] = block;
    } else {
      ++first_entry_[row + 1];
    }
  }
  add_up(first_entry_);
  entries_.resize(first_entry_.back());
  std::vector<std::size_t> end(first_entry_.begin(), first_entry_.end() - 1);
  for (std::size_t block = 0; block < places.size(); ++block) {
    const auto [row, column] = row_and_column(places[block]);
    if (row != column) {
      entries_[end[row]++] = {static_cast<std::int32_t>(column), block,
                              row == place_of_cell_[index(places[block].lower)]};
    }
  }
}

void CoarseFactors::find_pattern() {
  constexpr std::int32_t none = -1;
  std::vector<std::int32_t> parent(num_cells_, none);
  std::vector<std::int32_t> seen_in(num_cells_, none);
  columns_.clear();
  first_in_row_.assign(1, 0);
  first_in_column_.assign(num_cells_ + 1, 0);
  for (std::size_t k = 0; k < num_cells_; ++k) {
    const auto row = static_cast<std::int32_t>(k);
    seen_in[k] = row;
    for (std::size_t e = first_entry_[k]; e < first_entry_[k + 1]; ++e) {
      for (std::int32_t i = entries_[e].column; seen_in[index(i)] != row; i = parent[index(i)]) {
        if (parent[index(i)] == none) {
          parent[index(i)] = row;
        }
        seen_in[index(i)] = row;
        columns_.push_back(i);
        ++first_in_column_[index(i) + 1];
      }
    }
    std::sort(columns_.begin() + static_cast<std::ptrdiff_t>(first_in_row_.back()), columns_.end());
    first_in_row_.push_back(columns_.size());
  }
  add_up(first_in_column_);
  rows_.resize(columns_.size());
  std::vector<std::size_t> end(first_in_column_.begin(), first_in_column_.end() - 1);
  for (std::size_t k = 0; k < num_cells_; ++k) {
    for (std::size_t place = first_in_row_[k]; place < first_in_row_[k + 1]; ++place) {
      rows_[end[index(columns_[place])]++] = static_cast<std::int32_t>(k);
    }
  }
}

void CoarseFactors::eliminate(std::size_t k, std::span<const double> blocks) {
  for (std::size_t e = first_entry_[k]; e < first_entry_[k + 1]; ++e) {
    const Entry &entry = entries_[e];
    const Columns block = block_of(blocks, entry.block);
    row_[index(entry.column)] = entry.is_transposed ? block : transposed(block);
  }
  Columns pivot = block_of(blocks, diagonal_[k]);
  for (std::size_t place = first_in_row_[k]; place < first_in_row_[k + 1]; ++place) {
    const std::size_t i = index(columns_[place]);
    const Columns z = row_[i];
    row_[i] = {};
    const std::size_t end = end_in_column_[i]++;
    for (std::size_t p = first_in_column_[i]; p < end; ++p) {
      subtract_product(lower_[p], z, row_[index(rows_[p])]);
    }
    Columns of_row{};
    for (std::size_t j = 0; j < 3; ++j) {
      add_product(inverse_[i], z[j], of_row[j]);
    }
    lower_[end] = transposed(of_row);
    subtract_product(lower_[end], z, pivot);
  }
  inverse_[k] = inverse_of(pivot);
}

void CoarseFactors::factorise(std::span<const double> blocks) {
  end_in_column_.assign(first_in_column_.begin(), first_in_column_.end() - 1);
  for (std::size_t k = 0; k < num_cells_; ++k) {
    eliminate(k, blocks);
  }
}

double CoarseFactors::solve(std::span<const double> forces, std::span<float> motions) {
  for (std::size_t cell = 0; cell < num_cells_; ++cell) {
    x_[place_of_cell_[cell]] = Column{forces[3 * cell], forces[3 * cell + 1], forces[3 * cell + 2], 0.0};
  }
  for (std::size_t j = 0; j < num_cells_; ++j) {
    const Column x = x_[j];
    for (std::size_t p = first_in_column_[j]; p < first_in_column_[j + 1]; ++p) {
      subtract_product(lower_[p], x, x_[index(rows_[p])]);
    }
  }
  for (std::size_t j = num_cells_; j-- > 0;) {
    Columns along{}; // each place of a column for itself
    for (std::size_t p = first_in_column_[j]; p < first_in_column_[j + 1]; ++p) {
      const Column &x = x_[index(rows_[p])];
      for (std::size_t k = 0; k < 3; ++k) {
        along[k] += lower_[p][k] * x;
      }
    }
    Column x{};
    add_product(inverse_[j], x_[j], x);
    for (std::size_t k = 0; k < 3; ++k) {
      x[k] -= along[k][0] + along[k][1] + along[k][2];
    }
    x_[j] = x;
  }
  double product = 0.0;
  for (std::size_t cell = 0; cell < num_cells_; ++cell) {
    for (std::size_t i = 0; i < 3; ++i) {
      const double x = x_[place_of_cell_[cell]][i];
      motions[3 * cell + i] = static_cast<float>(x);
      product += forces[3 * cell + i] * x;
    }
  }
  return product;
}

} // namespace gcpdda::statics
