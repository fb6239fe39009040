#if defined(__AVX__)
#define GCPDDA_INSTRUCTIONS wide
#define GCPDDA_NUM_LANES 4
#else
#define GCPDDA_INSTRUCTIONS portable
#define GCPDDA_NUM_LANES 2
#endif
#include "plain_kernel.hpp"

namespace gcpdda {

const RegionMemory PlainLanes::no_memory{.slip = -1.0, .position = {}, .dilation = {}};

std::unique_ptr<PlainBatch> make_plain_batch(Instructions instructions) {
  if (instructions == Instructions::widest) {
    if (std::unique_ptr<PlainBatch> wide = make_avx2_batch()) {
      return wide;
    }
  }
  return std::make_unique<GCPDDA_INSTRUCTIONS::LaneBatch>();
}

} // namespace gcpdda
