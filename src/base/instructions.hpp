#pragma once

// The instruction sets that kernels are compiled for, and which of these copies a machine takes.

#include <cstddef>

// Kernels are compiled once more for AVX2 and for AVX-512 (*_avx2.cpp, *_avx512.cpp), unless the compiler
// cannot or the whole build uses AVX.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__AVX__)
#define GCPDDA_HAS_COPIES 1
#else
#define GCPDDA_HAS_COPIES 0
#endif

namespace gcpdda {

/// What lanes (lanes.hpp) are computed with: the widest registers this machine has, or those every machine
/// has. The results are the same. Without these instructions of its own avx2 means the next narrower ones.
enum class Instructions { widest, avx2, portable };

/// Of any set of instructions.
constexpr std::size_t most_lanes = 8;

/// Calls the one of these that is compiled for the best instructions of this machine among those wanted.
template <class OfAvx512, class OfAvx2, class OfBuild>
auto with_copy_for(Instructions wanted, OfAvx512 &&of_avx512, OfAvx2 &&of_avx2, OfBuild &&of_build) {
#if GCPDDA_HAS_COPIES
  if (wanted == Instructions::widest && __builtin_cpu_supports("avx512f") &&
      __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl")) {
    return of_avx512();
  }
  if (wanted != Instructions::portable && __builtin_cpu_supports("avx2")) {
    return of_avx2();
  }
#else
  static_cast<void>(wanted);
  static_cast<void>(of_avx512);
  static_cast<void>(of_avx2);
#endif
  return of_build();
}

} // namespace gcpdda
