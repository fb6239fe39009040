// The kernels of block_lanes.hpp for the instruction set of the build.

#include "base/lanes_of_build.hpp"

#include "dynamics/lanes/block_kernel.hpp"

#include <array>
#include <cstddef>

namespace gcpdda {

namespace {

BlockLanes lanes_of(Instructions instructions) {
  return with_copy_for(
      instructions, [] { return avx512_blocks(); }, [] { return avx2_blocks(); },
      [] { return GCPDDA_INSTRUCTIONS::blocks; });
}

} // namespace

const BlockLanes &block_lanes(Instructions instructions) {
  static const std::array<BlockLanes, 3> lanes{lanes_of(Instructions::widest), lanes_of(Instructions::avx2),
                                               lanes_of(Instructions::portable)}; // in their order
  return lanes[static_cast<std::size_t>(instructions)];
}

} // namespace gcpdda
