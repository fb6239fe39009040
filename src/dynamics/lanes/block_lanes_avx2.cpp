// The lanes of a portable build on a machine that has AVX2; as in contact/lanes/plain_batch_avx2.cpp
// everything that is not made for it is included first.

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

#pragma GCC push_options
#pragma GCC target("avx2")
#define GCPDDA_INSTRUCTIONS avx2
#define GCPDDA_NUM_LANES 4
#include "dynamics/lanes/block_kernel.hpp"
#pragma GCC pop_options

namespace gcpdda {

BlockLanes avx2_blocks() {
  return avx2::blocks;
}

} // namespace gcpdda

#endif
