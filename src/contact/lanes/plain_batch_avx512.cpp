// The same as plain_batch_avx2.cpp with eight lanes, for a machine that has AVX-512.

#include "contact/lanes/plain_batch.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <limits>
#include <type_traits>
#include <utility>

#if GCPDDA_HAS_COPIES

#include <immintrin.h>

#pragma GCC push_options
#pragma GCC target("avx512f,avx512dq,avx512vl")
#define GCPDDA_INSTRUCTIONS avx512
#define GCPDDA_NUM_LANES 8
#include "contact/lanes/plain_kernel.hpp"
#pragma GCC pop_options

namespace gcpdda {

std::unique_ptr<PlainBatch> make_avx512_batch() {
  return std::make_unique<avx512::LaneBatch>();
}

} // namespace gcpdda

#endif
