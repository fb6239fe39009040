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

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__AVX__)

#include <immintrin.h>

#pragma GCC push_options
#pragma GCC target("avx512f,avx512dq,avx512vl")
#define GCPDDA_INSTRUCTIONS avx512
#define GCPDDA_NUM_LANES 8
#include "contact/lanes/plain_kernel.hpp"
#pragma GCC pop_options

namespace gcpdda {

std::unique_ptr<PlainBatch> make_avx512_batch() {
  const bool is_able = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
                       __builtin_cpu_supports("avx512vl");
  return is_able ? std::make_unique<avx512::LaneBatch>() : nullptr;
}

} // namespace gcpdda

#else

namespace gcpdda {

std::unique_ptr<PlainBatch> make_avx512_batch() {
  return nullptr;
}

} // namespace gcpdda

#endif
