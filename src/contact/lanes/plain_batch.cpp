// The kernels of plain_batch.hpp for the instruction set of the build.

#include "base/lanes_of_build.hpp"

#include "contact/lanes/plain_kernel.hpp"

#include <memory>

namespace gcpdda {

const RegionState PlainLanes::no_memory{.slip = -1.0};

std::unique_ptr<PlainBatch> make_plain_batch(Instructions instructions) {
  using Batch = std::unique_ptr<PlainBatch>;
  return with_copy_for(
      instructions, [] { return make_avx512_batch(); }, [] { return make_avx2_batch(); },
      [] { return Batch(std::make_unique<GCPDDA_INSTRUCTIONS::LaneBatch>()); });
}

} // namespace gcpdda
