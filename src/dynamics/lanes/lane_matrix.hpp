#pragma once

// As block_matrix.hpp, one matrix in each lane; by itself, or it would be compiled without the lanes'
// instructions.

#include "base/lanes.hpp"
#include "dynamics/block_matrix.hpp"

#include <array>
#include <cstddef>

namespace gcpdda::GCPDDA_INSTRUCTIONS {

/// Puts the factors of an N x N matrix into its place.
template <std::size_t N, std::size_t size>
[[gnu::always_inline]] inline void factorise(std::array<Lanes, size> &f) {
  static_assert(size == N * (N + 1) / 2);
  std::array<Lanes, N> pivots;
  for (std::size_t j = 0; j < N; ++j) {
    pivots[j] = f[packed(j, j)];
    for (std::size_t k = 0; k < j; ++k) {
      pivots[j] = pivots[j] - f[packed(j, k)] * f[packed(j, k)] * pivots[k];
    }
    f[packed(j, j)] = Lanes(1.0) / pivots[j];
    for (std::size_t i = j + 1; i < N; ++i) {
      for (std::size_t k = 0; k < j; ++k) {
        f[packed(i, j)] = f[packed(i, j)] - f[packed(i, k)] * f[packed(j, k)] * pivots[k];
      }
      f[packed(i, j)] = f[packed(i, j)] * f[packed(j, j)];
    }
  }
}

/// x becomes L^T x, the components over which the quadratic form x L D L^T x is a sum of squares.
template <std::size_t N, std::size_t size>
[[gnu::always_inline]] inline void to_squares(const std::array<Lanes, size> &f, std::array<Lanes, N> &x) {
  static_assert(size == N * (N + 1) / 2);
  for (std::size_t i = 0; i < N; ++i) {
    for (std::size_t k = i + 1; k < N; ++k) {
      x[i] = x[i] + f[packed(k, i)] * x[k];
    }
  }
}

/// The inverse of to_squares().
template <std::size_t N, std::size_t size>
[[gnu::always_inline]] inline void from_squares(const std::array<Lanes, size> &f, std::array<Lanes, N> &x) {
  static_assert(size == N * (N + 1) / 2);
  for (std::size_t i = N - 1; i-- > 0;) {
    for (std::size_t k = i + 1; k < N; ++k) {
      x[i] = x[i] - f[packed(k, i)] * x[k];
    }
  }
}

/// L D x: the force under which the accelerations of the factorised system are from_squares(x).
template <std::size_t N, std::size_t size>
[[gnu::always_inline]] inline void to_force(const std::array<Lanes, size> &f, std::array<Lanes, N> &x) {
  static_assert(size == N * (N + 1) / 2);
  for (std::size_t i = 0; i < N; ++i) {
    x[i] = x[i] / f[packed(i, i)];
  }
  for (std::size_t i = N; i-- > 1;) {
    for (std::size_t k = 0; k < i; ++k) {
      x[i] = x[i] + f[packed(i, k)] * x[k];
    }
  }
}

/// x becomes the solution of the factorised system of which it is the right-hand side.
template <std::size_t N, std::size_t size>
[[gnu::always_inline]] inline void solve(const std::array<Lanes, size> &f, std::array<Lanes, N> &x) {
  static_assert(size == N * (N + 1) / 2);
  for (std::size_t i = 1; i < N; ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      x[i] = x[i] - f[packed(i, k)] * x[k];
    }
  }
  for (std::size_t i = 0; i < N; ++i) {
    x[i] = x[i] * f[packed(i, i)];
  }
  for (std::size_t i = N - 1; i-- > 0;) {
    for (std::size_t k = i + 1; k < N; ++k) {
      x[i] = x[i] - f[packed(k, i)] * x[k];
    }
  }
}

} // namespace gcpdda::GCPDDA_INSTRUCTIONS
