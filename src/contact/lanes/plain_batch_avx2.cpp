// The lanes of a portable build on a machine that has AVX2. Only what stands between the pragmas is compiled
// for it: everything else that it includes, above all of the standard library, comes first, or a copy with
// such instructions might be linked into code that runs anywhere.

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

#pragma GCC push_options
#pragma GCC target("avx2")
#define GCPDDA_INSTRUCTIONS avx2
#define GCPDDA_NUM_LANES 4
#include "contact/lanes/plain_kernel.hpp"
#pragma GCC pop_options

namespace gcpdda {

std::unique_ptr<PlainBatch> make_avx2_batch() {
  return std::make_unique<avx2::LaneBatch>();
}

} // namespace gcpdda

#endif
