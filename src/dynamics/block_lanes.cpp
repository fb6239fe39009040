#include "gcpdda/base/lanes_of_build.hpp"

#include "block_kernel.hpp"

namespace gcpdda {

BlockLanes block_lanes(Instructions instructions) {
  BlockLanes lanes{};
  if (instructions == Instructions::widest) {
    lanes = avx512_blocks();
  }
  if (lanes.width == 0 && instructions != Instructions::portable) {
    lanes = avx2_blocks();
  }
  return lanes.width > 0 ? lanes : GCPDDA_INSTRUCTIONS::blocks;
}

} // namespace gcpdda
