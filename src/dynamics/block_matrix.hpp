#pragma once

// L D L^T of the small symmetric positive definite matrices that blocks have of their own. Without pivoting:
// positive definite matrices need none.

#include "model/block_system.hpp"

#include <array>
#include <cstddef>

namespace gcpdda {

/// Lower triangle by rows; the leading n x n block of a matrix is the first n (n + 1)/2 entries.
constexpr std::size_t packed(std::size_t row, std::size_t column) {
  return row * (row + 1) / 2 + column;
}

/// Factors of the leading N x N block; on the diagonal stands 1/D.
template <std::size_t N> BlockMatrix factorise(const std::array<double, 21> &lower) {
  static_assert(N <= 6);
  BlockMatrix result;
  auto &f = result.factor;
  std::array<double, N> pivots;
  for (std::size_t j = 0; j < N; ++j) {
    pivots[j] = lower[packed(j, j)];
    for (std::size_t k = 0; k < j; ++k) {
      pivots[j] -= f[packed(j, k)] * f[packed(j, k)] * pivots[k];
    }
    f[packed(j, j)] = 1.0 / pivots[j];
    for (std::size_t i = j + 1; i < N; ++i) {
      double below = lower[packed(i, j)];
      for (std::size_t k = 0; k < j; ++k) {
        below -= f[packed(i, k)] * f[packed(j, k)] * pivots[k];
      }
      f[packed(i, j)] = below / pivots[j];
    }
  }
  return result;
}

/// Solution of the factorised N x N system.
template <std::size_t N> std::array<double, N> solve(const BlockMatrix &matrix, std::array<double, N> x) {
  const auto &f = matrix.factor;
  for (std::size_t i = 1; i < N; ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      x[i] -= f[packed(i, k)] * x[k];
    }
  }
  for (std::size_t i = 0; i < N; ++i) {
    x[i] *= f[packed(i, i)];
  }
  for (std::size_t i = N - 1; i-- > 0;) {
    for (std::size_t k = i + 1; k < N; ++k) {
      x[i] -= f[packed(k, i)] * x[k];
    }
  }
  return x;
}

} // namespace gcpdda
