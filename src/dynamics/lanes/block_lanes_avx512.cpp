// The same as block_lanes_avx2.cpp with eight lanes, for a machine that has AVX-512.

#include "dynamics/lanes/block_lanes.hpp"

#include "dynamics/block_matrix.hpp"
#include "dynamics/deformable.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <limits>
#include <vector>

#if GCPDDA_HAS_COPIES

#include <immintrin.h>

#pragma GCC push_options
#pragma GCC target("avx512f,avx512dq,avx512vl")
#define GCPDDA_INSTRUCTIONS avx512
#define GCPDDA_NUM_LANES 8
#include "dynamics/lanes/block_kernel.hpp"
#pragma GCC pop_options

namespace gcpdda {

BlockLanes avx512_blocks() {
  return avx512::blocks;
}

} // namespace gcpdda

#endif
